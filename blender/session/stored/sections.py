# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Section properties of objects, measured and stored."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from bpy.types import Context, Depsgraph, Object

from ....core.flat.section import measure_section
from ....core.flat.section_properties import Section
from ....core.measurement.settings import fingerprint
from ....core.numerics.float32 import shortest_decimal
from ....core.verdict.finding import Finding
from ...bodies.flat.flat import area_findings, flat_region
from ...read.fingerprint import matrix_hash, settings_hash
from ...write import section as record
from ..tracking import staleness, stamps

MeasuredSection = tuple[Section, str, tuple[Finding, ...]]


def section_of(obj: Object, depsgraph: Depsgraph) -> MeasuredSection:
    """Return an object's section (SI, world axes), a description of the measured part, and the findings."""
    found = flat_region(obj, depsgraph, exact=False)
    section = measure_section(found.plane, found.spatial, found.edges, found.stored, found.shared)
    return section, found.description, (*found.findings, *area_findings(found, section.area))


def store_sections(context: Context, sections: Sequence[tuple[Object, MeasuredSection]]) -> None:
    """Store sections on their objects."""
    unit = shortest_decimal(context.scene.unit_settings.scale_length)
    for obj, (section, description, findings) in sections:
        parts = (section.plane.origin, section.plane.axes.ravel(), section.second, section.centroid)
        numbers = np.concatenate([*parts, [section.area, section.perimeter]])
        mark = fingerprint(numbers.tobytes(), matrix_hash(obj), settings_hash(obj, context.scene))
        record.store(obj, section, description, findings, mark, unit)
    staleness.mark_stamps(context, [(obj, stamp) for obj, _ in sections if (stamp := stamps.of_section(obj))])
