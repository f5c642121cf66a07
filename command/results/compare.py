# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""`compare`: the numbers of two results, body by body, against the bounds of both.

Standard library only.
"""

import math
from collections.abc import Iterable, Iterator
from typing import Any

from ...core.measurement import bound_of, radius_of_gyration

_SCALARS = ("mass", "volume", "area", "density", "length", "linear_density", "thickness")
_DOMAINS = ("volume", "surface", "length", "mass", "area")  # domains of moments
_LINE = "{:<5} {}: {:<18} {:>12.6g} {:>12.6g}  difference {:.2e}, allowed {:.2e}"

Matrix = list[list[float]]
Number = tuple[float | None, float, float]  # value, the size that a tolerance is relative to, bound


def differences(
    first: Iterable[dict[str, Any]], second: Iterable[dict[str, Any]], tolerance: float, align: bool
) -> tuple[list[str], bool]:
    """Return the lines to print, and whether a number differs by more than allowed.

    A number may differ by the bounds of both, and by the tolerance times its size: the largest
    entry of a vector, a tensor or the moments of one degree, for a center the radius of gyration.
    align: compare centers and tensors in each body's own pose, and skip numbers about a point that
    did not move with the body.
    """
    others = {document["file"]: document for document in second}
    rows: list[tuple[str, bool]] = []  # lines, and whether they pass
    compared = 0
    for document in first:
        other = others.pop(document["file"], None)
        if other is None:
            rows.append(("only in the first: {}".format(document["file"]), False))
            continue
        if document["status"] != other["status"]:
            text = "FAIL  {}: status {} and {}".format(
                document["file"], document["status"], other["status"]
            )
            rows.append((text, False))
        names = _bodies(other)
        for name, entry in _bodies(document).items():
            label = "{}: {}".format(document["file"], name)
            match = names.pop(name, None)
            if match is None:
                rows.append(("only in the first: {}".format(label), False))
                continue
            compared += 1
            rows += _numbers(label, entry, match, tolerance, align)
        rows += [
            ("only in the second: {}: {}".format(document["file"], name), False) for name in names
        ]
    rows += [("only in the second: {}".format(file), False) for file in others]
    failed = sum(not passes for _, passes in rows)
    summary = "{} bodies compared, {} differences beyond what is allowed".format(compared, failed)
    return [*(line for line, _ in rows), summary], bool(failed)


def _bodies(document: dict[str, Any]) -> dict[str, dict[str, Any]]:
    """Return a document's records by name: objects, assemblies, flat shapes, and bones with their
    armatures.
    """
    return {
        name.format_map(entry): entry
        for name, kind in (
            ("{name}", "objects"),
            ("assembly {name}", "assemblies"),
            ("flat {name}", "flat"),
            ("bone {name} of {armature}", "bones"),
        )
        for entry in document.get(kind, ())
    }


def _numbers(
    label: str, first: dict[str, Any], second: dict[str, Any], tolerance: float, align: bool
) -> Iterator[tuple[str, bool]]:
    """Yield a line for each differing number of an object, and whether it passes."""
    if "plane" in first:
        values, others = (_flat_values(entry, align) for entry in (first, second))
    elif align and not (first.get("pose") and second.get("pose")):
        yield "FAIL  {}: no pose to align by".format(label), False
        return
    else:
        values, others = (_values(entry, align) for entry in (first, second))
    for name in dict.fromkeys((*values, *others)):
        (value, size, bound), (other, _, second_bound) = (
            of.get(name, (None, 0.0, 0.0)) for of in (values, others)
        )
        if value is None or other is None:
            if value != other:
                yield "FAIL  {}: {} is {} and {}".format(label, name, value, other), False
            continue
        allowed = tolerance * size + bound + second_bound
        difference = abs(value - other)
        if difference:
            passes = difference <= allowed
            yield (
                _LINE.format(
                    "pass" if passes else "FAIL", label, name, value, other, difference, allowed
                ),
                passes,
            )


def _values(entry: dict[str, Any], align: bool) -> dict[str, Number]:
    """Return the numbers of a body's record by their names. align: in the body's own pose."""
    found: dict[str, Number] = {
        name: (entry[name], abs(entry[name] or 0.0), _bound(entry, name))
        for name in _SCALARS
        if name in entry
    }
    center = entry["center_of_mass"]
    inertia = entry["inertia"]
    about = entry.get("inertia_about")
    if not align:
        found |= _moments(entry.get("moments") or {})
        if about is not None:
            distance = math.dist(*(map(_number, point) for point in (about["point"], center)))
            found |= _tensor("inertia_about", about["inertia"], _bound_about(entry, distance))
    else:
        rows, inertia = (
            [[*map(_number, row)] for row in of] for of in (entry["pose"]["matrix"][:3], inertia)
        )
        center = [sum(a * _number(b) for a, b in zip(row, center)) + row[3] for row in rows]
        rows = [row[:3] for row in rows]
        inertia = _product(_product(rows, inertia), [list(column) for column in zip(*rows)])
    bound = _bound(entry, "inertia")
    return (
        found
        | _named(
            "center_of_mass",
            zip("xyz", center),
            radius_of_gyration(entry) or 0.0,
            _bound(entry, "center_of_mass"),
        )
        | _tensor("inertia", inertia, bound)
        | _named(
            "principal_moments",
            zip("123", entry["principal_moments"]),
            _largest(sum(inertia, [])),
            bound,
        )
    )


def _flat_values(entry: dict[str, Any], align: bool) -> dict[str, Number]:
    """Return the numbers of a flat shape. align: only numbers that do not depend on its place."""
    area = entry["area"]
    found: dict[str, Number] = {"area": (area, area or 0.0, bound_of(entry, "area") or 0.0)}
    for one in entry.get("invariants", ()):
        size = math.hypot(one["real"] or 0.0, one["imaginary"] or 0.0)
        bound = (one["error"] or 0.0) + (one["input"] or 0.0)
        for part in ("real", "imaginary"):
            found["{} {}".format(one["name"], part)] = (one[part], size, bound)
    if align:
        return found
    second = entry["second_moments"]
    square = (second["xx"] or 0.0) + (second["yy"] or 0.0)
    gyration = math.sqrt(max(square / area, 0.0)) if area else 0.0
    bound = bound_of(entry, "centroid") or 0.0
    found |= _named("centroid", zip("xyz", entry["centroid"]), gyration, bound)
    # The axes are known to that accuracy at best.
    turned = found["area"][2] / area if area else 0.0
    for name in ("x", "y", "normal"):
        found |= _named("plane." + name, zip("xyz", entry["plane"][name]), 1.0, turned)
    bound = bound_of(entry, "second_moments") or 0.0
    found |= _named("second_moments", second.items(), _largest(second.values()), bound)
    return found | _moments(entry.get("moments") or {})


def _named(
    name: str, values: Iterable[tuple[str, float | None]], size: float, bound: float
) -> dict[str, Number]:
    """Return the components of a vector or a tensor by their names."""
    return {"{}[{}]".format(name, key): (value, size, bound) for key, value in values}


def _tensor(name: str, rows: Matrix, bound: float) -> dict[str, Number]:
    pairs = [("xyz"[i] + "xyz"[j], rows[i][j]) for i in range(3) for j in range(i, 3)]
    return _named(name, pairs, _largest(sum(rows, [])), bound)


def _largest(values: Iterable[float | None]) -> float:
    return max(abs(value or 0.0) for value in values)


def _number(value: float | None) -> float:
    return math.nan if value is None else float(value)


def _moments(moments: dict[str, Any]) -> dict[str, Number]:
    found: dict[str, Number] = {}
    for domain in (name for name in _DOMAINS if name in moments):
        bounds = [moments.get(part, {}).get(domain, {}) for part in ("error", "input")]
        degrees: dict[int, dict[str, float | None]] = {}
        for powers, value in moments[domain].items():
            degrees.setdefault(sum(map(int, powers.split(","))), {})[powers] = value
        for values in degrees.values():
            size = _largest(values.values())
            found |= {
                "moments.{}[{}]".format(domain, powers): (
                    value,
                    size,
                    sum(of.get(powers) or 0.0 for of in bounds),
                )
                for powers, value in values.items()
            }
    return found


def _product(first: Matrix, second: Matrix) -> Matrix:
    return [[sum(a * b for a, b in zip(row, column)) for column in zip(*second)] for row in first]


def _bound(entry: dict[str, Any], name: str) -> float:
    # A given value has no bound, and does not differ.
    if name in ("mass", "density", "linear_density"):
        measure = "volume" if entry["volume"] else "area"
        size = entry[measure]
        return _bound(entry, measure) / abs(size) * abs(entry[name] or 0.0) if size else 0.0
    return bound_of(entry, name) or 0.0


def _bound_about(entry: dict[str, Any], distance: float) -> float:
    shift = distance * _bound(entry, "mass") + 2.0 * (entry["mass"] or 0.0) * _bound(
        entry, "center_of_mass"
    )
    return _bound(entry, "inertia") + distance * shift
