# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bones: the part of the active bone among the bone's properties, and the sub-panels of a whole
character.
"""

from __future__ import annotations

from collections.abc import Sequence

from bpy.types import Context, Menu, Panel, PoseBone, UILayout

from ..blender import scale, session, write
from ..blender.session.tracking import armatures, staleness
from ..core import lazy, verdict
from . import places, rows, texts

LISTED = 60  # bones that the sub-panel lists


class BonesPanel:
    """The parts of a character's bones"""

    bl_label = "Bones"

    @classmethod
    def poll(cls, context: Context) -> bool:
        return session.selected.armature_of(context) is not None

    def draw(self, context: Context) -> None:
        layout, armature = self.layout, session.selected.armature_of(context)
        if len(session.displayed.shown_objects(context)) > 1:
            layout.label(text=armature.name, icon="ARMATURE_DATA", translate=False)
        rows.main_button(layout, "object.body_moments_measure_bones", "BONE_DATA")
        is_measured = write.properties.stored(armature) is not None
        column = rows.buttons(
            layout,
            ("object.body_moments_physics_rig", "RIGID_BODY"),
            ("object.body_moments_rig_center", "EMPTY_AXIS"),
            ("object.body_moments_clear_bones", "TRASH"),
        )
        column.enabled = is_measured
        if not is_measured:
            return
        texts.stale_state(layout, staleness.stale_reason(armature, context.scene))
        units = texts.scene_units()
        measured = [
            (bone, bone_results.mass)
            for bone in armature.pose.bones
            if (bone_results := write.properties.stored(bone)) is not None
        ]
        total = sum(mass for _, mass in measured)
        column = layout.column(align=True)
        for bone, mass in measured[:LISTED]:
            row = column.row(align=True)
            row.label(text=bone.name, icon="BONE_DATA", translate=False)
            rows.right(row, units.text("mass", mass), "{:.1f}%".format(100.0 * mass / total))
        if len(measured) > LISTED:
            texts.filled(layout, "And {:d} more", len(measured) - LISTED)


class WeightPanel:
    """Center of mass, support and contacts of a character as it is posed"""

    bl_label = "Weight"

    def draw(self, context: Context) -> None:
        layout, armature = self.layout, context.object
        settings = armature.body_moments_weight
        column = layout.column()
        column.scale_y = 1.4
        column.operator("pose.body_moments_show_weight", icon="CON_FLOOR", depress=settings.show)
        if not settings.show:
            return
        # Buttons and settings first: they stay in place however the character stands.
        column.operator("pose.body_moments_balance_pose", icon="PIVOT_CURSOR")
        column = rows.buttons(
            layout,
            ("pose.body_moments_parabola", "FORCE_FORCE"),
            ("pose.body_moments_keep_spin", "FORCE_VORTEX"),
            ("pose.body_moments_bake_curves", "FCURVE"),
            ("pose.body_moments_trace", "CON_FOLLOWPATH"),
        )
        spans = _spans(context)
        row = column.row()
        row.enabled = bool(spans)
        text = write.translations.localized("Momentum from nothing: {:d}").format(len(spans))
        icon = "ERROR" if spans else "BLANK1"
        row.menu("VIEW3D_MT_body_moments_spans", text=text, icon=icon, translate=False)
        column = layout.column()
        mass = column.column()
        mass.active = settings.mass > 0.0
        rows.settings(mass, settings, "shown_mass")
        rows.settings(column, settings, "ground")
        column.prop(settings, "show_axes")
        bone = context.active_pose_bone
        if bone is not None:
            column.prop(bone.body_moments, "is_contact")
        else:
            column.label(text="Contact: no active bone", icon="CHECKBOX_DEHLT")
        posed = lazy.loaded_module(session.character, "weight")
        depsgraph = context.view_layer.depsgraph
        weight = None
        if posed is not None and depsgraph is not None:
            weight = posed.weight(armature, depsgraph)
        texts.stale_state(layout, staleness.stale_reason(armature, context.scene))
        _standing(layout, weight, scale.meters_per_unit(context.scene))


def standing(
    weight: session.character.weight.Weight, unit: float
) -> tuple[str, dict[str, str], str]:
    """Return the English text on how a character stands, the lengths in it, and its icon."""
    support = weight.support
    if weight.contacts.height is None:
        return "No mesh can touch the ground", {}, "INFO"
    if support is None:
        lengths = {"height": write.reports.distance(weight.contacts.height * unit)}
        return "In the air: {height} above ground", lengths, "INFO"
    margin = {"margin": write.reports.distance(abs(support.margin) * unit)}
    if not support.stands:
        return "Falls: {margin} outside", margin, "CANCEL"
    if support.is_near_edge:
        return "Near the edge: {margin} inside", margin, "ERROR"
    return "Balanced: {margin} inside", margin, "CHECKMARK"


def _standing(
    layout: UILayout, weight: session.character.weight.Weight | None, unit: float
) -> None:
    """Draw how a character stands, its mass, and the contacts that carry it, in as many rows
    however it stands.
    """
    text = write.translations.localized("Not measured. Show the weight again.")
    icon = "INFO"
    mass = None
    lengths: dict[str, float] = {}
    names: dict[str, Sequence[str]] = {}
    if weight is not None:
        template, length_texts, icon = standing(weight, unit)
        text = write.translations.localized(template).format(**length_texts)
        mass = weight.parts.mass
        unmeasured = [
            name
            for name, mass_share in zip(weight.parts.names, weight.parts.masses)
            if not mass_share
        ]
        contacts = weight.contacts
        names = {"Carries": contacts.names, "Lifted": contacts.lifted, "Not Measured": unmeasured}
        if weight.support is not None:
            lengths["Margin"] = weight.support.margin * unit
            lengths["Height"] = weight.support.height * unit
    box = layout.box()
    box.alert = icon == "CANCEL"
    box.label(text=text, icon=icon, translate=False)
    column = layout.column(align=True)
    rows.quantities(column, [("Mass", "mass", mass)])
    for name in ("Margin", "Height"):
        value = lengths.get(name)
        cell = (
            ("–", "", "")
            if value is None
            else (write.reports.distance(value), repr(float(value)), "m")
        )
        rows.table(column, [(name, *cell)])
    for word in ("Carries", "Lifted", "Not Measured"):
        listed = (
            verdict.truncate_list(names.get(word, ()), translate=write.translations.localized)
            or "–"
        )
        row = column.split(factor=rows.LABEL_SHARE)
        row.label(text=word)
        row.label(text=listed, translate=False)


def _spans(context: Context) -> list[tuple[float, ...]]:
    """Return the spans of frames in whose motion the momentum comes from nothing: first and last
    frame, impulse, twist.
    """
    name = context.object.name_full
    for obj in context.scene.objects:
        if obj.type == "EMPTY" and obj.get(write.properties.BALANCE_GROUP) == name:
            spans = list(obj.get(write.properties.BALANCE_SPANS, ()))
            return [tuple(spans[at : at + 4]) for at in range(0, len(spans), 4)]
    return []


class VIEW3D_MT_body_moments_spans(Menu):
    """Spans of frames in whose motion the momentum comes from nothing; a click goes there"""

    bl_label = "Momentum from Nothing"

    def draw(self, context: Context) -> None:
        for first, last, impulse, twist in _spans(context)[:LISTED]:
            text = write.translations.localized(
                "Frames {:.0f}–{:.0f}: {:.3g} N·s, {:.3g} N·m·s"
            ).format(first, last, impulse, twist)
            jump = self.layout.operator("wm.context_set_int", text=text, translate=False)
            jump.data_path = "scene.frame_current"
            jump.value = round(first)


class BONE_PT_body_moments(places.AmongProperties, Panel):
    """The part of the active bone, in rest pose and the bone's rest frame"""

    bl_context = "bone"

    @classmethod
    def poll(cls, context: Context) -> bool:
        return _pose_bone(context) is not None

    def draw(self, context: Context) -> None:
        bone = _pose_bone(context)
        layout = self.layout
        layout.use_property_decorate = False
        settings = bone.body_moments
        source_settings = {"DENSITY": ("density",), "MASS": ("mass",)}
        rows.settings(
            layout.column(), settings, "mass_from", *source_settings.get(settings.mass_from, ())
        )
        rows.button(layout, "object.body_moments_measure_bones", "BONE_DATA")
        texts.stale_state(layout, staleness.stale_reason(bone.id_data, context.scene))
        _numbers(layout, bone)


def _pose_bone(context: Context) -> PoseBone | None:
    obj = context.object
    if obj is None or obj.type != "ARMATURE" or obj.pose is None or obj.data.bones.active is None:
        return None
    return obj.pose.bones.get(obj.data.bones.active.name)


def _numbers(layout: UILayout, bone: PoseBone) -> None:
    stored = write.properties.stored(bone)
    if stored is None:
        return
    rows.quantities(layout, [("Mass", "mass", stored.mass), ("Volume", "volume", stored.volume)])
    rows.center(layout, "Center of Mass (Rest Frame)", stored)
    rows.group(layout, "Principal Moments", rows.PRINCIPAL_LABELS, "inertia", stored.moments)
    rows.group(layout, "Inertia, Ixy = −∫xy dm", rows.TENSOR_LABELS, "inertia", stored.inertia)


CLASSES = (
    *places.in_both_places(
        WeightPanel, "weight", options=frozenset(), shown_for=armatures.stands_for_meshes
    ),
    *places.in_both_places(BonesPanel, "bones"),
)
