"""What is to be run: parameters, their values in every run, and the options all runs share."""
import dataclasses
import itertools
import statistics
import sys
import warnings

# What the campaign gives every run itself, and what is no single run.
NOT_SHARED = {"-output_dir", "-output_every", "-overwrite", "-restart", "-dry_run", "-identify", "-design", "-parameters"}


@dataclasses.dataclass
class Plan:
    """Runs, each a list of values as words, one for each name; `words` is what makes this plan and no other."""
    words: dict
    names: list
    runs: list
    options: list


@dataclasses.dataclass
class Parameter:
    """An option that varies by chance: uniform between `first` and `second`, or normal with this mean and deviation."""
    name: str
    kind: str
    first: float
    second: float

    def value(self, probability):
        """The quantile."""
        if self.kind == "normal":
            return statistics.NormalDist(self.first, self.second).inv_cdf(probability)
        return self.first + (self.second - self.first) * probability

    @property
    def mean(self):
        return self.first if self.kind == "normal" else (self.first + self.second) / 2

    @property
    def deviation(self):
        return self.second if self.kind == "normal" else (self.second - self.first) / 12**0.5

    def standard(self, values):
        """From -1 to 1, or with mean 0 and deviation 1."""
        half = self.second if self.kind == "normal" else (self.second - self.first) / 2
        return (values - self.mean) / half


def factor(word):
    """Name and what is behind the sign of equality."""
    name, sign, rest = word.lstrip("-").partition("=")
    if not (name and sign and rest):
        sys.exit(f"study: '{word}' is no parameter; write NAME=..., for example friction_coefficient=0,0.1342")
    return name, rest


def parameter(word):
    """NAME=low:high or NAME=normal:mean:deviation."""
    name, rest = factor(word)
    parts = rest.split(":")
    kind = "normal" if parts[0] == "normal" else "uniform"
    try:
        first, second = map(float, parts[1:] if kind == "normal" else parts)
    except ValueError:
        sys.exit(f"study: '{word}' has no distribution; write {name}=low:high or {name}=normal:mean:deviation")
    if kind == "uniform" and not first < second:
        sys.exit(f"study: '{word}': the lower bound {first:g} is not below the upper one {second:g}")
    if kind == "normal" and not second > 0:
        sys.exit(f"study: '{word}': the deviation {second:g} has to be above 0")
    return Parameter(name, kind, first, second)


def checked(names, options):
    """Refuses what would make one run overwrite another's files or values."""
    for name in names:
        if names.count(name) > 1:
            sys.exit(f"study: parameter {name} is there twice; give each once")
        if f"-{name}" in options:
            sys.exit(f"study: -{name} is a parameter of the study, so it cannot be among the options as well; take one out")
        if f"-{name}" in NOT_SHARED:
            sys.exit(f"study: {name} cannot be a parameter; the study gives it to each run")
    for option in NOT_SHARED.intersection(options):
        sys.exit(f"study: {option} cannot be among the options of a study; leave it out")


def factorial(words, options):
    """All combinations of the values; the last parameter changes fastest."""
    factors = dict(pair for pair in map(factor, words))
    checked([factor(word)[0] for word in words], options)
    levels = {name: rest.split(",") for name, rest in factors.items()}
    for name, values in levels.items():
        if "" in values or len(set(values)) < len(values):
            sys.exit(f"study: {name}={factors[name]}: a value is empty or there twice; write NAME=value,value,...")
    return Plan({"plan": "factorial", "parameters": factors}, list(levels), list(map(list, itertools.product(*levels.values()))),
                options)


def sample(kind, runs, seed, words, options):
    """Runs with parameters drawn by chance."""
    parameters = [parameter(word) for word in words]
    checked([one.name for one in parameters], options)
    if runs < 2:
        sys.exit(f"study: a sample of {runs} runs says nothing; take 2 or more")
    if seed < 0:
        sys.exit(f"study: --seed {seed}: take 0 or more")
    # Ten digits: the table has exactly what the program got.
    values = [[f"{one.value(p):.10g}" for one, p in zip(parameters, row)] for row in probabilities(kind, runs, seed, len(parameters))]
    said = {"plan": kind, "runs": runs, "seed": seed, "parameters": dict(map(factor, words))}
    return Plan(said, [one.name for one in parameters], values, options)


def missing(error, what):
    """A sentence for a package that is not there."""
    return (f"study: {what} needs the package '{error.name}', which {sys.executable} does not have; "
            "pip install --requirement scripts/requirements.txt")


def probabilities(kind, runs, seed, dimension):
    """`runs` points of the unit cube: scrambled Sobol' points (Sobol' 1967; Owen 1998), a Latin hypercube (McKay,
    Beckman and Conover 1979), or independent ones."""
    try:
        import numpy
        from scipy.stats import qmc
    except ImportError as error:
        sys.exit(missing(error, "a sample"))
    chance = numpy.random.default_rng(seed)
    if kind == "random":
        points = chance.random((runs, dimension))
    elif kind == "lhs":
        points = qmc.LatinHypercube(dimension, rng=chance).random(runs)
    else:
        if runs & (runs - 1):
            print(f"study: {runs} is no power of two, so the Sobol' points are not balanced; 2^m would be better", file=sys.stderr)
        with warnings.catch_warnings(action="ignore", category=UserWarning):
            points = qmc.Sobol(dimension, rng=chance).random(runs)
    # A quantile of probability 0 may be infinite.
    return numpy.clip(points, 1e-12, 1 - 1e-12).tolist()
