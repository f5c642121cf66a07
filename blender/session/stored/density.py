# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Density as a multiplication: if it is one number, stored results follow it at once, without being
measured again.

The stamp must be that of the present settings with the stored density or mass. So nothing has to be
remembered, undo restores both together, and an animated setting leaves the results out of date.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from bpy.types import Context, Object, PropertyGroup, Scene

from ....core.bodies import DENSITY_DEFAULTED
from ....core.measurement import VERSION
from ....core.verdict import EditRefusedError, Finding, finding
from ... import bodies, read, write
from ...settings.density import default_density, unset_density
from .. import stored, tracking

if TYPE_CHECKING:
    from ....core.measurement import Measurement

DEFAULTS = {  # notes on an unset density, by the setting
    "density": finding(DENSITY_DEFAULTED, slight=True, density="1000 kg/m³"),
    "linear_density": finding(DENSITY_DEFAULTED, slight=True, density="1 kg/m"),
}


def noted(obj: Object, measurement: Measurement, scene: Scene) -> Measurement:
    """Return an object's measurement, with a note if its density is unset and no finding says so
    yet.
    """
    unset = unset_density(obj, measurement, scene)
    if unset is None:
        return measurement
    return replace(measurement, findings=with_default_note(measurement.findings, unset))


def with_default_note(findings: tuple[Finding, ...], unset: str) -> tuple[Finding, ...]:
    """Return findings with the note on the setting `unset`, unless one of them is about it."""
    if DENSITY_DEFAULTED in [finding.code for finding in findings]:
        return findings
    return (*findings, DEFAULTS[unset])


def follow_density(obj: Object, scene: Scene) -> None:
    """Update stored results if the settings change them by a factor alone; else leave them out of
    date. They must be stored and of one density, and nothing but density or mass may have changed.
    """
    stamp = tracking.stamps.stamp_of(obj)
    if stamp is None or stamp.version != VERSION or "body_density_from" in obj:
        return
    try:
        write.properties.require_storable(obj)
    except EditRefusedError:
        return
    numbers = write.properties.stored(obj)
    if numbers is None:
        return
    extent = write.properties.optional(obj, "body_length") or numbers.volume  # m or m³
    # A given inertia does not follow the mass.
    if not extent or any(
        (finding.code, finding.values.get("quantity"))
        == (bodies.findings.GIVEN, bodies.findings.INERTIA)
        for finding in write.properties.findings(obj)
    ):
        return
    mass = numbers.mass
    present = read.fingerprint.current_settings(obj, scene)
    # The other settings are those of the stamp if its digest is theirs with the stored density or
    # mass.
    stored_weights = {"density": mass / extent, "mass": None}, {"density": None, "mass": mass}
    if stamp.settings not in [replace(present, **weight).digest for weight in stored_weights]:
        return
    now = present.digest
    findings = _findings(obj, scene)
    # Equal settings have an equal digest though a measured density may have more digits. Then only
    # the note on a default may have changed.
    if now == stamp.settings:
        if findings != list(write.properties.findings(obj)):
            write.properties.store_findings(obj, findings)
        return
    settings = obj.body_moments
    density = present.density if present.mass is None else present.mass / extent
    assert density is not None
    mass_now = density * extent
    if not 0.0 < mass_now < float("inf"):
        return
    write.properties.store_scaled(
        obj,
        0.0 if settings.kind == "WIRE" else density,
        mass_now,
        findings,
        stamp._replace(settings=now).text,
    )
    tracking.staleness.replace_stamp(obj, stamp.text)
    if "body_reference" in obj:
        stored.reference.follow(obj, scene, stored.reference.stored_choice(obj))


def _findings(obj: Object, scene: Scene) -> list[Finding]:
    """Return the stored findings, with the note on an unset density only if it is unset now."""
    settings = obj.body_moments
    findings = [
        finding for finding in write.properties.findings(obj) if finding.code != DENSITY_DEFAULTED
    ]
    if settings.mass_from == "MASS":
        return findings
    name = "linear_density" if settings.kind == "WIRE" else "density"
    if settings.is_property_set(name) or name == "density" and default_density(scene) is not None:
        return findings
    return [*findings, DEFAULTS[name]]


def on_density(settings: PropertyGroup, context: Context) -> None:
    """Scale stored results after a change of density or mass."""
    if context.scene is not None and not read.tracking.tracking_paused.depth:
        with stored.assembly.kept_up_to_date(context, settings.id_data):
            follow_density(settings.id_data, context.scene)


def on_default_density(settings: PropertyGroup, context: Context) -> None:
    """Scale the results of objects without their own density after a change of the scene's
    density.
    """
    with stored.assembly.kept_up_to_date(context):
        for obj in settings.id_data.objects:
            if not obj.body_moments.is_property_set("density"):
                follow_density(obj, settings.id_data)
