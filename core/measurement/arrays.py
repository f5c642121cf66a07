# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""All results of a solid whose surface is given as arrays, in one call."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ..mesh.surface import Surface
from ..moments.moments import Moments
from ..solid.measure import SolidIntegrals, measure_solid
from ..verdict.method import Method
from .body import Body
from .builder import measure_body
from .measurement import Measurement
from .settings import Settings


@dataclass(frozen=True, eq=False)
class _SurfaceBody(Body):
    """The body that one surface bounds, with moments to any order."""

    any_order: ClassVar[bool] = True

    solid: SolidIntegrals = field(kw_only=True)

    def moments(self, order: int, area: bool) -> tuple[Moments, Moments | None]:
        """Return the moments of the volume, and of the area if wanted, to an order."""
        return self.solid.moments(order, order if area else None)

    def third_order(self) -> Moments:
        """Return the moments of the volume with exact third order."""
        return self.solid.exact_third_order()


def mass_properties(points: ArrayLike, triangles: ArrayLike, *, density: float) -> Measurement:
    """Measure the solid that triangles bound: mass, center, inertia, axes, bounds and findings.

    Holes are capped and flipped faces turned on a copy, and both are reported, as for objects in Blender.

    Parameters
    ----------
    points : (n, 3) array_like
        In meters.
    triangles : (m, 3) array_like of int
        Corners, counterclockwise as seen from outside.
    density : float
        In kg/m³; 1 makes the mass the volume.

    Returns
    -------
    Measurement
        `mass_properties` has mass, center, inertia about the center and principal axes; `method` is the verdict.

    Raises
    ------
    MeasureError
        If the triangles bound no volume, or the density is not positive.

    Examples
    --------
    >>> from body_moments.core import mass_properties
    >>> corners = np.eye(4, 3, -1)
    >>> body = mass_properties(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], density=6000.0)
    >>> str(body.method), round(body.mass_properties.mass, 9), body.mass_properties.center.round(9).tolist()
    ('exact', 1000.0, [0.25, 0.25, 0.25])
    """
    solid = measure_solid(Surface.from_triangles(points, triangles))
    body = _SurfaceBody(
        solid.volume,
        solid.area,
        solid.health,
        Method(solid.method),
        solid.findings,
        face_count=len(solid.repaired_surface.triangles),
        solid=solid,
    )
    place = {"name": "", "type": "MESH", "fingerprint": "", "rotation": np.eye(3), "location": np.zeros(3)}
    return measure_body(body, Settings(density=float(density)), **place)
