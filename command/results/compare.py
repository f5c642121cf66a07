# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""`compare`: the numbers of two results, body by body, against the bounds of both.

Standard library only.
"""

import math
from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

from ...core.measurement import bound_of, radius_of_gyration

_SCALARS = ("mass", "volume", "area", "density", "length", "linear_density", "thickness")
_DOMAINS = ("volume", "surface", "length", "mass", "area")  # domains of moments
_LINE = "{:<5} {}: {:<18} {:>12.6g} {:>12.6g}  difference {:.2e}, allowed {:.2e}"

Matrix = list[list[float]]


class Number(NamedTuple):
    """A number of a record. size: what a tolerance is relative to. bound: of its error."""

    value: float | None
    size: float = 0.0
    bound: float = 0.0


def differences(
    first: Iterable[dict[str, Any]], second: Iterable[dict[str, Any]], tolerance: float, align: bool
) -> tuple[list[str], bool]:
    """Return the lines to print, and whether a number differs by more than allowed.

    A number may differ by the bounds of both, and by the tolerance times its size: the largest
    entry of a vector, a tensor or the moments of one degree, for a center the radius of gyration.
    align: compare centers and tensors in each body's own pose, and skip numbers about a point that
    did not move with the body.
    """
    second_documents = {document["file"]: document for document in second}
    lines: list[tuple[str, bool]] = []  # lines, and whether they pass
    compared = 0
    for document in first:
        second_document = second_documents.pop(document["file"], None)
        if second_document is None:
            lines.append(("only in the first: {}".format(document["file"]), False))
            continue
        if document["status"] != second_document["status"]:
            text = "FAIL  {}: status {} and {}".format(
                document["file"], document["status"], second_document["status"]
            )
            lines.append((text, False))
        names = _bodies(second_document)
        for name, entry in _bodies(document).items():
            label = "{}: {}".format(document["file"], name)
            match = names.pop(name, None)
            if match is None:
                lines.append(("only in the first: {}".format(label), False))
                continue
            compared += 1
            lines += _numbers(label, entry, match, tolerance, align)
        lines += [
            ("only in the second: {}: {}".format(document["file"], name), False) for name in names
        ]
    lines += [("only in the second: {}".format(file), False) for file in second_documents]
    failed = sum(not passes for _, passes in lines)
    summary = "{} bodies compared, {} differences beyond what is allowed".format(compared, failed)
    return [*(line for line, _ in lines), summary], bool(failed)


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
        values, second_values = (_flat_values(entry, align) for entry in (first, second))
    elif align and not (first.get("pose") and second.get("pose")):
        yield "FAIL  {}: no pose to align by".format(label), False
        return
    else:
        values, second_values = (_values(entry, align) for entry in (first, second))
    for name in dict.fromkeys((*values, *second_values)):
        value, size, bound = values.get(name, Number(None))
        second_value, _, second_bound = second_values.get(name, Number(None))
        if value is None or second_value is None:
            if value != second_value:
                yield "FAIL  {}: {} is {} and {}".format(label, name, value, second_value), False
            continue
        allowed = tolerance * size + bound + second_bound
        difference = abs(value - second_value)
        if difference:  # NaN differs, and fails.
            passes = difference <= allowed
            yield (
                _LINE.format(
                    "pass" if passes else "FAIL",
                    label,
                    name,
                    value,
                    second_value,
                    difference,
                    allowed,
                ),
                passes,
            )


def _values(entry: dict[str, Any], align: bool) -> dict[str, Number]:
    """Return the numbers of a body's record by their names. align: in the body's own pose."""
    numbers: dict[str, Number] = {
        name: Number(entry[name], abs(entry[name] or 0.0), _bound(entry, name))
        for name in _SCALARS
        if name in entry
    }
    center = entry["center_of_mass"]
    inertia = entry["inertia"]
    about = entry.get("inertia_about")
    if not align:
        numbers |= _moments(entry.get("moments") or {})
        if about is not None:
            distance = math.dist(*(map(_number, point) for point in (about["point"], center)))
            numbers |= _tensor("inertia_about", about["inertia"], _bound_about(entry, distance))
    else:
        # R x + t brings a point x into the pose, and R I Rᵀ a tensor I.
        pose_rows, inertia = (
            [[*map(_number, row)] for row in rows]
            for rows in (entry["pose"]["matrix"][:3], inertia)
        )
        center = [sum(a * _number(b) for a, b in zip(row, center)) + row[3] for row in pose_rows]
        rotation = [row[:3] for row in pose_rows]
        inertia = _product(_product(rotation, inertia), [list(column) for column in zip(*rotation)])
    bound = _bound(entry, "inertia")
    return (
        numbers
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
    area_bound = bound_of(entry, "area") or 0.0
    numbers = {"area": Number(area, area or 0.0, area_bound)}
    for invariant in entry.get("invariants", ()):
        size = math.hypot(invariant["real"] or 0.0, invariant["imaginary"] or 0.0)
        bound = (invariant["error"] or 0.0) + (invariant["input"] or 0.0)
        for part in ("real", "imaginary"):
            numbers["{} {}".format(invariant["name"], part)] = Number(invariant[part], size, bound)
    if align:
        return numbers
    second = entry["second_moments"]
    polar_moment = (second["xx"] or 0.0) + (second["yy"] or 0.0)
    gyration = math.sqrt(max(polar_moment / area, 0.0)) if area else 0.0
    bound = bound_of(entry, "centroid") or 0.0
    numbers |= _named("centroid", zip("xyz", entry["centroid"]), gyration, bound)
    # The axes have no bound of their own. They are no more accurate than the area.
    axes_error = area_bound / area if area else 0.0
    for name in ("x", "y", "normal"):
        numbers |= _named("plane." + name, zip("xyz", entry["plane"][name]), 1.0, axes_error)
    bound = bound_of(entry, "second_moments") or 0.0
    numbers |= _named("second_moments", second.items(), _largest(second.values()), bound)
    return numbers | _moments(entry.get("moments") or {})


def _named(
    name: str, values: Iterable[tuple[str, float | None]], size: float, bound: float
) -> dict[str, Number]:
    """Return the components of a vector or a tensor by their names."""
    return {"{}[{}]".format(name, key): Number(value, size, bound) for key, value in values}


def _tensor(name: str, tensor: Matrix, bound: float) -> dict[str, Number]:
    pairs = [("xyz"[i] + "xyz"[j], tensor[i][j]) for i in range(3) for j in range(i, 3)]
    return _named(name, pairs, _largest(sum(tensor, [])), bound)


def _largest(values: Iterable[float | None]) -> float:
    return max(abs(value or 0.0) for value in values)


def _number(value: float | None) -> float:
    return math.nan if value is None else float(value)


def _moments(moments: dict[str, Any]) -> dict[str, Number]:
    """Return the moments of a record by their names. Each is relative to the largest moment of its
    degree.
    """
    numbers: dict[str, Number] = {}
    for domain in (name for name in _DOMAINS if name in moments):
        bounds = [moments.get(part, {}).get(domain, {}) for part in ("error", "input")]
        degrees: dict[int, dict[str, float | None]] = {}
        for powers, value in moments[domain].items():
            degrees.setdefault(sum(map(int, powers.split(","))), {})[powers] = value
        for values in degrees.values():
            size = _largest(values.values())
            numbers |= {
                "moments.{}[{}]".format(domain, powers): Number(
                    value,
                    size,
                    sum(errors.get(powers) or 0.0 for errors in bounds),
                )
                for powers, value in values.items()
            }
    return numbers


def _product(first: Matrix, second: Matrix) -> Matrix:
    return [[sum(a * b for a, b in zip(row, column)) for column in zip(*second)] for row in first]


def _bound(entry: dict[str, Any], name: str) -> float:
    """Return the bound of a number's error. Mass and density have the relative bound of the volume,
    else of the area: either may follow from it, and a given one does not differ.
    """
    if name in ("mass", "density", "linear_density"):
        measure = "volume" if entry["volume"] else "area"
        size = entry[measure]
        return _bound(entry, measure) / abs(size) * abs(entry[name] or 0.0) if size else 0.0
    return bound_of(entry, name) or 0.0


def _bound_about(entry: dict[str, Any], distance: float) -> float:
    """Return the bound of an inertia about a point at a distance d from the center: of I + m d²,
    to the first order, with d as uncertain as the center.
    """
    shift = distance * _bound(entry, "mass") + 2.0 * (entry["mass"] or 0.0) * _bound(
        entry, "center_of_mass"
    )
    return _bound(entry, "inertia") + distance * shift
