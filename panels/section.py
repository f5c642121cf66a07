# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The sub-panel of section properties, in the order of engineers' tables."""

from __future__ import annotations

from math import degrees

from bpy.types import Context, Object, UILayout

from ..blender import read, session, write
from ..blender.session.tracking import staleness, stamps
from ..core.verdict import Group
from . import places, remedies, rows, texts

# Largest thickness of a flat shape, relative to its width; chosen, above the rounding of float32.
# Other shapes have sections of selected faces.
FLAT_RTOL = 1e-5
ABOUT_LABELS = ("x", "y", "1", "2")


class SectionPanel:
    """Section properties"""

    bl_label = "Section"

    def draw(self, context: Context) -> None:
        obj, layout = session.selected.subject(context), self.layout
        if not _may_have_section(obj):
            return  # its sub-panel is for other shapes, too
        row = layout.row(align=True)
        rows.button(row, "object.body_moments_measure_section", "FACESEL", short="Measure")
        row.operator("object.body_moments_copy", text="", icon="COPYDOWN").what = "SECTION"
        stored = write.section.stored(obj)
        if stored is None:
            layout.label(text="Not Measured", icon="RADIOBUT_OFF")
            return
        _verdict(layout, stored, staleness.stale_reason(obj, context.scene, stamps.Kind.SECTION))
        groups = [Group(finding) for finding in stored.findings]
        remedies.lines(layout, context, groups, can_accept=False)
        _numbers(layout, stored.section)
        _more_numbers(layout, stored.section)
        remedies.notes(layout, "body_moments_section_notes", groups)


def _may_have_section(obj: Object) -> bool:
    if obj.type not in read.visibility.SECTION_TYPES:
        return False
    is_flat = min(obj.dimensions) <= FLAT_RTOL * max(obj.dimensions)
    return is_flat or obj.mode == "EDIT" or write.section.KEY in obj


def _verdict(layout: UILayout, stored: write.section.StoredSection, outdated: str | None) -> None:
    column = layout.column(align=True)
    outlines = stored.section.outlines
    holes = stored.section.holes
    counts = ((outlines, "1 Outline", "{:d} Outlines"), (holes, "1 Hole", "{:d} Holes"))
    parts = [
        write.translations.localized(singular if count == 1 else plural).format(count)
        for count, singular, plural in counts
        if count
    ]
    texts.sentence(
        column,
        "{:s}: {:s}".format(write.translations.localized(stored.description), ", ".join(parts)),
        icon="CHECKMARK",
    )
    texts.stale_state(column, outdated)


def _numbers(layout: UILayout, section) -> None:
    rows.quantities(
        layout, [("Area", "area", section.area), ("Perimeter", "length", section.perimeter)]
    )
    size = section.area**0.5
    rows.group(layout, "Centroid (World)", rows.AXIS_LABELS, "length", section.center, size)
    second = (*section.second, section.polar)
    rows.group(
        layout,
        "Second Moments of Area",
        ("Ix", "Iy", "Ixy", "Polar Jp"),
        "area_moment",
        second,
        section.polar,
    )
    column = rows.group(layout, "Principal", ("I1", "I2"), "area_moment", section.principal)
    if section.axes_undetermined:
        column.label(text="Every Axis Is Principal", icon="INFO")
    else:
        angle = degrees(section.angle)
        # A smaller angle is rounding: chosen, 1e-6° are 2e-8 rad.
        angle_text = "{:s}°".format(write.units.number(0.0 if abs(angle) < 1e-6 else angle))
        rows.table(column, [("Angle from x to 1", angle_text, repr(section.angle), "rad")])


def _more_numbers(layout: UILayout, section) -> None:
    body = rows.fold(layout, "body_moments_section_moduli", "Section Moduli and Radii of Gyration")
    if body is not None:
        moduli, radii = (
            ["{:s}{:s}".format(letter, name) for name in ABOUT_LABELS] for letter in "Wi"
        )
        rows.group(body, "Elastic, at the Outermost Corner", moduli, "volume", section.moduli)
        rows.group(body, "Radii of Gyration", radii, "length", section.radii)
    if (body := rows.fold(layout, "body_moments_section_plane", "Plane")) is not None:
        column = body.column(align=True)
        texts.filled(column, "x is nearest to the object's {:s} axis", section.plane.x_axis_name)
        for label, axis in zip(("x", "y", "n"), zip(*section.plane.axes)):
            rows.direction(column, label, axis)
        column = rows.group(
            body,
            "Centroid from Object Origin",
            ("x", "y"),
            "length",
            section.centroid,
            section.area**0.5,
        )
        column.label(text="About the centroid, Ix = ∫y² dA, Ixy = +∫xy dA")
        column.label(text="Jp = Ix + Iy is not the torsion constant")
    if (body := rows.fold(layout, "body_moments_section_bounds", "Error Bounds")) is not None:
        entries = [
            ("Area", "area", "area", section.area),
            ("Perimeter", "length", "perimeter", section.perimeter),
            ("Centroid", "length", "centroid", section.area**0.5),
            ("Moments", "area_moment", "second", section.polar),
        ]
        sources = (
            ("Rounding, at Most", section.rounding_error),
            ("Float32 Coordinates, at Most", section.input_error),
        )
        rows.error_bounds(body, sources, entries)


CLASSES = places.in_both_places(
    SectionPanel,
    "section",
    shown_for=lambda obj: (
        obj.type in read.visibility.SECTION_TYPES
        and (read.visibility.measurable(obj) or _may_have_section(obj))
    ),
)
