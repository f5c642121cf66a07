# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The findings about decisions in reading an object, and the reasons if there was nothing to read.

Objects are read as the viewport shows them; a finding says if Blender's settings would render
another body.
"""

from collections.abc import Iterator

from ...core.bodies import DRAWN_AS_POLYGONS, attribute_to_source
from ...core.numerics import shortest_decimal
from ...core.verdict import NO_FACES, Finding, finding
from .curves import is_round
from .findings import (
    DISPLAY_MESH_FOR_MODIFIERS,
    DISPLAY_MESH_MEASURED,
    EDIT_MODE_SINGLE_SHAPE_KEY,
    HIDDEN_OBJECT_MEASURED,
    INSTANCED_BY_PARENT,
    INSTANCES_VANISHED,
    KIND_COUNT,
    LINES_ONLY,
    MEMBERS_DIFFER_IN_RENDER,
    METABALL_FAMILY,
    METABALL_OF_FAMILY,
    MODIFIER_ERROR,
    MODIFIERS_LEFT_OUT,
    NO_INSTANCES,
    NO_SPLINE_SURFACE,
    NOT_SHOWN,
    NOTHING_TO_MEASURE,
    ONLY_WITHOUT_SURFACE,
    READ_IN_MODE,
    RENDER_DIFFERS,
    RENDER_LEVELS_DIFFER,
    RENDER_MODIFIER_DIFFERS,
    SCALE_ZERO_AXIS,
    SURFACELESS_LEFT_OUT,
)
from .instances import InstanceCollector, shows_itself, visible_objects
from .splines import nonpositive_weights, spline_modifiers
from .visibility import (
    SURFACE_TYPES,
    blends_keys,
    hidden_reason,
    instanced_by_parent,
    measurable,
    metaball_families,
)


def why_empty(obj, gathered: InstanceCollector, depsgraph) -> Finding:
    """Return the reason why the object shows no face."""
    vertices, edges = gathered.faceless
    mother = _family(obj, depsgraph)[0]
    is_plain_surface = obj.type == "SURFACE" and obj.instance_type == "NONE" and obj.data.splines
    if mother != obj:
        return finding(METABALL_OF_FAMILY, object=mother.name)
    if gathered.vanished_count:
        return finding(SCALE_ZERO_AXIS)
    cause = None
    if obj.type == "FONT" and not obj.data.body.strip():
        cause = "the text is empty. Type a text"
    elif obj.type in {"CURVE", "FONT"} and not obj.modifiers:
        cause = LINES_ONLY
    elif is_plain_surface and not obj.modifiers:
        cause = LINES_ONLY if vertices else NO_SPLINE_SURFACE
    if cause is not None:
        return finding(NOTHING_TO_MEASURE, cause=cause)
    elements = {"vertices": vertices, "edges": edges} if vertices else {}
    if gathered.left_out or elements:
        return finding(ONLY_WITHOUT_SURFACE, kinds=_kinds(gathered.left_out or elements))
    if obj.instance_type == "COLLECTION":
        return finding(NOT_SHOWN, cause=NO_INSTANCES)
    if obj.type in SURFACE_TYPES and not shows_itself(obj, False):
        return finding(
            NOT_SHOWN,
            cause="the object hides its own geometry. Turn on Show Instancer in Object Properties",
        )
    return finding(NO_FACES)


def reading_findings(obj, gathered: InstanceCollector, depsgraph) -> Iterator[Finding]:
    """Yield a finding for each decision of the reading."""
    hidden = hidden_reason(obj, depsgraph)
    if hidden:
        yield finding(HIDDEN_OBJECT_MEASURED, cause=hidden.as_record())
    if instanced_by_parent(obj):
        yield finding(INSTANCED_BY_PARENT, parent=obj.parent.name)
    for evaluated, splines in gathered.splines.items():
        for result in _spline_findings(evaluated, splines):
            yield attribute_to_source(result, evaluated.original.name, obj.name)
    family_members = _family(obj, depsgraph)[1:]
    if family_members:
        yield finding(METABALL_FAMILY, objects=_names(family_members))
    for source in gathered.drawn:
        if source.type == "META" or (source.type in {"CURVE", "FONT"} and is_round(source)):
            yield attribute_to_source(finding(DRAWN_AS_POLYGONS), source.name, obj.name)
    yield from _mode_findings(obj)
    exact = {evaluated.original for evaluated, splines in gathered.splines.items() if splines}
    for source in dict.fromkeys((obj, *gathered.sources)):
        for result in render_findings(source, depsgraph.scene, source in exact):
            yield attribute_to_source(result, source.name, obj.name)
    if gathered.collections:
        yield from _member_findings(gathered.collections)
    yield from _node_errors(obj)
    if gathered.vanished_count:
        yield finding(INSTANCES_VANISHED, count=gathered.vanished_count)
    if gathered.left_out:
        yield finding(SURFACELESS_LEFT_OUT, kinds=_kinds(gathered.left_out))


def modifier_findings(obj, scene) -> Iterator[Finding]:
    """Yield the findings about an object's modifiers: differences in the render, and errors of node
    trees.
    """
    yield from render_findings(obj, scene)
    yield from _node_errors(obj)


def render_findings(obj, scene, exact: bool = False) -> Iterator[Finding]:
    """Yield a finding if Blender would render another body; resolutions are ignored for `exact`
    objects.
    """
    differences = list(_render_differences(obj, scene, exact))
    if differences:
        # Levels differ by Blender's defaults already.
        are_levels = all(difference.code == RENDER_LEVELS_DIFFER for difference in differences)
        records = [difference.as_record() for difference in differences]
        yield finding(RENDER_DIFFERS, slight=are_levels, differences=records)


def _member_findings(collections) -> Iterator[Finding]:
    """Yield findings about members of instanced collections that only the viewport or only the
    render shows.
    """
    shown, rendered = (
        {
            member.original: None
            for collection in collections
            for member in visible_objects(collection, switch)
            if measurable(member.original)
            and member.type != "META"  # Blender cannot instance metaballs
        }
        for switch in ("hide_viewport", "hide_render")
    )
    for treatment, members, other_members in (
        ("Left out, as only the render shows them", rendered, shown),
        ("Measured, although the render does not show them", shown, rendered),
    ):
        names = [member.name for member in members if member not in other_members]
        if names:
            yield finding(MEMBERS_DIFFER_IN_RENDER, treatment=treatment, objects=names)


def _node_errors(obj) -> Iterator[Finding]:
    for modifier in obj.modifiers:
        for warning in getattr(modifier, "node_warnings", ()):
            if warning.type == "ERROR":
                yield finding(MODIFIER_ERROR, modifier=modifier.name, error=warning.message)


def _family(obj, depsgraph) -> list:
    """Return the metaballs of an object's family, the mother first; other objects are alone."""
    families = metaball_families(depsgraph.view_layer) if obj.type == "META" else []
    return next((family for family in families if obj in family), [obj])


def _mode_findings(obj) -> Iterator[Finding]:
    if obj.type == "MESH" and obj.data.is_editmode:
        yield finding(READ_IN_MODE, mode="Edit Mode")
        if obj.mode == "EDIT" and obj.active_shape_key and not blends_keys(obj):
            yield finding(EDIT_MODE_SINGLE_SHAPE_KEY, shape_key=obj.active_shape_key.name)
        idle = [
            modifier
            for modifier in obj.modifiers
            if modifier.show_viewport and not modifier.show_in_editmode
        ]
        if idle:
            yield finding(MODIFIERS_LEFT_OUT, modifiers=_names(idle))
    elif obj.mode == "SCULPT" and obj.modifiers:
        yield finding(READ_IN_MODE, mode="Sculpt Mode")


def _spline_findings(evaluated, splines) -> Iterator[Finding]:
    """Yield the findings about a surface object, which is the read object or one of its
    instances.
    """
    if splines is not None:
        yield from splines.findings
        return
    meshed = spline_modifiers(evaluated.original)[1]
    cause = "its control points are unknown"
    if nonpositive_weights(evaluated.data.splines):
        cause = "some control points have no positive weight"
    yield (
        finding(DISPLAY_MESH_FOR_MODIFIERS, modifiers=_names(meshed))
        if meshed
        else finding(DISPLAY_MESH_MEASURED, cause=cause)
    )


def _render_differences(obj, scene, exact: bool = False) -> Iterator[Finding]:
    """Yield findings about differences in the render; resolutions are ignored for `exact`
    objects.
    """
    for modifier in obj.modifiers:
        shown = modifier.show_viewport
        rendered = modifier.show_render
        if shown != rendered:
            yield finding(
                RENDER_MODIFIER_DIFFERS,
                modifier=modifier.name,
                place="viewport" if shown else "render",
            )
        elif shown:
            viewport, render = _levels(modifier, scene.render)
            quoted = "“{}”".format(modifier.name)
            if viewport != render:
                yield finding(RENDER_LEVELS_DIFFER, name=quoted, viewport=viewport, render=render)
            system = getattr(modifier, "particle_system", None)
            if system is not None and system.settings.display_percentage < 100:
                share = "{:d}%".format(system.settings.display_percentage)
                yield finding(RENDER_LEVELS_DIFFER, name=quoted, viewport=share, render="100%")
    data = obj.data
    if not exact and obj.type in {"CURVE", "FONT", "SURFACE"}:
        for axis in "uv" if obj.type == "SURFACE" else "u":
            shown = getattr(data, "resolution_" + axis)
            rendered = getattr(data, "render_resolution_" + axis)
            if rendered not in (0, shown):
                yield finding(
                    RENDER_LEVELS_DIFFER,
                    name="Resolution " + axis.upper(),
                    viewport=shown,
                    render=rendered,
                )
    if obj.type == "META" and data.resolution != data.render_resolution:
        yield finding(
            RENDER_LEVELS_DIFFER,
            name="Resolution",
            viewport=shortest_decimal(data.resolution),
            render=shortest_decimal(data.render_resolution),
        )


def _levels(modifier, render) -> tuple[int, int]:
    """Return a modifier's levels, steps or resolution in the viewport and in the render; (0, 0) if
    it has none.
    """
    names_by_type = {
        "SUBSURF": ("levels", "render_levels"),
        "MULTIRES": ("levels", "render_levels"),
        "SCREW": ("steps", "render_steps"),
        "OCEAN": ("viewport_resolution", "resolution"),
    }
    names = names_by_type.get(modifier.type)
    if names is None:
        return 0, 0
    viewport_level, render_level = (getattr(modifier, name) for name in names)
    if render.use_simplify and modifier.type in {"SUBSURF", "MULTIRES"}:
        viewport_level = min(viewport_level, render.simplify_subdivision)
        render_level = min(render_level, render.simplify_subdivision_render)
    return viewport_level, render_level


def _names(items) -> list[str]:
    return [item.name for item in items]


def _kinds(counts) -> list[dict]:
    return [
        finding(KIND_COUNT, kind=kind, count=count).as_record() for kind, count in counts.items()
    ]
