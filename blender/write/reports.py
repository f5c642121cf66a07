# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Texts of operators: reports, reasons for disabled buttons, the status bar.

A text of the interface is an English template at the place where it is shown; `phrase` translates
and fills it. Findings are shown by their sentences. Both are in the language of the interface, with
lengths in the scene's units.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import bpy
from bpy.types import Operator

from ...core.verdict import (
    Finding,
    MeasureError,
    Severity,
    fill,
    finding,
    internal_error,
    sentence,
    severity,
    truncate_findings,
)
from .findings import FAILURE
from .units import Units

MAX_REPORTED = 3  # findings that a report names; it counts the others
LEVELS = {Severity.NOTE: "INFO", Severity.WARNING: "WARNING", Severity.ERROR: "ERROR"}


class Refused(Exception):
    """The reason why an operator does nothing: an English text, filled with values."""

    def __init__(self, text: str, **values: Any):
        super().__init__(text)
        self.text, self.values = text, values


def phrase(template: str, plural: str | None = None, /, **values: Any) -> str:
    """Return an interface text, translated and filled as sentences are; plural: for a `count` other
    than 1.
    """
    return fill(template, plural, values, bpy.app.translations.pgettext_rpt, _length)


def text(*parts: Finding | str) -> str:
    """Return the sentences of findings and finished texts, one after the other, with a period or
    semicolon between them.
    """
    joined = ""
    for part in parts:
        added = (
            part
            if isinstance(part, str)
            else sentence(part, bpy.app.translations.pgettext_rpt, _length)
        )
        if joined and not joined.endswith((".", ":")):
            joined += "." if added.endswith(".") else ";"
        joined += " " + added if joined else added
    return joined


def _length(meters: float) -> str:
    return Units.from_settings(bpy.context.scene.unit_settings).text("length", meters)


def distance(meters: float) -> str:
    """Return a length on a body: in centimeters or less where the scene's unit is the meter."""
    units = Units.from_settings(bpy.context.scene.unit_settings)
    units = units._replace(length="ADAPTIVE") if units.length == "METERS" else units
    return units.text("length", meters)


def _rank(part: Finding | str) -> Severity:
    """Return the severity of a finding; a text is a note."""
    return Severity.NOTE if isinstance(part, str) else severity(part)


def report(operator: Operator, *parts: Finding | str, level: Severity = Severity.NOTE) -> set[str]:
    """Report texts and findings in one message, with the highest severity; return the result of
    `execute`.

    level: the severity of the texts.
    """
    worst = max([level, *map(_rank, parts)], key=[*Severity].index)
    operator.report({LEVELS[worst]}, text(*parts))
    return {"FINISHED"}


def unavailable(operator: type[Operator], reason: str) -> bool:
    """Return False for an operator's `poll`, and give Blender the reason, which is passed in
    English.
    """
    operator.poll_message_set(phrase(reason))
    return False


@contextmanager
def progress(count: float) -> Iterator[Callable[[float], None]]:
    """Yield a function that displays the finished part of `count` at the cursor, if `count` is more
    than 1.
    """
    manager = bpy.context.window_manager
    if count <= 1:
        yield lambda _done: None
        return
    manager.progress_begin(0, count)
    try:
        yield manager.progress_update
    finally:
        manager.progress_end()


def first(parts: Sequence[Any]) -> list[Any]:
    """Return at most MAX_REPORTED findings or texts, the most severe first, and the number of
    omitted ones.
    """
    return truncate_findings(
        sorted(parts, key=lambda part: [*Severity].index(_rank(part)), reverse=True), MAX_REPORTED
    )


def failure(name: str, reason: Finding | Exception) -> Finding:
    """Return the finding that one of several objects was left unchanged, by a refusal or an
    internal error.
    """
    cause = reason if isinstance(reason, Finding) else internal_error.finding_of(reason)
    return finding(FAILURE, object=name, cause=cause.as_record())


def refusal(error: MeasureError) -> Finding:
    """Return the reason why an operator does nothing at all."""
    if not error.subject:
        return error.finding
    return error.finding.of_sources([error.subject])
