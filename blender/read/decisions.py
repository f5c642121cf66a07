# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The findings for what reading an object decided, and for why there was nothing to read.

The viewport is what is read. Where the render would show another body, by Blender's settings as far
as they report, that is a finding; a node tree that asks where it runs is beyond them.
"""

from __future__ import annotations

from collections.abc import Iterator

from ...core.numerics.float32 import shortest_decimal
from ...core.verdict.finding import Finding, finding
from .instances import InstanceCollector, shows_itself, visible_objects
from .nurbs.curves import is_round
from .nurbs.deformation import spline_modifiers
from .nurbs.splines import nonpositive_weights
from .reading import attribute_to_source
from .visibility import blends_keys, edit_modifiers, hidden_reason, instanced_by_parent, measurable, metaball_families

LINES_ONLY = {"CURVE": "lines_only_curve", "FONT": "lines_only_text"}


def why_empty(obj, gathered: InstanceCollector, depsgraph) -> Finding:
    """Why nothing of the object has a face."""
    vertices, edges = gathered.faceless
    if obj.type == "META":
        mother = _family(obj, depsgraph)[0]
        if mother != obj:
            return finding("metaball_of_family", object=mother.name)
    if gathered.vanished_count:
        return finding("no_visible_instances")
    if obj.type == "FONT" and not obj.data.body.strip():
        return finding("empty_text")
    if obj.type in LINES_ONLY and not obj.modifiers:
        return finding(LINES_ONLY[obj.type])
    if obj.type == "SURFACE" and not obj.modifiers and obj.instance_type == "NONE" and obj.data.splines:
        return finding("lines_only_surface" if vertices else "splines_without_surface")
    if set(gathered.left_out) == {"kind_volumes"} and (gathered.sources or obj.type != "VOLUME"):
        return finding("only_volume_instances")
    if gathered.left_out:
        return finding("only_without_surface", kinds=_kinds(gathered.left_out))
    if vertices:
        return finding("only_loose_geometry", vertices=vertices, edges=edges)
    if obj.instance_type == "COLLECTION":
        return finding("collection_without_surface")
    if obj.type in {"CURVES", "POINTCLOUD", "VOLUME", "GREASEPENCIL"}:
        return finding("no_surface")
    if not shows_itself(obj, False):
        return finding("instancer_hidden")
    return finding("no_geometry")


def reading_findings(obj, gathered: InstanceCollector, depsgraph) -> Iterator[Finding]:
    """A finding for each thing that was decided while reading."""
    hidden = hidden_reason(obj, depsgraph)
    if hidden:
        yield finding("hidden_object_measured", cause=hidden.as_record())
    if instanced_by_parent(obj):
        yield finding("instanced_by_parent", parent=obj.parent.name)
    for evaluated, splines in gathered.splines.items():
        for result in _spline_findings(evaluated, splines):
            yield attribute_to_source(result, evaluated.original.name, obj.name)
    if obj.type == "META":
        family_members = _family(obj, depsgraph)[1:]
        if family_members:
            yield finding("metaball_family", objects=_names(family_members))
    if gathered.drawn:
        yield from _polygons(obj, gathered.drawn)
    yield from _mode_findings(obj)
    exact = {evaluated.original for evaluated, splines in gathered.splines.items() if splines}
    for source in (obj, *[source for source in gathered.sources if source != obj]):
        for result in _render_findings(source, depsgraph.scene, source in exact):
            yield attribute_to_source(result, source.name, obj.name)
    if gathered.collections:
        yield from _member_findings(gathered.collections)
    if obj.modifiers:
        yield from _node_errors(obj)
    if gathered.vanished_count:
        yield finding("instances_vanished", count=gathered.vanished_count)
    if gathered.left_out:
        yield finding("surfaceless_left_out", kinds=_kinds(gathered.left_out))


def modifier_findings(obj, scene) -> Iterator[Finding]:
    """The same of what the object's modifiers made, whatever that is."""
    yield from _render_findings(obj, scene)
    yield from _node_errors(obj)


def _render_findings(obj, scene, exact: bool = False) -> Iterator[Finding]:
    differences = [difference.as_record() for difference in _render_differences(obj, scene, exact)]
    if differences:
        yield finding("render_differs", differences=differences)


def _member_findings(collections) -> Iterator[Finding]:
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
        yield finding("render_only_members", objects=_names(missing))
    extra = [member for member in shown if member not in rendered]
    if extra:
        yield finding("viewport_only_members", objects=_names(extra))


def _node_errors(obj) -> Iterator[Finding]:
    for modifier in obj.modifiers:
        for warning in getattr(modifier, "node_warnings", ()):
            if warning.type == "ERROR":
                yield finding("modifier_error", modifier=modifier.name, error=warning.message)


def _family(obj, depsgraph) -> list:
    families = metaball_families(depsgraph.view_layer)
    return next((family for family in families if obj in family), [obj])


def _polygons(obj, drawn) -> Iterator[Finding]:
    """What polygons stand for, of curves, text and metaballs."""
    for source in drawn:
        if source.type == "META":
            yield attribute_to_source(finding("surface_drawn_as_polygons"), source.name, obj.name)
        elif source.type in {"CURVE", "FONT"} and is_round(source):
            yield attribute_to_source(finding("curves_drawn_as_polygons"), source.name, obj.name)


def _mode_findings(obj) -> Iterator[Finding]:
    if obj.type == "MESH" and obj.data.is_editmode:
        acting = edit_modifiers(obj)
        if acting:
            yield finding("edit_mode_modifiers", modifiers=_names(acting))
        elif blends_keys(obj):
            yield finding("edit_mode_shape_keys")
        else:
            yield finding("edit_mode_mesh")
        if obj.mode == "EDIT" and obj.active_shape_key and not blends_keys(obj):
            yield finding("edit_mode_single_shape_key", shape_key=obj.active_shape_key.name)
        idle = [modifier for modifier in obj.modifiers if modifier.show_viewport and not modifier.show_in_editmode]
        if idle:
            yield finding("edit_mode_modifiers_off", modifiers=_names(idle))
    elif obj.mode == "SCULPT" and obj.modifiers:
        yield finding("sculpt_mode_modifiers")


def _spline_findings(evaluated, splines) -> Iterator[Finding]:
    """What was decided about a surface object, the one that is read or one that it instances."""
    if splines is not None:
        yield from splines.findings
        return
    meshed, count = spline_modifiers(evaluated.original)[1], nonpositive_weights(evaluated.data.splines)
    if meshed:
        yield finding("display_mesh_for_modifiers", modifiers=_names(meshed))
    elif count:
        yield finding("display_mesh_for_weights", count=count)
    else:
        yield finding("display_mesh_measured")


def _render_differences(obj, scene, exact: bool = False) -> Iterator[Finding]:
    """exact: the object is read without its display mesh, so that no resolution counts."""
    for modifier in obj.modifiers:
        shown, rendered = modifier.show_viewport, modifier.show_render
        if shown != rendered:
            yield finding("render_modifier_off" if shown else "render_modifier_only", modifier=modifier.name)
        elif shown:
            here, there = _levels(modifier, scene.render)
            if here != there:
                yield finding("render_levels_differ", modifier=modifier.name, viewport=here, render=there)
            system = getattr(modifier, "particle_system", None)
            if system is not None and system.settings.display_percentage < 100:
                share = system.settings.display_percentage / 100.0
                yield finding("render_particles_differ", modifier=modifier.name, share=share)
    data = obj.data
    if not exact and obj.type in {"CURVE", "FONT", "SURFACE"}:
        axes = (("u", "render_resolution_u_differs"), ("v", "render_resolution_v_differs"))
        for axis, code in axes if obj.type == "SURFACE" else axes[:1]:
            shown, rendered = getattr(data, "resolution_" + axis), getattr(data, "render_resolution_" + axis)
            if rendered not in (0, shown):
                yield finding(code, viewport=shown, render=rendered)
    if obj.type == "META" and data.resolution != data.render_resolution:
        yield finding(
            "render_resolution_differs",
            viewport=shortest_decimal(data.resolution),
            render=shortest_decimal(data.render_resolution),
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


def _names(items) -> list[str]:
    return [item.name for item in items]


def _kinds(counts) -> list[dict]:
    return [finding(code, count=count).as_record() for code, count in counts.items()]
