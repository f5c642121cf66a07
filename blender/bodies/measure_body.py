# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measurement of one object alone: the first kind of body that can read it is measured.

Each kind is a module with MEASURED_AS, the values of the setting Kind (solid, shell, wire) with
which it is tried, and two functions: `read(request)` returns a reading, or None if the object is of
another kind; `body(reading, request)` returns the body. Both raise MeasureError if nothing can be
measured. `measure_object` measures plain solids together, and all others here.
"""

from __future__ import annotations

import os
from contextlib import ExitStack

import bpy

from ...core.bodies import name_subject
from ..settings.options import AS_SET, MeasureOptions
from . import grid, mesh, nurbs, stack, wire
from .assembly.given import point_measurement, read_point, with_given
from .flat import region
from .request import Request, measurement_of

THREADS = os.cpu_count() or 1  # for long measurements
KINDS = (grid, wire, region, mesh, nurbs)


def measure_body(
    obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph, options: MeasureOptions = AS_SET
) -> stack.Measured:
    """Return the measurement of one evaluated object with its reading and body, or raise
    MeasureError.
    """
    with name_subject(obj.name), ExitStack() as opened:
        request = Request.resolve(obj, depsgraph, options, opened=opened)
        point = read_point(request)
        if point is not None:
            measurement, body = point_measurement(point, request)
            return stack.Measured(measurement, reading=point, body=body)
        kinds = (kind for kind in KINDS if request.settings.kind in kind.MEASURED_AS)
        readings = ((kind, kind.read(request)) for kind in kinds)  # lazy: read until one fits
        # The last kind raises MeasureError in place of returning None.
        kind, reading = next((kind, reading) for kind, reading in readings if reading is not None)
        body = with_given(kind.body(reading, request), reading, request)
        measurement = measurement_of(reading, body, request)
        return stack.Measured(measurement, reading=reading, body=body)
