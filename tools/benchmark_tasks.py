# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The daily tasks, beside an earlier build and other programs, from one run.

    python tools/benchmark_tasks.py [--against COMMIT] [--rounds N] [--plot FILE]

Each task runs in processes of its own: ours, the earlier build's (checked out into a temporary
folder) and the other program's, in turn. Times are the processor's; a process says the least of
some repetitions, and the table the median of the rounds. Programs that are not installed, and a
commit that the repository does not have, are left out.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import numpy as np
from loading import ROOT, load_checkout

EARLIER = "d9a8130e"  # the build to compare with, by default
OURS, OTHER = "ours", "other"

Steps = Iterator[Callable[[], object]]  # one function for each repetition


# Tasks of ours. Each yields what is timed, after what is not.


def measure(kind: str, repeat: int = 15) -> Steps:
    """Press Measure on one object."""
    bpy = blender()
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    add = bpy.ops.mesh.primitive_cube_add if kind == "cube" else bpy.ops.mesh.primitive_monkey_add
    add()
    if kind == "smooth Suzanne":
        bpy.context.object.modifiers.new("Subdivision", "SUBSURF").levels = 3
    for _ in range(repeat):
        yield bpy.ops.object.body_moments_measure


def measure_many(kind: str) -> Steps:
    """Press Measure on 400 objects."""
    parts(kind)
    for _ in range(4):
        yield blender().ops.object.body_moments_measure


def read_and_store(kind: str) -> Steps:
    """Read 400 objects' arrays and store twelve numbers, which is the least that Measure has to
    do.
    """
    from benchmark_many import floor

    objects = parts(kind)
    for _ in range(4):
        yield partial(floor, objects, False)


def snap(name: str, kind: str = "boxes") -> Steps:
    """Press a snap, each time on 400 new objects; without a name, Measure."""
    operator = getattr(blender().ops.object, "body_moments_" + name)
    for _ in range(3):
        parts(kind)
        yield operator


def properties(subdivisions: int) -> Steps:
    """Give all properties of triangles in arrays, with the verdict."""
    from body_moments.core import mass_properties

    points, triangles = ball(subdivisions)
    for _ in range(max(200 >> 2 * subdivisions, 5)):
        yield lambda: mass_properties(points, triangles, density=1.0)


def verdict(threads: int) -> Steps:
    """Say whether 1.3 million triangles are closed, and integrate them."""
    from body_moments.core import Surface, measure_solid

    surface = Surface(*ball(8))
    for _ in range(3):
        yield lambda: measure_solid(surface, threads=threads)


def threshold(noise: float) -> Steps:
    """Measure the region of a scan of 96³ above a threshold."""
    from body_moments.core.density.threshold import threshold_body

    samples = scan(noise)
    yield lambda: threshold_body(samples, 0.0, order=2)


def convex_pieces(name: str) -> Steps:
    """Cut a body into as many convex pieces as CoACD does."""
    from benchmark_colliders import run
    from body_moments.core import Surface
    from body_moments.core.colliders.convex_pieces import cut_into_pieces

    surface = Surface.from_triangles(*body(name))
    yield lambda: run(cut_into_pieces(surface, 0.0, 16, 256))


def colliders(kind: str) -> Steps:
    """Press Make Colliders, Automatic, each time on 20 new objects that all differ."""
    bpy = blender()
    for seed in range(3):
        parts(kind, 20, seed)
        yield lambda: bpy.ops.object.body_moments_make_colliders(shape="AUTOMATIC")


# Tasks of other programs


def trimesh_properties(subdivisions: int) -> Steps:
    """Ask trimesh whether triangles are watertight, and for their mass properties."""
    import trimesh

    points, triangles = ball(subdivisions)

    def all_properties() -> None:
        mesh = trimesh.Trimesh(points, triangles, process=False)
        assert mesh.is_watertight and mesh.mass_properties is not None

    for _ in range(max(200 >> 2 * subdivisions, 5)):
        yield all_properties


def igl_moments() -> Steps:
    """Integrate 1.3 million triangles without a verdict."""
    import igl

    points, triangles = ball(8)
    triangles = triangles.astype(np.int64)
    for _ in range(3):
        yield lambda: igl.moments(points, triangles)


def vtk_contour(noise: float) -> Steps:
    """Triangulate the region of a scan, without a bound."""
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk

    samples = scan(noise)
    image = vtk.vtkImageData()
    image.SetDimensions(*samples.shape)
    image.GetPointData().SetScalars(numpy_to_vtk(samples.ravel(order="F"), deep=True))
    for _ in range(3):
        contour = vtk.vtkFlyingEdges3D()
        contour.SetInputData(image)
        contour.SetValue(0, 0.0)
        yield contour.Update


def coacd_pieces(name: str) -> Steps:
    """Cut a body into convex pieces by CoACD, at most 16."""
    import coacd

    coacd.set_log_level("error")
    mesh = coacd.Mesh(*body(name))
    yield lambda: coacd.run_coacd(mesh, preprocess_mode="off", seed=1, max_convex_hull=16)


# row -> our task, the other's task and what it is called
TASKS: dict[str, tuple[Callable[[], Steps], Callable[[], Steps] | None, str]] = {
    **{
        "Measure, one {}".format(kind): (partial(measure, kind), None, "")
        for kind in ("cube", "Suzanne", "smooth Suzanne")
    },
    **{
        "Measure, 400 {}".format(kind): (
            partial(measure_many, kind),
            partial(read_and_store, kind),
            "reading and storing",
        )
        for kind in ("cubes", "boxes", "cylinders")
    },
    **{
        "{}, 400 boxes".format(title): (
            partial(snap, name),
            partial(snap, "measure"),
            "Measure, first",
        )
        for title, name in (
            ("Origin to Center", "origin_to_center"),
            ("Axes to Principal", "axes_to_principal"),
        )
    },
    **{
        "properties, {:,} triangles".format(20 << 2 * n): (
            partial(properties, n),
            partial(trimesh_properties, n),
            "trimesh, watertight",
        )
        for n in (1, 3, 5)
    },
    **{
        "verdict, 1.3 M triangles, {:d} thread{}".format(n, "s" * (n > 1)): (
            partial(verdict, n),
            igl_moments,
            "libigl, no verdict",
        )
        for n in (1, 2)
    },
    **{
        "threshold, {} scan of 96³".format(title): (
            partial(threshold, noise),
            partial(vtk_contour, noise),
            "vtk, no bound",
        )
        for title, noise in (("smooth", 0.0), ("noisy", 0.02))
    },
    **{
        "convex pieces, {}".format(name): (
            partial(convex_pieces, name),
            partial(coacd_pieces, name),
            "CoACD",
        )
        for name in ("torus", "hook", "chair")
    },
    **{
        "colliders, 20 {}".format(kind): (partial(colliders, kind), None, "")
        for kind in ("boxes", "cylinders", "angles")
    },
}


# What the tasks need


def blender():
    """The module bpy, with the add-on registered."""
    import bpy

    if not hasattr(bpy.types, "OBJECT_OT_body_moments_measure"):
        sys.modules["body_moments"].register()
    return bpy


def parts(kind: str, count: int = 400, seed: int = 1) -> list:
    """So many selected objects: cubes that are equal, or other bodies that all differ."""
    from benchmark_many import CORNERS, SIDES, make, prism

    blender()
    rng = np.random.default_rng(seed)
    kinds = {
        "cubes": lambda: (CORNERS.copy(), SIDES),
        "boxes": lambda: (CORNERS * rng.uniform(0.5, 2.0, 3), SIDES),
        "cylinders": lambda: (prism(32)[0] * rng.uniform(0.5, 2.0, 3), prism(32)[1]),
        "angles": lambda: (angle()[0] * rng.uniform(0.5, 2.0, 3), angle()[1]),
    }
    return make(count, kinds[kind], rng)


def angle() -> tuple[np.ndarray, list[list[int]]]:
    """A prism over an L."""
    outline = [(0, 0), (3, 0), (3, 1), (1, 1), (1, 3), (0, 3)]
    points = np.array([(x, y, z) for z in (0, 1) for x, y in outline], float)
    sides = [[i, (i + 1) % 6, (i + 1) % 6 + 6, i + 6] for i in range(6)]
    return points, [[5, 4, 3, 2, 1, 0], [6, 7, 8, 9, 10, 11], *sides]


def ball(subdivisions: int) -> tuple[np.ndarray, np.ndarray]:
    """An icosahedron, each face cut in four again and again, on the sphere."""
    golden = (1.0 + 5.0**0.5) / 2.0
    signs = [(a, b) for a in (-1.0, 1.0) for b in (-golden, golden)]
    points = np.array([np.roll((0.0, a, b), k) for k in range(3) for a, b in signs])
    pairs = np.linalg.norm(points[:, None] - points, axis=2)
    near = (pairs > 0.0) & (pairs < 2.1)
    triangles = np.array(
        [
            (i, j, k) if np.linalg.det(points[[i, j, k]]) > 0.0 else (i, k, j)
            for i in range(12)
            for j in range(i + 1, 12)
            for k in range(j + 1, 12)
            if near[i, j] and near[j, k] and near[i, k]
        ]
    )
    for _ in range(subdivisions):
        edges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        edges, places = np.unique(edges, axis=0, return_inverse=True)
        a, b, c = triangles.T
        ab, bc, ca = len(points) + places.reshape(-1, 3).T
        points = np.concatenate([points, points[edges].mean(axis=1)])
        corners = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        triangles = np.concatenate([np.stack(one, axis=1) for one in corners])
    points /= np.linalg.norm(points, axis=1)[:, None]
    return points, triangles.astype(np.int32)


def scan(noise: float, count: int = 96) -> np.ndarray:
    """Samples of a round bump that is positive within a ball, and noise."""
    x, y, z = np.meshgrid(*[np.linspace(-1.0, 1.0, count)] * 3, indexing="ij")
    samples = 0.6 - np.sqrt(x * x + y * y + z * z)
    return samples + noise * np.random.default_rng(0).standard_normal(samples.shape)


def body(name: str) -> tuple[np.ndarray, np.ndarray]:
    """A body of the benchmark of colliders."""
    from benchmark_colliders import bodies

    return bodies()[name]


# The run


def run_task(row: str, who: str, root: Path) -> None:
    """Print the least time of a task on the processor, in seconds."""
    load_checkout(root)
    ours, other, _ = TASKS[row]
    times = []
    for function in (other if who == OTHER else ours)():
        start = time.process_time()
        function()
        times.append(time.process_time() - start)
    print("\nseconds {!r}".format(min(times)))


def time_task(row: str, who: str, root: Path, folder: str) -> float | None:
    """Run a task in a process of its own; return its time, or None if it cannot run."""
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "BLENDER_USER_RESOURCES": folder}
    words = [sys.executable, str(Path(__file__)), "--row", row, "--who", who, "--root", str(root)]
    done = subprocess.run(words, env=environment, capture_output=True, text=True, check=False)
    last = (done.stdout.strip().splitlines() or [""])[-1]
    return float(last.split()[1]) if last.startswith("seconds") else None


def checkout(commit: str, folder: str) -> Path | None:
    """Check out a commit into the folder; return None if the repository does not have it."""
    target = Path(folder) / commit
    words = ["git", "-C", str(ROOT), "archive", "--format=tar", commit]
    packed = subprocess.run(words, capture_output=True, check=False)
    if packed.returncode:
        return None
    target.mkdir()
    subprocess.run(["tar", "-x", "-C", str(target)], input=packed.stdout, check=True)
    return target


def compare(against: str, rounds: int, chosen: list[str]) -> dict[str, dict[str, float]]:
    """Print the table; return the seconds of each row."""
    columns = "{:<36s}{:>10s}{:>12s}{:>8s}{:>12s}{:>8s}  {}"
    print(columns.format("milliseconds of the processor", "today", against, "x", "other", "x", ""))
    result = {}
    with tempfile.TemporaryDirectory(prefix="body_moments_benchmark_") as folder:
        earlier = checkout(against, folder)
        for row, (_, other, name) in TASKS.items():
            if not any(word in row for word in chosen or [""]):
                continue
            runs = {OURS: (OURS, ROOT)}
            if earlier:
                runs[against] = OURS, earlier
            if other:
                runs[OTHER] = OTHER, ROOT
            times: dict[str, list[float]] = {key: [] for key in runs}
            for _ in range(rounds):
                for key, (who, root) in runs.items():
                    seconds = time_task(row, who, root, folder)
                    times[key] += [] if seconds is None else [seconds]
            result[row] = found = {
                key: statistics.median(values) for key, values in times.items() if values
            }
            cells = []
            for key in (against, OTHER):
                is_known = key in found and OURS in found
                cells.append("{:.2f}".format(1e3 * found[key]) if is_known else "-")
                cells.append("{:.2f}".format(found[OURS] / found[key]) if is_known else "-")
            today = "{:.2f}".format(1e3 * found[OURS]) if OURS in found else "-"
            print(columns.format(row, today, *cells, name), flush=True)
    return result


def plot(result: dict[str, dict[str, float]], against: str, path: str) -> None:
    """Draw the ratios of the rows to the earlier build and to others, on a logarithmic axis."""
    import matplotlib as mpl

    mpl.use("svg")
    mpl.rcParams |= {"svg.hashsalt": "body-moments", "svg.fonttype": "none"}
    from matplotlib import pyplot

    rows = [row for row in result if len(result[row]) > 1][::-1]
    figure, axes = pyplot.subplots(figsize=(9, 0.32 * len(rows) + 1.2))
    for key, title, mark in ((against, "earlier build " + against, "o"), (OTHER, "other", "s")):
        places = [i for i, row in enumerate(rows) if key in result[row]]
        ratios = [result[rows[i]][OURS] / result[rows[i]][key] for i in places]
        axes.plot(ratios, places, mark, label="time / {}".format(title))
    labels = ["{} (other: {})".format(row, TASKS[row][2]) if TASKS[row][2] else row for row in rows]
    axes.set(xscale="log", yticks=range(len(rows)), yticklabels=labels)
    axes.set_xlabel("ratio of times on one processor; left of 1 is faster")
    axes.axvline(1.0, color="gray", linewidth=0.8)
    axes.legend(loc="lower right")
    axes.grid(axis="x", alpha=0.3)
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--against", metavar="COMMIT", default=EARLIER, help="the earlier build")
    parser.add_argument("--rounds", type=int, default=3, help="processes of each kind (3)")
    parser.add_argument("--plot", metavar="FILE", help="draw the ratios into an .svg file")
    parser.add_argument("words", nargs="*", metavar="WORD", help="only rows with one of the words")
    parser.add_argument("--row", help=argparse.SUPPRESS)
    parser.add_argument("--who", help=argparse.SUPPRESS)
    parser.add_argument("--root", type=Path, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.row:
        run_task(options.row, options.who, options.root)
        return
    result = compare(options.against, options.rounds, options.words)
    if options.plot:
        plot(result, options.against, options.plot)


if __name__ == "__main__":
    main()
