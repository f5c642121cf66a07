# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Options of the Fourier transform: its wave vectors, its object and its output."""

from __future__ import annotations

from argparse import Namespace

import bpy

from ...blender.bodies.flat.flat_fourier import FlatTransform, flat_transform
from ...blender.bodies.fourier import ObjectTransform, object_transform
from ...blender.settings.options import MeasureOptions
from ...blender.write import spectrum
from ...core.verdict.finding import Finding
from ..files.own_results import guard


def write(obj: bpy.types.Object, options: Namespace, measure_options: MeasureOptions) -> tuple[Finding, ...]:
    """Write an object's Fourier transform to a file, and return findings. Raises MeasureError and OSError."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    under_way: ObjectTransform | FlatTransform
    if options.flat:
        unit = measure_options.unit_scale
        under_way = flat_transform(obj, depsgraph, options.waves, frame=options.frame, unit=unit)
    else:
        under_way = object_transform(obj, depsgraph, measure_options, options.waves, frame=options.frame)
    for _ in under_way.steps():
        pass
    transform, findings = under_way.result()
    spectrum.save(options.fourier, transform, options.frame, guard(options.force), under_way.arrays)
    return findings
