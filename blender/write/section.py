# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A stored section: one group of ID properties, `body_section`, on the measured object, and its
text report.

SI units, world axes. It holds a `core.flat.section.Section` with its description, findings and a
fingerprint.
"""

from __future__ import annotations

from math import degrees
from typing import NamedTuple

import bpy

from ... import core
from ...core.verdict import Finding, Severity, sentence, severity
from .properties import findings_in, findings_text, warning_lines
from .units import clean, report_line, report_number, report_vector, rounded_up

KEY = "body_section"
BOUND_KEYS = ("area", "perimeter", "centroid", "second")
LENGTHS = {
    "area": 1,
    "perimeter": 1,
    "origin": 3,
    "axes": 9,
    "off": 1,
    "centroid": 2,
    "second": 3,
    "reach": 4,
    "counts": 2,
    "error": 4,
    "input": 4,
    "unit": 1,
}
TEXTS = ("what", "named", "findings", "fingerprint")
ABOUT = ("x", "y", "1", "2")


class StoredSection(NamedTuple):
    """A stored section; `unit` is in meters per Blender unit at its measurement."""

    section: core.flat.Section
    description: str
    findings: tuple[Finding, ...]
    fingerprint: str
    unit: float


def store(
    obj: bpy.types.Object,
    section: core.flat.Section,
    description: str,
    findings: tuple[Finding, ...],
    fingerprint: str,
    unit: float,
) -> None:
    """Write the section on the object, in place of an older one."""
    plane = section.plane
    obj[KEY] = {
        "area": [section.area],
        "perimeter": [section.perimeter],
        "origin": plane.origin.tolist(),
        "axes": plane.axes.T.ravel().tolist(),
        "off": [plane.out_of_plane],
        "centroid": section.centroid.tolist(),
        "second": section.second.tolist(),
        "reach": section.reach.tolist(),
        "counts": [float(section.outlines), float(section.holes)],
        "error": [section.rounding_error[name] for name in BOUND_KEYS],
        "input": [section.input_error[name] for name in BOUND_KEYS],
        "unit": [unit],
        "what": description,
        "named": plane.x_axis_name,
        "warnings": warning_lines(findings),
        "findings": findings_text(findings),
        "fingerprint": fingerprint,
    }


def stored(obj: bpy.types.Object) -> StoredSection | None:
    """Return the stored section; None if there is none, or it is damaged."""
    group = obj.get(KEY)
    if not hasattr(group, "get"):
        return None
    try:
        values = {key: tuple(float(value) for value in group[key]) for key in LENGTHS}
        texts = {key: str(group.get(key, "") if key == "findings" else group[key]) for key in TEXTS}
    except (KeyError, TypeError, ValueError):
        return None
    if {key: len(numbers) for key, numbers in values.items()} != LENGTHS:
        return None
    positive = *values["area"], *values["second"][:2], *values["reach"]
    if not all([value > 0.0 for value in positive]):
        return None
    axes = values["axes"]
    (out_of_plane,) = values["off"]
    (outlines, holes) = values["counts"]
    loaded = core.flat.section_properties  # imported if there is a section to read
    # The columns of the axes were stored one after the other.
    rows = (axes[0::3], axes[1::3], axes[2::3])
    section = loaded.Section(
        loaded.Plane(values["origin"], rows, out_of_plane, texts["named"]),
        values["area"][0],
        values["perimeter"][0],
        values["centroid"],
        values["second"],
        values["reach"],
        int(outlines),
        int(holes),
        dict(zip(BOUND_KEYS, values["error"])),
        dict(zip(BOUND_KEYS, values["input"])),
    )
    return StoredSection(
        section,
        texts["what"],
        findings_in(texts["findings"]),
        texts["fingerprint"],
        values["unit"][0],
    )


def clear(obj: bpy.types.Object) -> bool:
    """Remove the section; return whether there was one."""
    if KEY not in obj:
        return False
    del obj[KEY]
    return True


def text(name: str, stored_section: StoredSection, outdated: str | None = None) -> str:
    """Return a report that a person reads, in SI units. outdated: the reason why the section no
    longer holds.
    """
    section = stored_section.section
    plane = section.plane
    size = section.area**0.5
    x, y, normal = (report_vector(axis, 1.0) for axis in zip(*plane.axes))
    first, second = map(report_number, section.principal)
    direction = "axis 1 at {}° from x towards y".format(report_number(degrees(section.angle)))
    if section.axes_undetermined:
        direction = "every axis through the centroid is principal"
    rows = [
        *([("Out of date", outdated)] if outdated else []),
        (
            "Measured",
            "{}; outer outlines {}, holes {}".format(
                stored_section.description, section.outlines, section.holes
            ),
        ),
        ("Area", report_number(section.area), "m²"),
        ("Perimeter", report_number(section.perimeter), "m"),
        ("Centroid", report_vector(section.center, size), "m"),
        (
            "Plane",
            "normal {}, x {}, y {}; x nearest to the object's {} axis".format(
                normal, x, y, plane.x_axis_name
            ),
        ),
        (
            "Centroid in plane",
            report_vector(section.centroid, size),
            "m, from the foot of the object's origin",
        ),
        (
            "Second moments",
            "about the centroid, along x and y of the plane, m⁴ (Ixy = +∫xy dA)",
        ),
        *(
            ("  " + label, report_number(value))
            for label, value in zip(("Ix", "Iy", "Ixy"), clean(section.second, section.polar))
        ),
        (
            "  Polar Jp",
            "{} = Ix + Iy; not the torsion constant".format(report_number(section.polar)),
        ),
        ("Principal", "I1 {}, I2 {} m⁴; {}".format(first, second, direction)),
        ("Radii of gyration", _labeled_values("i", section.radii), "m"),
        (
            "Section moduli",
            _labeled_values("W", section.moduli),
            "m³ (elastic, outermost corner)",
        ),
        *(
            (
                label,
                "area {:.1e} m², perimeter {:.1e} m, centroid {:.1e} m, second moments {:.1e} "
                "m⁴".format(*(rounded_up(bound[name]) for name in BOUND_KEYS)),
            )
            for label, bound in (
                ("Rounding, at most", section.rounding_error),
                ("float32 coordinates", section.input_error),
            )
        ),
        *(
            ("Note" if severity(finding) == Severity.NOTE else "Warning", sentence(finding))
            for finding in stored_section.findings
        ),
    ]
    lines = ["Section properties, SI units, world frame", "", name]
    return "\n".join([*lines, *(report_line(*row) for row in rows), ""])


def _labeled_values(letter: str, values) -> str:
    return ", ".join(
        "{}{} {}".format(letter, about, report_number(value)) for about, value in zip(ABOUT, values)
    )
