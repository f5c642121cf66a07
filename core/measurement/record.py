# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measurements as records, the parts of a document (`documents.py`).

A public contract, `body-moments/1`.

All numbers are SI. Centers, tensors, axes and moments are in the world frame or in each
object's own frame (its location and rotation, unit scale); objects do not share their frames, so
the total is always in the world frame. A number that is not finite is written as null, never as NaN
or Infinity, which are not JSON.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np

from .. import flat, inertia, polyhedron
from ..moments import (
    Invariant,
    Moments,
    U,
    monomial_index,
    monomials,
)
from ..numerics import Array, NDArray
from ..verdict import Finding, MeasureError, Severity, find_verdict, sentence, severity
from .documents import TOTAL, plain
from .findings import UNIFORM_DENSITIES
from .results import Measurement

MAX_ELEMENTS = 1000  # Limit for one finding.
_FIRST = ((1, 0, 0), (0, 1, 0))
_SECOND = ((2, 0, 0), (0, 2, 0), (1, 1, 0))
SHIFT_ROUNDINGS = 16.0  # Rounding of the shift from plane to frame, in u of the distance.


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
    surface: its area moments, world frame, listed beside them. more: further entries. about:
    "center", "origin", "world", or a point in the frame: adds `inertia_about`, and the moments are
    about it.
    """
    properties = measurement.mass_properties if frame == "world" else measurement.in_object_frame()
    entry = {
        "name": measurement.name,
        "type": measurement.type,
        "kind": measurement.kind,
        "verdict": str(find_verdict(measurement.method, measurement.findings)),
        "method": str(measurement.method),
        "density": measurement.density,
        **(
            {}
            if measurement.density_from in UNIFORM_DENSITIES
            else {"density_from": str(measurement.density_from)}
        ),
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
    if measurement.printed is not None:
        entry["print"] = measurement.printed
    point = _point(about, measurement, properties, frame)
    if about is not None:
        entry["inertia_about"] = {"point": point, "inertia": properties.inertia_about(point)}
    if order is not None:
        domains = _moments_by_domain(measurement, order, surface)
        if frame == "object":
            axes = measurement.rotation
            origin = measurement.location + measurement.rotation @ point
            placed = {name: moments.in_frame(axes, origin) for name, moments in domains.items()}
        else:
            # A point of the body itself moves with it.
            moved = 0.0 if about in ("center", "origin") else measurement.place_error
            placed = {
                name: _displaced(moments.about_point(point), moved)
                for name, moments in domains.items()
            }
        entry["moments"] = _moments_record(order, point, placed, monomials(order))
    entry |= more or {}
    if measurement.display_volume is not None:
        entry["display_mesh"] = {
            "volume": measurement.display_volume,
            "difference": measurement.display_volume - measurement.volume,
        }
    entry["health"] = measurement.health.as_record()
    bound = measurement.error_bound
    if frame == "world" and measurement.place_error:
        inputs = bound["input"]
        center = inputs["center_of_mass"] + measurement.place_error
        bound = bound | {"input": inputs | {"center_of_mass": center}}
    entry["error_bound"] = bound
    return plain(entry) | described(measurement.findings)


def _moments_by_domain(
    measurement: Measurement, order: int, surface: Moments | None
) -> dict[str, Moments]:
    """Return the moments to an order, or as far as they are known, by the names of a record."""
    volume = measurement.volume_moments
    if volume is None:
        volume = measurement.area_moments * measurement.thickness
    domains = {"volume": volume.truncate(order)}
    mass_order = order
    if measurement.length is not None:
        length, _ = measurement.mass_moments
        mass_order = min(order, length.order)
        domains["length"] = length.truncate(mass_order)
    if surface is not None:
        domains["surface"] = surface.truncate(order)
    mass = measurement.moments_of_mass(mass_order)
    if mass is not None:
        domains["mass"] = mass
    return domains


def described(findings: Iterable[Finding]) -> dict[str, list]:
    """Return a record's `findings` as data, and their messages: `notes` for notes, `warnings` for
    severer ones.
    """
    entry = {"findings": [], "warnings": [], "notes": []}
    add_findings(entry, findings)
    return entry


def add_findings(entry: dict[str, Any], findings: Iterable[Finding]) -> None:
    """Add findings to a record, unless it has them already."""
    for finding in findings:
        record = {
            "code": finding.code,
            "severity": str(severity(finding)),
            "message": sentence(finding),
            "values": plain(finding.values),
        }
        if len(finding.elements):
            record["elements"] = plain(finding.elements[:MAX_ELEMENTS])
        if record not in entry["findings"]:
            entry["findings"].append(record)
            entry["notes" if record["severity"] == Severity.NOTE else "warnings"].append(
                record["message"]
            )


def total(measurements: Sequence[Measurement], findings: Iterable[Finding] = ()) -> dict[str, Any]:
    """Return the `total` entry: all objects as one body in the world frame, null if there are none;
    and findings about it.
    """
    entry: dict[str, Any] = dict.fromkeys(TOTAL)
    if measurements:
        entry["mass"] = math.fsum(member.mass_properties.mass for member in measurements)
        entry["volume"] = math.fsum(member.volume for member in measurements)
        entry["area"] = math.fsum(member.area for member in measurements)
        with suppress(MeasureError):  # together they have no mass, and so no center
            whole = inertia.combine([member.mass_moments for member in measurements])
            entry.update(_inertial(whole))
    return plain(entry) | described(findings)


def _inertial(properties: inertia.MassProperties) -> dict[str, Any]:
    """Return the entries of a record that `TOTAL` has, too: center, inertia and principal axes."""
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
    about: str | Sequence[float] | None,
    measurement: Measurement,
    properties: inertia.MassProperties,
    frame: str,
) -> Array:
    """Return the (3,) coordinates of the point `about` in the frame, by default the frame's
    origin.
    """
    if about == "center":
        return properties.center
    if about == "origin" and frame == "world":
        return np.asarray(measurement.location, np.float64)
    if about == "world" and frame == "object":
        return -measurement.rotation.T @ measurement.location
    return np.zeros(3) if about is None or isinstance(about, str) else np.asarray(about, np.float64)


def _displaced(moments: Moments, distance: float) -> Moments:
    """Return moments with the effect of a displacement of the body, in any direction, in their
    `input_error`.
    """
    if distance == 0.0:
        return moments
    size = moments.order + 1
    # (|x| + distance)^p = Σ_a binomial(p, a) distance^(p-a) |x|^a, for each axis
    binomials = np.array(
        [[math.comb(p, a) * distance ** max(p - a, 0) for a in range(size)] for p in range(size)]
    )
    index = tuple(monomials(moments.order).T)
    largest = np.zeros((size, size, size))
    largest[index] = np.abs(moments.raw) + moments.input_error
    spread = np.einsum("pa,qb,rc,abc->pqr", binomials, binomials, binomials, largest, optimize=True)
    return replace(moments, input_error=moments.input_error + (spread - largest)[index])


def _moments_record(
    order: int,
    about: NDArray,
    domains: dict[str, Moments],
    powers: NDArray,
    rows: slice | NDArray = slice(None),
) -> dict[str, Any]:
    """Return a record's `moments`: for each domain, a dict from powers, such as "p,q,r", to values.

    powers: (K, d) exponents; rows: their indices in `Moments.raw`.
    """
    keys = [",".join(map(str, exponents)) for exponents in powers.tolist()]

    def tables(name: str) -> dict[str, dict[str, float]]:
        """Return the values of one attribute of the moments, by domain and powers."""
        return {
            domain: dict(zip(keys, getattr(each, name)[rows].tolist()))
            for domain, each in domains.items()
        }

    bounds = {"error": tables("rounding_error"), "input": tables("input_error")}
    return {"order": order, "about": about} | tables("raw") | bounds


def flat_record(
    name: str,
    kind: str,
    plane: flat.Plane,
    moments: Moments,
    findings: Iterable[Finding],
    *,
    order: int | None = None,
    invariants: Sequence[Invariant] = (),
    more: dict[str, Any] | None = None,
    about: str | Sequence[float] | None = None,
    frame: tuple[str, Array, Array] = ("world", np.eye(3), np.zeros(3)),
) -> dict[str, Any]:
    """Return one shape's record.

    kind: the object's type. moments: about the centroid, along the plane's axes, to second order at
    least. order: adds `moments`, about the projection of the frame's origin or of the point `about`
    (as in `record`) on the plane. frame: its name, and the object frame's axes and origin. more:
    further entries.
    """
    axes, location = (np.eye(3), np.zeros(3)) if frame[0] == "world" else frame[1:]

    def to_frame(point: NDArray) -> Array:
        """Return the coordinates in the frame of a point in the world."""
        return axes.T @ (point - location)

    centroid = plane.origin + plane.axes @ moments.center
    central = moments.about_center()
    entry = {
        "name": name,
        "type": kind,
        "area": moments.total,
        "centroid": to_frame(centroid),
        "plane": (
            {"origin": to_frame(plane.origin)}
            | {key: axes.T @ axis for key, axis in zip(("x", "y", "normal"), plane.axes.T)}
        ),
        "second_moments": {"xx": central[2, 0, 0], "yy": central[0, 2, 0], "xy": central[1, 1, 0]},
    }
    if order is not None:
        point = _plane_point(about, centroid, axes, location, frame[2])
        placed = moments.truncate(order).about_point(flat.foot(plane, point))
        powers = polyhedron.multi_indices(2, order)
        entry["moments"] = _moments_record(
            order, placed.about[:2], {"area": placed}, powers, flat.plane_positions(order)
        )
    if invariants:
        entry["invariants"] = [
            {
                "name": invariant.name,
                "real": invariant.value.real,
                "imaginary": invariant.value.imag,
                "error": invariant.rounding_error,
                "input": invariant.input_error,
            }
            for invariant in invariants
        ]
    entry |= more or {}
    rounding = _bounds(central, central.rounding_error, U * float(np.linalg.norm(centroid)))
    entry["error_bound"] = rounding | {"input": _bounds(central, central.input_error, 0.0)}
    return plain(entry) | described(findings)


def _bounds(central: Moments, bounds: Array, shift: float) -> dict[str, float]:
    """Return bounds of area, centroid coordinates and second moments. bounds: of the central
    moments.
    """
    first, second = (
        float(np.linalg.norm([bounds[monomial_index(*row)] for row in rows]))
        for rows in (_FIRST, _SECOND)
    )
    return {
        "area": float(bounds[0]),
        "centroid": first / abs(central.total) + SHIFT_ROUNDINGS * shift,
        "second_moments": second,
    }


def _plane_point(
    about: str | Sequence[float] | None,
    centroid: NDArray,
    axes: NDArray,
    location: NDArray,
    origin: NDArray,
) -> Array:
    """Return the (3,) world position of the point `about`, not yet on the plane.

    axes, location: of the frame. origin: the object's, in the world.
    """
    if about == "center":
        return centroid
    if about == "origin":
        return origin
    if about == "world":
        return np.zeros(3)
    return location + axes @ (np.zeros(3) if about is None else np.asarray(about, np.float64))
