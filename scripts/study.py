#!/usr/bin/env python3
"""Runs the solver over a set of options and tabulates forces and angles.

  scripts/study.py sweep NAME VALUE,VALUE,... [OPTION ...]   one option, any values
  scripts/study.py convergence [OPTION ...]                  meshes and step sizes, both friction cases
  scripts/study.py sensitivity [OPTION ...]                  angle after release against the data, +-5 %
  scripts/study.py factorial NAME=VALUE,VALUE,... ... [CAMPAIGN] [-- OPTION ...]
                                                             all combinations of the values
  scripts/study.py sample RUNS NAME=LOW:HIGH NAME=normal:MEAN:DEVIATION ... [--plan lhs|sobol|random] [--seed 1] [CAMPAIGN] [-- OPTION ...]
                                                             values by chance: a Latin hypercube, scrambled Sobol' points, or independent
  scripts/study.py analyse FOLDER [QUANTITY] [--derivatives RUNS]
                                                             of a sample: quantiles of a column, withdrawn_deg if none is given, and the
                                                             parameters its variance comes from, with a figure; RUNS (5) more runs carry
                                                             derivatives, 0 for none

The punch is withdrawn in all of them unless an OPTION says otherwise. Tables are Markdown on standard output; options given
last go to every run. The program is target/release/ssnp155, or $SSNP155.

The first three: results of single runs stay in results-study/, or $STUDY; with REUSE=1 a run that is there is not made again.

CAMPAIGN of factorial and sample:
  --folder FOLDER  where runs.csv (a row for each run) and plan.json are; results-study/factorial or sample, if not given
  --jobs N         runs side by side, each on one rank; 1 if not given
  --again          make failed runs once more
  --keep           keep the folders of all runs, not those of failed ones only

A run that is in the table is not made again: the same command goes on after an interruption. A table of another plan, of
other options, or of another program is refused. A failed run is a row with its reason, and then the study ends with code 1.
docs/studies.md has an example.
"""
import argparse
import pathlib
import sys

from studies import campaign, plan, tables
from studies.program import RESULTS


class Words(argparse.ArgumentParser):
    """One sentence for words that make no sense."""

    def error(self, message):
        sys.exit(f"study: {message}; scripts/study.py --help says what there is")


def words_of_campaign(command):
    words = Words(prog=f"study.py {command}", add_help=False)
    if command == "sample":
        words.add_argument("runs", type=int)
        words.add_argument("--plan", choices=["lhs", "sobol", "random"], default="lhs")
        words.add_argument("--seed", type=int, default=1)
    words.add_argument("parameters", nargs="+")
    words.add_argument("--folder", type=pathlib.Path, default=RESULTS / command)
    words.add_argument("--jobs", type=int, default=1)
    words.add_argument("--again", action="store_true")
    words.add_argument("--keep", action="store_true")
    return words


def run_plan(command, arguments):
    """Makes what is missing of a factorial or a sample, and shows it."""
    end = arguments.index("--") if "--" in arguments else len(arguments)
    given = words_of_campaign(command).parse_intermixed_args(arguments[:end])
    options = arguments[end + 1:]
    if given.jobs < 1:
        sys.exit(f"study: --jobs {given.jobs}: take 1 or more")
    if command == "factorial":
        planned = plan.factorial(given.parameters, options)
    else:
        planned = plan.sample(given.plan, given.runs, given.seed, given.parameters, options)
    table = campaign.carry_out(planned, given.folder, given.jobs, given.again, given.keep)
    if command == "factorial":
        rows = [table.rows[number] for number in sorted(table.rows)]
        columns = [column for column in table.columns if any(row[column] for row in rows)]
        tables.table(columns, [[tables.rounded(row[column]) for column in columns] for row in rows])
    print(f"{given.folder}/runs.csv has the {len(table.rows)} runs")
    for number in table.failed():
        print(f"study: run {number} failed: {table.rows[number]['reason']}", file=sys.stderr)
    sys.exit(1 if table.failed() else 0)


def analyse(arguments):
    words = Words(prog="study.py analyse", add_help=False)
    words.add_argument("folder", type=pathlib.Path)
    words.add_argument("quantity", nargs="?", default="withdrawn_deg")
    words.add_argument("--derivatives", type=int, default=5)
    given = words.parse_intermixed_args(arguments)
    try:
        from studies import uncertainty
    except ImportError as error:
        sys.exit(plan.missing(error, "an analysis"))
    uncertainty.report(given.folder, given.quantity, max(0, given.derivatives))


def main(arguments):
    match arguments:
        case ["-h" | "--help", *_]:
            print(__doc__.strip())
        case ["sweep", name, values, *extra]:
            tables.sweep(name.lstrip("-"), values.split(","), extra)
        case ["convergence", *extra]:
            tables.convergence(extra)
        case ["sensitivity", *extra]:
            tables.sensitivity(extra)
        case ["factorial" | "sample" as command, *rest]:
            run_plan(command, rest)
        case ["analyse", *rest]:
            analyse(rest)
        case _:
            sys.exit(__doc__)


if __name__ == "__main__":
    main(sys.argv[1:])
