# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Entries of a document about objects: failures, and findings that several records share."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

from ...core.measurement import Measurement
from ...core.verdict.finding import Finding, MeasureError, finding, unique


@dataclass
class Contents:
    """Measured entries of a file's document.

    internal: returns the entry about an unexpected error. measured: names, objects in Blender and
    measurements, in the order of `objects`. caveats: about the total.
    """

    internal: Callable[[str | None, Exception], dict[str, Any]]
    objects: list[dict[str, Any]] = field(default_factory=list)
    measured: list[tuple[str, Any, Measurement]] = field(default_factory=list)
    flats: list[dict[str, Any]] = field(default_factory=list)
    errors: list[dict[str, Any]] = field(default_factory=list)
    left_out: list[dict[str, Any]] = field(default_factory=list)
    caveats: list[Finding] = field(default_factory=list)

    @contextmanager
    def attempt(self, name: str) -> Iterator[None]:
        """Turn an error in the block into an entry about the object of this name."""
        try:
            yield
        except MeasureError as refusal:
            self.errors.append(failure(name, refusal.finding))
        except Exception as error:
            self.errors.append(self.internal(name, error))


def failure(name: str | None, reason: Finding) -> dict[str, Any]:
    """Return an entry of a document's `errors` or `left_out`: an object's name and the reason."""
    return {"name": name, "reason": str(reason)}


def said_once(entries: Sequence[dict[str, Any]], code: str) -> Iterator[Finding]:
    """Yield the finding with a code, to be said once of a file, if several records all have it; it
    leaves them.
    """
    found = [(entry, one) for entry in entries for one in entry["findings"] if one["code"] == code]
    if len(found) < len(entries) or len(entries) < 2:
        return
    for entry, one in found:
        entry["findings"].remove(one)
        entry["warnings"].remove(one["message"])
    yield from unique(finding(code, **one["values"]) for _, one in found)
