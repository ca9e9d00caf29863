#!/usr/bin/env python3
"""Makes docs/reference/: the reference solution as data, each value with its bar, and a figure.

  scripts/reference.py run [CASE[:RUN] ...]     makes the runs, in results-reference/; CASE: frictionless or friction
  scripts/reference.py write                    writes the files from them

Runs of each case, all to full withdrawal: `reference` on the finest mesh, with twice the elements in both directions of `coarse`, which
has the mesh of inputs/released.opts; and `steps` like `coarse` with another longest step (6 instead of 9 ms; with friction on the way
back 0.5 instead of 0.25). A bar is |reference - coarse| + |steps - coarse|: the whole of what mesh, contact points and steps still
change, not an extrapolated share of it. With REUSE=1 a run that is there is not made again. The program is target/release/ssnp155,
or $SSNP155; writing needs scripts/requirements.txt. The fields of the reference with friction take 5 GB.
"""
import csv
import datetime
import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = os.environ.get("SSNP155", str(ROOT / "target/release/ssnp155"))
RESULTS = ROOT / "results-reference"
DATA = ROOT / "docs/reference"
CASES = {"frictionless": "inputs/ssnp155-springback.opts", "friction": "inputs/ssnp155-friction-springback.opts"}
FINEST = ["-sheet_nx", "340", "-sheet_ny", "8", "-contact_points_per_edge", "8"]
# Every half millimetre down: steps end there, so nothing is interpolated on the way down.
REPORTED = ["-report_strokes", ",".join(f"{0.5 * k:g}" for k in range(1, 57))]
VARIANTS = {"reference": FINEST, "coarse": [], "steps": ["-dt_max", "6"]}
# With friction the sheet yields again until the punch is 1.35 mm back, and a longer step sees the end of that earlier: 0.05 degrees
# for each millisecond. So the way back has equal steps of 0.25 ms, and of 0.5 for the bar.
BACK = {"reference": "4000", "coarse": "4000", "steps": "2000"}
QUANTITIES = [("force_N", "force of the whole sheet", "%.3f"), ("dy_A_punch_mm", "DY of A, punch side", "%.5f"),
              ("dy_A_sheet_mm", "DY of A, sheet side", "%.5f"), ("angle_deg", "angle between the arms", "%.4f")]
# Sections through the thickness: middle of the sheet, the bend, the end of the bend at the shoulder; mm from the middle.
SECTIONS = [0, 15, 30]
# Force of the punch, N, from which the sheet is held.
LEAST_FORCE = 0.01
# Travel of the punch between two rows of contact regions, mm; steps on the way back are shorter.
APART = 0.05
# Share of the largest pressure from which a contact point carries.
CARRIES = 1e-6
CODE_ASTER = ROOT / "inputs/reference/code_aster-15.2-frictionless.csv"


def make(case, only):
    for name, changed in VARIANTS.items():
        if only not in ("", name):
            continue
        folder = RESULTS / f"{case}-{name}"
        if os.environ.get("REUSE") and (folder / "summary.json").exists():
            continue
        if case == "friction":
            changed = [*changed, "-fixed_steps_unload", BACK[name]]
        every = "2" if name == "reference" else "0"
        command = [PROGRAM, "-options_file", CASES[case], "-options_file", "inputs/released.opts", "-options_file", "inputs/band.opts",
                   *REPORTED, "-dt_max", "9", *changed, "-output_every", every, "-overwrite", "-output_dir", str(folder)]
        print("run:", *command[1:], file=sys.stderr, flush=True)
        subprocess.run(command, cwd=ROOT, stdout=subprocess.DEVNULL, check=False)


def load(case, name):
    """Summary and history of a run."""
    folder = RESULTS / f"{case}-{name}"
    try:
        summary = json.loads((folder / "summary.json").read_text())
    except OSError:
        sys.exit(f"reference: no run in {folder}; make it with: scripts/reference.py run {case}")
    if summary["status"] != "finished":
        sys.exit(f"reference: the run in {folder} did not finish: {summary['reason']}")
    with open(folder / "history.csv", newline="") as file:
        rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
    return summary, rows


def at(rows, time, column):
    """Value at a time, linear between rows."""
    for before, after in zip(rows, rows[1:]):
        if before["t_ms"] <= time <= after["t_ms"] + 1e-9:
            share = (time - before["t_ms"]) / (after["t_ms"] - before["t_ms"])
            return before[column] + share * (after[column] - before[column])
    return rows[-1][column]


def stages(options):
    """Stage, travel of the punch (mm) and time (ms) of the rows of a table: every half millimetre."""
    stroke, down, back = (float(options[name]) for name in ("stroke", "time_load", "time_unload"))
    halves = [0.5 * k for k in range(1, round(2 * stroke) + 1)]
    found = [("down", depth, down * depth / stroke) for depth in halves]
    return found + [("back", depth, down + back * (stroke - depth) / stroke) for depth in [*halves[-2::-1], 0.0]]


def head(case, what, summary):
    provenance = summary["provenance"]
    options = provenance["options"]
    mesh = f"{options['sheet_nx']} x {options['sheet_ny']} elements, {options['quadrature']} x {options['quadrature_thickness']} Gauss points, "
    return [
        f"# {what}; SSNP155 {'with friction, mu = 0.1342' if case == 'friction' else 'without friction'}",
        "# Units: mm, N, degrees, MPa; forces are those of the whole sheet, 30 mm wide; x from the middle of the sheet, y upwards.",
        f"# Source: ssnp155 {provenance['version']}, {mesh}{options['contact_points_per_edge']} contact points per edge; scripts/reference.py",
        f"# Date: {datetime.date.today().isoformat()}. Licence: CC0 1.0, no rights reserved (the data, not the program).",
    ]


def write(path, lines, columns, rows):
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w", newline="") as file:
        file.write("\n".join(lines) + "\n")
        table = csv.writer(file, lineterminator="\n")
        table.writerow(columns)
        table.writerows(rows)
    print("written:", path.relative_to(ROOT), len(rows), "rows")


def bar(value, coarse, steps):
    """A bar to two digits; 0 where only rounding is left."""
    width = abs(value - coarse) + abs(steps - coarse)
    return f"{width:.2g}" if width > 1e-9 else "0"


def history(case):
    """Writes force, DY and angle with their bars; returns the rows for the figure and the released angles."""
    runs = {name: load(case, name) for name in VARIANTS}
    summary, rows = runs["reference"]
    table, columns = [], ["way", "travel_mm"]
    for name, _, _ in QUANTITIES:
        columns += [name, f"bar_{name}"]
    for way, travel, time in stages(summary["provenance"]["options"]):
        line = [way, f"{travel:g}"]
        for name, _, form in QUANTITIES:
            value, coarse, steps = (at(runs[run][1], time, name) for run in ("reference", "coarse", "steps"))
            line += [form % value, bar(value, coarse, steps)]
        table.append(line)
    write(DATA / f"{case}-history.csv", head(case, "Force, displacement of A and angle against the travel of the punch", summary),
          columns, table)
    angles = []
    for place in runs["reference"][0]["angles_deg"]:
        value, coarse, steps = (runs[run][0]["angles_deg"].get(place) for run in ("reference", "coarse", "steps"))
        if None not in (value, coarse, steps):
            angles.append([place, f"{value:.4f}", bar(value, coarse, steps)])
    write(DATA / f"{case}-angles.csv", head(case, "Angle between the arms", summary), ["state", "angle_deg", "bar_angle_deg"], angles)
    return table


def contact_regions(case):
    """Writes where each face of the sheet carries a pressure, as intervals of x in the undeformed sheet."""
    from field_files import Fields

    summary, history_rows = load(case, "reference")
    options = summary["provenance"]["options"]
    stroke, down, back = (float(options[name]) for name in ("stroke", "time_load", "time_unload"))
    fields = Fields(RESULTS / f"{case}-reference" / "contact.vtkhdf")
    apart = 1.01 * float(options["sheet_length"]) / 2 / float(options["sheet_nx"])
    rows, before = [], None
    for time in fields.times:
        # When the punch has left the sheet, what touches where is rounding.
        if at(history_rows, time, "force_N") < LEAST_FORCE:
            continue
        travel = stroke * time / down if time <= down else stroke * (1.0 - (time - down) / back)
        if before is not None and time > down and abs(travel - before) < APART:
            continue
        before = travel
        points, arrays = fields.at(time)
        pressure = arrays["contact_pressure"]
        # Open points keep multipliers of the size of rounding.
        least = CARRIES * max(pressure.max(), 1e-300)
        for face, height in [("punch", float(options["sheet_thickness"])), ("die", 0.0)]:
            here = [k for k in range(len(points)) if abs(points[k][1] - height) < 1e-9 and pressure[k] > least]
            places = sorted(float(points[k][0]) for k in here)
            for first, last in intervals(places, apart):
                rows.append(["down" if time <= down + 1e-9 else "back", f"{travel:.4f}", face, f"{first:.4f}", f"{last:.4f}"])
    write(DATA / f"{case}-contact.csv", [*head(case, "Where the sheet touches: first and last contact point of each region", summary),
          f"# Points that carry are one region where they are no more than an element, {apart:.3f} mm, apart; x in the undeformed sheet."],
          ["way", "travel_mm", "tool", "from_x_mm", "to_x_mm"], rows)


def intervals(places, gap):
    """First and last of each run of sorted places that are no further apart than `gap`."""
    found = []
    for place in places:
        if found and place - found[-1][1] <= gap:
            found[-1][1] = place
        else:
            found.append([place, place])
    return found


def shapes(case):
    """Writes both faces of the sheet loaded, after 10 % and released, and the plastic strain through the thickness."""
    from field_files import Fields

    summary, _ = load(case, "reference")
    options = summary["provenance"]["options"]
    down, back, thick = (float(options[name]) for name in ("time_load", "time_unload", "sheet_thickness"))
    fields = Fields(RESULTS / f"{case}-reference" / "fields.vtkhdf")
    states = {"full_stroke": down, "10_percent_back": down + 0.1 * back, "released": fields.times[-1]}
    placed = {state: fields.between(time, "displacement") for state, time in states.items()}
    points = placed["full_stroke"][0]
    rows = []
    for face, height in [("lower", 0.0), ("upper", thick)]:
        nodes = sorted((k for k in range(len(points)) if abs(points[k][1] - height) < 1e-9), key=lambda k: points[k][0])
        # Every second: the corners of the elements.
        for node in nodes[::2]:
            line = [face, f"{points[node][0]:.5f}"]
            for _, displacement in placed.values():
                line += [f"{points[node][axis] + displacement[node][axis]:.5f}" for axis in (0, 1)]
            rows.append(line)
    columns = ["face", "x0_mm"] + [f"{axis}_{state}_mm" for state in states for axis in ("x", "y")]
    write(DATA / f"{case}-profile.csv", head(case, "Profile of the sheet at the corners of its elements", summary), columns, rows)
    plastic = {state: fields.between(time, "equivalent_plastic_strain")[1] for state, time in states.items() if state != "10_percent_back"}
    rows = []
    for section in SECTIONS:
        nearest = min((x for x in points[:, 0]), key=lambda x: abs(x - section))
        column = sorted((k for k in range(len(points)) if abs(points[k][0] - nearest) < 1e-9), key=lambda k: points[k][1])
        for node in column:
            rows.append([f"{nearest:.4f}", f"{points[node][1]:.5f}", *(f"{values[node]:.6f}" for values in plastic.values())])
    write(DATA / f"{case}-plastic-strain.csv", [*head(case, "Equivalent plastic strain through the thickness of three sections", summary),
          "# Averaged at the nodes from bilinear fits in the elements; x0 and y0 in the undeformed sheet."],
          ["x0_mm", "y0_mm", *(f"plastic_strain_{state}" for state in plastic)], rows)


def figure(tables):
    """Force against the travel of the punch, with code_aster's curve, as SVG."""
    width, height, left, bottom, right, top = 820, 460, 64, 52, 16, 18
    most_x, most_y = 29.0, 320.0

    def place(x, y):
        return (left + (width - left - right) * x / most_x, height - bottom - (height - bottom - top) * y / most_y)

    def line(points, color, dash=""):
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in (place(*point) for point in points))
        return f'<polyline points="{path}" fill="none" stroke="{color}" stroke-width="1.6"{dash}/>'

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="13">',
           f'<rect width="{width}" height="{height}" fill="white"/>']
    for x in range(0, 29, 4):
        (a, b), (_, c) = place(x, 0), place(x, most_y)
        out += [f'<line x1="{a:.1f}" y1="{b:.1f}" x2="{a:.1f}" y2="{c:.1f}" stroke="#ddd"/>',
                f'<text x="{a:.1f}" y="{b + 18:.1f}" text-anchor="middle">{x}</text>']
    for y in range(0, 301, 50):
        (a, b), (c, _) = place(0, y), place(most_x, y)
        out += [f'<line x1="{a:.1f}" y1="{b:.1f}" x2="{c:.1f}" y2="{b:.1f}" stroke="#ddd"/>',
                f'<text x="{a - 6:.1f}" y="{b + 4:.1f}" text-anchor="end">{y}</text>']
    with open(CODE_ASTER, newline="") as file:
        rows = csv.DictReader(row for row in file if not row.startswith("#"))
        aster = [(float(row["punch_mm"]), float(row["force_punch_N"])) for row in rows]
    peak = max(range(len(aster)), key=lambda k: aster[k][0])
    dotted = ' stroke-dasharray="2 3"'
    out += [line([point for point in aster[:peak + 1] if point[1] <= most_y], "#888")]
    legend = [("code_aster 15.2, without friction", "#888", "")]
    for case, color, label in [("frictionless", "#1f6fb4", "without friction"), ("friction", "#c8431f", "friction 0.1342")]:
        rows = tables.get(case)
        if not rows:
            continue
        # Columns of a row: way, travel, force.
        down = [(float(row[1]), float(row[2])) for row in rows if row[0] == "down"]
        back = [down[-1]] + [(float(row[1]), float(row[2])) for row in rows if row[0] == "back"]
        out += [line([(0.0, 0.0), *down], color), line(back, color, dotted)]
        legend += [(f"reference, {label}", color, ""), (f"reference, {label}, on the way back", color, dotted)]
    for number, (label, color, dash) in enumerate(legend):
        y = height - bottom - 16 - 19 * (len(legend) - 1 - number)
        x = place(2.8, 0)[0]
        out += [f'<line x1="{x}" y1="{y - 4}" x2="{x + 28}" y2="{y - 4}" stroke="{color}" stroke-width="1.6"{dash}/>',
                f'<text x="{x + 36}" y="{y}">{label}</text>']
    (a, b), (c, _) = place(0, 0), place(most_x, 0)
    out += [f'<line x1="{a}" y1="{b}" x2="{c}" y2="{b}" stroke="black"/>', f'<line x1="{a}" y1="{b}" x2="{a}" y2="{top}" stroke="black"/>',
            f'<text x="{(a + c) / 2}" y="{height - 12}" text-anchor="middle">travel of the punch, mm</text>',
            f'<text x="16" y="{height / 2}" text-anchor="middle" transform="rotate(-90 16 {height / 2})">force of the punch, N</text>', "</svg>"]
    (DATA / "force.svg").write_text("\n".join(out) + "\n")


def main(arguments):
    match arguments:
        case ["run", *cases]:
            for case, _, only in (word.partition(":") for word in cases or CASES):
                if case not in CASES or only not in ("", *VARIANTS):
                    sys.exit(__doc__)
                make(case, only)
        case ["write"]:
            tables = {}
            for case in CASES:
                tables[case] = history(case)
                contact_regions(case)
                shapes(case)
            figure(tables)
        case _:
            sys.exit(__doc__)


if __name__ == "__main__":
    main(sys.argv[1:])
