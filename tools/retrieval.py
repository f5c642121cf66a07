# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Retrieval rate of real parts that were moved, cut into other faces and made noisy.

    python -m pip download --no-deps gymnasium-robotics
    python -m zipfile -e gymnasium_robotics-*.whl parts
    python3 tests/project.py retrieval parts

The parts are the STL files under the folder, binary, and the closed shells of those that hold
several. Of parts whose signatures are nearer than DISTINCT only one is kept: screws that differ by
less are one screw. It prints, and asserts nothing. It takes some minutes.
"""

from __future__ import annotations

import argparse
import struct
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from loading import load_checkout

load_checkout()

from body_moments.core.mesh.surface import Surface
from body_moments.core.numerics.graph import connected_components
from body_moments.core.polyhedron import polyhedron_moments
from body_moments.core.shape.signatures import Signature, signature, similarity
from body_moments.core.solid.measure import measure_solid

from tests.core import bodies, shapes

ORDER = 12
FEWEST, MOST = 30, 60_000  # triangles of a part
DISTINCT = 5e-3
NOISES = (0.0, 3e-4, 1e-3)  # standard deviations of the corners, by the part's largest extent

Part = tuple[np.ndarray, np.ndarray]


def read_stl(path: Path) -> Part:
    data = path.read_bytes()
    count = struct.unpack_from("<I", data, 80)[0]
    row = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")])
    corners = np.frombuffer(data, row, count, 84)["corners"].astype(float)
    points, index = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    triangles = index.reshape(-1, 3)
    a, b, c = triangles.T
    return points, triangles[(a != b) & (b != c) & (c != a)]


def shells(part: Part) -> Iterator[Part]:
    points, triangles = part
    ends = np.concatenate([triangles[:, :2], triangles[:, 1:]])
    which, number = connected_components(len(points), ends[:, 0], ends[:, 1])
    for i in range(number):
        faces = triangles[which[triangles[:, 0]] == i]
        if len(faces):
            used, index = np.unique(faces, return_inverse=True)
            yield points[used], index.reshape(-1, 3)


def parts(folder: Path) -> Iterator[tuple[str, Part]]:
    for path in sorted(folder.rglob("*.stl")):
        whole = read_stl(path)
        pieces = list(shells(whole))
        yield from ((path.stem, whole),) if len(pieces) > 1 else ()
        yield from (("{:s} #{:d}".format(path.stem, i), piece) for i, piece in enumerate(pieces))


def signed(part: Part) -> Signature:
    points, triangles = part
    points = points - polyhedron_moments(Surface(points, triangles))[0].center
    radius = np.linalg.norm(points[np.unique(triangles)], axis=1).max()
    moments = polyhedron_moments(
        Surface(points, triangles), ORDER, about=np.zeros(3), reach=radius
    )[0]
    return signature(moments, radius)


def library(folder: Path) -> list[tuple[str, Part, Signature]]:
    kept: list[tuple[str, Part, Signature]] = []
    seen = set()
    for name, (points, triangles) in parts(folder):
        key = len(triangles), np.ptp(points, axis=0).tobytes()
        if key in seen or not FEWEST <= len(triangles) <= MOST:
            continue
        seen.add(key)
        try:
            solid = measure_solid(Surface(points, triangles))
        except ValueError:
            continue
        if solid.method == "open" or not solid.volume.total > 0.0:
            continue
        part = (
            solid.repaired_surface.points.astype(float),
            solid.repaired_surface.all_triangles()[0],
        )
        found = signed(part)
        if all(similarity(other, found).distance() >= DISTINCT for _, _, other in kept):
            kept.append((name, part, found))
    return kept


def altered(part: Part, seed: int, noise: float) -> Part:
    """Moved, with each triangle cut in three at a random point, and its points noisy and rounded to
    float32.
    """
    rng = np.random.default_rng(seed)
    size = np.ptp(part[0], axis=0).max()
    points, triangles = shapes.refined(part, seed)
    points = points + rng.normal(size=points.shape) * noise * size
    points = points @ bodies.rotation(seed).T + rng.normal(size=3) * size * 10.0
    return points.astype(np.float32).astype(float), triangles


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    start = time.perf_counter()
    kept = library(parser.parse_args().folder)
    print(
        "{:d} distinct parts, {:,d} triangles, {:.0f} s".format(
            len(kept), sum(len(part[1]) for _, part, _ in kept), time.perf_counter() - start
        )
    )
    for noise in NOISES:
        missed = []
        for i, (name, part, _) in enumerate(kept):
            found = signed(altered(part, i, noise))
            nearest = min(kept, key=lambda row: similarity(row[2], found).distance())
            if nearest[0] != name:
                missed.append("{:s} -> {:s}".format(name, nearest[0]))
        print(
            "noise {:g} of the size: the original is nearest in {:d} of {:d}, {:.2f} %".format(
                noise, len(kept) - len(missed), len(kept), 100.0 - 100.0 * len(missed) / len(kept)
            ),
            flush=True,
        )
        for line in missed:
            print("    " + line)


if __name__ == "__main__":
    main()
