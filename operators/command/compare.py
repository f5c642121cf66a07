# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""`compare`: the numbers of two results, object by object, against the bounds of both. Standard library only."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Any

_SCALARS = ("mass", "volume", "area")
_LINE = "{:<5} {}: {:<18} {:>12.6g} {:>12.6g}  difference {:.2e}, allowed {:.2e}"

Matrix = list[list[float]]


def differences(
    first: Iterable[dict[str, Any]], second: Iterable[dict[str, Any]], tolerance: float, align: bool
) -> tuple[list[str], bool]:
    """The lines to print, and whether anything differs by more than it may.

    A number may differ by the bounds of both, and by the tolerance times its size: the largest entry of a vector or a
    tensor, for a center the radius of gyration. align: centers and tensors are compared in each body's own pose.
    """
    others = {document["file"]: document for document in second}
    lines, failed, compared = [], 0, 0
    for document in first:
        other = others.pop(document["file"], None)
        if other is None:
            lines.append("only in the first: {}".format(document["file"]))
            failed += 1
            continue
        if document["status"] != other["status"]:
            lines.append("FAIL  {}: status {} and {}".format(document["file"], document["status"], other["status"]))
            failed += 1
        names = {entry["name"]: entry for entry in other["objects"]}
        for entry in document["objects"]:
            label = "{}: {}".format(document["file"], entry["name"])
            match = names.pop(entry["name"], None)
            if match is None:
                lines.append("only in the first: {}".format(label))
                failed += 1
                continue
            compared += 1
            for line, passes in _numbers(label, entry, match, tolerance, align):
                lines.append(line)
                failed += not passes
        lines += ["only in the second: {}: {}".format(document["file"], name) for name in names]
        failed += len(names)
    lines += ["only in the second: {}".format(file) for file in others]
    failed += len(others)
    lines.append("{} objects compared, {} differences beyond what is allowed".format(compared, failed))
    return lines, bool(failed)


def _numbers(
    label: str, first: dict[str, Any], second: dict[str, Any], tolerance: float, align: bool
) -> Iterator[tuple[str, bool]]:
    """A line for each number of an object that differs at all, and whether it passes."""
    if align and not (first.get("pose") and second.get("pose")):
        yield "FAIL  {}: no pose to align by".format(label), False
        return
    values, others = (_values(entry, align) for entry in (first, second))
    for name, (value, size) in values.items():
        other = others.get(name, (None, 0.0))[0]
        if value is None or other is None:
            if value != other:
                yield "FAIL  {}: {} is {} and {}".format(label, name, value, other), False
            continue
        group = name.split("[")[0]
        allowed = tolerance * size + _bound(first, group) + _bound(second, group)
        difference = abs(value - other)
        if difference:
            passes = difference <= allowed
            yield _LINE.format("pass" if passes else "FAIL", label, name, value, other, difference, allowed), passes


def _values(entry: dict[str, Any], align: bool) -> dict[str, tuple[float | None, float]]:
    """Each number by its name, with the size that a tolerance is relative to."""
    found: dict[str, tuple[float | None, float]] = {name: (entry[name], abs(entry[name] or 0.0)) for name in _SCALARS}
    center, inertia = entry["center_of_mass"], entry["inertia"]
    if center is None or inertia is None:
        return found
    gyration = math.sqrt(sum(entry["principal_moments"]) / (2.0 * entry["mass"])) if entry["mass"] else 0.0
    if align:
        rows = [row[:3] for row in entry["pose"]["matrix"][:3]]
        shift = [row[3] for row in entry["pose"]["matrix"][:3]]
        center = [sum(a * b for a, b in zip(row, center)) + s for row, s in zip(rows, shift)]
        inertia = _product(_product(rows, inertia), [list(column) for column in zip(*rows)])
    found |= {"center_of_mass[{}]".format(axis): (value, gyration) for axis, value in zip("xyz", center)}
    largest = max(abs(value) for row in inertia for value in row)
    for i, row in enumerate(inertia):
        for j in range(i, 3):
            found["inertia[{}{}]".format("xyz"[i], "xyz"[j])] = (row[j], largest)
    for number, value in enumerate(entry["principal_moments"]):
        found["principal_moments[{}]".format(number + 1)] = (value, largest)
    return found


def _product(first: Matrix, second: Matrix) -> Matrix:
    return [[sum(a * b for a, b in zip(row, column)) for column in zip(*second)] for row in first]


def _bound(entry: dict[str, Any], name: str) -> float:
    """What a record says that rounding and its input may have changed in a number. Moments have their tensor's."""
    bounds = entry["error_bound"] or {}
    if name == "mass":
        volume = entry["volume"] or entry["area"]
        share = _bound(entry, "volume" if entry["volume"] else "area") / abs(volume) if volume else 0.0
        return share * abs(entry["mass"] or 0.0)
    name = "inertia" if name == "principal_moments" else name
    return (bounds.get(name) or 0.0) + ((bounds.get("input") or {}).get(name) or 0.0)
