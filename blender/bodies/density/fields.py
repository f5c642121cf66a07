# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The mass moments of a body whose density is a function of the place: a polynomial, or a Volume
object's grid.

No polynomial may be negative in the body. A solid and the Volume object that fills it keep their
places.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from ....core import bodies, measurement, mesh, polyhedron
from ....core.density import (
    MAX_VOXELS,
    GridOptions,
    density_function,
    empty_background_note,
    find_negative_point,
    inside_moments,
    local_coordinates,
    polynomial_mass_of_images,
)
from ....core.moments import Measure, Moments, affine_matrices
from ....core.numerics import Array, NDArray, polar_rotation
from ....core.solid.measure import SolidIntegrals
from ....core.verdict import (
    NEGLIGIBLE,
    Finding,
    MeasureError,
    Method,
    Procedure,
    ReadError,
    Source,
    finding,
)
from ...read.findings import GRID_UNSUPPORTED, IS_LEVEL_SET, NO_SCALAR_GRID, OBJECT_UNREADABLE
from ...read.tracking import tracking_paused
from ...read.volume import VolumeReading, volume_reading
from ...settings.density import DensityField
from ..findings import (
    DENSITY_GRID_ELSEWHERE,
    DENSITY_NEGATIVE,
    DENSITY_POSSIBLY_NEGATIVE,
    OPEN_SURFACE_OF_GRID,
    OUTSIDE_GRID,
    SHEARED_DENSITY_AXES,
    UNION_LACKS,
)
from ..request import Request

# Different places of a surface in which the sign of the density is checked.
MAX_CHECKED_INSTANCES = 50
MAX_OUTSIDE_SHARE = 1e-9  # relative to the volume: a smaller share outside the grid is rounding


@dataclass(frozen=True, eq=False)
class _Piece:
    """A surface with (k, 4, 4) maps from its coordinates, in meters.

    matrices: to its places in the world. fields: from the same coordinates to those of the density
    at each place. about: the point that an open surface is closed to.
    """

    surface: mesh.Surface
    matrices: Array
    fields: Array
    about: Array | None = None


def polynomial_mass_result(
    reading: bodies.Reading,
    body: bodies.MeshBody,
    density: DensityField,
    settings: measurement.Settings,
    order: int,
) -> tuple[list[Moments], list[Finding]]:
    """Return the mass moments of all parts to an order (of a shell per meter of thickness), and the
    findings.
    """
    polynomial = density.polynomial
    findings = []
    unit = settings.unit
    shell = settings.kind == "shell"
    assert polynomial is not None
    pieces = list(
        _sheet_pieces(reading, density.in_world, unit)
        if shell
        else _solid_pieces(reading, body, density.in_world, unit)
    )
    if not density.in_world and any(
        polar_rotation(part.matrices)[1].any() for part in reading.parts
    ):
        findings.append(finding(SHEARED_DENSITY_AXES))
    findings += _negative_density_note(density, pieces, shell)
    parts = []
    order += polynomial.degree
    for piece in pieces:
        volume, area = polyhedron.polyhedron_moments(
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


def _solid_pieces(
    reading: bodies.Reading, body: bodies.MeshBody, in_world: bool, unit: float
) -> Iterator[_Piece]:
    """Yield the repaired surfaces around the body."""
    is_united = body.method.procedure == Procedure.UNION
    if is_united and reading.instance_count > 1 and not in_world:
        raise ReadError(UNION_LACKS, data="object coordinates")
    for solid, matrices in body.solids:
        if in_world:
            fields = matrices
        elif is_united:  # the union is in the world: its density follows the axes of the one place
            place = bodies.to_si(reading.parts[0].matrices, unit)
            axes = polar_rotation(place)[0].transpose(0, 2, 1)
            fields = affine_matrices(axes, -(axes @ place[:, :3, 3, None])[..., 0]) @ matrices
        else:
            fields = local_coordinates(matrices)
        yield _Piece(solid.repaired_surface, matrices, fields, solid.volume.about)


def _sheet_pieces(reading: bodies.Reading, in_world: bool, unit: float) -> Iterator[_Piece]:
    """Yield the surfaces before repair; unevenly stretched images become surfaces of their own."""
    for part in reading.parts:
        matrices = bodies.to_si(part.matrices, unit)
        fields = local_coordinates(matrices)
        axes = polar_rotation(matrices)[0]
        for surface, image_matrices, places in bodies.group_by_similarity(part.surface, matrices):
            to_local = fields[places]
            # A mapped surface is in the world's units, about its origin: only the turn is left.
            if surface is not part.surface:
                to_local = affine_matrices(axes[places].transpose(0, 2, 1))
            yield _Piece(surface, image_matrices, image_matrices if in_world else to_local)


def _negative_density_note(
    density: DensityField, pieces: list[_Piece], shell: bool
) -> list[Finding]:
    """Return a finding if the density may be negative in the body; raise ReadError if it is
    negative.
    """
    polynomial = density.polynomial
    assert polynomial is not None
    low, high = _box_of_fields(pieces)
    if polynomial.lower_bound(low, high) >= 0.0:
        return []
    is_doubtful = False
    for piece in pieces:
        triangles = piece.surface.all_triangles()[0]
        points = piece.surface.points.astype(np.float64)
        # Places differ if they do so in float32, the precision of Blender's matrices.
        distinct = np.unique(np.float32(piece.fields), axis=0, return_index=True)[1]
        is_doubtful |= len(distinct) > MAX_CHECKED_INSTANCES
        for field in piece.fields[distinct[:MAX_CHECKED_INSTANCES]]:
            worst, is_undecided = find_negative_point(
                polynomial, points @ field[:3, :3].T + field[:3, 3], triangles, not shell
            )
            if worst is not None:
                value, point = worst
                raise ReadError(
                    DENSITY_NEGATIVE,
                    density=float(value),
                    point=[float(x) for x in point],
                    frame=density.frame,
                )
            is_doubtful |= is_undecided
    return [finding(DENSITY_POSSIBLY_NEGATIVE)] if is_doubtful else []


def _box_of_fields(pieces: list[_Piece]) -> tuple[Array, Array]:
    """Return the (3,) least and largest coordinates, in those of the density, of the corners of all
    pieces' boxes.
    """
    unit_corners = np.array(list(product((0.0, 1.0), repeat=3)))
    corners = []
    for piece in pieces:
        low, high = piece.surface.box
        box = low + unit_corners * (high - low)
        corners.append(
            np.einsum("kij,nj->kni", piece.fields[:, :3, :3], box) + piece.fields[:, None, :3, 3]
        )
    joined = np.concatenate(corners)
    return joined.min(axis=(0, 1)), joined.max(axis=(0, 1))


def filled_by_volume(body: bodies.MeshBody, request: Request, order: int) -> bodies.MeshBody:
    """Return the solid with the density of the Volume object that its settings name, or raise
    MeasureError.
    """
    name = request.obj.name
    source = request.obj.body_moments.density_volume
    grid = GridOptions.from_settings(source.body_moments)
    try:
        with tracking_paused(), volume_reading(source, request.depsgraph, grid.grid) as volume:
            if volume is None:
                raise ReadError(NO_SCALAR_GRID, grids="none")
            filled = voxel_filled_body(body, volume, grid, request.settings.unit, name, order)
            origin = finding(bodies.DENSITY_FROM_GRID, grid=volume.grid).of_sources([source.name])
            return replace(filled, density_from=origin)
    except MeasureError as error:
        if error.subject == name:  # the error is about the solid already
            raise
        raise ReadError(
            OBJECT_UNREADABLE, subject=name, object=source.name, cause=error.finding.as_record()
        ) from error


def voxel_filled_body(
    body: bodies.MeshBody,
    reading: VolumeReading,
    options: GridOptions,
    unit: float,
    name: str,
    order: int,
) -> bodies.MeshBody:
    """Return the body of the object `name` with mass moments to an order, from the grid's densities
    inside it.
    """
    names = {"grid": reading.grid, "object": reading.name}
    options.needs_even_samples(reading.grid)
    if body.method.procedure == Procedure.OPEN:
        raise ReadError(OPEN_SURFACE_OF_GRID, subject=name)
    if reading.level_set:
        raise ReadError(GRID_UNSUPPORTED, fault=IS_LEVEL_SET, subject=name, **names)
    # Grid coordinates count voxels from the corner of the first one, not from its center.
    corner = affine_matrices(np.eye(3), reading.low - 0.5)
    to_world = bodies.to_si(reading.matrix[None], unit)[0] @ reading.to_object @ corner
    voxel_volume = abs(np.linalg.det(to_world[:3, :3]))
    if min(reading.shape) < 1 or not voxel_volume > 0.0:
        raise ReadError(bodies.GRID_EMPTY, subject=name, **names)
    to_grid = np.linalg.inv(to_world)
    triangles = np.concatenate(
        [_corners(solid, to_grid @ place) for solid, matrices in body.solids for place in matrices]
    )
    # The box of voxels around the solid, at least one along each axis, in indices of voxels.
    low = np.clip(np.floor(triangles.min(axis=(0, 1))), 0, np.array(reading.shape) - 1).astype(
        np.int64
    )
    high = np.clip(np.ceil(triangles.max(axis=(0, 1))), low + 1, reading.shape).astype(np.int64)
    if np.prod((high - low).astype(float)) > MAX_VOXELS:
        raise ReadError(bodies.GRID_TOO_LARGE, subject=name, **names, samples=(high - low).tolist())
    grid_moments, voxels_inside = inside_moments(
        triangles - low, _box_densities(reading, options, low, high), order
    )
    from_low = to_world @ affine_matrices(np.eye(3), low)
    volume_moments = replace(grid_moments, measure=Measure.VOLUME).transform(from_low)
    mass = replace(volume_moments, measure=Measure.MASS)
    mass = replace(mass, input_error=_input_error(body, mass))
    if not np.abs(mass.raw).max() < bodies.MAX_MASS_MOMENT:
        raise ReadError(bodies.MASS_OVERFLOW)
    if not mass.total > mass.rounding_error[0]:
        raise ReadError(DENSITY_GRID_ELSEWHERE, subject=name, **names)
    meaning = options._replace(spline_order=1).meaning()
    density = finding(bodies.GRID_DENSITY, samples=list(reading.shape), cause=meaning.as_record())
    findings = [
        *body.findings,
        density.of_sources([reading.name]),
        *empty_background_note(options, reading.background),
    ]
    outside = float(1.0 - voxels_inside * voxel_volume / body.volume.total)
    if outside > MAX_OUTSIDE_SHARE:
        findings.append(finding(OUTSIDE_GRID, slight=outside < NEGLIGIBLE, share=outside))
    findings += [
        bodies.attribute_to_source(result, reading.name, name) for result in reading.findings
    ]
    return replace(
        body,
        mass=mass,
        method=Method(body.method.procedure, Source.GRID),
        estimated=True,
        findings=tuple(findings),
    )


def _corners(solid: SolidIntegrals, matrix: NDArray) -> Array:
    """Return (n, 3, 3) triangles of the measured surface, in the grid's coordinates, outward."""
    surface = solid.repaired_surface.transform(matrix[:3, :3], matrix[:3, 3])
    return surface.points[surface.all_triangles()[0]].astype(np.float64, copy=False)


def _box_densities(
    reading: VolumeReading, options: GridOptions, low: NDArray, high: NDArray
) -> Array:
    """Return the densities, kg/m³, of the voxels from index `low` up to, but without, `high`."""
    to_densities = density_function(options, reading.background)
    densities = np.zeros(high - low)
    for block_start, block in reading.blocks():
        block_low = np.array(block_start)
        first = np.maximum(block_low, low)
        end = np.minimum(block_low + block.shape, high)
        if (first < end).all():
            in_block = tuple(map(slice, first - block_low, end - block_low))
            in_box = tuple(map(slice, first - low, end - low))
            densities[in_box] = to_densities(block[in_block].astype(np.float64))
    return densities


def _input_error(body: bodies.MeshBody, mass: Moments) -> Array:
    """Return the input error of the mass moments: the solid's, multiplied by the ratio of largest
    moments or of totals, whichever is larger.
    """
    solid = body.volume if mass.order <= body.volume.order else body.moments(mass.order, False)[0]
    solid = solid.about_point(mass.about).truncate(mass.order)
    scale = np.abs(mass.raw).max() / max(np.abs(solid.raw).max(), np.finfo(float).tiny)
    return solid.input_error * max(scale, mass.total / solid.total)
