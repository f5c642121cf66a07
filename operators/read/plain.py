# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that show their own mesh and nothing else, of which reading has nothing to decide: most of many parts."""

from __future__ import annotations

from bpy.types import Depsgraph, Mesh, Object

from .visibility import instanced_by_parent


def plain_mesh(obj: Object, depsgraph: Depsgraph) -> Mesh | None:
    """Return the evaluated mesh of a plain object, of which `read_object` would give one part in one place and no
    findings; None where that has to look for itself.

    Parameters
    ----------
    obj : bpy.types.Object
        An original object.
    depsgraph : bpy.types.Depsgraph
    """
    data = obj.data
    if (
        obj.type != "MESH"
        or obj.mode == "SCULPT"
        or obj.instance_type != "NONE"
        or data.is_editmode
        or data.shape_keys is not None
        or len(obj.modifiers)
        or not obj.visible_get(view_layer=depsgraph.view_layer)
        or instanced_by_parent(obj)
    ):
        return None
    evaluated = obj.evaluated_get(depsgraph)
    return evaluated.data if evaluated.is_evaluated else None
