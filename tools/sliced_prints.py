# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights of prints beside those of PrusaSlicer, with the same settings.

    python tools/sliced_prints.py

Needs numpy and `prusa-slicer` on the path. It widens strips of solid infill under slopes by three
lines, so that wedges and lying cylinders become heavier than their layers need.
"""

from __future__ import annotations

import re
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from loading import load_checkout

WIDTH, HEIGHT, WALLS, LAYERS, INFILL, DENSITY = 0.45, 0.2, 2, 4, 15, 1.24  # mm and g/cm³
SETTINGS = {
    "--perimeters": WALLS,
    "--top-solid-layers": LAYERS,
    "--bottom-solid-layers": LAYERS,
    "--layer-height": HEIGHT,
    "--first-layer-height": HEIGHT,
    "--fill-density": f"{INFILL}%",
    "--fill-pattern": "gyroid",
    "--filament-density": DENSITY,
    "--filament-diameter": 1.75,
    "--nozzle-diameter": 0.4,
    "--skirts": 0,
    "--brim-width": 0,
    **{
        f"--{name}extrusion-width": WIDTH
        for name in (
            "",
            "external-perimeter-",
            "perimeter-",
            "infill-",
            "solid-infill-",
            "top-infill-",
            "first-layer-",
        )
    },
}
TURN = 2.0 * np.pi * np.arange(96) / 96
OUTLINES = {  # and whether the prism lies
    "cube": ([(0, 0), (20, 0), (20, 20), (0, 20)], 20.0, False),
    "angle": ([(0, 0), (40, 0), (40, 15), (15, 15), (15, 40), (0, 40)], 25.0, False),
    "cylinder": (15.0 * np.column_stack([np.cos(TURN), np.sin(TURN)]), 30.0, False),
    "wedge": ([(0, 0), (40, 0), (40, 25)], 30.0, True),
    "lying cylinder": (15.0 * np.column_stack([np.cos(TURN), np.sin(TURN)]), 30.0, True),
}


def prism(outline: np.ndarray, height: float) -> tuple[np.ndarray, np.ndarray]:
    """Return points and triangles of a prism over an outline that its first corner sees."""
    count = len(outline)
    low = np.column_stack([outline, np.zeros(count)])
    faces = [(0, i + 1, i) for i in range(1, count - 1)]
    faces += [(count, count + i, count + i + 1) for i in range(1, count - 1)]
    for i in range(count):
        j = (i + 1) % count
        faces += [(i, j, j + count), (i, j + count, i + count)]
    return np.vstack([low, low + [0.0, 0.0, height]]), np.array(faces)


def sliced_grams(points: np.ndarray, faces: np.ndarray, folder: Path) -> float:
    """Return the weight that the slicer states for a mesh in mm."""
    part, gcode = folder / "part.obj", folder / "part.gcode"
    rows = [f"v {x} {y} {z}" for x, y, z in points.tolist()]
    rows += [f"f {a} {b} {c}" for a, b, c in (faces + 1).tolist()]
    part.write_text("\n".join(rows) + "\n")  # it drops a last line without an end
    options = [str(item) for pair in SETTINGS.items() for item in pair]
    command = ["prusa-slicer", "--export-gcode", *options, "--output", str(gcode), str(part)]
    subprocess.run(command, check=True, capture_output=True)
    found = re.search(r"filament used \[g\] = ([\d.]+)", gcode.read_text())
    assert found
    return float(found[1])


def main() -> None:
    """Print a row of the table in docs/walls.md for each body."""
    usage = subprocess.run(["prusa-slicer", "--help"], capture_output=True, text=True).stdout
    print(*re.findall(r"PrusaSlicer-\S+", usage))
    load_checkout()
    from body_moments.core.mesh import Surface
    from body_moments.core.polyhedron import polyhedron_moments
    from body_moments.core.wall import find_core

    for name, (outline, height, lies) in OUTLINES.items():
        points, faces = prism(np.array(outline, float), height)
        if lies:
            points = points @ np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
        surface = Surface.from_triangles(points, faces)
        core = find_core(surface, WALLS * WIDTH, LAYERS * HEIGHT, LAYERS * HEIGHT).surface
        whole, inner = (
            polyhedron_moments(each, allow_open=True)[0].total for each in (surface, core)
        )
        ours = (whole - (1.0 - INFILL / 100.0) * inner) * DENSITY * 1e-3
        with tempfile.TemporaryDirectory() as folder:
            theirs = sliced_grams(points, faces, Path(folder))
        print(f"| {name} | {ours:.2f} | {theirs:.2f} | {100 * (ours / theirs - 1):+.1f} % |")


main()
