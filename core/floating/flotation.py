# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Positions in which a body rests in a liquid.

A position is the direction u against gravity in the body's frame; the waterline is the plane
u · x = d that cuts off the displaced volume V = m / ρ. Per weight, the potential energy is the
height of the center of gravity G over the center of buoyancy B, e(u) = u · (G - B). When u turns
by a small s across u, the liquid's center moves by J s / V, with J the second moments of the
waterplane about its center F, and d by F · s. So the gradient of e is the part of G - B across u,
the righting arm, and its second derivative J / V - e, the metacentric height. Liquid in a tank is
the same with the opposite sign. Newton's steps within a trust region on the sphere go downhill to a
minimum; each needs one cut of the body or two, because a small error of the volume is corrected by
a slab on the waterplane.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import product

import numpy as np

from ..cuts import measure_below
from ..inertia import frame_about
from ..moments import U
from ..numerics import (
    Array,
    ArrayLike,
    Integers,
    float_array,
    index_array,
    rotation_matrix,
    unit_vector,
)
from ..verdict import Finding, MeasureError, finding
from .findings import (
    FLOAT_UNAVAILABLE,
    HOLLOW_FLOODED,
    LIQUID_ENTERS,
    NO_BODY,
    NO_LIQUID_DENSITY,
    NO_MASS,
    NO_REST,
    SINKS,
)

MAX_STEPS = 200
MAX_ROUNDS = 8  # rounds of filling hollows and settling
FIRST_LEVELS = 17  # levels at which the volume is taken if none is known
# Of the volume: the slab corrects a smaller error to less than rounding.
SLAB_RTOL = 1e-6
FULL_RTOL = 1e-12  # a tank without less has no free surface
AT_REST = 1e-12  # relative to the size: smaller righting arms count as none
ACCEPTED = 1e-9  # relative to the size: larger righting arms at the end are no rest
FLAT = 1e-9  # relative to the size: metacentric heights that may be zero
SHIFT = 1e-6  # Relative to the height: between levels whose surfaces are compared.
SAME_ATTITUDE = 1e-5  # rad: positions closer than this are one
PROBE = 0.03  # rad: the turn by which a lower position beside a flat one is looked for
FIRST_RADIUS = 0.3  # radius of the trust region, rad
# The directions from the middle of a cube to its faces, edges and corners, turned: a start in the
# plane of symmetry between two positions of rest finds one of them only.
STARTS = [start for start in product((0.0, 1.0, -1.0), repeat=3) if any(start)] @ rotation_matrix(
    [0.9, 0.11, 0.27, 0.33]
)


@dataclass(frozen=True, eq=False)
class Waterplane:
    """The surface of a liquid: its `level` along the vertical, the liquid's (3,) `center`, the
    `area`, its (3,) centroid `middle`, and (3, 3) second moments `second` about that.
    """

    level: float
    center: Array
    area: float
    middle: Array
    second: Array


@dataclass(frozen=True, eq=False)
class Vessel:
    """A closed surface that a liquid of a fixed volume fills, or that displaces it.

    Parameters
    ----------
    points : (n, 3) array
    triangles : (m, 3) array of int
        Counter-clockwise from outside; spaces that the liquid floods are turned inside out.
    volume : float
        Of the liquid.
    displacement : (3,) array
        Largest shift of the points by storing.
    """

    points: Array
    triangles: Integers
    volume: float
    displacement: Array = field(default_factory=lambda: np.zeros(3))

    @cached_property
    def whole(self) -> tuple[float, Array]:
        """The volume inside, and its (3,) center."""
        if not len(self.triangles):
            return 0.0, np.zeros(3)
        top = [float(self.points[:, 2].max())]
        part = measure_below(self.points, self.triangles, [[0.0, 0.0, 1.0]], top)
        return float(part.volume[0]), part.part.center[0]

    def surface_at(self, up: Array, guess: float | None = None) -> Waterplane:
        """Return the liquid's surface across a unit vector; `guess`: a level near it, along it.

        A full vessel, and a surface of no area, have no second moments.
        """
        heights = self.points @ up
        low, high = float(heights.min()), float(heights.max())
        if self.volume >= self.whole[0] * (1.0 - FULL_RTOL):
            return Waterplane(high, self.whole[1], 0.0, np.zeros(3), np.zeros((3, 3)))
        reach = max(abs(low), abs(high))
        if guess is None:
            levels = np.linspace(low, high, FIRST_LEVELS)
            volumes = measure_below(
                self.points, self.triangles, np.broadcast_to(up, (FIRST_LEVELS, 3)), levels
            ).volume
            above = min(max(int(np.searchsorted(volumes, self.volume)), 1), FIRST_LEVELS - 1)
            low, high = levels[above - 1], levels[above]
            rise = volumes[above] - volumes[above - 1]
            share = (self.volume - volumes[above - 1]) / rise if rise > 0.0 else 0.5
            guess = float(low + np.clip(share, 0.0, 1.0) * (high - low))
        level = min(max(guess, low), high)
        last_excess = np.inf
        # Newton's steps, or halves of the interval if these leave it or do not halve the excess: so
        # the interval ends within rounding.
        while True:
            part = measure_below(self.points, self.triangles, up[None], [level])
            excess = float(part.volume[0]) - self.volume
            area = float(part.face_area[0])
            low, high = (low, level) if excess > 0.0 else (level, high)
            is_close = abs(excess) <= SLAB_RTOL * self.volume and area > 0.0
            if is_close or high - low <= 4.0 * U * reach:
                break
            next_level = level - excess / area if area > 0.0 else high
            is_slow = abs(excess) > last_excess / 2.0 or not low < next_level < high
            last_excess = abs(excess)
            level = (low + high) / 2.0 if is_slow else next_level
        if not area > 0.0:
            return Waterplane(
                level, part.first[0] / self.volume, 0.0, np.zeros(3), np.zeros((3, 3))
            )
        # The slab of the remaining excess, as high as the excess over the area, is taken away: its
        # volume times its middle, which is half of its height below the surface.
        middle = part.face_first[0] / area
        slab = -excess * (middle - excess / (2.0 * area) * up)
        second = part.face.about_point(middle[None]).second()[0]
        return Waterplane(
            level - excess / area, (part.first[0] + slab) / self.volume, area, middle, second
        )

    def errors_at(self, up: Array, plane: Waterplane) -> Array:
        """Return (3, 2) bounds by rounding and by storing: of the level, of the center's height,
        and of the surface's second moments.
        """
        # The level itself, and one on each side for the growth of the surface's moments.
        step = SHIFT * float(np.ptp(self.points @ up))
        levels = plane.level + step * np.arange(-1.0, 2.0)
        ups = np.broadcast_to(up, (3, 3))
        below = measure_below(self.points, self.triangles, ups, levels, self.displacement)
        part = below.part.at(1)
        errors = np.stack([part.rounding_error, part.input_error], axis=1)
        # The error of the volume changes the quotient of the center's height, and the level, by the
        # slab between both.
        height = float(up @ (part.center - part.about))
        reach = 2.0 * abs(height) + abs(plane.level - float(up @ part.about))
        of_level = of_second = np.zeros(2)
        of_center = (np.abs(up) @ errors[1:4] + reach * errors[0]) / self.volume
        if plane.area > 0.0:
            faces = below.face.about_point(np.broadcast_to(plane.middle, (3, 3)))
            face = faces.at(1)
            of_level = errors[0] / plane.area
            growth = float(np.abs(np.diff(faces.second(), axis=0)).sum(axis=(1, 2)).max()) / step
            # Mixed moments are twice in the matrix.
            of_second = (
                2.0 * np.array([face.rounding_error[4:].sum(), face.input_error[4:].sum()])
                + growth * of_level
            )
        return np.stack([of_level, of_center, of_second])


@dataclass(frozen=True, eq=False)
class Tank:
    """Liquid in a closed tank that is fixed to the body, and its density."""

    liquid: Vessel
    density: float

    @property
    def mass(self) -> float:
        """The mass of the liquid."""
        return self.density * self.liquid.volume


@dataclass(frozen=True, eq=False)
class FloatingBody:
    """A body in a liquid.

    Parameters
    ----------
    points : (n, 3) array_like
    triangles : (m, 3) array_like of int
        The closed surface that keeps the liquid out, counter-clockwise from outside.
    mass : float
        Without the liquid in tanks.
    center : (3,) array_like
        Center of mass.
    density : float
        Of the liquid.
    openings : (k, 3) array_like
        Points at which liquid runs in if they are below the waterline.
    tanks : tuple of Tank
    fitted : callable, optional
        Returns the body for a direction against gravity, with the hollows filled that are open
        upward, or with its hollows full of the liquid for None; the same one for the same hull.
    displacement : (3,) array
        Largest shift of the points by storing.
    center_error : (2,) array
        Bounds of the center of mass by rounding and by storing.

    Raises
    ------
    MeasureError
        If it sinks, or a number makes no sense.

    Examples
    --------
    >>> from body_moments.core.floating import FloatingBody
    >>> log = FloatingBody(
    ...     np.array([[x, y, z] for x in (-3.0, 3.0) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]),
    ...     [
    ...         [0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
    ...         [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3],
    ...     ],
    ...     mass=3000.0,
    ...     center=[0.0, 0.0, 0.0],
    ...     density=1000.0,
    ... )
    >>> rest = log.settle([0.0, 0.0, 1.0])
    >>> (rest.up.round(6) + 0.0).tolist(), round(rest.draught, 6)
    ([0.0, 0.707107, 0.707107], 0.707107)
    """

    points: Array
    triangles: Integers
    mass: float
    center: Array
    density: float
    openings: Array = field(default_factory=lambda: np.empty((0, 3)))
    tanks: tuple[Tank, ...] = ()
    fitted: Callable[[Array | None], FloatingBody] | None = None
    displacement: Array = field(default_factory=lambda: np.zeros(3))
    center_error: Array = field(default_factory=lambda: np.zeros(2))

    def __post_init__(self) -> None:
        set_field = object.__setattr__
        set_field(self, "points", float_array("points", self.points, "n", 3, finite=True))
        triangles = index_array("triangles", self.triangles, "m", 3, count=len(self.points))
        set_field(self, "triangles", triangles)
        set_field(self, "center", float_array("center", self.center, 3, finite=True))
        set_field(self, "openings", float_array("openings", self.openings, "k", 3))
        if not self.density > 0.0:
            raise MeasureError(FLOAT_UNAVAILABLE, fault=NO_LIQUID_DENSITY)
        if not self.total_mass > 0.0:
            raise MeasureError(FLOAT_UNAVAILABLE, fault=NO_MASS)
        if not self.capacity > 0.0:
            raise MeasureError(FLOAT_UNAVAILABLE, fault=NO_BODY)
        excess = self.total_mass - self.density * self.capacity
        if excess >= -4.0 * U * self.total_mass:
            raise MeasureError(SINKS, excess=max(excess, 0.0), mass=self.total_mass)

    @cached_property
    def total_mass(self) -> float:
        """The mass with the liquid in tanks."""
        return self.mass + sum(tank.mass for tank in self.tanks)

    @cached_property
    def capacity(self) -> float:
        """The volume that it displaces under water."""
        return self.hull.whole[0]

    @cached_property
    def size(self) -> float:
        """The diagonal of the box around it."""
        return float(np.linalg.norm(np.ptp(self.points, axis=0)))

    @cached_property
    def hull(self) -> Vessel:
        """The displaced liquid, in coordinates from the center of mass."""
        volume = self.total_mass / self.density
        return Vessel(self.points - self.center, self.triangles, volume, self.displacement)

    @cached_property
    def liquids(self) -> list[tuple[Vessel, float]]:
        """The liquids in tanks, in coordinates from the center of mass, and their shares of the
        mass.
        """
        return [
            (
                replace(tank.liquid, points=tank.liquid.points - self.center),
                tank.mass / self.total_mass,
            )
            for tank in self.tanks
            if tank.mass > 0.0
        ]

    def at(self, up: ArrayLike, near: Flotation | None = None) -> Flotation:
        """Return the body held at a direction against gravity; `near`: a position not far away."""
        up = unit_vector("up", up)
        vessels = [self.hull, *(vessel for vessel, _ in self.liquids)]
        guesses: list[float | None] = [None] * len(vessels)
        if near is not None:
            # To first order, a surface turns about its middle.
            guesses = [
                plane.level + float((up - near.up) @ plane.middle)
                for plane in (near.plane, *near.tank_planes)
            ]
        planes = [vessel.surface_at(up, guess) for vessel, guess in zip(vessels, guesses)]
        return Flotation(self, up, planes[0], tuple(planes[1:]))

    def settle(self, up: ArrayLike, known: Sequence[Flotation] = ()) -> Flotation:
        """Return the position in which it comes to rest, downhill from a direction against gravity,
        or one of the known ones.

        Its hollows keep the liquid out if they do so in the position of rest.

        Raises
        ------
        MeasureError
            If none is found, or liquid runs in.
        """
        up = unit_vector("up", up)
        fitted = self.fitted or (lambda _: self)
        body = fitted(up)
        try:
            wet = fitted(None)
        except MeasureError:  # it sinks
            wet = None
        # Liquid that runs in floods all hollows (`wet`). In the position of rest with these, some
        # hollows may keep the liquid out again (`fresh`); if it runs in there, too, the flooded
        # position stays. `depth`: of the opening through which liquid ran in first.
        flooded = depth = None
        for _ in range(MAX_ROUNDS):
            rest = body._descend(body.at(up), [other for other in known if other.body is body])
            if any(rest is other for other in known):
                return rest
            start, up = up, rest.up
            if rest.depth_of_openings > 0.0:
                depth = depth or rest.depth_of_openings
                if flooded is not None:
                    return flooded.with_flooded_hollow(depth)
                if wet is None or body is wet:
                    raise MeasureError(LIQUID_ENTERS, depth=depth)
                body = wet
                continue
            is_turned = float(np.linalg.norm(up - start)) >= SAME_ATTITUDE
            fresh = fitted(up) if is_turned or (body is wet and depth is not None) else body
            if fresh is not body:
                flooded, body = rest if body is wet else None, fresh
            elif body is wet:
                return rest.with_flooded_hollow(depth)
            else:
                return rest
        raise MeasureError(FLOAT_UNAVAILABLE, fault=NO_REST)

    def find_rests(self, known: Sequence[Flotation] = ()) -> list[Flotation]:
        """Return the known positions of rest and those found from 26 starts, the lowest energy
        first, without those in which liquid runs in.

        Raises
        ------
        MeasureError
            If there is none.
        """
        rests = [*known]
        for start in STARTS:
            try:
                rest = self.settle(start, rests)
            except MeasureError:
                continue
            if not any(rest.is_near(other, SAME_ATTITUDE) for other in rests):
                rests.append(rest)
        if not rests:
            raise MeasureError(FLOAT_UNAVAILABLE, fault=NO_REST)
        return sorted(rests, key=lambda rest: rest.energy)

    def _descend(self, state: Flotation, known: Sequence[Flotation] = ()) -> Flotation:
        """Return the minimum of the energy downhill from a state, or a known stable minimum as soon
        as the way comes near it.
        """
        radius = FIRST_RADIUS
        for _ in range(MAX_STEPS):
            arm = float(np.linalg.norm(state.slope))
            values, vectors = np.linalg.eigh(state.curvature)
            if arm <= AT_REST * self.size and values[0] >= -FLAT * self.size:
                lower = self._lower_beside(state, values, vectors)
                if lower is None:
                    break
                state = lower
                continue
            for rest in known:
                if rest.metacentric_heights[0] > 0.0 and state.is_near(rest, 1e-3):
                    return rest
            step = _trust_step(state.slope, values, vectors, radius)
            angle = float(np.linalg.norm(step))
            predicted = float(state.slope @ step + step @ state.curvature @ step / 2.0)
            turned = np.cos(angle) * state.up + np.sin(angle) / angle * (state.axes @ step)
            trial = self.at(turned, state)
            # Of a change that small, rounding leaves too few digits: then the righting arm decides.
            gain = trial.energy - state.energy
            is_fine = abs(predicted) <= 1e-9 * self.size
            closer = float(np.linalg.norm(trial.slope)) < arm
            if (gain <= 0.1 * predicted and not is_fine) or (is_fine and closer):
                if gain <= 0.7 * predicted or is_fine:
                    radius = min(max(radius, 2.0 * angle), 1.0)
                state = trial
                continue
            radius = angle / 4.0
            if radius < U or (is_fine and arm <= ACCEPTED * self.size and values[0] >= 0.0):
                break
        if float(np.linalg.norm(state.slope)) > ACCEPTED * self.size:
            raise MeasureError(FLOAT_UNAVAILABLE, fault=NO_REST)
        return state

    def _lower_beside(self, state: Flotation, values: Array, vectors: Array) -> Flotation | None:
        """Return a position of less energy beside one where the second derivative is zero, or None.

        values, vectors: ascending eigenvalues and eigenvectors of the second derivative.
        """
        if values[0] > FLAT * self.size:
            return None
        for angle in (PROBE, -PROBE):
            toward = state.axes @ vectors[:, 0]
            trial = self.at(np.cos(angle) * state.up + np.sin(angle) * toward, state)
            if trial.energy < state.energy - AT_REST * self.size:
                return trial
        return None


def _trust_step(slope: Array, values: Array, vectors: Array, radius: float) -> Array:
    """Return the (2,) step that lowers a quadratic function most within a radius.

    slope: (2,) its first derivative. values, vectors: ascending eigenvalues and eigenvectors of its
    second derivative.
    """
    along = slope @ vectors
    largest = float(np.abs(values).max())
    if values[0] > 1e-12 * largest:
        step = -along / values
        if float(np.linalg.norm(step)) <= radius:
            return vectors @ step
    # The step is -along / (values + shift), shorter the larger the shift. If the slope has no part
    # along the first axis, the step may stay short for all shifts allowed: it is then lengthened
    # along that axis.
    low = max(0.0, -float(values[0]))
    high = low + float(np.linalg.norm(slope)) / radius + U * largest
    for _ in range(60):
        shift = (low + high) / 2.0
        is_short = bool((np.abs(along) <= radius * (values + shift)).all()) and (
            float(np.linalg.norm(along / np.maximum(values + shift, U * U * largest))) <= radius
        )
        low, high = (low, shift) if is_short else (shift, high)
    shifted = values + high
    step = np.where(shifted > 0.0, -along / np.where(shifted > 0.0, shifted, 1.0), 0.0)
    size = float(np.linalg.norm(step))
    if size > radius:
        step = step * (radius / size)
    elif values[0] < 0.0:
        missing = np.sqrt(max(radius * radius - size * size, 0.0))
        step[0] += missing if step[0] >= 0.0 else -missing
    return vectors @ step


@dataclass(frozen=True, eq=False)
class Flotation:
    """A floating body at one direction against gravity, (3,) `up`, the surfaces of the liquids in
    coordinates from its center of mass, and findings about the liquid.
    """

    body: FloatingBody
    up: Array
    plane: Waterplane
    tank_planes: tuple[Waterplane, ...] = ()
    findings: tuple[Finding, ...] = ()

    @cached_property
    def axes(self) -> Array:
        """(3, 2) unit vectors along the water."""
        return np.array(frame_about(self.up.tolist())).T[:, :2]

    @cached_property
    def arm(self) -> Array:
        """The (3,) vector from the center of buoyancy to the center of gravity, liquids in tanks
        included.
        """
        arm = -self.plane.center
        for (_, share), plane in zip(self.body.liquids, self.tank_planes):
            arm = arm + share * plane.center
        return arm

    @property
    def energy(self) -> float:
        """Potential energy per weight, m."""
        return float(self.up @ self.arm)

    @cached_property
    def slope(self) -> Array:
        """(2,) derivatives of `energy` by turns toward the `axes`: the righting arms."""
        return self.axes.T @ self.arm

    @cached_property
    def stiffness(self) -> Array:
        """(3, 3) second derivatives of `energy` but for the part of the height: second moments of
        the waterplane less the tanks' free surfaces, over the displaced volume.
        """
        second = self.plane.second
        filled = [tank for tank in self.body.tanks if tank.mass > 0.0]
        for tank, plane in zip(filled, self.tank_planes):
            second = second - tank.density / self.body.density * plane.second
        return second / self.displacement

    @cached_property
    def curvature(self) -> Array:
        """(2, 2) second derivatives of `energy` along the `axes`."""
        return self.axes.T @ self.stiffness @ self.axes - self.energy * np.eye(2)

    @cached_property
    def metacentric_heights(self) -> Array:
        """(2,) GM about the water's axis of least stiffness and the one across, ascending."""
        return np.asarray(np.linalg.eigvalsh(self.curvature), np.float64)

    @property
    def heel_axis(self) -> Array:
        """The (3,) unit vector along the water about which it turns most easily."""
        toward = self.axes @ np.linalg.eigh(self.curvature)[1][:, 0]
        return np.cross(toward, self.up)

    @cached_property
    def metacentric_radii(self) -> Array:
        """(2,) BM: principal second moments of the waterplane over the volume, ascending."""
        return self.waterplane_moments / self.displacement

    @cached_property
    def waterplane_moments(self) -> Array:
        """(2,) principal second moments of the waterplane, ascending, m^4."""
        across = self.axes.T @ self.plane.second @ self.axes
        return np.asarray(np.linalg.eigvalsh(across), np.float64)

    @property
    def displacement(self) -> float:
        """Displaced volume."""
        return self.body.hull.volume

    @property
    def level(self) -> float:
        """Height of the waterline over the origin, along `up`."""
        return self.plane.level + float(self.up @ self.body.center)

    @cached_property
    def keel(self) -> float:
        """Height of the lowest point, along `up`."""
        return float((self.body.points @ self.up).min())

    @property
    def draught(self) -> float:
        """Depth of the lowest point."""
        return self.level - self.keel

    @property
    def center_of_buoyancy(self) -> Array:
        """The (3,) center of the displaced liquid."""
        return self.plane.center + self.body.center

    @property
    def center_of_flotation(self) -> Array:
        """The (3,) centroid of the waterplane."""
        return self.plane.middle + self.body.center

    @property
    def center_of_gravity(self) -> Array:
        """The (3,) center of mass with the liquids in tanks."""
        return self.center_of_buoyancy + self.arm

    @property
    def residual(self) -> float:
        """The righting arm over the size; 0 at rest."""
        return float(np.linalg.norm(self.slope)) / self.body.size

    @cached_property
    def error_bounds(self) -> dict[str, Array]:
        """(2,) bounds of draught, KB, KG and GM in this attitude: by rounding and by storing."""
        level, buoyancy, second = self.body.hull.errors_at(self.up, self.plane)
        gravity = self.body.center_error
        for (tank, share), plane in zip(self.body.liquids, self.tank_planes):
            _, height, own_second = tank.errors_at(self.up, plane)
            gravity = gravity + share * height
            # The factor is the ratio of both liquids' densities, as in `stiffness`.
            second = second + own_second * share * self.displacement / tank.volume
        reach = float(np.abs(self.body.points).max())
        keel = np.array([8.0 * U * reach, float(np.linalg.norm(self.body.displacement))])
        height = second / self.displacement
        height[0] += 8.0 * U * self.metacentric_radii[1]
        return {
            "draught": level + keel,
            "kb": buoyancy + keel,
            "kg": gravity + keel,
            "gm": height + buoyancy + gravity,
        }

    @property
    def depth_of_openings(self) -> float:
        """How far the deepest opening is below the waterline; negative above, -inf without any."""
        return self.level - float((self.body.openings @ self.up).min(initial=np.inf))

    def with_flooded_hollow(self, depth: float | None) -> Flotation:
        """Return the position with a finding if the liquid has run in by a depth, or, with None,
        fills a hollow that is open downward and would carry the body alone.
        """
        if depth is None and self.body.fitted is not None:
            with suppress(MeasureError):
                lidded = self.body.fitted(
                    -self.up
                )  # with the hollows filled that are open downward
                if lidded.capacity - self.body.capacity > self.displacement:
                    depth = replace(self, body=lidded).depth_of_openings
        if depth is None:
            return self
        return replace(self, findings=(finding(HOLLOW_FLOODED, depth=depth),))

    def is_near(self, other: Flotation, angle: float) -> bool:
        """Return whether the two positions differ by less than an angle."""
        return float(np.linalg.norm(self.up - other.up)) < angle

    def matrix(self, up: ArrayLike = (0.0, 0.0, 1.0), level: float = 0.0) -> Array:
        """Return the (4, 4) map that turns it by the smallest angle about its center of mass and
        lifts it to a level of the liquid along a unit vector.
        """
        up = unit_vector("up", up)
        turn = turn_between(self.up, up)
        center = self.body.center
        height = float(self.up @ center) - self.level + level
        matrix = np.eye(4)
        matrix[:3, :3] = turn
        matrix[:3, 3] = center - turn @ center + (height - float(up @ center)) * up
        return matrix


def turn_between(start: Array, stop: Array) -> Array:
    """Return the smallest (3, 3) rotation from one unit vector to another."""
    across = np.cross(start, stop)
    cosine = float(start @ stop)
    if cosine < -1.0 + 1e-12:  # half a turn about any axis across
        first = np.array(frame_about(start.tolist()))[0]
        return 2.0 * np.outer(first, first) - np.eye(3)
    # Rodrigues' formula; (1 - cosine) / |across|² is 1 / (1 + cosine).
    skew = np.cross(np.eye(3), across)
    return np.eye(3) + skew + skew @ skew / (1.0 + cosine)
