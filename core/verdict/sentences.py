# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sentences of findings: their templates, filled.

A template is a `str.format` template over the finding's values. `plural` is taken if the value
`count` is not 1. Values stay numbers, strings, booleans and lists; only the template formats them:

    {share:percent}      a fraction, as 12.3%                {samples:size}   integers, as 2 x 3 x 4
    {thickness:length}   meters, as the scene shows them     {point:point}    three lengths
    {side:word}          words of ours, to be translated, or a list of names
    {names}              a list, the first 8: “A”, “B”, and 3 more
    {cause}, {causes}    another finding, or several ({"code", "values"}): their messages
    {elements}           its mesh elements (`Finding.elements`, `count` in all): 3, 5, 9, or 3 of
                         “Cube”

The optional value `sources` (names of the objects that a surface came from, if not the measured
object itself) puts “A”, “B”: before any message. `accepted` says that a user has judged the
finding, `slight` that its effect is negligible: a warning is a note then.
"""

import string
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

from .catalog import declared
from .finding_types import MAX_STORED_ELEMENTS, Elements, Finding, Severity, truncate
from .findings import AND_MORE
from .method import Method, Procedure

MAX_LISTED = MAX_STORED_ELEMENTS
ACCEPTED = "Accepted: {}"  # before a finding that a user has judged, by its value `accepted`
JOINED = (("count", sum), ("share", max))  # values of several findings in one


def _item(item: Any, translate: Callable[[str], str]) -> str:
    """Write a number, “a name”, or a pair of them: 3 of “Cube”."""
    if hasattr(item, "tolist"):
        item = item.tolist()
    if isinstance(item, (list, tuple)):
        return translate("{} of {}").format(*[_item(part, translate) for part in item])
    return "“{}”".format(item) if isinstance(item, str) else "{}".format(item)


def truncate_list(
    items: Elements, count: int | None = None, translate: Callable[[str], str] = str
) -> str:
    """Write the first names, numbers or pairs of a list, and the number of the others: “A”, “B”,
    and 3 more.
    """
    shown, more = truncate(items, MAX_LISTED, count)
    texts = [_item(item, translate) for item in shown]
    if more:
        texts.append(translate(AND_MORE.text).format(count=more))
    return ", ".join(texts)


class _Formatter(string.Formatter):
    """`str.format` with the formats named above. lengths: formats a length in meters, by default in
    meters.
    """

    def __init__(
        self, translate: Callable[[str], str], lengths: Callable[[float], str] | None
    ) -> None:
        self.translate = translate
        self.lengths = lengths or "{:.4g} m".format

    def format_field(self, value: Any, format_spec: str) -> str:
        if isinstance(value, Mapping):
            return sentence(Finding.from_record(value), self.translate, self.lengths)
        if value is None:  # stored in place of a number that was not finite
            return self.translate("unknown")
        if format_spec == "percent":
            return "{:.3g}%".format(100.0 * value)
        if format_spec == "length":
            return self.lengths(value)
        if format_spec == "word" and isinstance(value, str):
            return self.translate(value)
        if format_spec == "size":
            return " x ".join("{:d}".format(number) for number in value)
        if format_spec == "point":
            return "({})".format(", ".join(self.lengths(number + 0.0) for number in value))
        if isinstance(value, (list, tuple)):
            if len(value) and isinstance(value[0], Mapping):
                return self._join([self.format_field(finding, "") for finding in value])
            return truncate_list(value, translate=self.translate)
        return super().format_field(value, format_spec)

    @staticmethod
    def _join(texts: Sequence[str]) -> str:
        """Join sentences by spaces, clauses by commas."""
        return "".join(
            text + (" " if text.endswith(".") else ", ") for text in texts[:-1]
        ) + "".join(texts[-1:])


def fill(
    text: str,
    plural: str | None,
    values: Mapping[str, Any],
    translate: Callable[[str], str] = str,
    lengths: Callable[[float], str] | None = None,
) -> str:
    """Return a template, translated and then filled. plural: the template for a `count` other than
    1.
    """
    template = text if plural is None or values.get("count") == 1 else plural
    return _Formatter(translate, lengths).vformat(translate(template), (), values)


def sentence(
    finding: Finding,
    translate: Callable[[str], str] = str,
    lengths: Callable[[float], str] | None = None,
) -> str:
    """Return the sentence of a finding; templates are translated before they are filled, lengths
    are meters.
    """
    entry = declared(finding.code)
    values = finding.values
    count = values.get("count")
    elements = "{}".format(count)
    if len(finding.elements):
        elements = truncate_list(finding.elements, count, translate)
    text = fill(entry.text, entry.plural, {**values, "elements": elements}, translate, lengths)
    if sources := values.get("sources"):
        text = "{}: {}".format(truncate_list(sources, translate=translate), text)
    return translate(ACCEPTED).format(text) if values.get("accepted") else text


def severity(finding: Finding) -> Severity:
    """Return the severity of a finding, by its code; an accepted or slight warning is a note."""
    by_code = declared(finding.code).severity
    values = finding.values
    is_lowered = values.get("accepted") or values.get("slight")
    return Severity.NOTE if by_code == Severity.WARNING and is_lowered else by_code


def of_severity(findings: Iterable[Finding], *severities: Severity) -> list[Finding]:
    """Return the findings that have one of the severities."""
    return [finding for finding in findings if severity(finding) in severities]


# Texts of enums in a panel or a report: method → headline, explanation. Not findings.
METHODS = {
    "exact": ("Exact", "The surface is closed"),
    "grid exact": ("Exact, from a Grid", "Voxel values are taken as they are"),
    "reoriented": ("Reoriented", "Closed after flipped faces were reversed"),
    "capped": ("Capped", "The surface is open; its holes were capped"),
    "open": ("Open", "Open or through itself: it bounds no certain volume"),
    "shell": ("Shell", "The mass is in the surface"),
    "wall": ("Wall", "The mass is in a wall of real thickness"),
    "union": (
        "Union",
        "Overlapping components were united by Blender's Boolean, accurate to 7 digits",
    ),
    "wire": ("Wire", "The mass is along the curve"),
    "given": ("Given", "The mass is given; there is no geometry"),
    "assembly": ("Assembly", "The members as one body"),
}


def method_key(method: Method | None, walled: bool) -> str:
    """Return the entry of METHODS that a method belongs to, "" for none. walled: if a shell is a
    wall.
    """
    if method is None:
        return ""
    if walled and method.procedure == Procedure.SHELL:
        return "wall"
    return str(method) if str(method) in METHODS else method.procedure.value


# Counts of the health record, as the text report names them: one, several.
HEALTH = {
    "boundary_edges": ("boundary edge", "boundary edges"),
    "non_manifold_edges": ("non-manifold edge", "non-manifold edges"),
    "inconsistent_edges": ("edge with opposite normals", "edges with opposite normals"),
    "inverted_components": ("inside-out component", "inside-out components"),
    "nested_components": (
        "component inside another, counted twice",
        "components inside others, counted twice",
    ),
    "overlapping_components": ("overlapping component", "overlapping components"),
    "cavities": ("cavity", "cavities"),
    "duplicate_faces": ("duplicate face", "duplicate faces"),
    "degenerate_faces": ("zero-area face", "zero-area faces"),
    "non_planar_faces": ("non-planar face", "non-planar faces"),
    "flipped_faces": ("flipped face", "flipped faces"),
}
# Relation of a shape to the one that it was compared with (an enum in core/shape).
SIMILARITY = {
    "copy": "copy",
    "scaled_copy": "scaled copy",
    "mirror": "mirror image",
    "scaled_mirror": "scaled mirror image",
    "copy_or_mirror": "copy or mirror image",
    "scaled_copy_or_mirror": "scaled copy or mirror image",
    "similar": "similar",
    "different": "different",
}


class Group(NamedTuple):
    """Findings with one code, of one or several objects.

    finding: the first one, with the sum of all counts and the largest share. objects: full names.
    """

    finding: Finding
    objects: tuple[str, ...] = ()


def grouped(findings: Iterable[tuple[str, Finding]]) -> list[Group]:
    """Return groups of the findings of objects, given with their full names; the most severe
    first.
    """
    by_code: dict[tuple[Severity, str], list[tuple[str, Finding]]] = {}
    for name, item in findings:
        by_code.setdefault((severity(item), item.code), []).append((name, item))
    groups = []
    for members in by_code.values():
        _, first = members[0]
        values = dict(first.values)
        if len(members) > 1:
            for key, join in JOINED:
                numbers = [
                    item.values[key] for _, item in members if item.values.get(key) is not None
                ]
                if numbers:
                    values[key] = join(numbers)
        names = dict.fromkeys(name for name, _ in members)
        groups.append(Group(replace(first, values=values), tuple(filter(None, names))))
    return sorted(groups, key=lambda group: -tuple(Severity).index(severity(group.finding)))
