#!/usr/bin/env python3
"""Measures the figures of docs/performance.md. Called by scripts/bench.sh, which says how to use it."""
import json
import math
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
TARGET = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
PROGRAM = TARGET / "release/ssnp155"
RESULTS = ROOT / "results-bench"
PAGE = ROOT / "docs/performance.md"
COMMITTED = ROOT / "docs/performance.json"
# A count or a ratio may be worse than the committed one by this share.
TOLERANCE = 0.10
BAND = ["-options_file", "inputs/band.opts"]
WHOLE = ["-condensed_pc_type", "cholesky"]
# The first 5 mm: contact grows at the die's shoulder, nothing slides through yet.
START = ["-stroke", "5", "-time_load", "157.89473684", "-unload_fraction", "0", "-report_strokes", "none",
         "-output_every", "0"]


def run(name, options, ranks=1, **environment):
    """One run: its counts, times, events and memory."""
    folder = RESULTS / name
    folder.mkdir(parents=True, exist_ok=True)
    log = folder / "log.txt"
    command = [str(PROGRAM), "-options_file", "inputs/ssnp155.opts", *options, "-overwrite", "-output_dir", str(folder),
               "-log_view", f":{log}"]
    if ranks > 1:
        command = ["mpirun", "-n", str(ranks), *command]
    print(f"bench: {name}: {ranks} rank(s), {' '.join(options)}", file=sys.stderr, flush=True)
    with open(folder / "run.log", "w") as output:
        process = subprocess.Popen(command, cwd=ROOT, stdout=output, stderr=subprocess.STDOUT,
                                   env={**os.environ, **environment})
        _, status, usage = os.wait4(process.pid, 0)
    summary = json.loads((folder / "summary.json").read_text())
    if summary["status"] not in ("finished", "not_converged") or not os.WIFEXITED(status):
        sys.exit(f"bench: {name} did not finish; see {folder / 'run.log'}")
    text = log.read_text()
    counts, timing = summary["counts"], summary["timing"]
    return {
        "ranks": ranks,
        "unknowns": int(summary["provenance"]["build"]["unknowns"]),
        "steps": counts["steps"],
        "refused": counts["refused_solves"],
        "iterations": counts["newton_iterations"],
        "cpu": timing["cpu_s"],
        "wall": timing["wall_s"],
        "memory": usage.ru_maxrss / 1024,
        "events": events(text),
        "messages": messages(text),
        "force": summary["final"]["force_N"],
        "summary": summary,
        "angle": summary["final"]["angle_deg"],
    }


def least(runs):
    """The runs of a table, each the one of three that took least: round by round, so that what else a machine does
    meets all of them."""
    rounds = [{label: run(*words, **more) for label, (words, more) in runs.items()} for _ in range(3)]
    return {label: min((results[label] for results in rounds), key=lambda result: result["wall"]) for label in runs}


def of(*words, **more):
    """A run that is still to be made."""
    return words, more


def events(log):
    """Calls and seconds of PETSc's events."""
    found = {}
    for line in log.splitlines():
        words = line.split()
        if len(words) > 10 and re.fullmatch(r"[A-Z]\w+", words[0]) and words[1].isdigit():
            try:
                found[words[0]] = (int(words[1]), float(words[3]))
            except ValueError:
                continue
    return found


def messages(log):
    """Messages between ranks, and their bytes."""
    found = re.search(r"^ 0: +Main Stage: .*", log, re.MULTILINE)
    numbers = re.findall(r"\d\.\d+e[+-]\d+", found.group(0)) if found else []
    count, length = (float(numbers[2]), float(numbers[3])) if len(numbers) > 3 else (0.0, 0.0)
    return count, count * length


def calls(result, *names):
    return sum(result["events"].get(name, (0, 0.0))[0] for name in names)


def seconds(result, *names):
    return sum(result["events"].get(name, (0, 0.0))[1] for name in names)


def factorisations(result):
    return calls(result, "SheetFactor")


def symbolic(result):
    return calls(result, "MatCholFctrSym", "MatLUFactorSym")


def per_iteration(result):
    """Seconds of the stepping for one Newton iteration."""
    return seconds(result, "TSStep") / result["iterations"]


def floor(result):
    """What the iterations would take if they were one factorisation and one assembly each."""
    one = seconds(result, "SheetFactor") / factorisations(result)
    one += seconds(result, "SheetResAndJac") / calls(result, "SheetResAndJac")
    return one * factorisations(result)


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    lines += ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def benchmark():
    """The reference case to full stroke and 10 % back, and where its time goes."""
    runs = least({
        "default: slices, MUMPS": of("slices", []),
        "MUMPS alone (`-condensed_pc_type cholesky`)": of("mumps", WHOLE),
        "PETSc's band Cholesky (`inputs/band.opts`)": of("band", BAND),
        "default with friction": of("friction", ["-options_file", "inputs/ssnp155-friction.opts"]),
    })
    rows = [
        ("processor time", [f"{r['cpu']:.1f} s" for r in runs.values()]),
        ("memory", [f"{r['memory']:.0f} MB" for r in runs.values()]),
        ("steps accepted / solves refused", [f"{r['steps']} / {r['refused']}" for r in runs.values()]),
        ("Newton iterations, refused solves included", [r["iterations"] for r in runs.values()]),
        ("linear solves, springbacks included", [factorisations(r) for r in runs.values()]),
        ("symbolic factorisations: the run and two springbacks", [symbolic(r) for r in runs.values()]),
        ("floor: factorisation and assembly alone", [f"{floor(r):.1f} s" for r in runs.values()]),
        ("processor time / floor", [f"{r['cpu'] / floor(r):.2f}" for r in runs.values()]),
        ("one Newton iteration", [f"{1e3 * per_iteration(r):.1f} ms" for r in runs.values()]),
    ]
    text = table(["", *runs], [(name, *cells) for name, cells in rows])
    parts = [
        ("factorisation", ("SheetFactor",)),
        ("forward and backward substitution", ("SheetSolve",)),
        ("residual and tangent of elements and contact points", ("SheetResAndJac",)),
        ("residual alone, where the solve is expected to end", ("SheetResidual",)),
        ("inertia of the tangent; the rest of it, too, where the solve did not end", ("SheetJacobian",)),
    ]
    of_it = [
        ("of the factorisation: entries to PETSc", ("MatSetValuesCOO",)),
        ("of it: the sparse solver", ("MatCholFctrNum", "MatLUFactorNum")),
        ("of the substitution: the sparse solver", ("MatSolve",)),
    ]
    where = [(name, " + ".join(f"`{event}`" for event in events_),
              *[f"{seconds(r, *events_):.2f}" for r in runs.values()]) for name, events_ in parts + of_it]
    where.insert(len(parts), ("everything else: fields, figures, measures, set-up", "", *[
        f"{r['wall'] - sum(seconds(r, *e) for _, e in parts):.2f}" for r in runs.values()]))
    text += "\nSeconds:\n\n" + table(["", "event", *runs], where)
    default, mumps, band, friction = runs.values()
    return text, {
        "iterations": default["iterations"], "refused": default["refused"], "symbolic": symbolic(default),
        "iterations with friction": friction["iterations"], "refused with friction": friction["refused"],
        "processor time / floor": default["cpu"] / floor(default),
        "default / MUMPS alone, processor time": default["cpu"] / mumps["cpu"],
        "default / band, processor time": default["cpu"] / band["cpu"],
        "friction / none, processor time": friction["cpu"] / default["cpu"],
    }


def growth():
    """The first 5 mm on four meshes."""
    meshes = [(85, 3), (170, 5), (340, 10), (680, 20)]
    text, figures = "", {}
    for solver, options in (("default", []), ("band", BAND)):
        results = least({
            (nx, ny): of(f"growth-{solver}-{nx}", [*START, *options, "-sheet_nx", str(nx), "-sheet_ny", str(ny)])
            for nx, ny in meshes})
        rows = []
        for (nx, ny), result in results.items():
            rows.append((f"{nx} x {ny}", result["unknowns"], result["steps"],
                         f"{result['iterations'] / result['steps']:.2f}", f"{1e3 * per_iteration(result):.1f} ms",
                         f"{result['memory']:.0f} MB"))
        results = list(results.values())
        times, memory = (exponent(results[1:], per_iteration), exponent(results[1:], lambda r: r["memory"]))
        text += f"\n{'Default' if solver == 'default' else 'Band Cholesky'}:\n\n" + table(
            ["mesh", "unknowns", "steps", "iterations a step", "an iteration", "memory"], rows)
        text += (f"\nFrom 170 x 5 to 680 x 20 an iteration grows as the unknowns to the power {times:.2f}, "
                 f"memory {memory:.2f}.\n")
        figures[f"exponent of an iteration, {solver}"] = times
        figures[f"iterations a step, 680 x 20, {solver}"] = results[-1]["iterations"] / results[-1]["steps"]
    return text, figures


def exponent(results, quantity):
    """Slope of the least-squares line through the logarithms."""
    points = [(math.log(r["unknowns"]), math.log(quantity(r))) for r in results]
    mean = [sum(p[k] for p in points) / len(points) for k in (0, 1)]
    return (sum((x - mean[0]) * (y - mean[1]) for x, y in points)
            / sum((x - mean[0]) ** 2 for x, _ in points))


def whole():
    """The whole benchmark on finer meshes."""
    rows = []
    for case, options in (("none", []), ("friction", ["-options_file", "inputs/ssnp155-friction.opts"])):
        for nx, ny in ((170, 5), (340, 10), (680, 20)):
            r = run(f"whole-{case}-{nx}", [*options, "-sheet_nx", str(nx), "-sheet_ny", str(ny)])
            rows.append((f"{nx} x {ny}", case, r["unknowns"], f"{r['steps']} / {r['refused']}", r["iterations"],
                         f"{r['iterations'] / r['steps']:.1f}", certificates(r),
                         f"{r['summary']['angles_deg']['full stroke']:.3f}°", f"{released(r):.2f}°"))
    return table(["mesh", "friction", "unknowns", "steps accepted / solves refused", "iterations", "a step",
                  "certificates that hold", "angle at full stroke", "released there"], rows), {}


def certificates(result):
    """How many of the certificates of every step hold; the comparisons beside them are for the mesh of the document."""
    limits = [v for v in result["summary"]["verdicts"] if v["comparison"] == "limit"]
    return f"{sum(v['verdict'] == 'holds' for v in limits)} of {len(limits)}"


def released(result):
    return next(angle for name, angle in result["summary"]["angles_deg"].items() if name.endswith("28.5 mm"))


def large():
    """Other solvers on 680 x 20, the first 2 mm."""
    start = [*START, "-stroke", "2", "-time_load", "63.157894737", "-sheet_nx", "680", "-sheet_ny", "20"]
    mumps = [*start, *WHOLE]
    interface = ["-condensed_ksp_type", "cg", "-condensed_ksp_rtol", "1e-8", "-condensed_pc_type", "bjacobi",
                 "-condensed_sub_pc_type", "cholesky", "-condensed_sub_pc_factor_mat_solver_type", "mumps"]
    runs = least({
        "default: slices, MUMPS": of("large-slices", start),
        "MUMPS alone": of("large-mumps", mumps),
        "MUMPS with its scaling": of("large-scaled", [*mumps, "-condensed_mat_mumps_icntl_8", "77"]),
        "MUMPS, block low-rank, 1e-12": of("large-blr", [*mumps, "-condensed_mat_mumps_icntl_35", "1",
                                                         "-condensed_mat_mumps_cntl_7", "1e-12"]),
        "MUMPS, out of core": of("large-core", [*mumps, "-condensed_mat_mumps_icntl_22", "1"]),
        "band Cholesky": of("large-band", [*start, *BAND]),
    })
    runs["CG, one block a rank, 2 ranks"] = run("large-cg", [*start, *interface], ranks=2)
    text = table(["", "iterations", "an iteration", "factorisation", "solves", "memory of a rank"], [
        (name, r["iterations"], f"{1e3 * per_iteration(r):.0f} ms",
         f"{seconds(r, 'SheetFactor'):.1f} s", f"{seconds(r, 'SheetSolve'):.1f} s", f"{r['memory']:.0f} MB")
        for name, r in runs.items()])
    return text, {}


def ranks():
    """Strong and weak scaling of the first 5 mm, and the same answer on more ranks than cores."""
    mesh = lambda nx, ny: ["-sheet_nx", str(nx), "-sheet_ny", str(ny)]
    fine = [*START, *mesh(680, 20)]
    strong = least({
        "1": of("strong-1", fine),
        "2": of("strong-2", fine, 2),
        # MUMPS asks MPI for messages at every block of its fronts, on one rank as well; each question yields the core.
        "1, yielding (`OMPI_MCA_mpi_yield_when_idle=1`)":
            of("strong-1-yield", fine, OMPI_MCA_mpi_yield_when_idle="1"),
        "2, yielding": of("strong-2-yield", fine, 2, OMPI_MCA_mpi_yield_when_idle="1"),
        "2, MUMPS over both (`-condensed_pc_type cholesky`)":
            of("strong-2-whole", [*fine, *WHOLE], 2),
    })
    text = "\nStrong, 680 x 20:\n\n" + rank_table(strong)
    weak = least({str(n): of(f"weak-{n}", [*START, *mesh(340 * n, 20)], n) for n in (1, 2)})
    text += "\nWeak, 340 x 20 for each rank:\n\n" + rank_table(weak)
    many = [run(f"many-{n}", [*START, *mesh(170, 5)], n) for n in (1, 2, 4, 8)]
    text += "\nMore ranks than cores, 170 x 5 (for correctness):\n\n" + table(
        ["ranks", "force, relative difference", "angle, difference", "iterations", "memory of a rank"],
        [(r["ranks"], f"{abs(r['force'] / many[0]['force'] - 1):.0e}",
          f"{abs(r['angle'] - many[0]['angle']):.0e}°", r["iterations"], f"{r['memory']:.0f} MB") for r in many])
    return text, {
        "time on 2 ranks / on 1, 680 x 20": per_iteration(strong["2"]) / per_iteration(strong["1"]),
        "messages an iteration, 680 x 20, 2 ranks": strong["2"]["messages"][0] / strong["2"]["iterations"],
        "bytes an iteration, 680 x 20, 2 ranks": strong["2"]["messages"][1] / strong["2"]["iterations"],
    }


def rank_table(runs):
    first = runs["1"]
    return table(
        ["ranks", "iterations", "an iteration", "speed-up", "factorisation", "solves", "residual and tangent",
         "messages an iteration", "bytes an iteration", "memory of a rank"],
        [(name, r["iterations"], f"{1e3 * per_iteration(r):.0f} ms",
          f"{per_iteration(first) / per_iteration(r):.2f}",
          f"{seconds(r, 'SheetFactor'):.1f} s", f"{seconds(r, 'SheetSolve'):.1f} s",
          f"{seconds(r, 'SheetResAndJac', 'SheetResidual', 'SheetJacobian'):.1f} s",
          f"{r['messages'][0] / r['iterations']:.0f}", f"{r['messages'][1] / r['iterations'] / 1e6:.2f} MB",
          f"{r['memory']:.0f} MB") for name, r in runs.items()])


def kernels():
    """The kernels by themselves, from `cargo bench`."""
    command = ["cargo", "bench", "--locked", "--bench", "kernels", "--", "--warm-up-time", "1",
               "--measurement-time", "3"]
    print("bench:", " ".join(command), file=sys.stderr, flush=True)
    output = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    units = {"ns": 1e-9, "µs": 1e-6, "us": 1e-6, "ms": 1e-3}
    found = re.findall(r"^(\S.*?)\s+time:\s+\[\S+ \S+ (\S+) (\S+) ", output, re.MULTILINE)
    found += re.findall(r"^(\S.*)\n\s+time:\s+\[\S+ \S+ (\S+) (\S+) ", output, re.MULTILINE)
    time = {name.strip(): float(value) * units[unit] for name, value, unit in found}
    elements = 850
    rows = [(name, f"{1e9 * t:.0f} ns" if t < 1e-5 else f"{1e3 * t:.2f} ms",
             f"{elements / t:.3g}" if name.startswith("assembly") else f"{1 / t:.3g}") for name, t in time.items()]
    return table(["kernel", "time", "a second"], rows), {
        "stress / stress and tangent, plastic":
            time["return map/plastic, stress"] / time["return map/plastic, stress and tangent"],
        "element: force / force and stiffness": time["element/force"] / time["element/force and stiffness"],
        "assembly: residual / tangent": time["assembly/residual"] / time["assembly/tangent"],
        "assembly: both at once / tangent": time["assembly/residual and tangent"] / time["assembly/tangent"],
    }


def write_page(name, text):
    """Puts a table between its marks in the page."""
    page = PAGE.read_text()
    begin, end = f"<!-- {name}: scripts/bench.sh -->\n", f"<!-- end of {name} -->\n"
    if begin not in page:
        sys.exit(f"bench: {PAGE} has no place for {name}")
    before, rest = page.split(begin)
    PAGE.write_text(before + begin + text + end + rest.split(end)[1])


def compare(name, figures, committed):
    """Prints the figures beside the committed ones; how many are worse. For all of them less is better."""
    worse = 0
    for what, value in figures.items():
        old = committed.get(what)
        mark = "new" if old is None else f"{value / old - 1:+.1%}" if old else "0 before"
        if old is not None and value > old * (1 + TOLERANCE) + 1e-12:
            worse, mark = worse + 1, mark + "  WORSE"
        print(f"{name:10} {what:45} {value:12.4g} {'' if old is None else f'{old:.4g}':>12} {mark}")
    return worse


SECTIONS = {f.__name__: f for f in (benchmark, growth, whole, large, ranks, kernels)}


def main():
    chosen = sys.argv[1:] or list(SECTIONS)
    unknown = [name for name in chosen if name not in SECTIONS]
    if unknown:
        sys.exit(f"bench: no section {unknown[0]}; there are {', '.join(SECTIONS)}")
    committed = json.loads(COMMITTED.read_text()) if COMMITTED.exists() else {}
    worse, lines = 0, {}
    for name in chosen:
        text, lines[name] = SECTIONS[name]()
        print(f"\n## {name}\n\n{text}", flush=True)
        if os.environ.get("UPDATE"):
            write_page(name, text)
    print(f"{'section':10} {'figure':45} {'now':>12} {'committed':>12} change")
    for name, figures in lines.items():
        worse += compare(name, figures, committed.get(name, {}))
    if os.environ.get("UPDATE"):
        COMMITTED.write_text(json.dumps({**committed, **lines}, indent=2) + "\n")
    elif worse:
        sys.exit(f"bench: {worse} figure(s) more than {TOLERANCE:.0%} worse than committed")


if __name__ == "__main__":
    main()
