# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measurements as records, the parts of a document (`documents.py`). A public contract, `body-moments/1`.

All numbers are SI. Centers, tensors, axes and moments are in the world frame or in each
object's own frame (its location and rotation, unit scale); objects do not share their frames, so
the total is always in the world frame. A number that is not finite is written as null, never as NaN
or Infinity, which are not JSON.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from contextlib import suppress
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..inertia.mass_properties import MassProperties, combine
from ..moments.exponents import order_from_count
from ..moments.moments import Moments, monomials
from ..verdict.finding import Finding, MeasureError, Severity
from ..verdict.sentences import sentence, severity
from .documents import plain
from .measurement import UNIFORM_DENSITIES, Measurement
from .trust import trust_of

MAX_ELEMENTS = 1000  # Limit for one finding.


def record(
    measurement: Measurement,
    frame: str = "world",
    order: int | None = None,
    surface: Moments | None = None,
    more: dict[str, Any] | None = None,
    about: str | Sequence[float] | None = None,
) -> dict[str, Any]:
    """Return one object's record.

    frame: "world" or "object". order: adds `moments`, volume moments up to that order, which the
    measurement must have, about the frame's origin; of a thin shell, area moments times thickness.
    surface: its area moments, world frame, listed beside them. more: further entries. about: "center", "origin",
    "world", or a point in the frame: adds `inertia_about`, and the moments are about it.
    """
    properties = measurement.mass_properties if frame == "world" else measurement.in_object_frame()
    entry = {
        "name": measurement.name,
        "type": measurement.type,
        "kind": measurement.kind,
        "verdict": str(trust_of(measurement.method, measurement.findings)),
        "method": str(measurement.method),
        "density": measurement.density,
        **({} if measurement.density_from in UNIFORM_DENSITIES else {"density_from": str(measurement.density_from)}),
        "mass": properties.mass,
        "volume": measurement.volume,
        "area": measurement.area,
        **({"thickness": measurement.thickness} if measurement.kind == "shell" else {}),
        **_inertial(properties),
    }
    if measurement.length is not None:
        entry |= {
            "density": None,  # a wire has none, and no volume
            "length": measurement.length,
            "linear_density": properties.mass / measurement.length,
        }
    point = _point(about, measurement, properties, frame)
    if about is not None:
        entry["inertia_about"] = {"point": point, "inertia": properties.inertia_about(point)}
    if order is not None:
        volume = measurement.volume_moments
        if volume is None:
            volume = measurement.area_moments * measurement.thickness
        domains = {"volume": volume.truncate(order)}
        length = None if measurement.length is None else measurement.mass_moments[0]
        if length is not None:
            domains["length"] = length.truncate(min(order, length.order))
        if surface is not None:
            domains["surface"] = surface.truncate(order)
        mass = measurement.moments_of_mass(order if length is None else min(order, length.order))
        if mass is not None:
            domains["mass"] = mass
        placed = {name: _about(point, moments, measurement, frame) for name, moments in domains.items()}
        entry["moments"] = {
            "order": order,
            "about": point,
            **{name: _by_powers(moments.raw) for name, moments in placed.items()},
            "error": {name: _by_powers(moments.rounding_error) for name, moments in placed.items()},
            "input": {name: _by_powers(moments.input_error) for name, moments in placed.items()},
        }
    entry |= more or {}
    if measurement.display_volume is not None:
        entry["display_mesh"] = {
            "volume": measurement.display_volume,
            "difference": measurement.display_volume - measurement.volume,
        }
    entry["health"] = measurement.health.as_record()
    entry["error_bound"] = measurement.error_bound
    return plain(entry) | described(measurement.findings)


def described(findings: Iterable[Finding]) -> dict[str, list]:
    """Return a record's `findings` as data, and their messages: `notes` for notes, `warnings` for severer ones."""
    entry = {"findings": [], "warnings": [], "notes": []}
    add_findings(entry, findings)
    return entry


def add_findings(entry: dict[str, Any], findings: Iterable[Finding]) -> None:
    """Add findings to a record, unless it has them already."""
    for finding in findings:
        record = _finding_record(finding)
        if record not in entry["findings"]:
            entry["findings"].append(record)
            entry["notes" if record["severity"] == Severity.NOTE else "warnings"].append(record["message"])


def _finding_record(finding: Finding) -> dict[str, Any]:
    """Return a finding as data: code, severity, message, values, and the first elements if there are any."""
    entry = {
        "code": finding.code,
        "severity": str(severity(finding)),
        "message": sentence(finding),
        "values": finding.values,
    }
    first = finding.elements[:MAX_ELEMENTS]
    return plain({**entry, "elements": first} if len(first) else entry)


def total(measurements: Sequence[Measurement], findings: Iterable[Finding] = ()) -> dict[str, Any]:
    """Return the `total` entry: all objects as one body in the world frame, and findings about it."""
    entry = {
        "mass": math.fsum(measurement.mass_properties.mass for measurement in measurements),
        "volume": math.fsum(measurement.volume for measurement in measurements),
        "area": math.fsum(measurement.area for measurement in measurements),
        **dict.fromkeys(("center_of_mass", "inertia", "principal_moments", "principal_axes", "symmetry")),
    }
    if measurements:
        with suppress(MeasureError):  # together they have no mass, and so no center
            entry.update(_inertial(combine([measurement.mass_moments for measurement in measurements])))
    return plain(entry) | described(findings)


def _inertial(properties: MassProperties) -> dict[str, Any]:
    principal = properties.principal
    return {
        "center_of_mass": properties.center,
        "inertia": properties.inertia,
        "principal_moments": principal.moments,
        "principal_axes": principal.axes,
        "symmetry": principal.symmetry,
        "principal_axes_unique": principal.is_unique,
    }


def _point(
    about: str | Sequence[float] | None, measurement: Measurement, properties: MassProperties, frame: str
) -> NDArray[np.float64]:
    """Return the (3,) coordinates of the point `about` in the frame, by default the frame's origin."""
    if about == "center":
        return properties.center
    if about == "origin" and frame == "world":
        return np.asarray(measurement.location, np.float64)
    if about == "world" and frame == "object":
        return -measurement.rotation.T @ measurement.location
    return np.zeros(3) if about is None or isinstance(about, str) else np.asarray(about, np.float64)


def _about(point: NDArray[np.float64], moments: Moments, measurement: Measurement, frame: str) -> Moments:
    """Return world-frame moments about a point of a frame and along the frame's axes."""
    if frame == "object":
        return moments.in_frame(measurement.rotation, measurement.location + measurement.rotation @ point)
    return moments.about_point(point)


def _by_powers(values: NDArray[np.float64]) -> dict[str, float]:
    """Return moments in a dict, with the exponents of x, y and z as keys "p,q,r"."""
    powers = monomials(order_from_count(len(values))).tolist()
    return {",".join(map(str, exponents)): value for exponents, value in zip(powers, values.tolist())}
