# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Section properties of a plane region, as structural engineers know them.

I_x = ∫ y² dA, I_y = ∫ x² dA and I_xy = +∫ xy dA (no minus: a tensor's entry would have one), about
the centroid and along the plane's own axes x, y. Principal second moments I_1 ≥ I_2; axis 1 is at
the angle θ in (-90°, 90°] from x towards y, tan 2θ = -2 I_xy / (I_x - I_y). J_p = I_x + I_y is the
polar second moment of area; it is the torsion constant of round sections only. Radii of gyration
are √(I/A), elastic section moduli I / (distance of the outermost corner), exact as no other point
is farther out.

Measured sections hold arrays, sections of a saved file tuples: panels draw them without numpy.
"""

from dataclasses import dataclass
from math import atan2, hypot, pi, sqrt

from ..numerics import Vector

EQUAL_MOMENTS_RTOL = 1e-6  # principal moments closer than this, relatively, are equal
MAX_NOISE_SHARE = 1e-3  # Relative to the larger principal moment: noise is limited to this.


@dataclass(frozen=True, eq=False)
class Plane:
    """The plane of a section.

    `origin`: (3,) a point of the plane. `axes`: (3, 3) columns x, y and the normal, right-handed.
    `out_of_plane`: the largest distance of the points from it. `x_axis_name`: the preferred axis
    that x is nearest to, "X" or "Y".
    """

    origin: Vector
    axes: Vector
    out_of_plane: float
    x_axis_name: str


@dataclass(frozen=True, eq=False)
class Section:
    """Section properties of one region, in one unit of length.

    Attributes
    ----------
    plane : Plane
    area, perimeter : float
    centroid : (2,) array or tuple
        In the plane's axes from its origin.
    second : (3,) array or tuple
        I_x, I_y, I_xy about the centroid.
    reach : (4,) array or tuple
        The distance of the outermost corner from the axes x, y, 1, 2 through the centroid.
    outlines, holes : int
    rounding_error, input_error : dict of str to float
        Bounds of "area", "perimeter", "centroid" and "second": of rounding, and of storing
        coordinates as float32; for the centroid the length of its shift, for the second moments
        each of them.

    Examples
    --------
    >>> from body_moments.core.flat import directed_edges, measure_section
    >>> from body_moments.core.flat.section_properties import Plane
    >>> points = np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
    >>> plane = Plane(np.zeros(3), np.eye(3), 0.0, "X")
    >>> section = measure_section(plane, points, directed_edges([range(4)]))
    >>> [round(6 * modulus, 9) for modulus in section.moduli], round(section.polar * 6, 9)
    ([2.0, 4.0, 4.0, 2.0], 5.0)
    """

    plane: Plane
    area: float
    perimeter: float
    centroid: Vector
    second: Vector
    reach: Vector
    outlines: int
    holes: int
    rounding_error: dict[str, float]
    input_error: dict[str, float]

    @property
    def center(self) -> tuple[float, ...]:
        """The (3,) centroid in space, in the same coordinates as the plane's origin."""
        u, v = self.centroid
        center = []
        # A row of the axes has one coordinate of the plane's x, y and normal.
        for start, (x, y, _) in zip(self.plane.origin, self.plane.axes):
            center.append(float(start + u * x + v * y))
        return tuple(center)

    @property
    def principal(self) -> tuple[float, float]:
        """Principal second moments I_1 ≥ I_2."""
        about_x, about_y, product = map(float, self.second)
        larger = (about_x + about_y) / 2.0 + hypot((about_x - about_y) / 2.0, product)
        # The determinant over the larger one avoids a difference of near equals.
        return larger, max(0.0, (about_x * about_y - product * product) / larger)

    @property
    def axes_undetermined(self) -> bool:
        """True if every axis through the centroid is a principal one."""
        larger, smaller = self.principal
        return larger - smaller <= EQUAL_MOMENTS_RTOL * larger + 2.0 * self._noise

    @property
    def angle(self) -> float:
        """Angle from x towards y to principal axis 1, in radians, above -π/2 to π/2; 0 if every
        axis is principal.
        """
        about_x, about_y, product = map(float, self.second)
        if self.axes_undetermined:
            return 0.0
        # Noise may make -π/2 of π/2: a product within noise counts as 0, and the axis as x or y.
        if abs(product) <= self._noise:
            return 0.0 if about_x >= about_y else pi / 2.0
        return 0.5 * atan2(-2.0 * product, about_x - about_y)

    @property
    def _noise(self) -> float:
        """The effect of rounding on the axes, limited so that moments with wide bounds still give
        axes.
        """
        return min(
            self.rounding_error["second"] + self.input_error["second"],
            MAX_NOISE_SHARE * self.principal[0],
        )

    @property
    def polar(self) -> float:
        """Polar second moment J_p = I_x + I_y."""
        return float(self.second[0] + self.second[1])

    @property
    def radii(self) -> tuple[float, ...]:
        """The radii of gyration about x, y, 1, 2."""
        return tuple(sqrt(moment / self.area) for moment in self._about_axes)

    @property
    def moduli(self) -> tuple[float, ...]:
        """The elastic section moduli about x, y, 1, 2: the smaller one of both sides of each
        axis.
        """
        return tuple(moment / float(reach) for moment, reach in zip(self._about_axes, self.reach))

    @property
    def _about_axes(self) -> tuple[float, ...]:
        """Second moments about x, y, 1, 2."""
        about_x, about_y, _ = map(float, self.second)
        return about_x, about_y, *self.principal
