# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Equal findings of many objects as one."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from .finding import Finding, Severity
from .sentences import severity

JOINED = (("count", sum), ("share", max))  # values of several findings in one


@dataclass(frozen=True, eq=False)
class Group:
    """Findings with one code, of one or several objects.

    finding: the first one, with the sum of all counts and the largest share. objects: full names.
    """

    finding: Finding
    objects: tuple[str, ...] = ()


def grouped(findings: Iterable[tuple[str, Finding]]) -> list[Group]:
    """Return groups of the findings of objects, given with their full names; the most severe first."""
    together: dict[tuple[Severity, str], list[tuple[str, Finding]]] = {}
    for name, found in findings:
        together.setdefault((severity(found), found.code), []).append((name, found))
    groups = []
    for members in together.values():
        values = dict(members[0][1].values)
        for key, join in JOINED if len(members) > 1 else ():
            numbers = [found.values[key] for _, found in members if found.values.get(key) is not None]
            values |= {key: join(numbers)} if numbers else {}
        names = dict.fromkeys(name for name, _ in members)
        groups.append(Group(replace(members[0][1], values=values), tuple(filter(None, names))))
    return sorted(groups, key=lambda group: -tuple(Severity).index(severity(group.finding)))
