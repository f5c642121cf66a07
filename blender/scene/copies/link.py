# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Linking of copies: equal objects come to share one mesh, and their transforms change so that nothing moves.

If M lays the shared mesh onto an object's own one, its matrix W becomes W · M. `reframe` makes that change and keeps it
only if neither the object nor anything that refers to it looks different. It compares the present frame, without
shading: an object that would look different at another time, or in a render, is left out before.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import bpy
import numpy as np
from bpy.types import ID, Context, Node, NodeTree, Object

from ....core.mesh.correspondence import Correspondence
from ....core.verdict.finding import EditRefusedError, Finding, MeasureError
from ....core.verdict.findings import LINKED_OBJECT
from .. import reframe
from ..dependents import SAME_SHAPE_RTOL
from ..findings import CHANNEL_LOCKED, FOLLOWS_MOVED, MODIFIERS_CHANGE_SHAPE, OWN_AXES_USED, TRANSFORM_CONSTRAINED
from ..transforms import driven_channels, world
from .find import Copies

PLACES = (bpy.types.Collection, bpy.types.Scene, bpy.types.WindowManager, bpy.types.Screen, bpy.types.WorkSpace)
CHANNELS = ("location", "rotation", "scale", "delta")  # beginnings of animated data paths
# Nodes that show a mesh's own axes: outputs, by the node's type, or values of a setting.
OWN_AXES_OUTPUTS = {"TEX_COORD": {"Object", "Generated", "Normal"}, "OBJECT_INFO": {"Location"}}
OWN_AXES_VALUES = {"OBJECT", "BLENDER_OBJECT", "RADIAL"}
GENERATED = {"NOISE", "VORONOI", "WAVE", "MAGIC", "CHECKER", "BRICK", "GRADIENT", "GABOR"}  # if nothing is linked


class Linked(NamedTuple):
    """The linked objects, reasons for those left out, the farthest move of a vertex, and the bytes saved."""

    objects: list[Object]
    left_out: list[tuple[Object, Finding]]
    farthest: float
    saved: int


def link_copies(
    context: Context,
    kinds: Sequence[Copies],
    tolerance: float,
    keep_materials: bool,
    progress: Callable[[float], None] = lambda done: None,
) -> Linked:
    """Let the members of each kind share its mesh; no vertex moves by more than the tolerance, relative to the size."""
    left_out = [(obj, kind.reason) for kind in kinds if kind.reason and not kind.members for obj in kind.objects]
    plans: list[reframe.Plan] = []
    members: dict[Object, tuple] = {}  # own and shared mesh, places of the vertices, materials
    followers = _followers({obj for kind in kinds for obj, _, found in kind.members if not _is_mere_exchange(found)})
    for kind in kinds:
        for obj, data, found in kind.members:
            try:
                _check(obj, found, followers.get(obj))
            except MeasureError as error:
                left_out.append((obj, error.finding))
                continue
            matrix, change = world(obj), np.eye(4)
            change[:3, :3], change[:3, 3] = found.linear, found.offset
            points = data.elements.points[found.vertices] @ matrix[:3, :3].T + matrix[:3, 3]
            members[obj] = data, kind.data, points, [slot.material for slot in obj.material_slots]
            if not _is_mere_exchange(found):
                size = np.linalg.norm(points - points.mean(axis=0), axis=1).max() * tolerance / SAME_SHAPE_RTOL
                order = None if found.is_ordered else found.vertices
                plans.append(reframe.Plan(obj, matrix @ change, float(size), False, mesh=kind.data.mesh, order=order))
    refused, farthest = dict(reframe.reframe(context, plans, progress)[1]), 0.0
    linked = [obj for obj in members if obj not in refused]
    for obj in linked:
        _, shared, points, materials = members[obj]
        obj.data = shared.mesh
        for slot, material in zip(obj.material_slots, materials):
            if keep_materials and slot.material != material:
                slot.link, slot.material = "OBJECT", material
        matrix = world(obj)
        off = shared.elements.points @ matrix[:3, :3].T + matrix[:3, 3] - points
        farthest = max(farthest, float(np.linalg.norm(off, axis=1).max()))
    unused = {data for data, *_ in members.values() if data.mesh.users == 0}
    bpy.data.batch_remove([data.mesh for data in unused])
    context.view_layer.update()
    return Linked(linked, left_out + [*refused.items()], farthest, sum(data.bytes for data in unused))


def _is_mere_exchange(found: Correspondence) -> bool:
    """Return whether neither the transform nor the number of any element changes."""
    return found.is_still and found.is_ordered


def _followers(objects: set[Object]) -> dict[Object, ID]:
    """Return, by object, data that may show its transform at another time, as by a driver or a constraint."""
    found: dict[Object, ID] = {}
    for obj, users in (bpy.data.user_map(subset=objects) if objects else {}).items():
        for user in users:
            targets: list[ID | None] = []
            if isinstance(user, Object):
                curves = user.animation_data.drivers if user.animation_data is not None else ()
                variables = [variable for curve in curves for variable in curve.driver.variables]
                targets += [target.id for variable in variables for target in variable.targets]
                targets += [getattr(constraint, "target", None) for constraint in user.constraints]
            if obj in targets or not isinstance(user, (Object, *PLACES)):
                found[obj] = user
    return found


def _check(obj: Object, found: Correspondence, follower: ID | None) -> None:
    """Raise MeasureError if something of the object shows its own axes or numbering, perhaps at another time."""
    if not (obj.is_editable and obj.data.is_editable) or obj.override_library or obj.data.override_library:
        raise EditRefusedError(LINKED_OBJECT)
    if _is_mere_exchange(found):
        return
    reframe.check(obj)
    if follower is not None:
        raise EditRefusedError(FOLLOWS_MOVED, follower=follower.name, target=obj.name)
    own = [each.name for each in obj.modifiers if each.type not in reframe.FRAME_INDEPENDENT_MODIFIERS]
    if own:
        raise EditRefusedError(MODIFIERS_CHANGE_SHAPE, modifiers=own)
    if any(not constraint.mute for constraint in obj.constraints):
        raise EditRefusedError(TRANSFORM_CONSTRAINED, channel="location")
    channel = next((name for name in CHANNELS if any(path.startswith(name) for path in driven_channels(obj))), None)
    if channel is not None:
        raise EditRefusedError(CHANNEL_LOCKED, channel=channel)
    if obj.rigid_body or obj.rigid_body_constraint or obj.field is not None and obj.field.type != "NONE":
        raise EditRefusedError(OWN_AXES_USED, cause="Physics")
    for material in [slot.material for slot in obj.material_slots if not found.is_still]:
        if material is not None and material.node_tree is not None and _uses_own_axes(material.node_tree, set()):
            raise EditRefusedError(OWN_AXES_USED, cause=material.name)


def _uses_own_axes(tree: NodeTree, seen: set[NodeTree]) -> bool:
    """Return whether a material's nodes show the object's own origin or axes."""
    seen.add(tree)
    return any(_shows_own_axes(node) for node in tree.nodes) or any(
        _uses_own_axes(node.node_tree, seen)
        for node in tree.nodes
        if node.type == "GROUP" and node.node_tree is not None and node.node_tree not in seen
    )


def _shows_own_axes(node: Node) -> bool:
    outputs, vector = OWN_AXES_OUTPUTS.get(node.type, ()), node.inputs.get("Vector")
    if getattr(node, "object", None) is None and any(out.is_linked and out.name in outputs for out in node.outputs):
        return True
    if node.type.removeprefix("TEX_") in GENERATED and vector is not None and not vector.is_linked:
        return True
    choices = [each.identifier for each in node.bl_rna.properties if each.type == "ENUM" and not each.is_enum_flag]
    return any(getattr(node, name) in OWN_AXES_VALUES for name in choices)
