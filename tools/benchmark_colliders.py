# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Convex pieces beside those of CoACD: the sum of hulls over the body's volume, at the same number
of pieces.

    python tools/benchmark_colliders.py [NAME ...]

Needs numpy and coacd. Times are the processor's. Prints a row for each concave body, then the
median and the largest ratio. CoACD's results are kept in the folder of temporary files.
"""

from __future__ import annotations

import json
import multiprocessing
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

Part = tuple[np.ndarray, np.ndarray]
SUZANNE = """
import bpy, numpy as np
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.mesh.primitive_monkey_add()
modifier = bpy.context.object.modifiers.new("", "REMESH")
modifier.mode, modifier.voxel_size = "VOXEL", 0.08
mesh = bpy.context.object.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
mesh.calc_loop_triangles()
triangles = [t.vertices[:] for t in mesh.loop_triangles]
np.savez({!r}, points=[v.co[:] for v in mesh.vertices], triangles=triangles)
"""


def cells(*layers: str, lines=None) -> Part:
    """Return the surface of the cells marked # in layers from below, rows separated by spaces."""
    filled = np.array(
        [[[mark == "#" for mark in row] for row in layer.split()] for layer in layers]
    )
    filled = np.pad(filled.transpose(2, 1, 0), 1)
    quads, shape = [], np.array(filled.shape) + 1
    for axis in range(3):
        step = np.roll(filled, -1, axis)
        for where, turned in ((filled & ~step, False), (step & ~filled, True)):
            base = np.argwhere(where)
            base[:, axis] += 1
            u, v = np.eye(3, dtype=int)[(axis + 1) % 3], np.eye(3, dtype=int)[(axis + 2) % 3]
            corners = np.stack([base, base + u, base + u + v, base + v], axis=1)
            quads.append(corners[:, ::-1] if turned else corners)
    corners = np.concatenate(quads)
    ids, which = np.unique(
        corners.reshape(-1, 3) @ [shape[1] * shape[2], shape[2], 1], return_inverse=True
    )
    points = np.stack(np.unravel_index(ids, shape), axis=1).astype(float)
    quads = which.reshape(-1, 4)
    return points, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def revolve(outline, sides: int = 32) -> Part:
    """Return the body of a closed outline (r, z), counter-clockwise with r to the right, turned
    about z.
    """
    outline = np.array(outline, float)
    turn = np.arange(sides) * 2.0 * np.pi / sides
    count = len(outline)
    points = np.stack(
        [
            np.outer(np.cos(turn), outline[:, 0]),
            np.outer(np.sin(turn), outline[:, 0]),
            np.tile(outline[:, 1], (sides, 1)),
        ],
        axis=2,
    ).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(sides), np.arange(count), indexing="ij")
    a, b = i * count + j, i * count + (j + 1) % count
    c, d = (i + 1) % sides * count + (j + 1) % count, (i + 1) % sides * count + j
    triangles = np.concatenate([np.stack([a, d, c], axis=2), np.stack([a, c, b], axis=2)]).reshape(
        -1, 3
    )
    return weld(points, triangles)


def weld(points, triangles) -> Part:
    """Join equal points, and leave out triangles without area."""
    _, first, which = np.unique(np.round(points, 9), axis=0, return_index=True, return_inverse=True)
    triangles = which.reshape(-1)[triangles]
    real = (triangles != np.roll(triangles, 1, axis=1)).all(axis=1)
    return points[first], triangles[real]


def extrude(outline, height: float) -> Part:
    """Return the prism over a simple polygon (x, y), counter-clockwise."""
    from body_moments.core.streams.file_mesh import tessellate

    outline = np.array(outline, float)
    count = len(outline)
    lid = tessellate(
        np.column_stack([outline, np.zeros(count)]).astype(np.float32), np.arange(count)[None]
    )
    lid = lid.reshape(-1, 3)
    a, b, c = (outline[lid[:, k]] for k in range(3))
    turned = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0] < 0.0
    lid = np.where(turned[:, None], lid[:, ::-1], lid)
    points = np.concatenate([np.column_stack([outline, np.full(count, z)]) for z in (0.0, height)])
    i = np.arange(count)
    j = (i + 1) % count
    return points, np.concatenate(
        [
            lid[:, ::-1],
            lid + count,
            np.stack([i, j, j + count], 1),
            np.stack([i, j + count, i + count], 1),
        ]
    )


def tube(line, radius: float, sides: int = 12, closed: bool = False) -> Part:
    """Return a round tube along a line of points, with flat ends or closed."""
    line = np.array(line, float)
    ahead = np.roll(line, -1, axis=0) - np.roll(line, 1, axis=0)
    if not closed:
        ahead[0], ahead[-1] = line[1] - line[0], line[-1] - line[-2]
    ahead /= np.linalg.norm(ahead, axis=1)[:, None]
    side = np.cross(ahead, (0.1, 0.2, 1.0))
    side /= np.linalg.norm(side, axis=1)[:, None]
    turn = np.arange(sides) * 2.0 * np.pi / sides
    ring = (
        np.cos(turn)[:, None] * side[:, None]
        + np.sin(turn)[:, None] * np.cross(ahead, side)[:, None]
    )
    count, points = len(line), (line[:, None] + radius * ring).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(count if closed else count - 1), np.arange(sides), indexing="ij")
    a, b = i * sides + j, i * sides + (j + 1) % sides
    c, d = (i + 1) % count * sides + (j + 1) % sides, (i + 1) % count * sides + j
    triangles = np.concatenate([np.stack([a, b, c], axis=2), np.stack([a, c, d], axis=2)]).reshape(
        -1, 3
    )
    if not closed:
        k = np.arange(1, sides - 1)
        low = np.stack([0 * k, k + 1, k], axis=1)
        triangles = np.concatenate([triangles, low, low[:, ::-1] + (count - 1) * sides])
    return points, triangles


def circle(count: int, radius=1.0, start=0.0, stop=2.0 * np.pi, end: bool = False) -> np.ndarray:
    turn = np.linspace(start, stop, count, endpoint=end)
    return np.stack([radius * np.cos(turn), radius * np.sin(turn)], axis=1)


def bodies() -> dict[str, Part]:
    """Return concave bodies by name."""
    spiral = np.linspace(0.5, 4.0 * np.pi, 80)
    turn = np.linspace(0.0, 2.0 * np.pi, 120, endpoint=False)
    wave = np.where(np.arange(96) % 8 < 4, 1.0, 0.8)
    knot = np.stack(
        [
            np.sin(turn) + 2 * np.sin(2 * turn),
            np.cos(turn) - 2 * np.cos(2 * turn),
            -np.sin(3 * turn),
        ],
        axis=1,
    )
    helix = np.linspace(0.0, 4.0 * np.pi, 70)
    fingers = [
        (0, 0),
        (4, 0),
        (4.2, 1.5),
        (5.8, 3),
        (5.3, 3.5),
        (4, 2.6),
        (4, 5.5),
        (3.2, 5.5),
        (3.1, 3),
        (2.9, 3),
    ]
    fingers += [
        (2.8, 6.2),
        (2, 6.2),
        (1.95, 3),
        (1.8, 3),
        (1.7, 6),
        (0.9, 6),
        (0.85, 3),
        (0.7, 3),
        (0.5, 5),
        (-0.2, 4.8),
    ]
    cup = [(0, 0), (1, 0), (1.2, 2), (1.1, 2), (0.9, 0.15), (0, 0.15)]
    goblet = [
        (0, 0),
        (1, 0),
        (1, 0.1),
        (0.15, 0.3),
        (0.15, 1.2),
        (0.9, 1.8),
        (1, 2.8),
        (0.9, 2.8),
        (0.75, 1.9),
        (0, 1.4),
    ]
    bowl = np.concatenate(
        [circle(12, 1.0, -np.pi / 2, 0.0, True), circle(12, 0.85, 0.0, -np.pi / 2, True)]
    )
    donut = circle(16) * 0.35 + (1.0, 0.0)
    weight = [
        (0, 0),
        (0.6, 0.1),
        (0.8, 0.6),
        (0.6, 1),
        (0.2, 1.1),
        (0.2, 2.5),
        (0.6, 2.6),
        (0.8, 3),
        (0.6, 3.5),
        (0, 3.6),
    ]
    moon = np.concatenate(
        [circle(24, 1.0, 0.6, 5.7, True), circle(20, 0.75, 5.5, 0.8, True) + (0.25, 0)]
    )
    outer, inner = (
        np.stack(
            [(0.25 * spiral + w) * np.cos(spiral), (0.25 * spiral + w) * np.sin(spiral)], axis=1
        )
        for w in (0.35, 0.0)
    )
    bend = [(1 - np.cos(a), 0, 2 + np.sin(a)) for a in np.linspace(0.2, 3.6, 16)]
    legs = ["#...#", ".....", ".....", ".....", "#...#"]
    seat, back = " ".join(["#####"] * 5), "##### " + " ".join(["....."] * 4)
    return {
        "L": cells("### #.. #.."),
        "U": cells("#.# #.# ###"),
        "T": cells("### .#. .#."),
        "E": cells("### #.. ### #.. ###"),
        "H": cells("#.# ### #.#"),
        "cross": cells("... .#. ...", ".#. ### .#.", "... .#. ..."),
        "stairs": cells("#### #### ####", ".### .### .###", "..## ..## ..##", "...# ...# ...#"),
        "frame": cells("#### #..# #..# ####"),
        "blind hole": cells("### ### ###", "### #.# ###", "### #.# ###"),
        "table": cells(" ".join(legs), " ".join(legs), " ".join(legs), seat),
        "chair": cells(" ".join(legs), " ".join(legs), seat, back, back),
        "shelf": cells("#### ####", "#... #...", "#### ####", "#... #...", "#### ####"),
        "comb": cells("#.#.#.#.# #.#.#.#.# #########"),
        "torus": revolve(donut),
        "washer": revolve([(0.6, 0), (1, 0), (1, 0.3), (0.6, 0.3)]),
        "cup": revolve(cup),
        "goblet": revolve(goblet, 24),
        "bowl": revolve(bowl, 24),
        "dumbbell": revolve(weight, 24),
        "star": extrude(circle(10) * np.where(np.arange(10) % 2, 0.4, 1.0)[:, None], 0.4),
        "gear": extrude(circle(96) * wave[:, None], 0.3),
        "crescent": extrude(moon, 0.4),
        "arrow": extrude(
            [(0, -0.2), (2, -0.2), (2, -0.7), (3, 0), (2, 0.7), (2, 0.2), (0, 0.2)], 0.3
        ),
        "hand": extrude(fingers, 0.8),
        "spiral": extrude(np.concatenate([outer, inner[::-1]]), 0.5),
        "helix": tube(np.stack([np.cos(helix), np.sin(helix), helix / 10], axis=1), 0.2),
        "knot": tube(knot, 0.35, closed=True),
        "hook": tube([(0, 0, 0), (0, 0, 2), *bend], 0.25, 16),
    }  # fmt: skip


def suzanne() -> dict[str, Part]:
    """Return Blender's monkey, closed by a voxel remesh, if Blender is on the path."""
    if shutil.which("blender") is None:
        return {}
    with tempfile.TemporaryDirectory() as folder:
        path = str(Path(folder, "suzanne.npz"))
        subprocess.run(
            ["blender", "-b", "--python-expr", SUZANNE.format(path)],
            capture_output=True,
            check=True,
        )
        with np.load(path) as arrays:
            return {"Suzanne": (arrays["points"].astype(float), arrays["triangles"])}


def run(steps):
    """Return the result of a generator of progress."""
    while True:
        try:
            next(steps)
        except StopIteration as done:
            return done.value


def by_coacd(part: Part, queue: multiprocessing.Queue) -> None:
    """Put the point sets of CoACD's pieces into a queue."""
    import coacd

    coacd.set_log_level("error")
    queue.put(
        [points for points, _ in coacd.run_coacd(coacd.Mesh(*part), preprocess_mode="off", seed=1)]
    )


def hull_sum(sets) -> float:
    from body_moments.core import Surface
    from body_moments.core.mesh import convex_hull
    from body_moments.core.polyhedron.integration import volume_and_center

    hulls = [convex_hull(points) for points in sets]
    return sum(
        volume_and_center(Surface.from_triangles(hull.points, hull.triangles))[0] for hull in hulls
    )


def main(names: list[str]) -> None:
    from loading import load_checkout

    load_checkout()
    from body_moments.core import Surface
    from body_moments.core.colliders.convex_pieces import cut_into_pieces
    from body_moments.core.polyhedron.integration import volume_and_center

    ratios = []
    cache = Path(tempfile.gettempdir(), "body-moments-coacd.json")
    known = json.loads(cache.read_text()) if cache.exists() else {}
    print("body            faces pieces  CoACD   ours  ratio  s CoACD  s ours")
    for name, part in {**bodies(), **suzanne()}.items():
        if names and name not in names:
            continue
        surface = Surface.from_triangles(*part)
        volume = volume_and_center(surface)[0]
        if name not in known:
            queue = multiprocessing.Queue()
            start = time.perf_counter()
            process = multiprocessing.Process(target=by_coacd, args=(part, queue))
            process.start()
            sets = queue.get()
            process.join()
            known[name] = len(sets), hull_sum(sets) / volume, time.perf_counter() - start
            cache.write_text(json.dumps(known))
        count, theirs, seconds = known[name]
        start = time.process_time()
        hulls = run(cut_into_pieces(surface, 0.0, count, 256))
        own_seconds = time.process_time() - start
        ours = hull_sum([hull.points for hull in hulls]) / volume
        ratios.append(ours / theirs)
        row = "{:14s} {:6d} {:3d}/{:<3d} {:6.3f} {:6.3f} {:6.3f} {:8.2f} {:7.2f}"
        print(
            row.format(
                name,
                len(part[1]),
                len(hulls),
                count,
                theirs,
                ours,
                ratios[-1],
                seconds,
                own_seconds,
            ),
            flush=True,
        )
    print("median {:.3f}, largest {:.3f}".format(statistics.median(ratios), max(ratios)))


if __name__ == "__main__":
    main(sys.argv[1:])
