# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A report that a person reads, in the order of CAD dialogs: verdict, mass, volume, center,
principal axes, tensor.

It is made from a document (`documents.document`); results stored on objects become a document
first.
"""

from collections.abc import Callable, Collection, Iterator, Sequence
from itertools import starmap
from math import sqrt
from typing import Any

from ...core import measurement, verdict, wall
from ...core.inertia import TENSOR, PlainBody, add_bodies, principal_axes, tensor_rows
from ...core.verdict import Finding, ReadError, finding
from ..scale import meters_per_unit
from . import properties
from .findings import NO_STORED_RESULTS, STALE_RESULTS
from .units import INDENT, clean, report_line, report_number, report_vector, rounded_up

BOUNDS = {"volume": "m³", "area": "m²", "center_of_mass": "m", "inertia": "kg·m²"}


def stored_document(
    context: Any,
    objects: Sequence[Any],
    outdated: Collection[str] = (),
    caveats: Sequence[Finding] = (),
    file: str | None = None,
    blender: str | None = None,
    place_error: Callable[[Any], float] | None = None,
) -> dict[str, Any]:
    """Return the document of the results stored on objects, in the scene's frame; their health is
    not stored.

    outdated: names. caveats: about the total. place_error: how far rounding may have moved an
    object, in Blender units.
    """
    scene = context.scene
    unit = meters_per_unit(scene)
    frame = scene.body_moments.frame.lower()
    entries = []
    bodies = []
    errors = []
    for obj in objects:
        stored = properties.stored(obj)
        if stored is None:
            errors.append({"name": obj.name, "reason": ReadError(NO_STORED_RESULTS).reason})
            continue
        world = stored.in_world(obj.matrix_world, unit)
        bodies.append(world)
        entry = _stored_record(obj, world if frame == "world" else stored, obj.name in outdated)
        if frame == "world" and place_error is not None:
            inputs = entry["error_bound"]["input"]
            inputs["center_of_mass"] += place_error(obj) * unit
        entries.append(entry)
    total = _stored_total(entries, bodies) | measurement.described(caveats)
    return measurement.document(entries, total, errors, file=file, blender=blender, frame=frame)


def text(file_document: dict[str, Any]) -> str:
    """Return a document as plain text, with its units and conventions stated."""
    lines = ["Mass properties, SI units, {} frame".format(file_document["frame"])]
    if file_document["file"]:
        lines.append("File: {}".format(file_document["file"]))
    for entry in file_document["objects"]:
        lines += [
            "",
            entry["name"],
            *starmap(report_line, _report_rows(entry, file_document["frame"])),
        ]
    if len(file_document["objects"]) > 1:
        lines += [
            "",
            "Total of {} objects, world frame".format(len(file_document["objects"])),
            *starmap(report_line, _report_rows(file_document["total"], "world")),
        ]
    for heading, entries in (
        ("Left out", file_document["left_out"]),
        ("Not measured", file_document["errors"]),
    ):
        lines += ["", heading] if entries else []
        lines += [
            "{}{}: {}".format(INDENT, entry["name"] or "File", entry["reason"]) for entry in entries
        ]
    return "".join(measurement.visible(line) + "\n" for line in lines)


def _report_rows(entry: dict[str, Any], frame: str) -> Iterator[tuple[str, ...]]:
    """Yield the label, value and unit of each line about a record, as far as it has them."""
    if "method" in entry:
        has_wall = any(record["code"] == wall.WALL_MEASURED for record in entry.get("findings", ()))
        method = verdict.method_key(verdict.Method.parse(entry["method"]), has_wall)
        _, explanation = verdict.METHODS.get(method, ("", ""))
        yield "Verdict", ": ".join(filter(None, (entry["method"], explanation)))
        counts = ", ".join(_counts(entry.get("health", {})))
        if counts:
            yield "Found", counts
        yield "Kind", "{}, {}".format(entry["kind"], entry["type"].lower())
    for label, name, unit in (
        ("Mass", "mass", "kg"),
        ("Length", "length", "m"),
        ("Linear density", "linear_density", "kg/m"),
        ("Density", "density", "kg/m³"),
    ):
        if name in entry and (name != "density" or "length" not in entry):
            yield label, report_number(entry[name]), unit
    if "density_from" in entry:
        yield "Density from", entry["density_from"]
    yield "Volume", report_number(entry["volume"]), "m³"
    yield "Surface area", report_number(entry["area"]), "m²"
    if "display_mesh" in entry:
        display = entry["display_mesh"]
        volume = entry["volume"]
        share = 100.0 * display["difference"] / volume if volume else 0.0
        display_volume = report_number(display["volume"])
        yield "Its display mesh", "{} m³, {:+.3g} %".format(display_volume, share)
    if entry["center_of_mass"] is None or entry["inertia"] is None:
        return
    size = entry.get("length") or abs(entry["volume"] or 0.0) ** (1.0 / 3.0)
    center = report_vector(entry["center_of_mass"], size)
    yield "Center of mass", center, "m, {} frame".format(frame)
    yield from _principal(entry)
    yield from _tensor(entry["inertia"], frame)
    yield from _bounds(entry.get("error_bound", {}))
    for message in entry.get("warnings", []):
        yield "Warning", message
    for message in entry.get("notes", []):
        yield "Note", message


def _counts(health: dict[str, Any]) -> Iterator[str]:
    for name, (singular, plural) in verdict.HEALTH.items():
        elements = health.get(name, 0)  # a list of them, or their number
        count = len(elements) if isinstance(elements, list) else elements
        if count:
            yield "{} {}".format(count, singular if count == 1 else plural)


def _principal(entry: dict[str, Any]) -> Iterator[tuple[str, ...]]:
    moments = entry["principal_moments"]
    axes = entry.get("principal_axes")
    symmetry = ", {}".format(entry["symmetry"]) if entry.get("symmetry") else ""
    yield "Principal moments", "about the center of mass, kg·m²{}".format(symmetry)
    for i, moment in enumerate(moments):
        along = "  along {}".format(report_vector([row[i] for row in axes])) if axes else ""
        yield "  I{}".format(i + 1), report_number(moment) + along
    if entry["mass"]:
        radii = [
            None if moment is None else sqrt(max(moment, 0.0) / entry["mass"]) for moment in moments
        ]
        yield "Radii of gyration", report_vector(radii), "m"


def _tensor(inertia: list[list[float]], frame: str) -> Iterator[tuple[str, ...]]:
    axes = "about the center of mass, {} axes".format(frame)
    yield "Inertia tensor", axes + ", kg·m² (entries: Ixy = −∫ρxy dV)"
    values = clean([inertia[i][j] for _, i, j in TENSOR])
    for row in (slice(0, 3), slice(3, 6)):
        cells = [
            "I{} {:<16}".format(name, report_number(value))
            for (name, *_), value in zip(TENSOR[row], values[row])
        ]
        yield "", "".join(cells)


def _bounds(bounds: dict[str, Any]) -> Iterator[tuple[str, ...]]:
    for label, values in (
        ("Errors, estimated" if bounds.get("estimated") else "Rounding, at most", bounds),
        ("float32 coordinates", bounds.get("input", {})),
    ):
        parts = [
            "{} {:.1e} {}".format(name.replace("_", " "), rounded_up(values[name]), unit)
            for name, unit in BOUNDS.items()
            if values.get(name) is not None
        ]
        if any(values.get(name) for name in BOUNDS):
            yield label, ", ".join(parts)


def _stored_record(obj: Any, stored: PlainBody, outdated: bool) -> dict[str, Any]:
    """Return the record of an object's stored results, with an empty health, which is not
    stored.
    """
    method = properties.method(obj)
    findings = properties.findings(obj)
    kinds = {verdict.Procedure.SHELL: "shell", verdict.Procedure.WIRE: "wire"}
    source = properties.density_from(obj)
    if outdated:
        findings = (finding(STALE_RESULTS), *findings)
    entry = {
        "name": obj.name,
        "type": obj.type,
        "kind": "solid" if method is None else kinds.get(method.procedure, "solid"),
        "method": properties.method_text(obj),
        "density": stored.density,
        **({"density_from": source} if source else {}),
        "mass": stored.mass,
        "volume": stored.volume,
        "area": stored.area,
        "center_of_mass": stored.center,
        "inertia": tensor_rows(stored.inertia),
        "principal_moments": stored.moments,
        "principal_axes": tuple(zip(*stored.axes)),
        "symmetry": None,
        "health": {},
        "error_bound": {
            **stored.error_bound,
            **({"estimated": True} if properties.is_estimated(obj) else {}),
        },
        **measurement.described(findings),
    }
    length, display = (properties.optional(obj, key) for key in properties.OPTIONAL)
    if length is not None:
        entry |= {"length": length, "linear_density": stored.mass / length}
    if display is not None:
        entry["display_mesh"] = {"volume": display, "difference": display - stored.volume}
    return measurement.plain(entry)


def _stored_total(entries: Sequence[dict[str, Any]], bodies: Sequence[PlainBody]) -> dict[str, Any]:
    """Return the sum of stored results, world frame, without axes, whose signs need third
    moments.
    """
    total = {name: sum(entry[name] for entry in entries) for name in ("mass", "volume", "area")}
    total |= dict.fromkeys(("center_of_mass", "inertia", "principal_moments"))
    whole = add_bodies(bodies)
    if whole is not None:
        total |= {"center_of_mass": whole.center, "inertia": tensor_rows(whole.inertia)}
        total |= {"principal_moments": whole.moments, "symmetry": principal_axes(whole.inertia)[2]}
    return measurement.plain(total)
