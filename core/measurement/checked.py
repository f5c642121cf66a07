# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Documents read from files, checked once, so that commands can rely on their shape.

The shape is that of `docs/record.schema.json`, as far as commands use it; other entries may hold
anything. Standard library only.
"""

from __future__ import annotations

import json
import re
from math import isfinite
from typing import Any, NoReturn

from .documents import SCHEMA

MAX_DEPTH = 50  # levels of nested lists and objects, so that no later step nests too many calls
_MAX_WHOLE = 1 << 128  # Products of several whole numbers still fit into float64.

# A dict is an object with these entries: optional ones have a “?”, patterns stand for any number of
# entries. A list with one shape is a list of any length, with more shapes one of that length. A
# tuple allows null, as does `float`.
_VECTOR = [float] * 3
_TENSOR = [_VECTOR] * 3
_TEXTS = {"warnings": [str], "notes": [str]}
_FINDINGS = {"findings": [{"code": str, "severity": str, "message": str, "values": dict}], **_TEXTS}
_POWERS = {re.compile(r"[0-9]{1,3}(,[0-9]{1,3})*"): float}
_DOMAINS = {name + "?": _POWERS for name in ("volume", "surface", "length", "mass", "area")}
_MOMENTS = _DOMAINS | {"error?": _DOMAINS, "input?": _DOMAINS}
_BOUNDED = (
    "volume",
    "area",
    "length",
    "thickness",
    "center_of_mass",
    "inertia",
    "centroid",
    "second_moments",
)
_BOUNDS = {name + "?": float for name in _BOUNDED}
_RECORD = {
    **{name: str for name in ("name", "type", "kind", "method")},
    **{name: float for name in ("density", "mass", "volume", "area")},
    "verdict?": str,
    **{name + "?": float for name in ("length", "linear_density", "thickness")},
    "center_of_mass": _VECTOR,
    "inertia": _TENSOR,
    "principal_moments": _VECTOR,
    "principal_axes": _TENSOR,
    "inertia_about?": {"point": _VECTOR, "inertia": _TENSOR},
    "moments?": _MOMENTS,
    "display_mesh?": dict,
    "pose?": ({"matrix": [[float] * 4] * 4, "unique": bool, "symmetry": (str,)},),
    "signature?": (dict,),
    "health": dict,
    "error_bound": ((_BOUNDS | {"input?": (_BOUNDS,)}),),
    **_FINDINGS,
}
_FLAT = {
    "name": str,
    "type": str,
    "area": float,
    "centroid": _VECTOR,
    "signature?": (dict,),
    "moments?": _MOMENTS,
    "plane": {"x": _VECTOR, "y": _VECTOR, "normal": _VECTOR},
    "second_moments": {re.compile("xx|yy|xy"): float},
    "invariants?": [
        {"name": str, "real": float, "imaginary": float, "error": float, "input": float}
    ],
    "error_bound": (_BOUNDS | {"input": _BOUNDS}),
    **_FINDINGS,
}
_REASONS = [{"name": (str,), "reason": str}]
_DOCUMENT = {
    "run?": {"addon": str, "options": dict},
    "blender": (str,),
    "total?": {"findings?": _FINDINGS["findings"]},
    "file": (str,),
    "status": str,
    "frame": str,
    "objects": [_RECORD],
    "flat?": [_FLAT],
    "assemblies?": [_RECORD],
    "bones?": [{"armature": str, **_RECORD}],
    "left_out": _REASONS,
    "errors": _REASONS,
}
_NAMES = {
    dict: "an object",
    list: "a list",
    str: "a text",
    bool: "true or false",
    float: "a number or null",
}


class _WrongError(ValueError):
    """A value of another shape than expected. path: the keys and indices that lead to it, the
    innermost first.
    """

    def __init__(self, message: str) -> None:
        super().__init__(message)
        self.path: list[str] = []

    def __str__(self) -> str:
        return ("".join(reversed(self.path)).removeprefix(".") or "it") + self.args[0]


def parse_json(text: str, line: int = 1) -> Any:
    """Return the content of a JSON text with finite numbers.

    ValueError if it is no such text. line: its first line.
    """
    try:
        return json.loads(text, parse_constant=_not_finite, parse_float=_finite)
    except json.JSONDecodeError as error:
        place = "line {}, column {}: {}".format(line + error.lineno - 1, error.colno, error.msg)
        raise ValueError(place) from error
    except (ValueError, RecursionError) as error:
        raise ValueError("line {}: {}".format(line, str(error).partition(";")[0])) from error


def check_document(document: Any) -> None:
    """Raise ValueError, with the place in the document, if it has not the shape of a document of
    this program.
    """
    _check(document, {"schema": str})
    if document["schema"] != SCHEMA:
        raise ValueError("schema is {}, not {}".format(document["schema"], SCHEMA))
    _check(document, _DOCUMENT)
    level = [document]
    for _ in range(MAX_DEPTH):
        lists = [
            list(value.values()) if isinstance(value, dict) else value
            for value in level
            if isinstance(value, (dict, list))
        ]
        level = [entry for entries in lists for entry in entries]
    if level:
        raise ValueError("it is nested too deeply")


def check_journal_line(line: Any) -> None:
    """Raise ValueError, with the place in the line, if it has not the shape of a journal's line."""
    _check(line, {"attempts": float, "seconds": float, "document": dict})
    try:
        check_document(line["document"])
    except _WrongError as error:
        error.path.append(".document")
        raise


def _check(value: Any, shape: Any) -> None:
    """Raise _WrongError if a value has not a shape."""
    if isinstance(shape, tuple):
        if value is not None:
            _check(value, shape[0])
    elif isinstance(shape, (dict, list)):
        if not isinstance(value, type(shape)):
            _refuse(type(shape), value)
        for key, part in _parts(value, shape):
            try:
                _check(value[key], part)
            except _WrongError as error:
                error.path.append(".{}".format(key) if isinstance(key, str) else "[{}]".format(key))
                raise
    elif shape is float:
        is_number = type(value) is float or type(value) is int and abs(value) < _MAX_WHOLE
        if not is_number and value is not None:
            _refuse(shape, value)
    elif not isinstance(value, shape):
        _refuse(shape, value)


def _parts(value: Any, shape: Any) -> list[tuple[Any, Any]]:
    """Return the keys or indices of a value that a shape describes, with the shape of each."""
    if isinstance(shape, list):
        if len(shape) > 1 and len(value) != len(shape):
            raise _WrongError(" has {} entries, not {}".format(len(value), len(shape)))
        return [*enumerate(shape if len(shape) > 1 else shape * len(value))]
    parts = []
    for name, part in shape.items():
        if isinstance(name, re.Pattern):
            if (wrong := next((key for key in value if not name.fullmatch(key)), None)) is not None:
                raise _WrongError(" has the unknown entry “{}”".format(wrong))
            parts += [(key, part) for key in value]
        elif (key := name.removesuffix("?")) in value:
            parts.append((key, part))
        elif key == name:
            raise _WrongError(" has no “{}”".format(name))
    return parts


def _refuse(shape: type, value: Any) -> NoReturn:
    """Raise _WrongError for a value of another type than a shape's."""
    kind = "null" if value is None else _NAMES.get(float if type(value) is int else type(value))
    raise _WrongError(" is {} ({:.30}), not {}".format(kind, repr(value), _NAMES[shape]))


def _finite(text: str) -> float:
    """Return the number that a JSON text denotes, unless it exceeds the range of numbers."""
    value = float(text)
    return value if isfinite(value) else _not_finite(text)


def _not_finite(text: str) -> NoReturn:
    raise ValueError("{} is no finite number".format(text))
