# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Observations, decisions and refusals as data; and the exceptions that carry a refusal.

A finding is a code, the values that its sentence needs, and the elements that it is about. The
severity and the sentence belong to the code (`Code`), which a package declares in its
`findings.py`. Nothing parses a sentence.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import Any, Protocol, Self

MAX_STORED_ELEMENTS = 8  # in stored and nested findings: as many as a sentence names


class Elements(Protocol):
    """Mesh elements: a sequence or an array of faces, or of edges as pairs."""

    def __len__(self) -> int: ...
    def __iter__(self) -> Iterator[Any]: ...
    def __getitem__(self, part: slice, /) -> Elements: ...


class Severity(StrEnum):
    """The weight of a finding: notes do not question numbers, warnings do, errors leave none.

    Examples
    --------
    >>> from body_moments.core.verdict import Severity
    >>> [str(severity) for severity in Severity]
    ['note', 'warning', 'error']
    """

    NOTE = "note"
    WARNING = "warning"
    ERROR = "error"


class Code(str):
    """The code of a finding, with its severity and its English sentence.

    Packages declare theirs in `findings.py`.

    `text`: a `str.format` template over the finding's values (`core/verdict/sentences.py`) and the
    key of translations. `plural`: the template for a `count` other than 1. `is_repair`: True if the
    surface was repaired on a copy.
    """

    severity: Severity
    text: str
    plural: str | None
    is_repair: bool

    def __new__(
        cls,
        code: str,
        severity: Severity,
        text: str,
        plural: str | None = None,
        is_repair: bool = False,
    ) -> Self:
        self = super().__new__(cls, code)
        self.severity = severity
        self.text = text
        self.plural = plural
        self.is_repair = is_repair
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        """Return the constructor and its arguments, for copies."""
        return Code, (str(self), self.severity, self.text, self.plural, self.is_repair)


def note(code: str, text: str, plural: str | None = None) -> Code:
    """Declare a finding that does not question the numbers."""
    return Code(code, Severity.NOTE, text, plural)


def warning(code: str, text: str, plural: str | None = None) -> Code:
    """Declare a finding that questions the numbers."""
    return Code(code, Severity.WARNING, text, plural)


def repair(code: str, text: str, plural: str | None = None) -> Code:
    """Declare a warning about a repair: a body with such warnings alone counts as repaired."""
    return Code(code, Severity.WARNING, text, plural, is_repair=True)


def error(code: str, text: str, plural: str | None = None) -> Code:
    """Declare a refusal."""
    return Code(code, Severity.ERROR, text, plural)


@dataclass(frozen=True, eq=False)
class Finding:
    """One decision or observation, as data. `str` is its sentence.

    Attributes
    ----------
    code : str
        The name of a declared `Code`, such as ``holes_capped``.
    values : mapping
        Values for the sentence: numbers, strings, booleans, lists of these, and findings as
        mappings with the keys ``code`` and ``values``. Everything is plain enough for JSON.
        ``sources`` names the objects with the surfaces in question, if that is not simply the
        measured object.
    elements : sequence or array
        Mesh elements that it is about, in the input's numbers: faces as integers, edges as pairs of
        vertices.

    Examples
    --------
    >>> from body_moments.core import Finding
    >>> found = Finding("flipped_faces", {"count": 2}, (4, 7))
    >>> found.as_record()
    {'code': 'flipped_faces', 'values': {'count': 2}, 'elements': [4, 7]}
    >>> Finding.from_record(found.as_record()) == found
    True
    """

    code: str
    values: Mapping[str, Any] = field(default_factory=dict)
    elements: Elements = ()

    def as_record(self) -> dict[str, Any]:
        """Return the code, the values and the first elements as plain values for JSON, to be read
        by `from_record`.
        """
        record = {"code": str(self.code), "values": dict(self.values)}
        first = self.elements[:MAX_STORED_ELEMENTS]
        if len(first):
            record["elements"] = [
                item.tolist() if hasattr(item, "tolist") else item for item in first
            ]
        return record

    @classmethod
    def from_record(cls, record: Mapping[str, Any]) -> Finding:
        """Return the finding that `as_record` has written."""
        return cls(str(record["code"]), dict(record["values"]), tuple(record.get("elements", ())))

    def of_sources(self, names: Sequence[str]) -> Finding:
        """Return the same finding about the surfaces of these objects."""
        return replace(self, values={**self.values, "sources": list(names)})

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Finding) and (self.code, self.values) == (other.code, other.values)

    def __hash__(self) -> int:
        return hash((self.code, repr(sorted(self.values.items()))))

    def __str__(self) -> str:
        from .sentences import sentence  # late, as `sentences` imports this module

        return sentence(self)


def finding(
    code: str, elements: Elements = (), /, *, slight: bool = False, **values: Any
) -> Finding:
    """Make a finding with this code, about mesh elements, with the values of its sentence.

    slight: True if the effect on mass, size and inertia is negligible
    (`core/verdict/tolerances.py`): a warning is then a note.
    """
    return Finding(code, values | {"slight": True} if slight else values, elements)


def unique(findings: Iterable[Finding]) -> tuple[Finding, ...]:
    """Return the findings in their order, each once."""
    return tuple(dict.fromkeys(findings))


def system_reason(error: OSError) -> str:
    """Return the system's reason for a refusal, as a part of a sentence."""
    return (error.strerror or str(error)).rstrip(".")


def truncate(items: Elements, limit: int, count: int | None = None) -> tuple[Elements, int]:
    """Return the first `limit` items and the number of items left out. count: items in all, by
    default the length.
    """
    shown = items[:limit]
    return shown, max((count or len(items)) - len(shown), 0)


def truncate_findings(findings: Sequence[Any], limit: int) -> list[Any]:
    """Return the first `limit` findings or texts, and an ``and_more`` finding if there are
    others.
    """
    from .findings import AND_MORE  # late, as `findings` imports this module

    shown, more = truncate(findings, limit)
    return [*shown, finding(AND_MORE, count=more)] if more else [*shown]


class MeasureError(Exception):
    """A refusal of a request, with the reason and the remedy as a finding of severity error.

    Raised if the user's objects, settings, files or queries make a result impossible. Wrong
    arguments of a programmer are ValueError and TypeError; any other exception is a fault of the
    program.

    Parameters
    ----------
    reason : str or Finding
        A code, or the finding itself.
    subject : str
        The name of the object or file that it is about, if known.
    elements : sequence
        Mesh elements of the finding, if `reason` is a code.
    **values
        Values of the finding, if `reason` is a code.

    Attributes
    ----------
    finding : Finding
        The reason and the remedy.
    subject : str

    Examples
    --------
    >>> from body_moments.core import MeasureError, Surface, measure_solid
    >>> try:
    ...     measure_solid(Surface.from_triangles(np.zeros((0, 3)), np.zeros((0, 3), int)))
    ... except MeasureError as error:
    ...     error.finding.code
    'no_faces'
    """

    def __init__(
        self, reason: str | Finding, /, *, subject: str = "", elements: Elements = (), **values: Any
    ):
        self.finding = reason if isinstance(reason, Finding) else Finding(reason, values, elements)
        self.subject = subject
        super().__init__(self.finding.code)

    def about(self, subject: str) -> MeasureError:
        """Set the subject, an object or a file, unless the error has one already, and return the
        error itself.
        """
        self.subject = self.subject or subject
        return self

    @property
    def reason(self) -> str:
        """The sentence without the subject's name."""
        return str(self.finding)

    def __str__(self) -> str:
        return "{}: {}".format(self.subject, self.reason) if self.subject else self.reason


class ReadError(MeasureError):
    """An object cannot be read, or has nothing to measure."""


class EditRefusedError(MeasureError):
    """A refusal to change an object, because something protected would change with it."""


class FileError(MeasureError):
    """A file cannot be read or written."""


class QueryError(MeasureError):
    """A query without an answer: a name, a point, an order that does not exist."""
