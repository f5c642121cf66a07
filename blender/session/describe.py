# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Results as plain data, for scripts and agents that run inside Blender."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from math import inf
from typing import Any

import bpy
from bpy.types import Object

from ...core.measurement import FRAMES, record
from ...core.verdict import internal_error
from .. import bodies, settings, write
from .stored import density, results

WORDS = {
    "kind": ("solid", "shell", "printed", "wire"),
    "overlap": ("signed", "union"),
    "wall": ("thin", "inward", "outward", "centered"),
}
QUANTITIES = ("density", "mass", "thickness", "unit_scale")
MAX_ELEMENTS = 8  # elements of a finding; a record of the command line has more
UNITS = {
    "mass": "kg",
    "density": "kg/m³",
    "volume": "m³",
    "area": "m²",
    "center_of_mass": "m",
    "inertia": "kg·m²",
    "principal_moments": "kg·m²",
}
NUMBERS = (*UNITS, "principal_axes", "symmetry")
CALL = "bpy.ops.{}()"


def describe(
    objects: Object | str | Iterable[Object | str] | None = None,
    *,
    frame: str = "world",
    store: bool = False,
    **options: Any,
) -> list[dict[str, Any]]:
    """Measure objects and return one dictionary for each, which json.dumps can write.

    Parameters
    ----------
    objects : Object or str, or several of them
        Objects or their names; by default the selected objects.
    frame : {"world", "object"}
        The frame of center, inertia and axes.
    store : bool
        Stores the results on the objects, as *Measure* does. Otherwise nothing in the file changes.
    **options
        Override the objects' settings: kind ("solid", "shell", "printed", "wire"), density
        (kg/m³), mass (kg), thickness (m), overlap ("signed", "union"), wall ("thin", "inward",
        "outward", "centered"), unit_scale (meters per unit).

    Returns
    -------
    list of dict
        Each has `name`, `verdict` ("exact", "repaired", "doubtful" or "not measured"), `numbers`,
        `units`, `error_bound` (by quantity, in its unit), `findings` (each with `message` and
        `remedies`, which are calls) and `next`, the calls that make sense now. Calls of operators
        act on the selected objects.

    Raises
    ------
    ValueError
        If an object, a frame or an option does not exist, or an option has a wrong value.
    """
    if frame not in FRAMES:
        raise ValueError(
            "frame must be one of {}, not {!r}".format(", ".join(map(repr, FRAMES)), frame)
        )
    _check(options)
    subjects = _objects_named(objects)
    outcomes = [
        pair
        for batch in bodies.measure_object.measure_many(
            subjects,
            bpy.context.evaluated_depsgraph_get(),
            settings.options.MeasureOptions(**options),
        )
        for pair in batch
    ]
    if store:
        measured = [
            (obj, outcome) for obj, outcome in outcomes if not isinstance(outcome, Exception)
        ]
        refused = results.store_measured(bpy.context, measured)
        outcomes = [(obj, refused.get(obj, outcome)) for obj, outcome in outcomes]
    is_overridden = "density" in options or "mass" in options
    return [_description(obj, outcome, frame, store, is_overridden) for obj, outcome in outcomes]


def _check(options: dict[str, Any]) -> None:
    """Raise ValueError for an unknown option, and for a value that it cannot have."""
    for name, value in options.items():
        if name in WORDS:
            is_right = value in WORDS[name]
            expected = "one of " + ", ".join(map(repr, WORDS[name]))
        elif name in QUANTITIES:
            is_right = isinstance(value, (int, float)) and 0.0 < value < inf
            expected = "a positive number in SI units"
        else:
            raise ValueError(
                "no option is called {!r}; there are {}".format(
                    name, ", ".join((*WORDS, *QUANTITIES))
                )
            )
        if not is_right:
            raise ValueError("{} must be {}, not {!r}".format(name, expected, value))


def _objects_named(objects: Object | str | Iterable[Object | str] | None) -> list[Object]:
    """Return the objects, each once; by default the selected ones. Raises ValueError if one is not
    in the view layer.
    """
    if objects is None:
        return list(bpy.context.view_layer.objects.selected)  # also without a window
    several: Iterable[Any] = [objects] if isinstance(objects, (Object, str)) else objects
    layer_objects = bpy.context.view_layer.objects
    named: dict[Object, None] = {}
    for object_or_name in several:
        is_name = isinstance(object_or_name, str)
        name = object_or_name if is_name else object_or_name.name
        if name not in layer_objects:
            raise ValueError("no object of this view layer is called {!r}".format(name))
        # A given object is not looked up by its name, which a linked object may have, too.
        named[layer_objects[name] if is_name else object_or_name] = None
    return list(named)


def _description(
    obj: Object,
    outcome: bodies.stack.Measured | Exception,
    frame: str,
    is_stored: bool,
    is_overridden: bool,
) -> dict[str, Any]:
    """Return the dictionary of one object. is_overridden: whether an option replaces its density or
    mass, so that no note on an unset density is added.
    """
    if isinstance(outcome, Exception):
        entry: dict[str, Any] = {
            "name": obj.name,
            "verdict": "not measured",
            "numbers": None,
            "error_bound": None,
        }
        entry |= record.described([internal_error.finding_of(outcome)])
    else:
        measurement = (
            outcome.measurement
            if is_overridden
            else density.noted(obj, outcome.measurement, bpy.context.scene)
        )
        entry = record.record(replace(measurement, name=obj.name), frame)
        entry["numbers"] = {name: entry[name] for name in NUMBERS}
    findings = [
        record_finding
        | {
            "elements": record_finding.get("elements", [])[:MAX_ELEMENTS],
            "remedies": [
                _call(remedy)
                for remedy in write.remedies.remedies_of(record_finding["code"], obj.type)
            ],
        }
        for record_finding in entry["findings"]
    ]
    calls = [
        call
        for record_finding in findings
        if record_finding["severity"] != "note"
        for call in record_finding["remedies"]
    ]
    if not is_stored and entry["numbers"] is not None:
        calls.append("describe({!r}, store=True)".format(obj.name))
    entry_names = ("name", "verdict", "method", "kind", "numbers", "error_bound")
    return {name: entry[name] for name in entry_names if name in entry} | {
        "units": UNITS,
        "frame": frame,
        "findings": findings,
        "next": [*dict.fromkeys(calls)],
    }


def _call(remedy: str) -> str:
    """Return the call of a remedy: of Repair, which has several, or of the operator so named."""
    return (
        "bpy.ops.{}(remedy={!r})".format(write.remedies.REPAIR, remedy)
        if remedy in write.remedies.REMEDIES
        else CALL.format(remedy)
    )
