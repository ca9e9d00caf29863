"""The rooms of scripts/study.py, roof to cellar.

  analysis, figure   quantiles, shares of the variance, what derivatives tell; needs NumPy, SciPy, Matplotlib
  campaign           the runs of a plan side by side, and the progress line
  runs_table         the table of a plan's runs, which outlives an interruption
  tables             sweep, convergence, sensitivity: runs one after another, and their Markdown
  plan               what is to be run: parameters, their values, options
  program            one run, and what the tables show of it
"""
