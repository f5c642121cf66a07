# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The two places of every panel: the 3D Viewport's sidebar, and the object's properties.

The object's properties stay open beside other settings.

To add a sub-panel: a class with `bl_label`, `draw` and, if needed, `poll`, made into panels by
`in_both_places`, in a module that `panels/__init__.py` names. Sub-panels of the main panel follow
`ORDER`.
"""

from __future__ import annotations

from collections.abc import Callable, Set

from bpy.types import Context, Object, Panel

from ..blender import session, settings

# posed objects first, then the order of CAD's mass property dialogs; panels whose height depends on
# results are below those that always have the same rows
ORDER = (
    "weight",
    "inertia",
    "density",
    "given",
    "apply",
    "selection",
    "stability",
    "colliders",
    "floating",
    "assembly",
    "bones",
    "section",
    "shape",
    "advanced",
    "findings",
    "refused",
)
ROOT = "body_moments"
PLACES = {  # by the beginning of the panels' identifiers
    "VIEW3D_PT_": {"bl_space_type": "VIEW_3D", "bl_region_type": "UI", "bl_category": "Moments"},
    "OBJECT_PT_": {
        "bl_space_type": "PROPERTIES",
        "bl_region_type": "WINDOW",
        "bl_context": "object",
    },
}


class AmongProperties:
    """Base of panels among the properties of another thing than the object."""

    bl_label = "Body Moments"
    bl_space_type, bl_region_type = "PROPERTIES", "WINDOW"
    bl_options = {"DEFAULT_CLOSED"}


def in_both_places(
    contents: type,
    name: str = "",
    parent: str | None = None,
    options: Set[str] = frozenset({"DEFAULT_CLOSED"}),
    shown_for: Callable[[Object], bool] | None = None,
    for_any: bool = False,
) -> tuple[type[Panel], ...]:
    """Make a panel of the sidebar and one of the object's properties that show these contents.

    `contents` has `bl_label`, `draw(self, context)` and, if needed, `poll` and
    `draw_header_preset`. `name` is part of the identifiers, `VIEW3D_PT_body_moments_NAME` and
    `OBJECT_PT_body_moments_NAME`; "" for the main panel. `parent` names the parent panel, by
    default the main one. `options`: of a sub-panel. `shown_for`, in place of `poll`: whether to
    show the panel for the subject, whose name it shows if several objects are chosen; with
    `for_any` for any chosen object.
    """

    def draw(panel: Panel, context: Context) -> None:
        panel.layout.use_property_decorate = False
        if (
            shown_for is not None
            and not for_any
            and len(session.displayed.shown_objects(context)) > 1
        ):
            panel.layout.label(
                text=session.selected.subject(context).name, icon="OBJECT_DATA", translate=False
            )
        contents.draw(panel, context)

    def poll(_cls: type[Panel], context: Context) -> bool:
        if for_any:
            return any(map(shown_for, settings.chosen.chosen_objects(context)))
        obj = session.selected.subject(context)
        return obj is not None and shown_for(obj)

    shared: dict[str, object] = {
        "__doc__": contents.__doc__,
        "__module__": contents.__module__,
        "draw": draw,
    }
    if shown_for is not None:
        shared["poll"] = classmethod(poll)
    if name in ORDER:
        shared["bl_order"] = ORDER.index(name)
    panels = []
    for prefix, place in PLACES.items():
        idname = _idname(prefix, name)
        properties = {"bl_idname": idname, **place, "bl_options": set(options)}
        if name:
            properties["bl_parent_id"] = _idname(prefix, parent)
        elif prefix == "VIEW3D_PT_":
            properties["bl_options"] = set()
        panels.append(type(idname, (contents, Panel), (shared | properties)))
    return tuple(panels)


def _idname(prefix: str, name: str | None) -> str:
    return prefix + "_".join(filter(None, (ROOT, name)))
