# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The bill of masses of an assembly: a table with a row for each member, the assembly itself first."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from ...core.inertia.mass_properties import MassProperties
from ...core.inertia.plain_body import TENSOR
from ...core.measurement.documents import table
from ...core.verdict.finding import Finding, Severity
from ...core.verdict.sentences import of_severity, sentence

COLUMNS = (
    *("level", "name", "type", "counted", "method", "mass", "share", "density", "volume", "area"),
    *(f"center_of_mass_{axis}" for axis in "xyz"),
    *(f"inertia_{name}" for name, *_ in TENSOR),
    *("principal_moment_1", "principal_moment_2", "principal_moment_3", "notes", "warnings", "left_out"),
)


@dataclass(frozen=True, eq=False)
class BillRow:
    """A member of an assembly, SI, world axes.

    level: 0 for the assembly itself. type: of the member. properties: None if it has no mass. density, volume, area:
    None if it has none. findings: about the member; left_out: the reason why it is not counted.
    """

    level: int
    name: str
    type: str
    counted: bool
    method: str = ""
    share: float | None = None
    density: float | None = None
    volume: float | None = None
    area: float | None = None
    properties: MassProperties | None = None
    findings: Sequence[Finding] = ()
    left_out: Finding | None = None


def bill_csv(rows: Iterable[BillRow]) -> str:
    """Return the table as CSV, SI units, inertia about each member's own center of mass along the world axes."""
    return "".join(table(COLUMNS, (_cells(row) for row in rows)))


def _cells(row: BillRow) -> dict[str, object]:
    cells: dict[str, object] = {name: getattr(row, name) for name in ("level", "name", "type", "counted", "method")}
    cells |= {
        name: value for name in ("share", "density", "volume", "area") if (value := getattr(row, name)) is not None
    }
    if row.properties is not None:
        cells["mass"] = row.properties.mass
        cells |= {f"center_of_mass_{axis}": float(value) for axis, value in zip("xyz", row.properties.center)}
        cells |= {f"inertia_{name}": float(row.properties.inertia[i, j]) for name, i, j in TENSOR}
        cells |= {
            f"principal_moment_{number}": float(value)
            for number, value in enumerate(row.properties.principal.moments, start=1)
        }
    cells["notes"] = [sentence(found) for found in of_severity(row.findings, Severity.NOTE)]
    cells["warnings"] = [sentence(found) for found in of_severity(row.findings, Severity.WARNING, Severity.ERROR)]
    if row.left_out is not None:
        cells["left_out"] = sentence(row.left_out)
    return cells
