"""What the runs of a sample say of one quantity: mean, quantiles, and which parameter its variance comes from.

Shares of the variance ("first-order indices", Sobol' 1993) are estimated from the runs at hand in two ways:

  regression  least squares on polynomials of second degree that are orthogonal for the parameters' distributions; the
              squared coefficients are variances (Sudret 2008)
  bins        the variance of the means in bins of one parameter, the correlation ratio (Pearson 1905) without its bias
              (Kelley 1935); needs no form of the function (Plischke, Borgonovo and Smith 2013)

and a third time without them: by derivatives, (dq/dp sd(p))^2.
"""
import itertools

import numpy
from numpy.polynomial import hermite_e, legendre
from scipy import stats

PROBABILITIES = [0.05, 0.5, 0.95]
DEGREE = 2
RUNS_PER_BIN = 20
RESAMPLES = 1000
# Two-sided 95 %.
WIDTH = 1.96


def quantiles(values):
    """(quantile, lower, upper) at each of PROBABILITIES: median-unbiased estimates (Hyndman and Fan 1996, no. 8) within
    the order statistics that hold the quantile with 95 % (Conover 1999, 3.2); a side without one is infinite."""
    found = []
    for probability in PROBABILITIES:
        middle = numpy.quantile(values, probability, method="median_unbiased")
        bounds = stats.quantile_test(values, q=middle, p=probability).confidence_interval(0.95)
        low, high = (-numpy.inf if numpy.isnan(bounds.low) else bounds.low), (numpy.inf if numpy.isnan(bounds.high) else bounds.high)
        found.append((middle, low, high))
    return found


class Regression:
    """Polynomials in the parameters, orthonormal for their distributions, and their coefficients.

    `parameters` give the columns of `points` (runs x parameters).
    """

    def __init__(self, parameters, points, values):
        dimension = len(parameters)
        self.terms = [term for term in itertools.product(range(DEGREE + 1), repeat=dimension) if sum(term) <= DEGREE]
        if len(values) < 2 * len(self.terms):
            raise ValueError(f"{len(self.terms)} terms need {2 * len(self.terms)} finished runs or more, there are {len(values)}")
        self.basis = self.columns(parameters, points)
        self.values = values
        self.first = [[k for k, term in enumerate(self.terms) if term[i] and not sum(term) - term[i]] for i in range(dimension)]

    def columns(self, parameters, points):
        each = []
        for parameter, column in zip(parameters, points.T):
            x, orders = parameter.standard(column), numpy.arange(DEGREE + 1)
            if parameter.kind == "normal":
                factorials = numpy.cumprod([1, *orders[1:]])
                each.append(hermite_e.hermevander(x, DEGREE) / numpy.sqrt(factorials))
            else:
                each.append(legendre.legvander(x, DEGREE) * numpy.sqrt(2 * orders + 1))
        return numpy.stack([numpy.prod([each[i][:, n] for i, n in enumerate(term)], axis=0) for term in self.terms], axis=1)

    def fit(self, chosen=slice(None)):
        """Coefficients, their variances, and the variance that is left."""
        basis, values = self.basis[chosen], self.values[chosen]
        coefficients, *_ = numpy.linalg.lstsq(basis, values)
        left = values - basis @ coefficients
        noise = left @ left / (len(values) - len(self.terms))
        return coefficients, noise * numpy.diag(numpy.linalg.pinv(basis.T @ basis)), noise

    def shares(self, chosen=slice(None)):
        """First-order share of each parameter, share of the joint terms, share of what the polynomials leave."""
        coefficients, uncertainty, noise = self.fit(chosen)
        # A squared estimate is too large by its variance.
        variances = coefficients**2 - uncertainty
        first = numpy.array([variances[members].sum() for members in self.first])
        total = variances[1:].sum() + noise
        return numpy.array([*first, variances[1:].sum() - first.sum(), noise]) / total

    def slopes(self, parameters):
        """Mean slope by each parameter, and its standard error."""
        coefficients, uncertainty, _ = self.fit()
        linear_terms = [self.terms.index(tuple(int(i == k) for i in range(len(parameters)))) for k in range(len(parameters))]
        return [(coefficients[k] / one.deviation, uncertainty[k]**0.5 / one.deviation) for k, one in zip(linear_terms, parameters)]

    def unseen(self):
        """Share of the variance that the polynomials explain of runs they have not seen: each in turn is left out."""
        hat = numpy.einsum("ij,ji->i", self.basis, numpy.linalg.pinv(self.basis))
        coefficients, _, _ = self.fit()
        left = (self.values - self.basis @ coefficients) / (1 - hat)
        return 1 - numpy.mean(left**2) / numpy.var(self.values)


def bins(points, values):
    """First-order share of each parameter by the means in equally full bins."""
    number = max(2, len(values) // RUNS_PER_BIN)
    whole = ((values - values.mean())**2).sum()
    found = []
    for column in points.T:
        parts = numpy.array_split(values[numpy.argsort(column, kind="stable")], number)
        within = sum(((part - part.mean())**2).sum() for part in parts)
        found.append(1 - (len(values) - 1) / (len(values) - number) * within / whole)
    return numpy.array(found)


def deviation_by_resampling(estimate, runs, resamples=RESAMPLES):
    """Standard deviation of `estimate(chosen runs)` over resampled runs (Efron 1979)."""
    chance = numpy.random.default_rng(1)
    return numpy.std([estimate(chance.integers(runs, size=runs)) for _ in range(resamples)], axis=0, ddof=1)


def linear_shares(parameters, slopes):
    """Share of each parameter if the quantity were linear with these slopes."""
    variances = (slopes * [one.deviation for one in parameters])**2
    return variances / variances.sum()


def controlled_mean(values, control, mean):
    """The mean of `values` by help of a `control` whose mean is known (Lavenberg and Welch 1981), and its standard error
    for independent runs."""
    weight = numpy.cov(values, control)[0, 1] / numpy.var(control, ddof=1)
    rest = values - weight * (control - mean)
    return rest.mean(), numpy.sqrt(rest.var(ddof=2) / len(values))


def gain(values, control, mean, size):
    """By what factor the control lowers the variance of the mean of `size` runs: measured on groups drawn from all."""
    chance = numpy.random.default_rng(1)
    plain, helped = [], []
    for _ in range(RESAMPLES):
        order = chance.permutation(len(values))
        for group in range(len(values) // size):
            chosen = order[group * size:(group + 1) * size]
            plain.append(values[chosen].mean())
            helped.append(controlled_mean(values[chosen], control[chosen], mean)[0])
    return numpy.var(plain) / numpy.var(helped)
