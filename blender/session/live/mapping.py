# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Live numbers at the present place and stretch of their object, and their lag behind it."""

from __future__ import annotations

import numpy as np
from bpy.types import Object, Scene
from numpy.typing import NDArray

from ....core import bodies, inertia, measurement, moments, numerics
from ... import read, scale, settings
from .. import memory
from .following import Followed, Lag


def map_properties(
    obj: Object, current: Followed, measured: measurement.Measurement, scene: Scene
) -> inertia.PlainBody:
    """Return the numbers of an object with Live on, in its own frame, mapped to its place and
    stretch if they have changed since. measured: the measurement of `current`.
    """
    numbers = inertia.PlainBody.of_body(
        measured.in_object_frame(),
        measured.density,
        measured.volume,
        measured.area,
        measured.error_bound,
    )
    if current.first_order is None and read.fingerprint.has_transform(obj, current.transform):
        return numbers
    return _mapped(obj, current, measured, numbers, scene)


def is_of_another_scale(obj: Object, current: Followed) -> bool:
    """Return whether the object was scaled since its measurement in a way that the numbers cannot
    follow.
    """
    measured = current.measurement
    if measured is None or read.fingerprint.has_transform(obj, current.transform):
        return False
    return _linear_map(obj, current, measured) is None


def _linear_map(
    obj: Object, current: Followed, measured: measurement.Measurement
) -> NDArray | None:
    """Return the (3, 3) map in the world from the measured object to its current state; None if it
    is no solid or one of its matrices is singular, as only volumes follow any map.
    """
    assert current.matrix is not None
    before = current.matrix[:3, :3]
    now = bodies.float64_matrix(obj.matrix_world)[:3, :3]
    if (
        measured.kind != "solid"
        or not np.isfinite(now).all()
        or moments.are_singular(np.stack([before, now])).any()
    ):
        return None
    return now @ np.linalg.inv(before)


def _mapped(
    obj: Object,
    current: Followed,
    measured: measurement.Measurement,
    numbers: inertia.PlainBody,
    scene: Scene,
) -> inertia.PlainBody:
    """Return the numbers mapped to the current matrix; volume and center are those of the last
    light pass, if any.
    """
    linear = _linear_map(obj, current, measured)
    if linear is None or current.matrix is None:
        return numbers
    now = bodies.float64_matrix(obj.matrix_world)
    unit = scale.meters_per_unit(scene)
    stretch = abs(np.linalg.det(linear))
    center = measured.mass_properties.center / unit
    if current.first_order is None:
        volume = measured.volume * stretch
        center = (
            now[:3, :3] @ np.linalg.solve(current.matrix[:3, :3], center - current.matrix[:3, 3])
            + now[:3, 3]
        )
    else:
        own_volume, own_center = current.first_order
        volume = own_volume * abs(np.linalg.det(now[:3, :3])) * unit**3
        center = now[:3, :3] @ own_center + now[:3, 3]
    if not volume > 0.0:
        return numbers
    mass = measured.mass_properties.mass
    if settings.options.object_settings(obj, scene).mass is None:
        mass *= volume / measured.volume
    turn = numerics.rotation_matrix(obj.matrix_world.to_quaternion())
    image = inertia.affine_image(
        measured.mass_properties, linear, center * unit, mass, turn @ np.transpose(numbers.axes)
    )
    location = now[:3, 3] * unit
    # The area of a similar body; other stretches would need the faces.
    area = numbers.area * stretch ** (2.0 / 3.0)
    return inertia.PlainBody.of_body(
        image.in_frame(turn, location), mass / volume, volume, area, numbers.error_bound
    )


def lag(obj: Object) -> Lag:
    """Return the lag of an object's live numbers behind the displayed object."""
    current = memory.followed.get(obj)
    if current is None or not (current.is_pending or is_of_another_scale(obj, current)):
        return Lag.NONE
    return Lag.BEHIND if current.first_order is None else Lag.FIRST_ORDER
