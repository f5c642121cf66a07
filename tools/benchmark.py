# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Times and ratios against trimesh, libigl, Blender's BMesh and the floor of reading and gathering,
from one run.

    python tools/benchmark.py [--quick] [--stream M] [options of benchmark_tasks.py]

Every table interleaves its rows in one process, so that its ratios hold whatever else the machine
does. It prints medians and least times and asserts nothing: a busy machine is no failure. Programs
that are not installed are left out.
"""

from __future__ import annotations

import argparse
import importlib.util
import io
import os
import platform
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from types import ModuleType

import numpy as np
from loading import load_checkout

load_checkout()

from body_moments.core.fourier.grid import GridTransform
from body_moments.core.fourier.transform import run_to_completion, solid_transform
from body_moments.core.fourier.wave_vectors import FrequencyGrid
from body_moments.core.inertia.mass_properties import MassProperties
from body_moments.core.mesh.surface import Surface
from body_moments.core.moments.raw import monomials
from body_moments.core.papers.sheynin_tuzikov_2001 import sigma
from body_moments.core.polyhedron import integration
from body_moments.core.solid.measure import measure_solid

# A measurement calls it so.
polyhedron_moments = partial(integration.polyhedron_moments, allow_open=True)


def torus(n: int, m: int, noise: float, lopsided: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """A closed torus of n x m quads, index-local: points, and quads as corners. noise: of every
    coordinate, as a share of the shorter edges. lopsided: bent so that it has no symmetry.
    """
    u, v = np.meshgrid(
        np.arange(n) * (2 * np.pi / n), np.arange(m) * (2 * np.pi / m), indexing="ij"
    )
    points = np.stack(
        [(1 + 0.4 * np.cos(v)) * np.cos(u), (1 + 0.4 * np.cos(v)) * np.sin(u), 0.4 * np.sin(v)],
        axis=-1,
    )
    points = points.reshape(-1, 3)
    points += noise * 0.8 * np.pi / m * np.random.default_rng(0).standard_normal(points.shape)
    if lopsided:
        points[:, 0] *= 1.2 + 0.2 * points[:, 0]
        points[:, 2] += 0.3 * points[:, 0] ** 2 + 0.1 * points[:, 1]
        points[:, 1] *= 1.0 + 0.2 * points[:, 2] + 0.1 * points[:, 0]
    i, j = np.meshgrid(np.arange(n), np.arange(m), indexing="ij")
    corners = [(i, j), ((i + 1) % n, j), ((i + 1) % n, (j + 1) % m), (i, (j + 1) % m)]
    return points, np.stack([(a * m + b).ravel() for a, b in corners], axis=1).astype(np.int32)


def halves(quads: np.ndarray, paired: bool) -> np.ndarray:
    """Quads as triangles, their halves one after the other (paired), or all first halves before all
    second ones.
    """
    both = quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]
    return np.stack(both, axis=1).reshape(-1, 3) if paired else np.concatenate(both)


def measure_arrays(points: np.ndarray, triangles: np.ndarray, threads: int = 1) -> MassProperties:
    """The whole path: volume, center, inertia and the principal frame with its signs."""
    surface = Surface(points, triangles)
    refine = lambda: polyhedron_moments(surface, exact=True, threads=threads)[0]  # noqa: E731
    return MassProperties.from_moments(
        polyhedron_moments(surface, threads=threads)[0], refine=refine
    )


def gather(points: np.ndarray, faces: np.ndarray) -> None:
    """The floor: subtract a reference point and fetch every corner's coordinates in float64, in
    blocks.
    """
    size = 16384
    flat = np.subtract(points, points[0], dtype=np.float64).reshape(-1)
    for start in range(0, len(faces), size):
        index = np.multiply(faces[start : start + size].T, 3, dtype=np.intp)
        for axis in range(3):
            flat[axis:].take(index, mode="clip")


def gather_in_place(points: np.ndarray, faces: np.ndarray) -> None:
    """Gather as fast as numpy can: without a copy of the points, into reused arrays that stay in
    cache.
    """
    size, corners = 32768, faces.shape[1]
    flat, origin = points.reshape(-1), points[0].astype(np.float64)[:, None, None]
    index, fetched = np.empty((corners, size), np.intp), np.empty((3, corners, size), points.dtype)
    place = np.empty(fetched.shape)
    for start in range(0, len(faces) - size + 1, size):  # The rest is not worth a line.
        index[...] = faces[start : start + size].T
        np.multiply(index, 3, index)
        for axis in range(3):
            flat[axis:].take(index, None, fetched[axis], "wrap")
        np.subtract(fetched, origin, place)


def interleaved(rows: dict[str, Callable[[], object]], rounds: int) -> dict[str, list[float]]:
    """Seconds of each row, a round at a time, after one round that does not count."""
    times: dict[str, list[float]] = {name: [] for name in rows}
    for round_ in range(rounds + 1):
        for name, function in rows.items():
            start = time.perf_counter()
            function()
            if round_:
                times[name].append(time.perf_counter() - start)
    return times


def table(
    title: str, times: dict[str, list[float]], against: list[str], per: int | None = None
) -> None:
    """Print medians, least times and the ratios of the medians (and of the least times) to some of
    the rows.
    """
    print("\n" + title)
    head = "".join("{:>22s}".format("/ " + name) for name in against)
    unit = "ns a triangle" if per else ""
    print("    {:<40s}{:>10s}{:>10s}{:>15s}{:s}".format("", "median ms", "least ms", unit, head))
    for name, values in times.items():
        median, least = statistics.median(values), min(values)
        ratios = "".join(
            "{:>22s}".format(
                "{:.2f} ({:.2f})".format(
                    median / statistics.median(times[other]), least / min(times[other])
                )
            )
            for other in against
        )
        each = "{:.1f}".format(median / per * 1e9) if per else ""
        print(
            "    {:<40s}{:>10.1f}{:>10.1f}{:>15s}{:s}".format(
                name, median * 1e3, least * 1e3, each, ratios
            )
        )


def beside(name: str) -> ModuleType:
    """A module in this folder."""
    spec = importlib.util.spec_from_file_location(name, Path(__file__).parent / (name + ".py"))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class Tables(io.TextIOWrapper):
    """An output without Blender's reports, between whose lines no table could be read."""

    def write(self, text: str) -> int:
        """Write what is no report: the bpy module prints those through Python."""
        return len(text) if text.startswith(("Info: ", "Warning: ")) else super().write(text)


def hide_reports() -> None:
    """Print tables only, and let what Blender itself prints go nowhere: in a pipe or a file it
    would come out later.
    """
    sys.stdout.flush()
    sys.stdout = Tables(
        os.fdopen(os.dup(1), "wb"), encoding=sys.stdout.encoding, line_buffering=True
    )
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.close(nowhere)


def optional(name: str) -> ModuleType | None:
    """A module, or None where it is not installed."""
    return importlib.import_module(name) if importlib.util.find_spec(name) else None


def arrays(side: int, rounds: int) -> None:
    """A million triangles or so in arrays, of three kinds."""
    plain, lopsided = torus(side, side, 0.05), torus(side, side, 0.05, lopsided=True)
    compare("triangulated quads, noisy torus", *plain, True, rounds)
    compare("triangulated quads, lopsided body", *lopsided, True, rounds)
    compare("loose triangles, noisy torus", *plain, False, rounds)


def compare(title: str, points: np.ndarray, quads: np.ndarray, paired: bool, rounds: int) -> None:
    """A body in arrays, its quads cut into triangles that follow each other in pairs or do not."""
    trimesh, igl = optional("trimesh"), optional("igl")
    triangles = halves(quads, paired)
    indices = triangles.astype(np.int64)
    ours = {
        "ours with frame, 1 thread": lambda: measure_arrays(points, triangles),
        "ours with frame, 2 threads": lambda: measure_arrays(points, triangles, 2),
    }
    rows = ours | {"gather only": lambda: gather(points, triangles)}
    if igl:
        rows["igl.moments"] = lambda: igl.moments(points, indices)
    if trimesh:
        rows["trimesh mass_properties"] = lambda: trimesh.triangles.mass_properties(
            points[triangles]
        )
    times = interleaved(rows, rounds)
    others = [name for name in rows if name not in ours]
    table(
        "{:,} triangles in arrays: {:s}".format(len(triangles), title),
        times,
        others,
        len(triangles),
    )
    if trimesh:
        print(
            "    faster than trimesh: {:.1f}x on one thread, {:.1f}x on two".format(
                *(
                    statistics.median(times["trimesh mass_properties"])
                    / statistics.median(times[name])
                    for name in ours
                )
            )
        )


def verdicts(side: int, rounds: int) -> None:
    """Closedness and verdict from bare arrays of triangles, beside the integral and the way of
    others.
    """
    points, quads = torus(side, side, 0.02)
    triangles = halves(quads, True)
    surface, trimesh = Surface(points, triangles), optional("trimesh")
    rows = {
        "integral, 1 thread": lambda: polyhedron_moments(surface),
        "verdict, 1 thread": lambda: measure_solid(surface),
        "verdict, 2 threads": lambda: measure_solid(surface, threads=2),
    }
    if trimesh:

        def watertight() -> None:
            mesh = trimesh.Trimesh(points, triangles, process=False)
            assert mesh.is_watertight and mesh.mass_properties is not None

        rows["trimesh watertight and mass_properties"] = watertight
    title = "{:,} triangles in bare arrays: is it closed, and what is it".format(len(triangles))
    table(title, interleaved(rows, rounds), ["integral, 1 thread"], len(triangles))


# Each order may cost so many times the kernel for low orders.
MULTIPLES = {
    4: 6,
    6: 15,
    10: 60,
    16: 260,
    20: 480,
}
EXPLICIT = {4: 18, 6: 40}  # times as fast as the explicit formula that each order must be


def orders(quick: bool) -> None:
    """Moments to high orders on the same mesh, as multiples of the kernel for low ones and of the
    explicit formula.
    """
    points, quads = torus(400, 300, 0.05)
    for title, faces in (
        ("triangulated quads", halves(quads, paired=True)),
        ("loose triangles", halves(quads, paired=False)),
    ):
        print(
            "\nmoments to order N of {:s}, ns a triangle, medians of interleaved runs".format(title)
        )
        print(
            "    {:>4s}{:>10s}{:>10s}{:>11s}{:>10s}{:>14s}{:>11s}{:>16s}".format(
                "N",
                "order 3",
                "volume",
                "multiple",
                "at most",
                "with surface",
                "2 threads",
                "explicit/ours",
            )
        )
        for order in MULTIPLES:
            compare_order(points, faces, order, quick)


def explicit_moments(points: np.ndarray, faces: np.ndarray, order: int) -> list[float]:
    """The volume moments times (p+q+r+3)!, by the nine-fold sum as printed."""
    a, b, c = (points[faces[:, i]].T for i in range(3))
    det = (a * np.cross(b.T, c.T).T).sum(axis=0)
    return [float((det * sigma(tuple(row), a, b, c)).sum()) for row in monomials(order).tolist()]


def compare_order(points: np.ndarray, faces: np.ndarray, order: int, quick: bool) -> None:
    """One row of that table."""
    count = min(len(faces), (8_000_000 if quick else 32_000_000) // (order + 1) ** 3 // 2 * 2)
    part, base = Surface(points, faces[:count]), Surface(points, faces)
    few = max(count // 40, 200)
    rows = {
        "base": (lambda: polyhedron_moments(base)[0], len(faces)),
        "volume": (lambda: polyhedron_moments(part, order), count),
        "both": (lambda: polyhedron_moments(part, order, area_order=order), count),
    }
    if order in EXPLICIT:
        rows["explicit"] = (lambda: explicit_moments(points, faces[:few], order), few)
    times = interleaved({name: function for name, (function, _) in rows.items()}, 3 if quick else 7)
    each = {name: statistics.median(times[name]) / rows[name][1] * 1e9 for name in rows}
    # Threads want many blocks.
    shared = interleaved(
        {
            str(threads): partial(polyhedron_moments, base, order, threads=threads)
            for threads in (1, 2)
        },
        1 if quick else 2,
    )
    told = ""
    if order in EXPLICIT:
        told = "{:.0f}x (at least {:d})".format(each["explicit"] / each["volume"], EXPLICIT[order])
    print(
        "    {:>4d}{:>10.0f}{:>10.0f}{:>10.1f}x{:>9d}x{:>+13.0f}%{:>10.2f}x{:>22s}".format(
            order,
            each["base"],
            each["volume"],
            each["volume"] / each["base"],
            MULTIPLES[order],
            100.0 * (each["both"] / each["volume"] - 1.0),
            min(shared["1"]) / min(shared["2"]),
            told,
        )
    )


def stream(millions: float, order: int = 4) -> None:
    """A torus of so many million triangles, made strip by strip while it is measured: time, memory,
    and the truth.
    """
    import resource

    m, strip = 1000, 25
    n = max(int(millions * 1e6 / (2 * m)) // strip, 1) * strip
    angle = np.arange(m) * (2 * np.pi / m)
    ring = np.stack([1.0 + 0.4 * np.cos(angle), 0.4 * np.sin(angle)])
    i, j = np.meshgrid(np.arange(strip), np.arange(m), indexing="ij")
    corners = [(i, j), (i + 1, j), (i + 1, (j + 1) % m), (i, (j + 1) % m)]
    quads = np.stack([(a * m + b).ravel() for a, b in corners], axis=1).astype(np.int32)
    triangles = quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)

    def strips():
        for start in range(0, n, strip):
            turn = (start + np.arange(strip + 1)) % n * (2 * np.pi / n)
            points = np.stack(
                [
                    np.outer(np.cos(turn), ring[0]),
                    np.outer(np.sin(turn), ring[0]),
                    np.broadcast_to(ring[1], (strip + 1, m)),
                ],
                axis=-1,
            )
            yield Surface(points.reshape(-1, 3), triangles)

    before, start = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, time.perf_counter()
    volume, area = polyhedron_moments(
        strips(), order, area_order=order, threads=os.cpu_count() or 1, about=np.zeros(3), reach=1.4
    )
    seconds = time.perf_counter() - start
    grown = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
    polygons = np.prod([k / (2 * np.pi) * np.sin(2 * np.pi / k) for k in (n, m)])  # for circles
    print(
        "\nstream of {:,} triangles to order {:d}, both weights: {:.1f} s, {:.0f} MB more than "
        "before".format(2 * n * m, order, seconds, grown / 1024)
    )
    print(
        "    volume / that of the torus - 1 = {:.2e} (of its polygons {:.2e}), error bound "
        "{:.1e}".format(
            volume.total / (2 * np.pi**2 * 0.16) - 1.0, polygons - 1.0, volume.rounding_error[0]
        )
    )


def mesh_object(name: str, points: np.ndarray, quads: np.ndarray):
    """A mesh object of quads, linked to the scene."""
    import bpy

    mesh = bpy.data.meshes.new(name)
    mesh.vertices.add(len(points))
    mesh.attributes["position"].data.foreach_set("vector", points.astype(np.float32).reshape(-1))
    if len(quads):
        mesh.loops.add(quads.size)
        mesh.attributes[".corner_vert"].data.foreach_set("value", quads.reshape(-1))
        mesh.polygons.add(len(quads))
        mesh.polygons.foreach_set("loop_start", np.arange(0, quads.size, 4, dtype=np.int32))
        mesh.update(calc_edges=True)
    made = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(made)
    return made


def read_floor(mesh) -> Surface:
    """Read a mesh's positions and corners, and nothing else."""
    points = np.empty((len(mesh.vertices), 3), np.float32)
    corners = np.empty(len(mesh.loops), np.int32)
    mesh.attributes["position"].data.foreach_get("vector", points.reshape(-1))
    mesh.attributes[".corner_vert"].data.foreach_get("value", corners)
    return Surface(points, quads=corners.reshape(-1, 4))


def blender(side: int, rounds: int) -> None:
    """An evaluated mesh: reading, measuring, the full verdict, and Blender's own volume."""
    import bmesh
    import bpy
    from body_moments.blender.bodies.measure_object import measure_object
    from body_moments.blender.read.objects import read_object
    from body_moments.blender.settings.options import MeasureOptions

    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    body = mesh_object("Torus", *torus(side, side, 0.05))
    depsgraph = bpy.context.evaluated_depsgraph_get()

    def moments_only(threads: int) -> None:
        (part,) = read_object(body, depsgraph, edges=False).parts
        volume = polyhedron_moments(part.surface, threads=threads)[0].transform(part.matrices[0])
        MassProperties.from_moments(
            volume, refine=lambda: polyhedron_moments(part.surface, exact=True, threads=threads)[0]
        )

    def floor(fetch: Callable[[np.ndarray, np.ndarray], None]) -> None:
        surface = read_floor(body.evaluated_get(depsgraph).to_mesh())
        fetch(surface.points, surface.quads)

    def by_bmesh() -> None:
        edited = bmesh.new()
        edited.from_object(body, depsgraph)
        edited.calc_volume(signed=True)
        edited.free()

    rows = {
        "mass properties, 1 thread": lambda: moments_only(1),
        "mass properties, 2 threads": lambda: moments_only(2),
        "with the full verdict, 1 thread": lambda: measure_object(
            body, depsgraph, MeasureOptions(threads=1)
        ),
        "with the full verdict, 2 threads": lambda: measure_object(
            body, depsgraph, MeasureOptions(threads=2)
        ),
        "read and gather only": lambda: floor(gather),
        "the same, in place": lambda: floor(gather_in_place),
        "bmesh from_object + calc_volume": by_bmesh,
    }
    times = interleaved(rows, rounds)
    table(
        "evaluated mesh of {:,} quads, Blender {:s}".format(side * side, bpy.app.version_string),
        times,
        list(rows)[4:],
        2 * side * side,
    )
    bpy.data.objects.remove(body)


def instances(count: int, rounds: int) -> None:
    """Many instances of one mesh, scattered by geometry nodes."""
    import bpy
    from body_moments.blender.bodies.measure_object import measure_object
    from body_moments.blender.read.mesh import mesh_surface
    from body_moments.blender.settings.options import MeasureOptions

    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    source = mesh_object("Source", *torus(100, 100, 0.05))
    ground = mesh_object(
        "Ground",
        np.random.default_rng(1).uniform(-100.0, 100.0, (count, 3)),
        np.empty((0, 4), np.int32),
    )
    group = bpy.data.node_groups.new("Scatter", "GeometryNodeTree")
    for direction in ("INPUT", "OUTPUT"):
        group.interface.new_socket("Geometry", in_out=direction, socket_type="NodeSocketGeometry")
    start, end, info, scatter = (
        group.nodes.new(name)
        for name in (
            "NodeGroupInput",
            "NodeGroupOutput",
            "GeometryNodeObjectInfo",
            "GeometryNodeInstanceOnPoints",
        )
    )
    info.inputs["Object"].default_value = source
    info.inputs["As Instance"].default_value = True
    group.links.new(start.outputs[0], scatter.inputs["Points"])
    group.links.new(info.outputs["Geometry"], scatter.inputs["Instance"])
    group.links.new(scatter.outputs[0], end.inputs[0])
    ground.modifiers.new("Scatter", "NODES").node_group = group
    depsgraph = bpy.context.evaluated_depsgraph_get()

    def floor() -> None:
        geometry = ground.evaluated_get(depsgraph).evaluated_geometry()  # owns the cloud
        cloud = geometry.instances_pointcloud()
        matrices = np.empty(16 * len(cloud.points), np.float32)
        cloud.attributes["instance_transform"].data.foreach_get("value", matrices)
        mesh_surface(source.evaluated_get(depsgraph).data)

    def one_by_one() -> None:
        for instance in depsgraph.object_instances:
            instance.matrix_world.copy()
        mesh_surface(source.evaluated_get(depsgraph).data)

    rows = {
        "measure, 1 thread": lambda: measure_object(ground, depsgraph, MeasureOptions(threads=1)),
        "matrices as one array, and the mesh": floor,
        "depsgraph.object_instances, and the mesh": one_by_one,
    }
    table(
        "{:,} instances of {:,} faces".format(count, 10_000),
        interleaved(rows, rounds),
        list(rows)[1:],
    )


def fourier(quick: bool) -> None:
    """The Fourier transform on one thread: closed form on lists and grids, a large grid to a
    tolerance, and BornAgain's form factor of a tetrahedron where that is installed.
    """
    points, quads = torus(32, 16, 0.0)
    surface, rng = Surface(points, halves(quads, paired=False)), np.random.default_rng(0)
    faces, count = len(surface.triangles), 12
    print("\nFourier transform of {:,} triangles, 1 thread, ns a face and frequency".format(faces))
    for size in (1.0, 10.0, 100.0, 1000.0):
        q = rng.normal(size=(500, 3))
        q *= size / 2.8 / np.linalg.norm(q, axis=1)[:, None]
        grid = FrequencyGrid(count, size / 2.8)
        times = interleaved(
            {
                "list": lambda q=q: solid_transform(surface, q),
                "grid": lambda grid=grid: solid_transform(surface, grid),
            },
            1 if quick else 3,
        )
        half = (count + 1) ** 2 * (count // 2 + 1)  # Only half of a grid is computed.
        print(
            "    |q| L = {:<6g}    list {:>5.0f}    grid {:>5.0f}".format(
                size,
                min(times["list"]) / 500 / faces * 1e9,
                min(times["grid"]) / half / faces * 1e9,
            )
        )
    points, quads = torus(160, 64, 0.0)
    surface = Surface(points, halves(quads, paired=False))
    volume, grid = polyhedron_moments(surface)[0].total, FrequencyGrid(64, 16.0 * np.pi / 1.4)
    start = time.perf_counter()
    found = run_to_completion(GridTransform(surface, grid, "volume", 1e-7 * volume))
    seconds, some = time.perf_counter() - start, rng.integers(0, 64**3, 100)
    error = np.abs(found.values[some] - solid_transform(surface, found.q[some]).values).max()
    print(
        "    {:,} triangles, 64³ frequencies to 1e-7 of the volume: {:.1f} s, error {:.1e}, told "
        "{:.1e}".format(len(surface.triangles), seconds, error / volume, found.error.max() / volume)
    )
    if bornagain := optional("bornagain"):
        body, q = bornagain.PlatonicTetrahedron(1.0), rng.normal(size=(5000, 3)) * 10.0
        corners = np.array([[0, 0, 0], [1, 1, 0], [1, 0, 1], [0, 1, 1]]) / 2**0.5
        surface = Surface(corners, np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]))
        rows = {
            "ours": lambda: solid_transform(surface, q),
            "bornagain": lambda: [
                body.formfactorAtBottom(bornagain.C3(*row)) for row in q.tolist()
            ],
        }
        table("A tetrahedron at 5,000 wave vectors", interleaved(rows, 3), ["bornagain"])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="a tenth of the faces, fewer rounds")
    parser.add_argument(
        "--stream", type=float, metavar="M", help="only: a stream of M million triangles (try 50)"
    )
    options, others = parser.parse_known_args()
    if options.stream:
        stream(options.stream)
        return
    quick = options.quick
    tasks = Path(__file__).with_name("benchmark_tasks.py")
    rounds = "1" if quick else "3"
    subprocess.run([sys.executable, str(tasks), "--rounds", rounds, *others], check=True)
    side, rounds = (316, 5) if quick else (1000, 9)
    print(
        "Python {:s}, numpy {:s}, {:s}, {:d} processors".format(
            platform.python_version(), np.__version__, platform.machine(), os.cpu_count() or 1
        )
    )
    arrays(side, rounds)
    verdicts(side, rounds)
    fourier(quick)
    orders(quick)
    if not optional("bpy"):
        print("\nThere is no bpy here: reading from Blender was not measured.")
        return
    with tempfile.TemporaryDirectory(prefix="body_moments_user_") as folder:
        os.environ["BLENDER_USER_RESOURCES"] = folder
        import bpy  # noqa: F401

        hide_reports()
        sys.modules["body_moments"].register()
        parts = beside("benchmark_many")
        parts.single(rounds)
        parts.many(300 if quick else 1000, rounds)
        blender(side, rounds)
        instances(1000 if quick else 10_000, rounds)
        sys.modules["body_moments"].unregister()


if __name__ == "__main__":
    main()
