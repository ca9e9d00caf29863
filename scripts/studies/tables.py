"""Runs one after another, and their Markdown: a sweep, convergence, disturbed data."""
from studies.program import RESULTS, ROOT, WITHDRAWN, quantities, run

FRICTION = "0.1342"


def show(value):
    if value is None:
        return "-"
    return f"{value:.2f}" if isinstance(value, float) else str(value)


def table(heads, rows):
    print("| " + " | ".join(heads) + " |")
    print("|" + "---|" * len(heads))
    for row in rows:
        print("| " + " | ".join(show(value) for value in row) + " |", flush=True)
    print()


def rounded(word):
    """A word of a table: a number with a fraction to six digits, another as it is."""
    try:
        return f"{float(word):.6g}" if "." in word else word
    except ValueError:
        return word


def sweep(name, values, extra):
    rows = []
    for value in values:
        found = quantities(*run(f"{name}-{value}", [f"-{name}", value, *WITHDRAWN, *extra]))
        rows.append([value, *found.values()])
    table([name, *found], rows)


def convergence(extra):
    """Three meshes with the default step, three steps on the default mesh."""
    meshes, steps = [(85, 3), (170, 5), (340, 10)], ["9", "4.5", "2.25"]
    for friction in ["0", FRICTION]:
        found = {}
        for nx, ny, largest in [(*mesh, "9") for mesh in meshes] + [(170, 5, step) for step in steps[1:]]:
            options = ["-friction_coefficient", friction, "-sheet_nx", str(nx), "-sheet_ny", str(ny)]
            options += ["-dt_max", largest, *WITHDRAWN, *extra]
            found[nx, largest] = quantities(*run(f"convergence-{friction}-{nx}-{largest}", options))
        print(f"Coefficient of friction {friction}:\n")
        heads = ["mesh", "dt_max ms", *found[170, "9"]]
        names = {nx: f"{nx} x {ny}" for nx, ny in meshes}
        table(heads, [[names[nx], largest, *values.values()] for (nx, largest), values in found.items()])
        rows = []
        for quantity in list(found[170, "9"])[:7]:
            by_mesh = [found[nx, "9"][quantity] for nx, _ in meshes]
            by_step = [found[170, step][quantity] for step in steps]
            if None in by_mesh + by_step:
                continue
            # Second order in the mesh, first in the step; the error is what the last refinement of each still changed.
            mesh, step = by_mesh[2] - by_mesh[1], by_step[2] - by_step[1]
            rows.append([quantity, by_mesh[2] + mesh / 3.0 + (by_step[2] - by_step[0]) + step,
                         abs(mesh) + abs(step), mesh, step])
        table(["quantity", "extrapolated", "error estimate", "170 to 340 changes it by",
               "the last halving of the step by"], rows)


def sensitivity(extra):
    data = ["sheet_thickness", "die_shoulder_radius", "friction_coefficient", "yield stress"]
    for friction in ["0", FRICTION]:
        base = ["-friction_coefficient", friction, *WITHDRAWN, *extra]
        middle = quantities(*run(f"sensitivity-{friction}", base))
        rows = [["none", "", "", *list(middle.values())[4:7]]]
        defaults = {"sheet_thickness": 1.0, "die_shoulder_radius": 4.0, "friction_coefficient": float(friction)}
        for name in data:
            if name == "friction_coefficient" and friction == "0":
                continue
            for sign in [-1, 1]:
                factor = 1 + 0.05 * sign
                if name == "yield stress":
                    changed = ["-hardening_file", str(scaled_hardening(factor))]
                    value = f"x {factor:.2f}"
                else:
                    value = f"{defaults[name] * factor:.5g}"
                    changed = [f"-{name}", value]
                found = quantities(*run(f"sensitivity-{friction}-{name.replace(' ', '-')}-{sign}", base + changed))
                rows.append([name, value, found["withdrawn deg"] - middle["withdrawn deg"]
                             if found["withdrawn deg"] is not None else None, *list(found.values())[4:7]])
        print(f"Coefficient of friction {friction}:\n")
        table(["changed", "to", "change of the withdrawn angle", *list(middle)[4:7]], rows)


def scaled_hardening(factor):
    """The benchmark's table with all stresses times the factor, at the same plastic strains."""
    lines = [line for line in (ROOT / "inputs/reference/hardening.csv").read_text().splitlines()
             if line and not line.startswith("#")][1:]
    path = RESULTS / f"hardening-{factor:.2f}.csv"
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w") as out:
        out.write("strain,stress\n")
        for line in lines:
            strain, stress = map(float, line.split(","))
            plastic = max(strain - stress / 70500.0, 0.0)
            plastic = 0.0 if plastic < 1e-6 else plastic
            out.write(f"{plastic + factor * stress / 70500.0:.12e},{factor * stress:.12e}\n")
    return path
