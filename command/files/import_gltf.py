# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""glTF files as objects of the open scene; invisible nodes (KHR_node_visibility) are not rendered."""

from __future__ import annotations

from typing import Any

import addon_utils
import bpy

from ...core.verdict.finding import finding
from ..findings import FILE_HIDES
from .references import Opened

ADD_ON = "io_scene_gltf2"  # It comes with Blender, and may be switched off.


def import_gltf(path: str) -> Opened:
    """Import a .gltf or .glb file. Raise RuntimeError, and AttributeError without an importer."""
    hidden: list[str] = []

    class NodeVisibility:
        """An extension of the importer, which ignores whether nodes are visible."""

        def gather_import_node_after_hook(self, vnode: Any, _node: Any, obj: bpy.types.Object, gltf: Any) -> None:
            if any(_is_invisible(gltf.data.nodes[number]) for number in _line_of(vnode, gltf)):
                hidden.append(obj.name)

    # The importer looks for extensions in add-ons of the preferences, of which it is one itself.
    is_known = ADD_ON in bpy.context.preferences.addons
    module = addon_utils.enable(ADD_ON, default_set=not is_known)
    module.glTF2ImportUserExtension = NodeVisibility
    try:
        # Without disable_bone_shape, it adds objects that would be measured.
        bpy.ops.import_scene.gltf(filepath=path, disable_bone_shape=True)
    finally:
        del module.glTF2ImportUserExtension
    for name in hidden:
        bpy.data.objects[name].hide_render = True
    return Opened(hidden=dict.fromkeys(hidden, finding(FILE_HIDES, cause="it is invisible")))


def _line_of(vnode: Any, gltf: Any) -> list[int]:
    """Return the numbers of a node and of those above it. vnode: the importer's node; its own ones have no number."""
    line = [number for number, one in gltf.vnodes.items() if one is vnode]
    while vnode.parent is not None:
        line.append(vnode.parent)
        vnode = gltf.vnodes[vnode.parent]
    return [number for number in line if isinstance(number, int)]


def _is_invisible(node: Any) -> bool:
    extension = (node.extensions or {}).get("KHR_node_visibility", {})
    return isinstance(extension, dict) and extension.get("visible", True) is False
