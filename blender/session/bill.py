# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bills of masses: a row for each member of an assembly's tree."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ...core.measurement.builder import find_properties
from ..bodies.assembly.assembly import MemberBody
from ..bodies.findings import ASSEMBLY_MASS_GIVEN
from ..write.bill import BillRow


def bill_rows(part: MemberBody, mass: float, level: int = 0, counted: bool = True) -> Iterator[BillRow]:
    """Yield the rows of a member and of all members below it; mass: of the whole, kg; level: assemblies around it."""
    moments = part.mass
    measurement = part.measurement
    findings = part.findings if measurement is None else measurement.findings
    reason = part.member.left_out or part.refusal
    row = BillRow(
        level=level,
        name=part.member.name,
        type=part.member.kind.value.lower(),
        counted=counted and moments is not None,
        method="" if measurement is None else str(measurement.method),
        findings=findings,
        left_out=reason,
    )
    if moments is not None:
        row = replace(
            row,
            share=moments.total / mass if counted else None,
            density=moments.total / part.volume[0] if part.volume[0] else None,
            volume=part.volume[0],
            area=part.area[0],
            properties=find_properties(moments, np.eye(3)),
        )
    yield row
    given = any(found.code == ASSEMBLY_MASS_GIVEN for found in part.findings)
    for member in part.parts:
        yield from bill_rows(member, mass, level + 1, counted and not given)
