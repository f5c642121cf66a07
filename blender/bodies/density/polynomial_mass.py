# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The mass moments of a body whose density is a polynomial, and a check that no density in the body is negative."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from ....core.bodies.instances import group_by_similarity
from ....core.bodies.mesh_body import MeshBody
from ....core.bodies.reading import Reading, to_si
from ....core.density.polynomial import Polynomial
from ....core.density.polynomial_mass import find_negative_point, local_coordinates, polynomial_mass_of_images
from ....core.measurement.settings import Settings
from ....core.mesh.surface import Surface
from ....core.moments.affine_maps import translation_matrices
from ....core.moments.moments import Moments
from ....core.numerics.rotations import polar_rotation
from ....core.polyhedron import polyhedron_moments
from ....core.verdict.finding import Finding, ReadError, finding
from ....core.verdict.method import Verdict
from ...settings.density import DensityField
from ..findings import DENSITY_NEGATIVE, DENSITY_POSSIBLY_NEGATIVE, SHEARED_DENSITY_AXES, UNION_LACKS

MAX_CHECKED_INSTANCES = 50  # different places of a surface in which the sign of the density is checked


@dataclass(frozen=True, eq=False)
class _Piece:
    """A surface with (k, 4, 4) `matrices` to the world, and `fields` to the coordinates of the density, in meters.

    about: the point that an open surface is closed to.
    """

    surface: Surface
    matrices: NDArray[np.float64]
    fields: NDArray[np.float64]
    about: NDArray[np.float64] | None = None


def polynomial_mass_result(
    reading: Reading, body: MeshBody, density: DensityField, settings: Settings, order: int
) -> tuple[list[Moments], list[Finding]]:
    """Return the mass moments of all parts to an order (of a shell per meter of thickness), and the findings."""
    polynomial, findings, unit, shell = _polynomial(density), [], settings.unit, settings.kind == "shell"
    pieces = list(
        _sheet_pieces(reading, density.in_world, unit)
        if shell
        else _solid_pieces(reading, body, density.in_world, unit)
    )
    if not density.in_world and any(polar_rotation(part.matrices)[1].any() for part in reading.parts):
        findings.append(finding(SHEARED_DENSITY_AXES))
    findings += _negative_density_note(density, pieces, shell)
    parts = []
    order += polynomial.degree
    for piece in pieces:
        volume, area = polyhedron_moments(
            piece.surface,
            order,
            area_order=order if shell else None,
            about=piece.about,
            exact=True,
            threads=settings.threads,
            allow_open=True,
        )
        moments = volume if area is None else area
        parts.append(polynomial_mass_of_images(moments, polynomial, piece.matrices, piece.fields))
    return parts, findings


def _solid_pieces(reading: Reading, body: MeshBody, in_world: bool, unit: float) -> Iterator[_Piece]:
    """Yield the repaired surfaces around the body."""
    if body.method.verdict == Verdict.UNION:
        if reading.instance_count > 1 and not in_world:
            raise ReadError(UNION_LACKS, data="object coordinates")
        solid, matrices = body.solids[0]
        place = to_si(reading.parts[0].matrices, unit)
        yield _Piece(
            solid.repaired_surface, matrices, matrices if in_world else _to_local(place) @ matrices, solid.volume.about
        )
        return
    for solid, matrices in body.solids:
        yield _Piece(
            solid.repaired_surface, matrices, matrices if in_world else local_coordinates(matrices), solid.volume.about
        )


def _to_local(matrices: NDArray) -> NDArray[np.float64]:
    """Return (k, 4, 4) maps from world coordinates, in meters, to coordinates along the axes of each place."""
    axes = polar_rotation(matrices)[0].transpose(0, 2, 1)
    to_own = translation_matrices(-(axes @ matrices[:, :3, 3, None])[..., 0])
    to_own[:, :3, :3] = axes
    return to_own


def _sheet_pieces(reading: Reading, in_world: bool, unit: float) -> Iterator[_Piece]:
    """Yield the surfaces before repair; unevenly stretched images become surfaces of their own."""
    for part in reading.parts:
        matrices = to_si(part.matrices, unit)
        fields, axes = local_coordinates(matrices), polar_rotation(matrices)[0]
        for surface, image_matrices, which in group_by_similarity(part.surface, matrices):
            to_local = fields[which]
            if surface is not part.surface:  # mapped already: only the turn is left
                to_local = translation_matrices(np.zeros((len(which), 3)))
                to_local[:, :3, :3] = axes[which].transpose(0, 2, 1)
            yield _Piece(surface, image_matrices, image_matrices if in_world else to_local)


def _polynomial(density: DensityField) -> Polynomial:
    assert density.polynomial is not None
    return density.polynomial


def _negative_density_note(density: DensityField, pieces: list[_Piece], shell: bool) -> list[Finding]:
    """Return a finding if the density may be negative in the body; raise ReadError if it is negative."""
    polynomial = _polynomial(density)
    corners = np.array(list(product((0.0, 1.0), repeat=3)))
    boxes = []
    for piece in pieces:
        low, high = piece.surface.box
        box = low + corners * (high - low)
        boxes.append(np.einsum("kij,nj->kni", piece.fields[:, :3, :3], box) + piece.fields[:, None, :3, 3])
    boxes = np.concatenate(boxes)
    if polynomial.lower_bound(boxes.min(axis=(0, 1)), boxes.max(axis=(0, 1))) >= 0.0:
        return []
    is_doubtful = False
    for piece in pieces:
        triangles = piece.surface.all_triangles()[0]
        points = piece.surface.points.astype(np.float64)
        fields = piece.fields[np.unique(np.float32(piece.fields), axis=0, return_index=True)[1]]
        is_doubtful |= len(fields) > MAX_CHECKED_INSTANCES
        for field in fields[:MAX_CHECKED_INSTANCES]:
            worst, is_undecided = find_negative_point(
                polynomial, points @ field[:3, :3].T + field[:3, 3], triangles, not shell
            )
            if worst is not None:
                value, place = worst
                point = [float(x) for x in place]
                raise ReadError(DENSITY_NEGATIVE, density=float(value), point=point, frame=density.frame)
            is_doubtful |= is_undecided
    return [finding(DENSITY_POSSIBLY_NEGATIVE)] if is_doubtful else []
