# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The stored results as ID properties of an object: the public contract for drivers, rigs and
exporters.

SI units, object frame (the object's location and rotation, unit scale). Inertia is six tensor
entries about the center of mass, xx, yy, zz, xy, xz, yz, with xy = -∫xy dm.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Sequence
from functools import lru_cache
from math import isfinite
from typing import Any

import bpy

from ... import core
from ...core.inertia import BOUND_KEYS, COLUMNS, ROWS, PlainBody, rotation_axes
from ...core.measurement import UNIFORM_DENSITIES, plain
from ...core.verdict import (
    LINKED_OBJECT,
    EditRefusedError,
    Finding,
    Method,
    Procedure,
    Severity,
    Source,
    of_severity,
    sentence,
)

DESCRIPTIONS = {
    "body_mass": "Mass in kg",
    "body_density": "Mean density in kg/m³",
    "body_volume": "Volume in m³",
    "body_area": "Surface area in m²",
    "body_center_of_mass": "Center of mass in {frame}, in m",
    "body_inertia": "Inertia tensor xx, yy, zz, xy, xz, yz about the center of mass, along the "
    "axes of {frame}, "
    "in kg·m² (xy = −∫xy dm)",
    "body_inertia_diagonal": "Inertia tensor xx, yy, zz, as in body_inertia, in kg·m²",
    "body_inertia_products": "Inertia tensor xy, xz, yz, as in body_inertia, in kg·m²",
    "body_principal_moments": "Principal moments of inertia, ascending, in kg·m²",
    "body_principal_axes": "Quaternion w, x, y, z that turns the axes of {frame} into the "
    "principal axes",
    "body_error_bound": "What rounding may have changed: volume, area, center of mass, inertia; "
    "then the same four for what storing coordinates as float32 may have",
    "body_density_from": "Where the density came from",
    "body_materials": "The materials that the density came from, one a line",
    "body_material_volume": "Volume of the material in a print, in m³",
    "body_price": "Price of the material in a print",
    "body_method": "How the numbers came about",
    "body_warnings": "Warnings in English, one a line",
    "body_findings": "What was found and decided, as JSON: codes, values and the first elements",
    "body_length": "Length of a wire in m",
    "body_display_volume": "What the display mesh of a NURBS surface would have given as its "
    "volume, in m³",
    "body_fingerprint": "What the numbers were computed from",
    "body_reference": "What body_reference_inertia is about, as JSON",
    "body_reference_origin": "Origin of the reference in the world, in m",
    "body_reference_axes": "Quaternion w, x, y, z that turns the world axes into those of the "
    "reference",
    "body_reference_center": "Center of mass from the origin of the reference, along its axes, in "
    "m",
    "body_reference_inertia": "Inertia tensor xx, yy, zz, xy, xz, yz about the origin of the "
    "reference, along its "
    "axes, in kg·m² (xy = −∫xy dm)",
    "body_reference_error_bound": "What rounding may have changed: center of mass, inertia; then "
    "the same two for what "
    "storing coordinates as float32 may have",
    "body_axis_inertia": "Moment of inertia about the axis of the reference, in kg·m²",
}
REFERENCE_KEYS = ("body_reference", "body_axis")  # beginnings: results about a reference
FRAMES = {  # by the type of the owner of results
    bpy.types.Object: "the object's frame (location and rotation, unit scale)",
    bpy.types.Collection: "the world",
    bpy.types.PoseBone: "the bone's rest frame (head and axes, unit scale)",
}
Owner = bpy.types.Object | bpy.types.Collection | bpy.types.PoseBone
FIELDS = {  # the fields of `PlainBody` that the properties hold, and the properties' lengths
    "body_mass": ("mass", 0),
    "body_density": ("density", 0),
    "body_volume": ("volume", 0),
    "body_area": ("area", 0),
    "body_center_of_mass": ("center", 3),
    "body_inertia": ("inertia", 6),
    "body_principal_moments": ("moments", 3),
    "body_principal_axes": ("axes", 4),
    "body_error_bound": ("error_bound", 8),
}
# on an empty that shows a group: the names of its objects, one a line
BALANCE_GROUP = "body_balance_group"
# on it: first frame, last frame, N·s and N·m·s from nothing, span after span
BALANCE_SPANS = "body_balance_spans"
# for wires, and for bodies measured without their display mesh
OPTIONAL = ("body_length", "body_display_volume")
ROUNDING = 2.0**-52  # relative, for a product of two rounded numbers


def store(obj: Owner, measurement: core.measurement.Measurement) -> None:
    """Write all results on an object, a collection or a pose bone.

    Raises EditRefusedError if it cannot hold them.
    """
    store_values(obj, next(values_of(measurement)))


def values_of(measurement: core.measurement.Measurement) -> Iterator[dict[str, Any]]:
    """Yield the properties that hold a measurement, or each one of a stack."""
    body = measurement.in_object_frame()
    bound = measurement.error_bound
    bounds = [source[name] for source in (bound, bound["input"]) for name in BOUND_KEYS]
    columns = {
        "body_mass": body.mass,
        "body_density": measurement.density,
        "body_volume": measurement.volume,
        "body_area": measurement.area,
        "body_center_of_mass": body.center,
        "body_inertia": body.inertia[..., ROWS, COLUMNS],
        "body_principal_moments": body.principal.moments,
        "body_principal_axes": body.principal.quaternion,
    }
    # lists with one entry for each member of a stack; of one object, single values
    numbers = [
        column.tolist() if hasattr(column, "tolist") else column
        for column in (*columns.values(), *bounds)
    ]
    # In a stack, these are lists, too.
    texts = measurement.method, measurement.findings, measurement.fingerprint
    is_stack = isinstance(measurement.findings, list)
    rows = zip(*numbers, *texts) if is_stack else [(*numbers, *texts)]
    verdicts: dict[tuple[str, tuple[int, ...]], dict[str, Any]] = {}
    for *row, method, findings, fingerprint in rows:
        key = str(method), tuple(map(id, findings))
        if key not in verdicts:  # most members have the same
            verdicts[key] = {
                "body_method": key[0],
                "body_warnings": warning_lines(findings),
                "body_findings": findings_text(findings),
            }
        values = dict(zip(columns, row))
        values["body_error_bound"] = row[len(columns) :]
        values |= verdicts[key]
        values["body_fingerprint"] = fingerprint
        yield values if is_stack else values | _special_values(measurement)


def _special_values(measurement: core.measurement.Measurement) -> dict[str, Any]:
    """Return the properties of wires, prints, varying densities and B-spline patches."""
    values: dict[str, Any] = {
        key: getattr(measurement, key.removeprefix("body_")) for key in OPTIONAL
    }
    if measurement.density_from not in UNIFORM_DENSITIES:
        values["body_density_from"] = str(measurement.density_from)
        values["body_materials"] = "\n".join(measurement.materials) or None
    if measurement.printed is not None:
        values["body_material_volume"] = measurement.printed["material_volume"]
        values["body_price"] = measurement.printed.get("price")
    return {key: value for key, value in values.items() if value is not None}


def store_values(obj: Owner, values: dict[str, Any]) -> None:
    """Replace all results by `values`, or none if Blender cannot hold one of them. The tensor is
    stored a second time in two parts, which are added to `values`.
    """
    require_storable(obj)
    entries = values["body_inertia"]
    values |= {"body_inertia_diagonal": entries[:3], "body_inertia_products": entries[3:]}
    for key, value in values.items():
        if not isinstance(value, (float, str, list)):
            raise TypeError("{}: {!r}".format(key, value))
    for key in DESCRIPTIONS:
        if key in values:
            _set(obj, key, values[key])
        elif key in obj:
            del obj[key]
    retrigger_drivers(obj)


def store_scaled(
    obj: Owner, density: float, mass: float, findings: Sequence[Finding], fingerprint: str
) -> None:
    """Scale stored finite results to another density: mass, inertia and its bounds. density: mean,
    0 for a wire.
    """
    factor = mass / obj["body_mass"]
    for key in DESCRIPTIONS:
        if key.startswith(("body_inertia", "body_principal_moments")):
            obj[key] = [factor * value for value in obj[key]]
    # the bounds of inertia: of rounding, and of float32
    bounds = list(obj["body_error_bound"])
    # The principal moments are scaled already; their sum bounds each entry, which is rounded anew.
    bounds[3] = factor * bounds[3] + ROUNDING * sum(obj["body_principal_moments"])
    bounds[7] *= factor
    obj["body_error_bound"] = bounds
    obj["body_mass"] = mass
    obj["body_density"] = density
    obj["body_fingerprint"] = fingerprint
    store_findings(obj, findings)
    retrigger_drivers(obj)


def store_body(obj: Owner, body: PlainBody, fingerprint: str) -> None:
    """Replace the numbers of stored results, in the object frame; method and findings stay."""
    bound = body.error_bound
    quaternion = core.numerics.rotations.quaternion([list(axis) for axis in zip(*body.axes)])
    values = {key: getattr(body, field) for key, (field, _) in FIELDS.items()} | {
        "body_principal_axes": quaternion.tolist(),
        "body_error_bound": [
            source[name] for source in (bound, bound["input"]) for name in BOUND_KEYS
        ],
        "body_inertia_diagonal": body.inertia[:3],
        "body_inertia_products": body.inertia[3:],
        "body_fingerprint": fingerprint,
    }
    for key, value in values.items():
        obj[key] = value
    retrigger_drivers(obj)


def _set(obj: Owner, key: str, value: object) -> None:
    is_new = key not in obj  # an old property has its description already
    obj[key] = value
    if is_new and not isinstance(value, str):
        description = DESCRIPTIONS[key].format(frame=FRAMES[type(obj)])
        obj.id_properties_ui(key).update(description=description, precision=6)


def store_reference(obj: Owner, values: dict) -> None:
    """Write results about a reference, in place of earlier ones, or raise EditRefusedError."""
    require_storable(obj)
    for key in DESCRIPTIONS:
        if key.startswith(REFERENCE_KEYS) and key not in values and key in obj:
            del obj[key]
    for key, value in values.items():
        _set(obj, key, value)


def require_storable(obj: Owner) -> None:
    """Raise EditRefusedError for an owner that cannot store results."""
    data = obj.id_data
    # A file does not keep new ID properties of a library override.
    if not data.is_editable or data.override_library is not None:
        raise EditRefusedError(LINKED_OBJECT, subject=data.name_full)


def clear(obj: Owner) -> bool:
    """Remove all results; return whether there were any."""
    present = [key for key in DESCRIPTIONS if key in obj]
    for key in present:
        del obj[key]
    if present:
        retrigger_drivers(obj)
    return bool(present)


def retrigger_drivers(obj: Owner) -> None:
    """Make Blender evaluate only the drivers that read the stored results.

    Update tags do more: TIME evaluates the object's animation, which reverts unkeyed changes;
    OBJECT evaluates dependents of its place, such as Booleans with this operand. If a property that
    is only drawn is set, Blender copies the object for evaluation, and then looks at its custom
    properties.
    """
    if isinstance(obj, bpy.types.Collection):
        obj.color_tag = obj.color_tag
    else:
        obj.id_data.show_name = obj.id_data.show_name


def is_stored(obj: Owner) -> bool:
    return stored(obj) is not None


def method(obj: Owner) -> Method | None:
    """Return the method of the stored numbers; None without numbers, and for a method of another
    version.
    """
    return Method.parse(method_text(obj))


def method_text(obj: Owner) -> str:
    """Return the method as it is stored, "" if there are no numbers."""
    return str(obj.get("body_method", ""))


def fingerprint(obj: Owner) -> str:
    """Return the stamp of the numbers' inputs (session/tracking/stamps.py) as text, "" if there is
    none.
    """
    return str(obj.get("body_fingerprint", ""))


def findings(obj: Owner) -> tuple[Finding, ...]:
    """Return the findings of the stored measurement; see `findings_in`."""
    return findings_in(obj.get("body_findings"))


def store_findings(obj: bpy.types.Object, findings: Sequence[Finding]) -> None:
    """Replace the stored findings and warnings, for example after a finding was accepted."""
    obj["body_findings"] = findings_text(findings)
    obj["body_warnings"] = warning_lines(findings)


def warning_lines(findings: Iterable[Finding]) -> str:
    """Return the English sentences of the warnings, one a line."""
    return "\n".join([sentence(finding) for finding in of_severity(findings, Severity.WARNING)])


def findings_text(findings: Iterable[Finding]) -> str:
    """Return findings as JSON text, to be read by `findings_in`."""
    return json.dumps([plain(finding.as_record()) for finding in findings], ensure_ascii=False)


def findings_in(text: object) -> tuple[Finding, ...]:
    """Return the findings in a stored text that can be put into words; none if `findings_text` did
    not write it.
    """
    return _findings_in(text) if isinstance(text, str) else ()


@lru_cache(maxsize=256)  # panels ask for them at every redraw
def _findings_in(text: str) -> tuple[Finding, ...]:
    try:
        findings = tuple(Finding.from_record(record) for record in json.loads(text))
    except (ValueError, TypeError, KeyError, AttributeError, RecursionError):
        return ()
    return tuple(finding for finding in findings if _has_sentence(finding))


def _has_sentence(finding: Finding) -> bool:
    try:
        return bool(sentence(finding))
    except (ValueError, TypeError, KeyError, IndexError, AttributeError, RecursionError):
        return False


def is_estimated(obj: bpy.types.Object) -> bool:
    """Return whether the stored bounds are estimates, as for splines and for solids filled with a
    grid.
    """
    stored_method = method(obj)
    if stored_method is None:
        return False
    is_filled = stored_method.source == Source.GRID and obj.type != "VOLUME"
    is_smooth = stored_method.source == Source.NURBS or stored_method.procedure == Procedure.WIRE
    return is_filled or is_smooth


def optional(obj: Owner, key: str) -> float | None:
    """Return the value of a key in OPTIONAL, or None if the object does not have it."""
    value = obj.get(key)
    return value if isinstance(value, float) else None


def density_from(obj: Owner) -> str:
    """Return the source of the stored numbers' density, "" if the density is uniform."""
    return str(obj.get("body_density_from", ""))


def stored(obj: Owner) -> PlainBody | None:
    """Return the stored results, in the object frame; None if one is missing or (except error
    bounds) not finite.
    """
    values: dict[str, Any] = {}
    for key, (field, length) in FIELDS.items():
        value = obj.get(key)
        try:
            numbers = tuple(map(float, value)) if length else (float(value),)
        except (TypeError, ValueError):  # absent, or overwritten by something else
            return None
        is_usable = key == "body_error_bound" or all(map(isfinite, numbers))
        if len(numbers) != max(length, 1) or not is_usable:
            return None
        values[field] = numbers if length else numbers[0]
    bounds = values["error_bound"]
    rounding, inputs = (dict(zip(BOUND_KEYS, bounds[i : i + 4])) for i in (0, 4))
    values |= {"axes": rotation_axes(values["axes"]), "error_bound": rounding | {"input": inputs}}
    return PlainBody(**values)
