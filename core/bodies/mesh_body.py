# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies bounded by polygons, and the moments from which principal axes are found."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ..inertia.principal_frames import OwnMoments
from ..measurement.body import Body
from ..mesh.surface import Surface
from ..moments.affine_maps import are_similarities
from ..moments.images import sum_of_images
from ..moments.moments import Moments, monomials, stack_moments, sum_moments
from ..moments.symmetric_tensors import invert_through_point
from ..numerics.rotations import polar_rotation
from ..polyhedron import polyhedron_moments
from ..solid.measure import SolidIntegrals
from ..verdict.method import Verdict
from .instances import area_of_instances

MAX_MASS_MOMENT = 1e100  # kg m^n; squares of much larger moments would overflow


@dataclass(frozen=True, eq=False)
class MeshBody(Body):
    """A body bounded by polygons, or the sheets of these polygons.

    `solids`: the measured surfaces, each with the (k, 4, 4) maps to its places.
    """

    any_order: ClassVar[bool] = True
    has_surface: ClassVar[bool] = True

    solids: tuple[tuple[SolidIntegrals, NDArray[np.float64]], ...] = ()
    threads: int = field(kw_only=True)
    _known: dict[tuple[int, bool], tuple[Moments, Moments | None]] = field(default_factory=dict)

    def moments(self, order: int, area: bool) -> tuple[Moments, Moments | None]:
        """Return the moments of volume and area (None without `area`) to an order, measured once for each part."""
        if (order, area) not in self._known:  # the frame and the shape ask for the same order
            self._known[order, area] = self._to_order(order, area)
        return self._known[order, area]

    def _to_order(self, order: int, area: bool) -> tuple[Moments, Moments | None]:
        volumes, areas = [], []
        alone = 0 if order <= 3 else None  # up to third order the area is found on the way, and makes bounds smaller

        def measured(surface: Surface) -> Moments:
            return polyhedron_moments(
                surface, order, area_order=order, exact=True, threads=self.threads, allow_open=True
            )[1]

        for solid, matrices in self.solids:
            surface = solid.given_surface
            same = (
                solid.method in (Verdict.EXACT, Verdict.REORIENTED)
                and not solid.health.duplicate_faces
                and triangle_count(solid.repaired_surface) == triangle_count(surface)
            )  # otherwise the repaired surface has fewer or more faces
            volume, faces = polyhedron_moments(
                solid.repaired_surface,
                order,
                area_order=order if area and same else alone,
                about=solid.volume.about,  # an open surface's moments depend on it
                exact=True,
                threads=self.threads,
                allow_open=True,
            )
            volumes.append(sum_of_images(volume, matrices))
            if area:
                of_faces = faces if same and faces is not None else measured(surface)
                areas.extend(area_of_instances(surface, of_faces, matrices, measured))
        return sum_moments(volumes), sum_moments(areas) if area else None

    def moments_for_axes(self, order: int, area: bool) -> Moments | OwnMoments:
        """Return the moments from which axes are found, in the surface's own coordinates for one similar image."""
        if len(self.solids) == 1 and len(self.solids[0][1]) == 1:
            solid, matrices = self.solids[0]
            if are_similarities(matrices[:, :3, :3])[0]:
                in_place = replace(self, solids=((solid, np.eye(4)[None]),), _known={})
                volume, areas = in_place.moments(order, area)
                own = with_known(volume, solid.volume) if areas is None else with_known(areas, solid.area)
                return own_moments([own], np.zeros(1, np.intp), matrices[:, :3, :3])
        return super().moments_for_axes(order, area)

    def third_order(self) -> Moments:
        """Return the moments of the volume, the third order exact to rounding."""
        return sum_moments(
            [sum_of_images(solid.exact_third_order(self.threads), matrices) for solid, matrices in self.solids]
        )

    def surfaces(self, sheets: bool) -> Iterator[Surface]:
        """Yield the surfaces in world coordinates, repaired, or with `sheets` as they were before repair."""
        for solid, matrices in self.solids:
            piece = solid.given_surface if sheets else solid.repaired_surface
            yield from (piece.transform(matrix[:3, :3], matrix[:3, 3]) for matrix in matrices)


def with_known(moments: Moments, known: Moments) -> Moments:
    """Return moments with the lower orders and bounds of `known`, if both are about the same point."""
    if not np.array_equal(moments.about, known.about):
        return moments
    names = "raw", "rounding_error", "input_error"
    lower = len(known.raw)
    return replace(
        moments,
        **{name: np.concatenate([getattr(known, name), getattr(moments, name)[lower:]]) for name in names},
    )


def with_input_error(moments: Moments, known: Moments) -> Moments:
    """Return moments with input bounds no larger than those of `known`, if both are about the same point."""
    if not np.array_equal(moments.about, known.about):
        return moments
    error = moments.input_error.copy()
    error[: len(known.raw)] = np.minimum(error[: len(known.raw)], known.input_error)
    return replace(moments, input_error=error)


def extend_input_error(moments: Moments, known: Moments) -> Moments:
    """Return moments with input bounds of every order: the bound of the `known` total times powers of the reach."""
    swept, further = known.input_error[:2].tolist()
    reach = further / swept if swept > 0.0 else 0.0
    return replace(moments, input_error=swept * reach ** monomials(moments.order).sum(axis=1))


def own_moments(shapes: Sequence[Moments], which: NDArray[np.intp], linear: NDArray) -> OwnMoments:
    """Return the moments, in own coordinates, of m images of `shapes` (`which`) under (m, 3, 3) linear maps."""
    is_mirrored, is_even = np.linalg.det(linear) < 0.0, are_similarities(linear)
    rotation = np.eye(3)[None].repeat(len(which), 0)
    rotation[is_even] = polar_rotation(linear[is_even])[0]
    rotation[is_mirrored & is_even] *= -1.0
    moments: list[Moments] = []
    number: dict[tuple[int, ...], int] = {}
    of_bodies = []
    for body, shape in enumerate(which.tolist()):
        key = (shape, int(is_mirrored[body])) if is_even[body] else (shape, 0, body)
        if key not in number:
            number[key] = len(moments)
            own = shapes[shape]
            if not is_even[body]:
                matrix = np.eye(4)
                matrix[:3, :3] = linear[body]
                own = own.transform(matrix)
            moments.append(invert_through_point(own) if is_even[body] and is_mirrored[body] else own)
        of_bodies.append(number[key])
    return OwnMoments(stack_moments(moments), np.array(of_bodies), rotation)


def triangle_count(surface: Surface) -> int:
    """Return the number of triangles, quads counting as two."""
    return len(surface.triangles) + 2 * len(surface.quads)
