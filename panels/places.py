# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The two places of every panel: the 3D Viewport's sidebar, and the object's properties.

The object's properties stay open beside other settings.

To add a sub-panel: a class with `bl_label`, `draw` and, if needed, `poll`, made into panels by `in_both_places`, in a
module that `panels/__init__.py` names. Sub-panels of the main panel follow `ORDER`.
"""

from __future__ import annotations

from collections.abc import Set

from bpy.types import Panel

ORDER = (
    "weight",
    "inertia",
    "density",
    "given",
    "apply",
    "colliders",
    "stability",
    "selection",
    "assembly",
    "bones",
    "section",
    "shape",
    "advanced",
    "refused",
)  # what is posed, then the order of CAD's mass property dialogs
ROOT = "body_moments"


def in_both_places(
    contents: type, name: str = "", parent: str | None = None, options: Set[str] = frozenset({"DEFAULT_CLOSED"})
) -> tuple[type[Panel], type[Panel]]:
    """Make a panel of the sidebar and one of the object's properties that show these contents.

    `contents` has `bl_label`, `draw(self, context)` and, if needed, `poll` and `draw_header_preset`.
    `name` is part of the identifiers, `VIEW3D_PT_body_moments_NAME` and `OBJECT_PT_body_moments_NAME`; "" for the main
    panel. `parent` names the parent panel, by default the main one. `options`: of a sub-panel.
    """
    return (
        _panel(
            "VIEW3D_PT_",
            contents,
            name,
            parent,
            bl_space_type="VIEW_3D",
            bl_region_type="UI",
            bl_category="Moments",
            bl_options=set(options) if name else set(),
        ),
        _panel(
            "OBJECT_PT_",
            contents,
            name,
            parent,
            bl_space_type="PROPERTIES",
            bl_region_type="WINDOW",
            bl_context="object",
            bl_options=set(options),
        ),
    )


def _panel(prefix: str, contents: type, name: str, parent: str | None, **place: object) -> type[Panel]:
    idname = _idname(prefix, name)
    attributes = {"__doc__": contents.__doc__, "__module__": contents.__module__, "bl_idname": idname, **place}
    if name:
        attributes["bl_parent_id"] = _idname(prefix, parent)
    if name in ORDER:
        attributes["bl_order"] = ORDER.index(name)
    return type(idname, (contents, Panel), attributes)


def _idname(prefix: str, name: str | None) -> str:
    return prefix + "_".join(filter(None, (ROOT, name)))
