# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The words for what reading an object decided, and for why there was nothing to read.

The viewport is what is read. Where the render would show another body, by Blender's settings as far
as they tell, that is said; a node tree that asks where it runs is beyond them.
"""

from __future__ import annotations

from collections.abc import Iterator

from .curves import is_round
from .deformation import spline_modifiers
from .instances import Gathered, shows_itself, visible_objects
from .splines import weightless
from .visibility import blends_keys, edit_modifiers, hidden_reason, instanced_by_parent, measurable, metaball_families

POLYGONS = (
    "{:s} measured as the polygons that Blender draws, as fine as the viewport's resolution; twice as fine, they come "
    "four times as near."
)


def why_empty(obj, gathered: Gathered, depsgraph) -> str:
    """Why nothing of the object has a face, and what to do about it."""
    vertices, edges = gathered.faceless
    if obj.type == "META":
        mother = _family(obj, depsgraph)[0]
        if mother != obj:
            return "“{:s}” holds the polygons of this metaball's family; measure that.".format(mother.name)
    if gathered.vanished:
        return "All that it instances is scaled to zero; give the instances a scale."
    if obj.type == "FONT" and not obj.data.body.strip():
        return "Its text is empty; type one."
    if obj.type in {"CURVE", "FONT"} and not obj.modifiers:
        return "It shows lines without a surface; give it a bevel or an extrusion, or fill it{:s}.".format(
            ", or set its kind to Wire" if obj.type == "CURVE" else ""
        )
    if obj.type == "SURFACE" and not obj.modifiers and obj.instance_type == "NONE" and obj.data.splines:
        if vertices:
            return "It shows lines without a surface; extrude them in Edit Mode, or make a curve object of them."
        return (
            "None of its splines shows a surface: they have too few points for their order, or for Bézier ends; add "
            "points, lower the order or turn Bézier off in its Active Spline settings."
        )
    if set(gathered.left_out) == {"volumes"} and (gathered.sources or obj.type != "VOLUME"):
        return "It shows volumes by instances only, which are not measured; measure the Volume objects themselves."
    if gathered.left_out:
        return "It has no surface, only {:s}; give it one, by a modifier for example.".format(
            _listing(gathered.left_out)
        )
    if vertices:
        return (
            "It has no faces, only vertices ({:d}) and edges ({:d}); fill the faces, or give it "
            "thickness by a modifier."
        ).format(vertices, edges)
    if obj.instance_type == "COLLECTION":
        return "The collection that it instances shows no surface; add or show an object with faces."
    if obj.type in {"CURVES", "POINTCLOUD", "VOLUME", "GREASEPENCIL"}:
        return "It has no surface; give it one, by a modifier for example."
    if not shows_itself(obj, False):
        return "Its own geometry is not shown; turn on Show Instancer, Viewport in its properties."
    return "It has no geometry; add faces, or see whether a modifier removes them."


def decisions(obj, gathered: Gathered, depsgraph) -> Iterator[str]:
    """One sentence for each thing that was decided while reading."""
    hidden = hidden_reason(obj, depsgraph)
    if hidden:
        yield "Measured although it is not shown. {:s}".format(hidden)
    if instanced_by_parent(obj):
        yield "Shown only as instances of “{:s}”; measured once, where it stands.".format(obj.parent.name)
    for evaluated, splines in gathered.splines.items():
        yield from _spline_notes(evaluated, splines, obj)
    if obj.type == "META":
        others = _family(obj, depsgraph)[1:]
        if others:
            yield "Holds the polygons of its metaball family: {:s}.".format(_names(others))
    yield from _polygons(obj, gathered.drawn)
    yield from _mode(obj)
    exact = {evaluated.original for evaluated, splines in gathered.splines.items() if splines}
    yield from _rendered(obj, depsgraph.scene, obj in exact)
    for source in gathered.sources:
        differences = list(_render_differences(source, depsgraph.scene, source in exact)) if source != obj else []
        if differences:
            yield ("The instanced “{:s}” is read as the viewport shows it; the render differs: {:s}.").format(
                source.name, "; ".join(differences)
            )
    yield from _members(gathered.collections)
    yield from _node_errors(obj)
    if gathered.vanished:
        yield "Left out: {:d} {:s} scaled to zero.".format(
            gathered.vanished, "instance" if gathered.vanished == 1 else "instances"
        )
    if gathered.left_out:
        yield "Left out, as they have no surface: {:s}.".format(_listing(gathered.left_out))


def modifier_decisions(obj, scene) -> Iterator[str]:
    """The same of what the object's modifiers made, whatever that is."""
    yield from _rendered(obj, scene)
    yield from _node_errors(obj)


def _rendered(obj, scene, exact: bool = False) -> Iterator[str]:
    differences = list(_render_differences(obj, scene, exact))
    if differences:
        yield "Read as the viewport shows it; the render differs: {:s}.".format("; ".join(differences))


def _members(collections) -> Iterator[str]:
    """The members of instanced collections that only the viewport or only the render shows."""
    shown, rendered = (
        {
            member.original: None
            for collection in collections
            for member in visible_objects(collection, switch)
            if measurable(member.original) and member.type != "META"  # which Blender cannot instance
        }
        for switch in ("hide_viewport", "hide_render")
    )
    missing = [member for member in rendered if member not in shown]
    if missing:
        yield "Left out, since shown by the render only: {:s}.".format(_names(missing))
    extra = [member for member in shown if member not in rendered]
    if extra:
        yield "Measured, although not shown by the render: {:s}.".format(_names(extra))


def _node_errors(obj) -> Iterator[str]:
    for modifier in obj.modifiers:
        for warning in getattr(modifier, "node_warnings", ()):
            if warning.type == "ERROR":
                yield "Its modifier “{:s}” reports an error: {:s}".format(modifier.name, warning.message)


def _family(obj, depsgraph) -> list:
    families = metaball_families(depsgraph.view_layer)
    return next((family for family in families if obj in family), [obj])


def _polygons(obj, drawn) -> Iterator[str]:
    """What polygons stand for, of curves, text and metaballs."""
    for source in drawn:
        if source.type == "META":
            yield POLYGONS.format("Its surface was")
        elif source.type in {"CURVE", "FONT"} and is_round(source):
            yield POLYGONS.format(
                "Its curves were" if source == obj else "The curves of “{:s}” were".format(source.name)
            )


def _mode(obj) -> Iterator[str]:
    if obj.type == "MESH" and obj.data.is_editmode:
        acting = edit_modifiers(obj)
        if acting:
            yield "Read in Edit Mode, with the modifiers that act there: {:s}.".format(_names(acting))
        elif blends_keys(obj):
            yield "Read in Edit Mode, with its shape keys."
        else:
            yield "Read from the mesh being edited."
        if obj.mode == "EDIT" and obj.active_shape_key and not blends_keys(obj):
            yield "The shape key “{:s}” is edited, and was read alone.".format(obj.active_shape_key.name)
        idle = [modifier for modifier in obj.modifiers if modifier.show_viewport and not modifier.show_in_editmode]
        if idle:
            yield "Left out, as they are off in Edit Mode: {:s}.".format(_names(idle))
    elif obj.mode == "SCULPT" and obj.modifiers:
        yield "Read in Sculpt Mode, with the modifiers that act there."


def _spline_notes(evaluated, splines, obj) -> Iterator[str]:
    """What was decided about a surface object, `obj` or one that it instances."""
    if splines is None:
        source = evaluated.original
        name = "" if source == obj else " of “{:s}”".format(source.name)
        meshed, count = spline_modifiers(source)[1], weightless(evaluated.data.splines)
        reason = ""
        if meshed:
            reason = ", as modifiers work on the mesh: {:s}".format(_names(meshed))
        elif count:
            reason = ", as weights of its control points ({:d}) are not positive; raise them above zero".format(count)
        yield "Display mesh{:s} instead of the surface, as fine as the viewport's resolution{:s}.".format(name, reason)
    else:
        yield from splines.notes


def _render_differences(obj, scene, exact: bool = False) -> Iterator[str]:
    """exact: the object is read without its display mesh, so that no resolution counts."""
    for modifier in obj.modifiers:
        shown, rendered = modifier.show_viewport, modifier.show_render
        if shown != rendered:
            yield ("“{:s}” is not rendered" if shown else "“{:s}” is rendered only").format(modifier.name)
        elif shown:
            here, there = _levels(modifier, scene.render)
            if here != there:
                yield "“{:s}” has {:d} in the viewport, {:d} in the render".format(modifier.name, here, there)
            system = getattr(modifier, "particle_system", None)
            if system is not None and system.settings.display_percentage < 100:
                yield "“{:s}” shows {:d} % of its particles".format(modifier.name, system.settings.display_percentage)
    data = obj.data
    for axis in ("u", "v"):
        rendered = getattr(data, "render_resolution_" + axis, 0)
        shown = getattr(data, "resolution_" + axis, 0)
        if exact:
            break
        if rendered and rendered != shown and (axis == "u" or obj.type == "SURFACE"):
            yield "the resolution {:s} is {:d} in the viewport, {:d} in the render".format(axis, shown, rendered)
    if obj.type == "META" and data.resolution != data.render_resolution:
        yield "the resolution is {:.3g} in the viewport, {:.3g} in the render".format(
            data.resolution, data.render_resolution
        )


def _levels(modifier, render) -> tuple[int, int]:
    """The modifier's number in the viewport and in the render, the same where it has but one."""
    if modifier.type in {"SUBSURF", "MULTIRES"}:
        here, there = modifier.levels, modifier.render_levels
        if render.use_simplify:
            here = min(here, render.simplify_subdivision)
            there = min(there, render.simplify_subdivision_render)
        return here, there
    if modifier.type == "SCREW":
        return modifier.steps, modifier.render_steps
    if modifier.type == "OCEAN":
        return modifier.viewport_resolution, modifier.resolution
    return 0, 0


def _names(items) -> str:
    return ", ".join("“{:s}”".format(item.name) for item in items)


def _listing(counts) -> str:
    return ", ".join("{:d} {:s}".format(count, kind) for kind, count in counts.items())
