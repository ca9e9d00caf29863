#!/usr/bin/env python3
"""What the integration through the thickness is worth for the angle after release, by beam theory, in a minute.

  scripts/thickness.py RESULTS [--figure FILE.svg]

RESULTS is a run with fields along the way (-output_every 2, one rank). The curvature of every section is taken from its fields in
time; a sheet without shear and membrane force, in plane strain, is bent by it with the benchmark's table, and its moment is
integrated through the thickness by different rules. Released elastically, the two arms open by 2 ∫ M/(E' I) dx; what a rule
gives less what 200 points give is its error. The path is that of the run, so what a wrong moment does to the path is not in
it. Needs scripts/requirements.txt. The figure shows the stress through the thickness at full stroke, and released.
"""
import pathlib
import sys

import numpy as np
from field_files import Fields

ROOT = pathlib.Path(__file__).resolve().parent.parent
YOUNG, POISSON, THICKNESS = 70500.0, 0.342, 1.0
SHEAR, PLANE = YOUNG / (2 * (1 + POISSON)), YOUNG / (1 - POISSON**2)
# Elements through the thickness and Gauss points in each.
RULES = [(5, 2), (6, 2), (8, 2), (10, 2), (16, 2), (5, 3), (6, 3), (8, 3), (4, 5), (4, 7), (4, 10), (4, 15), (8, 4)]
EXACT = 200
# Steps of the curvature between two saved states.
BETWEEN = 3
HALVINGS = 45


def curvatures(folder):
    """Saved times, places of the elements' ends (mm) and the curvature of each element in time, 1/mm."""
    fields = Fields(pathlib.Path(folder) / "fields.vtkhdf")
    rows, faces = [], None
    for time in fields.times:
        points, arrays = fields.at(time)
        if faces is None:
            height = [np.flatnonzero(np.abs(points[:, 1] - y) < 1e-9) for y in (THICKNESS, 0.0)]
            faces = [nodes[np.argsort(points[nodes, 0])][::2] for nodes in height]
            places = points[faces[0], 0]
        moved = points + arrays["displacement"]
        across = moved[faces[0]] - moved[faces[1]]
        rows.append(np.diff(np.arctan2(-across[:, 0], across[:, 1])) / np.diff(places))
    return fields.times, places, np.array(rows)


def hardening():
    """Plastic strains and flow stresses (MPa) of the benchmark's table."""
    lines = (ROOT / "inputs/reference/hardening.csv").read_text().splitlines()
    strain, stress = np.array([line.split(",") for line in lines if line[:1].isdigit()], float).T
    plastic = strain - stress / YOUNG
    plastic[0] = 0.0
    return plastic, stress


def points(elements, count):
    """Places (mm) and weights of Gauss's rule in every element through the thickness."""
    x, w = np.polynomial.legendre.leggauss(count)
    places = [((number + 0.5 + 0.5 * x) / elements - 0.5) * THICKNESS for number in range(elements)]
    return np.concatenate(places), np.tile(0.5 * w * THICKNESS / elements, elements)


def returned(total, between, plastic, flow):
    """The return in plane stress (Simo and Taylor 1986): stress sum, difference and plastic strain, and the multiplier."""
    low, high = np.zeros_like(plastic), np.full_like(plastic, 1e-2)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        square = total**2 / 6 / (1 + YOUNG * middle / (3 * (1 - POISSON))) ** 2 + 0.5 * (between / (1 + 2 * SHEAR * middle)) ** 2
        outside = 1.5 * square > flow(plastic + middle * np.sqrt(2 / 3 * square)) ** 2
        low, high = np.where(outside, middle, low), np.where(outside, high, middle)
    total, between = total / (1 + YOUNG * low / (3 * (1 - POISSON))), between / (1 + 2 * SHEAR * low)
    square = total**2 / 6 + 0.5 * between**2
    return total, between, plastic + low * np.sqrt(2 / 3 * square), low


def stresses(path, y):
    """Stress along the sheet (MPa) at the heights `y` of every element at the end of a path of curvatures."""
    abscissae, ordinates = hardening()
    shape = (path.shape[1], len(y))
    along, across, plastic = np.zeros(shape), np.zeros(shape), np.zeros(shape)
    before = np.zeros(path.shape[1])
    for after in path:
        for part in range(1, BETWEEN + 1):
            strain = -(before + (after - before) * part / BETWEEN)[:, None] * y[None, :] - along
            sx, sz = PLANE * (strain - POISSON * across), PLANE * (POISSON * strain - across)
            total, difference = sx + sz, sx - sz
            yields = np.sqrt(0.25 * total**2 + 0.75 * difference**2) > np.interp(plastic, abscissae, ordinates)
            total[yields], difference[yields], plastic[yields], flow = returned(
                total[yields], difference[yields], plastic[yields], lambda p: np.interp(p, abscissae, ordinates))
            sx, sz = 0.5 * (total + difference), 0.5 * (total - difference)
            along[yields] += flow * (2 * sx[yields] - sz[yields]) / 3
            across[yields] += flow * (2 * sz[yields] - sx[yields]) / 3
        before = after
    return sx


def figure(path, places, stress, y, sections=(2.0, 15.0, 25.0)):
    """Stress through the thickness of some sections, at full stroke and released, as SVG."""
    width, height, size, gap, reach = 840, 300, 220, 50, 320.0
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="12">',
           f'<rect width="{width}" height="{height}" fill="white"/>']
    for number, section in enumerate(sections):
        element = int(np.searchsorted(places, section)) - 1
        left, top = 50 + number * (size + gap), 30

        def curve(values, color):
            line = " ".join(f"{left + size * (0.5 + 0.5 * s / reach):.1f},{top + size * (0.5 - h / THICKNESS):.1f}" for s, h in zip(values, y))
            return f'<polyline points="{line}" fill="none" stroke="{color}" stroke-width="1.6"/>'

        moment = -(stress[element] * y).sum() * THICKNESS / len(y)
        out += [f'<rect x="{left}" y="{top}" width="{size}" height="{size}" fill="none" stroke="#999"/>',
                f'<line x1="{left + size / 2}" y1="{top}" x2="{left + size / 2}" y2="{top + size}" stroke="#ccc"/>',
                f'<line x1="{left}" y1="{top + size / 2}" x2="{left + size}" y2="{top + size / 2}" stroke="#ccc"/>',
                f'<text x="{left + size / 2}" y="20" text-anchor="middle">{section:g} mm from the middle</text>',
                curve(stress[element], "#1f6fb4"), curve(stress[element] + 12 * moment * y / THICKNESS**3, "#c8431f")]
        out += [f'<text x="{left + size * (0.5 + 0.5 * s / reach):.1f}" y="{top + size + 16}" text-anchor="middle">{s}</text>' for s in (-200, 0, 200)]
    out += [f'<text x="44" y="{30 + size * (0.5 - h) + 4:.1f}" text-anchor="end">{h:g}</text>' for h in (-0.5, 0.0, 0.5)]
    out += ['<text x="50" y="290">stress along the sheet, MPa, against the height, mm:</text>',
            '<text x="400" y="290" fill="#1f6fb4">at full stroke</text>', '<text x="500" y="290" fill="#c8431f">released</text>', "</svg>"]
    pathlib.Path(path).write_text("\n".join(out) + "\n")


def main(arguments):
    match arguments:
        case [folder]:
            picture = None
        case [folder, "--figure", picture]:
            pass
        case _:
            sys.exit(__doc__)
    _, places, path = curvatures(folder)
    exact = (np.arange(EXACT) + 0.5) / EXACT * THICKNESS - 0.5 * THICKNESS
    stress = stresses(path, exact)
    if picture:
        figure(picture, places, stress, exact)

    def opening(stress, y, weights):
        return 2 * np.degrees((-(stress * y * weights).sum(1) * np.diff(places)).sum() * 12 / (PLANE * THICKNESS**3))

    truth = opening(stress, exact, np.full(EXACT, THICKNESS / EXACT))
    print(f"Springs back by {truth:.2f} degrees.\n\n| elements x points | points | error, deg |\n|---|---|---|")
    for elements, count in RULES:
        y, weights = points(elements, count)
        print(f"| {elements} x {count} | {elements * count} | {opening(stresses(path, y), y, weights) - truth:+.3f} |", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
