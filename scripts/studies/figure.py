"""The figure of a sample: how the quantity is spread, what its variance comes from, and how well derivatives foretell it."""
import matplotlib
import numpy

from studies.analysis import PROBABILITIES

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

INK, FAINT, GRID = "#1f2937", "#6b7280", "#e5e7eb"
COLORS = {"regression": "#2563eb", "bins": "#f59e0b", "derivatives": "#10b981"}
STYLE = {"font.size": 10, "font.family": "sans-serif", "text.color": INK, "axes.edgecolor": GRID, "axes.labelcolor": INK,
         "xtick.color": INK, "ytick.color": INK, "axes.titlesize": 11, "axes.titlelocation": "left", "axes.grid": True,
         "axes.axisbelow": True, "grid.color": GRID, "legend.frameon": False, "svg.hashsalt": "study", "svg.fonttype": "none"}
UNITS = {"deg": "degrees", "N": "N"}


def spoken(quantity):
    """withdrawn_deg as `withdrawn, degrees`."""
    *words, unit = quantity.split("_")
    kind = "angle " if unit == "deg" else ""
    return f"{kind}{' '.join(words)}, {UNITS[unit]}" if unit in UNITS else quantity


def draw_spread(axes, quantity, sample, marks, control):
    """Distribution function of runs and linear prediction, and the quantiles with their bars."""
    values = numpy.sort(sample.values)
    axes.step(values, (numpy.arange(len(values)) + 0.5) / len(values), where="mid", color=COLORS["regression"],
              label=f"{len(values)} runs")
    if control:
        foretold = numpy.sort(control(sample.points))
        axes.plot(foretold, (numpy.arange(len(values)) + 0.5) / len(values), color=COLORS["derivatives"], linewidth=1.2,
                  label=f"linear, from {len(control.each)} runs")
    for probability, (middle, low, high) in zip(PROBABILITIES, marks):
        low, high = (low if numpy.isfinite(low) else values[0]), (high if numpy.isfinite(high) else values[-1])
        axes.errorbar(middle, probability, xerr=[[middle - low], [high - middle]], color=INK, marker="o", markersize=4, capsize=3)
        axes.annotate(f"{middle:.4g}", (high, probability), xytext=(6, -4), textcoords="offset points")
    axes.set(title="Distribution, with quantiles and their 95 % bars", xlabel=spoken(quantity), ylabel="share of the runs below",
             ylim=(0, 1))
    axes.legend(loc="upper left")


def draw_shares(axes, sample, found):
    """Bars of each method side by side, the largest share on top."""
    names = [one.name for one in sample.parameters]
    first = next(iter(found.values()))
    order = sorted(range(len(names)), key=lambda k: first[k][0])
    height = 0.8 / len(found)
    for place, (method, column) in enumerate(found.items()):
        where = numpy.arange(len(order)) + 0.4 - height * (place + 0.5)
        shares = [100 * column[k][0] for k in order]
        bars = None if column[0][1] is None else [100 * column[k][1] for k in order]
        axes.barh(where, shares, height * 0.9, color=COLORS[method], label=method, xerr=bars,
                  error_kw={"ecolor": INK, "elinewidth": 1, "capsize": 2})
    axes.set_yticks(range(len(order)), [names[k].replace("_", " ") for k in order])
    axes.grid(visible=False, axis="y")
    axes.axvline(0, color=INK, linewidth=0.8)
    axes.set(title="Where the variance comes from, with 95 % bars", xlabel="first-order share, %")
    axes.legend(loc="lower right")


def draw_control(axes, quantity, sample, control):
    """Each run against its linear prediction."""
    foretold = control(sample.points)
    ends = [min(foretold.min(), sample.values.min()), max(foretold.max(), sample.values.max())]
    axes.plot(ends, ends, color=FAINT, linewidth=1)
    axes.scatter(foretold, sample.values, s=10, color=COLORS["regression"], linewidth=0)
    correlation = numpy.corrcoef(foretold, sample.values)[0, 1]
    axes.annotate(f"correlation {correlation:.4f}", (0.04, 0.92), xycoords="axes fraction")
    axes.set(title="Each run against the linear prediction", xlabel=f"linear, from the derivatives of {len(control.each)} runs", ylabel=spoken(quantity), aspect="equal")


def draw(folder, quantity, sample, marks, found, control):
    """Writes FOLDER/QUANTITY.svg and .png; the names of the files."""
    with plt.rc_context(STYLE):
        panels = 3 if control else 2
        picture, axes = plt.subplots(1, panels, figsize=(5 * panels, 4.2), layout="constrained")
        for one in axes:
            one.spines[["top", "right"]].set_visible(False)
        draw_spread(axes[0], quantity, sample, marks, control)
        draw_shares(axes[1], sample, found)
        if control:
            draw_control(axes[2], quantity, sample, control)
        paths = [folder / f"{quantity}.{kind}" for kind in ("svg", "png")]
        for path in paths:
            picture.savefig(path, dpi=110, metadata={"Date": None} if path.suffix == ".svg" else None)
        plt.close(picture)
    return ", ".join(map(str, paths))
