# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The body that a grid of voxels is: a density, or for a level set the solid that it bounds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...core.density.spline_grid import Blocks, grid_moments
from ...core.moments.moments import Measure, Moments
from ...core.verdict.health import Health
from ..read import Part, Reading
from ..read.volume import VolumeReading
from ..settings.grid import GridOptions
from .body import Body
from .mass import LARGEST
from .mesh import mesh_body

EMPTY = (
    "Every voxel of its grid is empty, or its value stands for no mass; choose another grid, or see what should "
    "fill it and what its values stand for."
)


def grid_body(reading: VolumeReading, options: GridOptions, unit: float, threads: int = 1) -> Body:
    """The body of one grid. unit: metres per Blender unit. ValueError, with what to do, where there is none."""
    if options.solid:
        return _solid(reading, unit, threads)
    if reading.level_set:
        raise ValueError(
            "Its grid “{:s}” is a level set, which holds distances and no densities; measure it as the "
            "solid that it bounds, or make a fog volume of it.".format(reading.grid)
        )
    scaled = np.diag([unit, unit, unit, 1.0])
    first = np.eye(4)
    first[:3, 3] = reading.low
    matrix = scaled @ reading.matrix @ reading.to_object @ first
    return density_body(
        reading.blocks,
        reading.shape,
        matrix,
        options,
        reading.background,
        (
            "Its density is the grid “{:s}” of {:d} x {:d} x {:d} voxels. {:s}".format(
                reading.grid, *reading.shape, options.told()
            ),
        ),
    )


def density_body(
    samples: Blocks | NDArray,
    shape: Sequence[int],
    matrix: NDArray,
    options: GridOptions,
    background: float | None = None,
    warnings: tuple[str, ...] = (),
    slope: float = 1.0,
    intercept: float = 0.0,
) -> Body:
    """The body of samples at matrix @ (i, j, k, 1), in metres, that stand for slope · sample + intercept.

    background: a value that counts as empty.
    """
    if min(shape) < 1:
        raise ValueError(EMPTY)
    weigh = options.weigh(background)

    def densities(block: NDArray) -> NDArray[np.float64]:
        return weigh(block if slope == 1.0 and intercept == 0.0 else block * slope + intercept)

    mass = grid_moments(samples, shape, matrix, options.spline_order, value=densities)
    if not np.abs(mass.raw).max() < LARGEST:
        raise ValueError("Its densities make its mass too large a number; take them as smaller ones.")
    if not mass.total > 0.0:
        raise ValueError(EMPTY)

    def held(order: int) -> Moments:
        moments = grid_moments(
            samples, shape, matrix, order=order, value=lambda block: (densities(block) != 0.0).astype(np.float64)
        )
        return replace(moments, of=Measure.VOLUME)

    def to_order(order: int, area: bool) -> tuple[Moments, Moments | None]:
        volume = held(order)
        return volume, Moments(np.zeros_like(volume.raw), volume.about, Measure.AREA) if area else None

    volume = held(3)
    warnings += (
        *options.left_empty(background),
        "It has no surface, and its area is told as 0; its volume is that of the voxels that are not empty.",
    )
    return Body(
        volume,
        Moments(np.zeros(1), volume.about, Measure.AREA),
        Health(closed=True),
        "grid exact",
        warnings,
        mass=mass,
        to_order=to_order,
    )


def _solid(reading: VolumeReading, unit: float, threads: int) -> Body:
    """What a level set bounds, by its polygons."""
    if not reading.level_set:
        raise ValueError(
            "Its grid “{:s}” does not say to be a level set; measure it as a density.".format(reading.grid)
        )
    surface = reading.polygons()
    if not len(surface.triangles) and not len(surface.quads):
        raise ValueError("Its level set “{:s}” bounds nothing.".format(reading.grid))
    shown = Reading(
        reading.name,
        reading.type,
        reading.matrix,
        reading.rotation,
        reading.location,
        [Part(surface, reading.matrix[None])],
    )
    body = mesh_body(shown, unit, shell=False, union=False, threads=threads)
    note = (
        "Measured as the solid that its level set “{:s}” bounds, by {:d} polygons through its voxels; the body "
        "that was sampled may differ by a part of a voxel."
    ).format(reading.grid, len(surface.triangles) + len(surface.quads))
    return replace(body, method="grid " + body.method, warnings=(note, *body.warnings))
