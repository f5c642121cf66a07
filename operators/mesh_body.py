# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The body that polygons bound, with all its instances: each surface is measured once and mapped to its places."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import fields, replace
from functools import cache, partial

import numpy as np
from numpy.typing import NDArray

from ..core.affine import distinct_linear, translations
from ..core.images import area_of_images
from ..core.moments import Moments, are_similarities, map_sum, sum_moments
from ..core.polyhedron import solid_and_area
from ..core.recursion import moments_to_order
from ..core.solid import Faults, Health, SolidMeasure, measure_solid
from ..core.surface import Surface, boxes_meet, joined
from .body import Body
from .read import Reading
from .read.union import union_surface

COMPARED = 200_000  # triangles up to which instances are compared with each other as shells of one mesh
RANKED = ("open", "capped", "reoriented", "exact")  # methods: of several, the first counts
FLATTENED = ("A zero scale flattens it; set its scale, or its parents', to something else than zero, or measure it as "
             "a shell.")
ALL_FLATTENED = ("A zero scale flattens all that it instances; give the instances another scale, or measure it as a "
                 "shell.")
MOST_NAMED = 8  # surfaces, or faces, that a sentence names
NOT_COMPARED = ("Overlap was not looked for between its {:d} instances, and boxes around some of them overlap; what "
                "those share counts twice.")


def mesh_body(reading: Reading, unit: float, *, shell: bool, union: bool, threads: int) -> Body:
    """What an object's surfaces bound, or with `shell` the sheets that they are.

    unit: metres per Blender unit. union: shells that overlap are united first. ValueError, with what to do, where
    there is nothing to measure.
    """
    if reading.singular and not shell:
        raise ValueError(flattened_reason(reading))
    body = _united(reading, unit, threads) if union and not shell else _summed(reading, unit, shell, threads)
    if reading.flattened and not shell:
        body = replace(body, warnings=(some_flattened(reading.flattened), *body.warnings))
    return body


def flattened_reason(reading: Reading) -> str:
    """Why nothing of a singular reading encloses anything, with the remedy."""
    return FLATTENED if reading.flat else ALL_FLATTENED


def some_flattened(count: int) -> str:
    """A sentence about so many instances that enclose nothing."""
    return ("One of its instances is flattened by a zero scale and encloses nothing." if count == 1 else
            "{:d} of its instances are flattened by a zero scale and enclose nothing.".format(count))


def told_of_parts(parts: Iterable[tuple[str, Iterable[str]]], whole: str) -> list[str]:
    """The sentences of several parts, as (name, sentences), each sentence once. Of a part that is all of the object
    `whole` they stay as they are; else the names come before them, for “it” is a part then."""
    parts = list(parts)
    named: dict[str, list[str]] = {}
    for k, (name, sentences) in enumerate(parts):
        for sentence in sentences:
            named.setdefault(sentence, []).append(
                "“{:s}”".format(name) if name else "Surface {:d} of {:d}".format(k + 1, len(parts)))
    if len(parts) == 1 and parts[0][0] in ("", whole):
        return list(named)
    return ["{:s}: {:s}".format(", ".join(names[:MOST_NAMED] + ["…"] * (len(names) > MOST_NAMED)), sentence)
            for sentence, names in named.items()]


def _summed(reading: Reading, unit: float, shell: bool, threads: int) -> Body:
    """Each part measured once in its own coordinates, and mapped to wherever it stands."""
    volumes, areas, healths, methods, warnings, told, parts = [], [], [], [], [], [], []
    if not shell and reading.places > 1 and places_meet(reading):
        if sum(_triangles(part.surface) * len(part.matrices) for part in reading.parts) <= COMPARED:
            return _as_one(reading, unit, threads)
        warnings.append(NOT_COMPARED.format(reading.places))
    for part in reading.parts:
        solid = measure_solid(part.surface, shell=shell, threads=threads)
        matrices = in_metres(part.matrices, unit)
        volumes.append(map_sum(solid.volume, matrices))
        measured = (lambda surface: solid_and_area(surface, threads, shell=True)[1]) if shell else None
        own = list(mapped_areas(part.surface, solid.area, matrices, measured))
        areas.extend(own)
        stretch = volumes[-1].total / solid.volume.total if solid.volume.total else 0.0  # Σ |det|
        healths.append((replace(solid.health, volume_spread=solid.health.volume_spread * stretch), len(matrices),
                        sum(moments.total for moments in own)))
        flat = not shell and not solid.volume.raw.any()
        methods.append(None if flat else solid.method)
        if shell:  # it is measured as it is
            copies = solid.health.duplicate_faces
            told.append((part.source, [] if not copies else [
                "One face is a copy of another and counts with it." if copies == 1 else
                "{:d} faces are copies of others and count with them.".format(copies)]))
        else:
            told.append((part.source, () if flat else solid.warnings))
        parts.append((solid, matrices))
    warnings += told_of_parts(told, reading.name)
    solid_methods = [method for method in methods if method]
    if solid_methods and len(solid_methods) < len(methods):
        count = methods.count(None)
        warnings.append("{:d} of its {:d} surfaces {:s} flat, as a ground is that instances stand on; areas count, and "
                        "volumes do not.".format(count, len(methods), "is" if count == 1 else "are"))
    method = min(solid_methods, key=RANKED.index, default="open")
    return _body(sum_moments(volumes), sum_moments(areas), together(healths), method, warnings, parts,
                 [part.surface for part in reading.parts], threads)


def _body(volume: Moments, area: Moments, health: Health, method: str, warnings: Iterable[str],
          solids: list[tuple[SolidMeasure, NDArray]], surfaces: list[Surface], threads: int) -> Body:
    """surfaces: what each of the solids was before it was mended."""
    def refined() -> Moments:
        return sum_moments([map_sum(solid.refined(threads), matrices) for solid, matrices in solids])

    @cache  # the frame and the shape need them to one order
    def to_order(order: int, area: bool) -> tuple[Moments, Moments | None]:
        return _to_order(solids, surfaces, order, area, threads)

    def pieces(sheets: bool) -> Iterator[Surface]:
        for (solid, matrices), surface in zip(solids, surfaces):
            one = surface if sheets else solid.mended
            yield from (one.mapped(matrix[:3, :3], matrix[:3, 3]) for matrix in matrices)

    faces = sum(len(solid.mended.triangles) + len(solid.mended.quads) for solid, _ in solids)
    return Body(volume, area, health, method, tuple(warnings), refined=refined, to_order=to_order,
                solids=tuple(solids), pieces=pieces, faces=faces)


def _to_order(solids: list[tuple[SolidMeasure, NDArray]], surfaces: list[Surface], order: int, area: bool,
              threads: int) -> tuple[Moments, Moments | None]:
    """The moments to an order of what was measured, each part once and mapped to its places: the volume of the mended
    surface, in one pass with the area where mending has neither added nor left out a face."""
    volumes, areas = [], []
    for (solid, matrices), surface in zip(solids, surfaces):
        same = (solid.method in ("exact", "reoriented") and not solid.health.duplicate_faces
                and _triangles(solid.mended) == _triangles(surface))  # else flat parts are left out
        volume, faces = moments_to_order(solid.mended, order, area=area and same, threads=threads,
                                         about=solid.volume.about)  # of an open surface they depend on it
        volumes.append(map_sum(volume, matrices))
        if area:
            measured = lambda other: moments_to_order(other, order, area=True, threads=threads)[1]  # noqa: E731
            areas.extend(mapped_areas(surface, faces or measured(surface), matrices, measured))
    return sum_moments(volumes), sum_moments(areas) if area else None


def _triangles(surface: Surface) -> int:
    return len(surface.triangles) + 2 * len(surface.quads)


def _as_one(reading: Reading, unit: float, threads: int) -> Body:
    """All parts where they stand as one surface, so that they are compared as the shells of one mesh are."""
    surface = reading.joined()
    solid = measure_solid(surface, threads=threads, names=partial(_named_faces, reading))
    scale = np.diag([unit, unit, unit, 1.0])
    health = replace(solid.health, volume_spread=solid.health.volume_spread * unit**3, faults=Faults())
    return _body(solid.volume.mapped(scale), solid.area.mapped(scale), health, solid.method, solid.warnings,
                 [(solid, scale[None])], [surface], threads)


def _named_faces(reading: Reading, faces: NDArray[np.integer]) -> str:
    """What faces of `reading.joined()` are called: their numbers in the surfaces that they are instances of."""
    places = np.repeat(np.arange(len(reading.parts)), [len(part.matrices) for part in reading.parts])
    counts = np.array([int(part.surface.all_triangles()[1].max(initial=-1)) + 1 for part in reading.parts])[places]
    ends = np.cumsum(counts)
    at = np.searchsorted(ends, faces, side="right")
    named = np.unique(np.stack([places[at], faces - (ends - counts)[at]]), axis=1).T[:MOST_NAMED + 1].tolist()
    sources = [part.source and "“{:s}”".format(part.source) for part in reading.parts]
    names = ["{:d} of {:s}".format(face, sources[i] or "surface {:d}".format(i + 1)) for i, face in named[:MOST_NAMED]]
    return ", ".join(names + ["…"] * (len(named) > MOST_NAMED))


def places_meet(reading: Reading) -> bool:
    """Whether the boxes around any two of the places where parts stand share more than a rim."""
    centers, extents = [], []
    for part in reading.parts:
        low, high = part.surface.box
        linear = part.matrices[:, :3, :3]
        centers.append(linear @ ((low + high) / 2.0) + part.matrices[:, :3, 3])
        extents.append(np.abs(linear) @ ((high - low) / 2.0))
    return boxes_meet(np.concatenate(centers), np.concatenate(extents))


def _united(reading: Reading, unit: float, threads: int) -> Body:
    """All parts where they stand as one surface, overlaps removed by Blender's exact boolean."""
    before = _summed(reading, unit, False, threads)
    if not before.volume.total > 0.0:
        return before
    mended = [solid.mended.mapped(matrix[:3, :3], matrix[:3, 3])
              for solid, matrices in before.solids for matrix in matrices]
    surface = union_surface(joined(mended))
    solid = measure_solid(surface, threads=threads) if _triangles(surface) else None
    if solid is None or solid.method == "open":
        raise ValueError("Blender's boolean could not unite its shells; close and clean the mesh, or count each.")
    notes = ["Its shells were united by Blender's exact boolean, which rounds to 7 digits."]
    if before.method == "capped":
        notes.append("Its holes were capped before; the caps are {:.3g} % of its area.".format(
            100.0 * before.health.cap_area_share))
    elif before.method != "exact":
        notes.append("Its faces were turned outward before." if before.method == "reoriented" else
                     "Some of its parts are open, so that their union need not be the body that is meant.")
    return _body(solid.volume, solid.area, before.health, "union", (*notes, *solid.warnings),
                 [(solid, np.eye(4)[None])], [surface], threads)


def in_metres(matrices: NDArray, unit: float) -> NDArray[np.float64]:
    """World matrices to SI."""
    scaled = np.array(matrices, np.float64)
    scaled[:, :3] *= unit
    return scaled


def mapped_areas(surface: Surface, area: Moments, matrices: NDArray, measured: Callable[[Surface], Moments] | None
                 ) -> Iterator[Moments]:
    """The area moments of a surface's images. They do not follow a map that stretches unevenly, so there the mapped
    surface is `measured`, once for each different map; with None, only the area itself is wanted."""
    if measured is None:
        even = are_similarities(matrices[:, :3, :3])
        if even.any():
            yield map_sum(area, matrices[even])
        if not even.all():
            yield area_of_images(surface, matrices[~even, :3, :3])
        return
    for image, places, _ in even_surfaces(surface, matrices):
        yield map_sum(area if image is surface else measured(image), places)


def even_surfaces(surface: Surface, matrices: NDArray) -> Iterator[tuple[Surface, NDArray, NDArray]]:
    """A surface's images as images under similarities: the surface itself or mapped ones, one for each different uneven
    map, with the (j, 4, 4) maps that are left and which of `matrices` they stand for, (j,)."""
    even = are_similarities(matrices[:, :3, :3])
    if even.any():
        yield surface, matrices[even], np.flatnonzero(even)
    if even.all():
        return
    rest = np.flatnonzero(~even)
    for linear, own in distinct_linear(matrices[rest]):
        yield surface.mapped(linear), translations(matrices[rest[own], :3, 3]), rest[own]


def together(healths: Iterable[tuple[Health, int, float]]) -> Health:
    """One verdict for all parts, each with the number of its instances and the area of all of them: counts add; faults
    are named where there is one part only."""
    healths = list(healths)
    first, copies, _ = healths[0]
    if len(healths) == 1 and copies == 1:
        return first
    area = sum(own for *_, own in healths)
    total = {"faults": Faults(), "closed": all(h.closed for h, *_ in healths),
             "welded": any(h.welded for h, *_ in healths),
             "volume_spread": sum(h.volume_spread for h, *_ in healths),
             "cap_area_share": sum(h.cap_area_share * own for h, _, own in healths) / area if area > 0.0 else 0.0}
    for field in fields(Health):
        if field.name not in total:
            total[field.name] = sum(getattr(h, field.name) * k for h, k, _ in healths)
    return Health(**total)
