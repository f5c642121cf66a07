# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The bill of masses of an assembly: a table with a row for each member, the assembly itself first."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...core.inertia.plain_body import TENSOR
from ...core.measurement.builder import find_properties
from ...core.measurement.documents import table
from ...core.verdict.finding import Severity
from ...core.verdict.sentences import of_severity, sentence
from ..bodies.assembly.assembly import MemberBody
from ..bodies.findings import ASSEMBLY_MASS_GIVEN

COLUMNS = (
    *("level", "name", "type", "counted", "method", "mass", "share", "density", "volume", "area"),
    *(f"center_of_mass_{axis}" for axis in "xyz"),
    *(f"inertia_{name}" for name, *_ in TENSOR),
    *("principal_moment_1", "principal_moment_2", "principal_moment_3", "notes", "warnings", "left_out"),
)


def bill_csv(root: MemberBody, mass: float) -> list[str]:
    """Return the lines of the bill of an assembly with this mass, kg, as CSV: the header, then its rows.

    SI units; the inertia of a member is about its own center of mass, along the world axes.
    """
    return list(table(COLUMNS, _rows(root, mass)))


def _rows(part: MemberBody, mass: float, level: int = 0, counted: bool = True) -> Iterator[dict[str, object]]:
    """Yield the rows of a member and of all members below it; level: number of assemblies around it."""
    moments, measurement = part.mass, part.measurement
    findings = part.findings if measurement is None else measurement.findings
    row: dict[str, object] = {
        "level": level,
        "name": part.member.name,
        "type": part.member.kind.value.lower(),
        "counted": counted and moments is not None,
        "method": "" if measurement is None else str(measurement.method),
        "notes": [sentence(found) for found in of_severity(findings, Severity.NOTE)],
        "warnings": [sentence(found) for found in of_severity(findings, Severity.WARNING, Severity.ERROR)],
    }
    reason = part.member.left_out or part.refusal
    if reason is not None:
        row["left_out"] = sentence(reason)
    if moments is not None:
        properties, volume = find_properties(moments, np.eye(3)), part.volume[0]
        row |= {"mass": properties.mass, "volume": volume, "area": part.area[0]}
        row |= {"share": moments.total / mass} if counted else {}
        row |= {"density": moments.total / volume} if volume else {}
        row |= {f"center_of_mass_{axis}": float(value) for axis, value in zip("xyz", properties.center)}
        row |= {f"inertia_{name}": float(properties.inertia[i, j]) for name, i, j in TENSOR}
        row |= {f"principal_moment_{k}": float(value) for k, value in enumerate(properties.principal.moments, start=1)}
    yield row
    given = any(found.code == ASSEMBLY_MASS_GIVEN for found in part.findings)
    for member in part.parts:
        yield from _rows(member, mass, level + 1, counted and not given)
