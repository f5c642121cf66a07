# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Hydrostatics beside those of capytaine: the same numbers of the same mesh, and the times.

    python tools/benchmark_floating.py [FACES ...]

Needs numpy and capytaine 3.0.0. Times are the processor's, of the shortest of three runs.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from types import ModuleType
from typing import Any

import capytaine
import numpy as np
from loading import load_checkout

NUMBERS = {
    "disp_volume": lambda rest: rest.displacement,
    "waterplane_area": lambda rest: rest.plane.area,
    "transversal_metacentric_radius": lambda rest: rest.metacentric_radii[0],
    "longitudinal_metacentric_radius": lambda rest: rest.metacentric_radii[1],
    "transversal_metacentric_height": lambda rest: rest.metacentric_heights[0],
    "longitudinal_metacentric_height": lambda rest: rest.metacentric_heights[1],
}


def ellipsoid(faces: int) -> tuple[np.ndarray, np.ndarray]:
    """Return points and triangles of an ellipsoid of 6 by 2 by 1.6."""
    count = round((faces / 2.0) ** 0.5)
    polar = np.linspace(0.0, np.pi, count + 1)[:, None]
    turn = 2.0 * np.pi * np.arange(count) / count
    unit = [np.sin(polar) * np.cos(turn), np.sin(polar) * np.sin(turn), np.cos(polar) + 0.0 * turn]
    points = np.stack(unit, axis=-1).reshape(-1, 3) * [3.0, 1.0, 0.8]
    i, j = np.divmod(np.arange(count * count), count)
    a, b = i * count + j, i * count + (j + 1) % count
    triangles = [[a, a + count, b + count], [a, b + count, b]]
    return points, np.concatenate([np.stack(one, axis=1) for one in triangles])


def timed(run: Callable[[], Any]) -> tuple[float, Any]:
    """Return the shortest of three times of a call, s, and its result."""
    times = []
    for _ in range(3):
        start = time.process_time()
        result = run()
        times.append(time.process_time() - start)
    return min(times), result


def compare(faces: int, floating: ModuleType) -> None:
    """Print the numbers and times of an ellipsoid of so many faces."""
    points, triangles = ellipsoid(faces)
    center = np.array([0.0, 0.0, -0.1])

    def theirs() -> dict:
        corners = np.column_stack([triangles, triangles[:, 0]])
        mesh = capytaine.Mesh(vertices=points, faces=corners)
        body = capytaine.FloatingBody(mesh=mesh, center_of_mass=center)
        return body.compute_hydrostatics(rho=1025.0)

    def ours():
        mass = 1025.0 * expected["disp_volume"]
        return floating.FloatingBody(points, triangles, mass, center, 1025.0).at([0.0, 0.0, 1.0])

    their_time, expected = timed(theirs)
    our_time, rest = timed(ours)
    settle_time, _ = timed(lambda: rest.body.settle([0.1, 0.2, 1.0]))
    angles = np.radians(np.arange(0.0, 91.0, 5.0))
    heel_time, _ = timed(lambda: floating.righting_curve(rest, angles))
    print("{} faces".format(len(triangles)))
    for name, number in NUMBERS.items():
        off = number(rest) / expected[name] - 1.0
        print("  {:32} {:14.9f} {:10.1e}".format(name, number(rest), off))
    text = "  hydrostatics {:.3f} s, capytaine {:.3f} s: {:.0f} times"
    print(text.format(our_time, their_time, their_time / our_time))
    print("  Float {:.3f} s, GZ at 19 angles {:.3f} s".format(settle_time, heel_time))


def main() -> None:
    """Print a table for each number of faces."""
    load_checkout()
    from body_moments.core import floating

    capytaine.set_logging("ERROR")
    for faces in [int(word) for word in sys.argv[1:]] or [10_000, 100_000]:
        compare(faces, floating)


if __name__ == "__main__":
    main()
