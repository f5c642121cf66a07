# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cost of many small parts beside the floor: reading their arrays, storing twelve numbers, and one
update.

Run by benchmark.py. Times are the processor's. All rows of a table are interleaved in one process.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from functools import partial

import bpy
import numpy as np
from mathutils import Matrix

CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
SIDES = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]


def prism(n: int) -> tuple[np.ndarray, list[list[int]]]:
    """A straight prism over a regular polygon."""
    angle = np.arange(n) * 2.0 * np.pi / n
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    points = np.concatenate([np.insert(ring, 2, z, axis=1) for z in (-1.0, 1.0)])
    sides = [[i, (i + 1) % n, n + (i + 1) % n, n + i] for i in range(n)]
    return points, [list(range(n - 1, -1, -1)), list(range(n, 2 * n)), *sides]


def ball() -> tuple[np.ndarray, list[list[int]]]:
    """80 triangles."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=2)
    mesh = bpy.context.object.data
    points = np.array([vertex.co[:] for vertex in mesh.vertices])
    faces = [list(face.vertices) for face in mesh.polygons]
    bpy.data.objects.remove(bpy.context.object)
    return points, faces


def kinds(rng: np.random.Generator) -> dict[str, Callable[[], tuple[np.ndarray, list]]]:
    """Return the kinds of parts by name; arrays repeated each time are one mesh."""
    points, faces = ball()
    linked = CORNERS.copy()
    turned, cylinder_faces = prism(32)
    two = [*SIDES, *[[corner + 8 for corner in side] for side in SIDES]]
    return {
        "random shards, 80 faces": lambda: (
            points * rng.uniform(0.7, 1.3, (len(points), 1)) * rng.uniform(0.5, 2, 3),
            faces,
        ),
        "equal cubes": lambda: (CORNERS.copy(), SIDES),
        "different boxes": lambda: (CORNERS * rng.uniform(0.5, 2, 3), SIDES),
        "32-gon cylinders": lambda: (turned * [1.0, 1.0, rng.uniform(0.5, 3)], cylinder_faces),
        "linked cubes": lambda: (linked, SIDES),
        "two components": lambda: (
            np.concatenate([CORNERS * rng.uniform(0.5, 2, 3), CORNERS + [5, 0, 0]]),
            two,
        ),
        "open boxes": lambda: (CORNERS * rng.uniform(0.5, 2, 3), SIDES[:5]),
    }


def make(count: int, part: Callable[[], tuple[np.ndarray, list]], rng: np.random.Generator) -> list:
    """So many selected objects, each in a place of its own."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    objects, meshes, kept = [], {}, []
    for _ in range(count):
        points, faces = part()
        mesh = meshes.get(id(points))
        if mesh is None:
            mesh = bpy.data.meshes.new("Part")
            mesh.from_pydata(points.tolist(), [], faces)
            meshes[id(points)] = mesh
            kept.append(points)  # so that no other array gets its id
        obj = bpy.data.objects.new("Part", mesh)
        bpy.context.collection.objects.link(obj)
        obj.location, obj.rotation_euler = rng.uniform(-50, 50, 3), rng.uniform(-3, 3, 3)
        obj.scale = np.full(3, rng.uniform(0.5, 2.0))
        obj.select_set(True)
        objects.append(obj)
    bpy.context.view_layer.objects.active = objects[0]
    bpy.context.view_layer.update()
    return objects


def floor(objects: list, linked: bool) -> None:
    """Read arrays and matrices, store twelve numbers, update once."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    for obj in objects:
        evaluated = obj.evaluated_get(depsgraph)
        np.array(evaluated.matrix_world)
        if linked:
            continue
        mesh = evaluated.data
        for name, member, count, dtype in (
            ("position", "vector", 3 * len(mesh.vertices), np.float32),
            (".corner_vert", "value", len(mesh.loops), np.int32),
            (".corner_edge", "value", len(mesh.loops), np.int32),
        ):
            mesh.attributes[name].data.foreach_get(member, np.empty(count, dtype))
    for obj in objects:
        for number in range(12):
            obj["floor_{:d}".format(number)] = 1.5
    for obj in objects:
        obj.update_tag(refresh={"OBJECT"})
    bpy.context.view_layer.update()
    for obj in objects:
        for number in range(12):
            del obj["floor_{:d}".format(number)]


def timed(function: Callable[[], object]) -> float:
    """Seconds of the processor, which a busy machine changes least."""
    start = time.process_time()
    function()
    return time.process_time() - start


def many(count: int, rounds: int) -> None:
    """Measure, Set Origin and the snaps for parts of each kind, against the floor."""
    rng = np.random.default_rng(1)
    make(3, next(iter(kinds(rng).values())), rng)
    for first in ("measure", "origin_to_center", "axes_to_principal"):  # It loads their modules.
        getattr(bpy.ops.object, "body_moments_" + first)()
    print(
        "\n{:,} separate parts: microseconds an object (median), and times the floor".format(count)
    )
    rows = "floor", "Measure", "Blender's Set Origin", "Origin to Center", "Axes to Principal"
    print(
        "    {:<26s}{:>10s}".format("", rows[0])
        + "".join("{:>28s}".format(name) for name in rows[1:])
    )
    for name, part in kinds(rng).items():
        objects, times = make(count, part, rng), {row: [] for row in rows}
        measure = bpy.ops.object.body_moments_measure
        for round_ in range(rounds + 1):
            sample = {
                "floor": timed(partial(floor, objects, name.startswith("linked"))),
                "Measure": timed(measure),
            }
            for row in sample:
                times[row] += [sample[row]] * bool(round_)
        steps = {
            "Blender's Set Origin": lambda: bpy.ops.object.origin_set(
                type="ORIGIN_CENTER_OF_VOLUME"
            ),
            "Origin to Center": lambda: bpy.ops.object.body_moments_origin_to_center(),
            "Axes to Principal": lambda: bpy.ops.object.body_moments_axes_to_principal(),
        }
        for row, step in steps.items():  # once each: they change what they find
            for obj in objects:
                obj.data.transform(shift())
            bpy.context.view_layer.update()
            times[row].append(timed(step))
        medians = {row: statistics.median(values) for row, values in times.items()}
        text = "    {:<26s}{:>10.1f}".format(name, 1e6 * medians["floor"] / count)
        for row in rows[1:]:
            text += "{:>18.1f}{:>10s}".format(
                1e6 * medians[row] / count, "({:.1f})".format(medians[row] / medians["floor"])
            )
        print(text)


def shift() -> Matrix:
    """A small move that no origin survives."""
    return Matrix.Translation((0.25, 0.125, 0.5))


def single(rounds: int) -> None:
    """One cube and one Suzanne, through the operator."""
    print("\none object, Measure (median ms)")
    for name, add in (
        ("cube", bpy.ops.mesh.primitive_cube_add),
        ("Suzanne", bpy.ops.mesh.primitive_monkey_add),
    ):
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        add()
        bpy.ops.object.body_moments_measure()
        times = [timed(bpy.ops.object.body_moments_measure) for _ in range(5 * rounds)]
        print("    {:<26s}{:>10.2f}".format(name, 1e3 * statistics.median(times)))
