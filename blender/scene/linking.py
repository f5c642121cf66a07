# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Copies of a mesh in other places that share one mesh from now on, and look as before.

If M lays the shared mesh onto an object's own one, its matrix W becomes W · M. `reframe` makes that
change and keeps it only if neither the object nor anything that refers to it looks different. It
compares the present frame, without shading: an object that would look different at another time, or
in a render, is left out before.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from typing import NamedTuple

import bpy
import numpy as np
from bpy.types import ID, Context, Material, Node, NodesModifier, NodeTree, Object

from ...core.mesh import Correspondence
from ...core.moments import affine_matrices
from ...core.numerics import Array
from ...core.verdict import LINKED_OBJECT, EditRefusedError, Finding, MeasureError
from . import reframe
from .copies import Copies, MeshData
from .dependents import SAME_SHAPE_RTOL
from .findings import (
    CHANNEL_LOCKED,
    FOLLOWS_MOVED,
    MODIFIERS_CHANGE_SHAPE,
    OWN_AXES_USED,
    TRANSFORM_CONSTRAINED,
)
from .transforms import driven_channels, world

PLACES = (
    bpy.types.Collection,
    bpy.types.Scene,
    bpy.types.WindowManager,
    bpy.types.Screen,
    bpy.types.WorkSpace,
)
CHANNELS = ("location", "rotation", "scale", "delta")  # beginnings of animated data paths
# Nodes that show a mesh's own axes: outputs, by the node's type, or values of a setting.
OWN_AXES_OUTPUTS = {"TEX_COORD": {"Object", "Generated", "Normal"}, "OBJECT_INFO": {"Location"}}
OWN_AXES_VALUES = {"OBJECT", "BLENDER_OBJECT", "RADIAL"}
# textures with generated coordinates if nothing is linked
GENERATED = {"NOISE", "VORONOI", "WAVE", "MAGIC", "CHECKER", "BRICK", "GRADIENT", "GABOR"}


class Linked(NamedTuple):
    """The linked objects, reasons for those left out, the farthest move of a vertex, and the bytes
    saved.
    """

    objects: list[Object]
    left_out: list[tuple[Object, Finding]]
    farthest: float
    saved: int


class _Link(NamedTuple):
    """The exchange of an object's mesh.

    places: (n, 3) places in the world, before, of the vertices that correspond to the shared ones.
    """

    previous: MeshData
    shared: MeshData
    places: Array
    materials: list[Material | None]


def link_copies(
    context: Context,
    kinds: Sequence[Copies],
    tolerance: float,
    keep_materials: bool,
    progress: Callable[[float], None] = lambda done: None,
) -> Linked:
    """Let the members of each kind share its mesh; no vertex moves by more than the tolerance,
    relative to the size.
    """
    left_out = [
        (obj, kind.reason)
        for kind in kinds
        if kind.reason and not kind.members
        for obj in kind.objects
    ]
    followers = _followers_of_members(kinds)
    plans: list[reframe.Plan] = []
    links: dict[Object, _Link] = {}
    for kind in kinds:
        for obj, data, correspondence in kind.members:
            try:
                _check(obj, correspondence, followers.get(obj) or followers.get(obj.data))
            except MeasureError as error:
                left_out.append((obj, error.finding))
                continue
            matrix = world(obj)
            points = data.elements.points[correspondence.vertices]
            places = points @ matrix[:3, :3].T + matrix[:3, 3]
            materials = [slot.material for slot in obj.material_slots]
            links[obj] = _Link(data, kind.data, places, materials)
            if not _is_mere_exchange(correspondence):
                change = affine_matrices(correspondence.linear, correspondence.offset)
                radius = float(np.linalg.norm(places - places.mean(axis=0), axis=1).max())
                plans.append(
                    reframe.Plan(
                        obj,
                        matrix @ change,
                        # so that `reframe` compares to the tolerance
                        radius * tolerance / SAME_SHAPE_RTOL,
                        move_only=False,
                        mesh=kind.data.mesh,
                        order=None if correspondence.is_ordered else correspondence.vertices,
                    )
                )
    refused = dict(reframe.reframe(context, plans, progress)[1])
    farthest = 0.0
    linked = [obj for obj in links if obj not in refused]
    for obj in linked:
        link = links[obj]
        obj.data = link.shared.mesh
        for slot, material in zip(obj.material_slots, link.materials):
            if keep_materials and slot.material != material:
                slot.link = "OBJECT"
                slot.material = material
        matrix = world(obj)
        off = link.shared.elements.points @ matrix[:3, :3].T + matrix[:3, 3] - link.places
        farthest = max(farthest, float(np.linalg.norm(off, axis=1).max()))
    unused = {link.previous for link in links.values() if link.previous.mesh.users == 0}
    bpy.data.batch_remove([data.mesh for data in unused])
    context.view_layer.update()
    return Linked(
        linked,
        left_out + [*refused.items()],
        farthest,
        saved=sum(data.bytes for data in unused),
    )


def _is_mere_exchange(correspondence: Correspondence) -> bool:
    """Return whether neither the transform nor the number of any element changes."""
    return correspondence.is_still and correspondence.is_ordered


def _followers_of_members(kinds: Sequence[Copies]) -> dict[ID, ID]:
    """Return the followers of all data that change if the members share their kinds' meshes."""
    changing: set[ID] = set()
    for kind in kinds:
        for obj, _, correspondence in kind.members:
            changing.add(obj.data)
            if not _is_mere_exchange(correspondence):
                changing.add(obj)
    return _followers(changing)


def _followers(objects: set[ID]) -> dict[ID, ID]:
    """Return, by object or mesh, data that may show its transform or values at another time, as by
    a driver or a constraint.
    """
    followers: dict[ID, ID] = {}
    for data, users in (bpy.data.user_map(subset=objects) if objects else {}).items():
        for user in users - {getattr(data, "shape_keys", None)}:
            if not isinstance(user, (Object, *PLACES)) or data in _pointed_at(user):
                followers[data] = user
    for user in _animated_data():
        for data in _read_by_drivers(user) & objects:
            followers.setdefault(data, user)
    return followers


def _animated_data() -> Iterator[ID]:
    """Yield the data of the file that have drivers, node trees inside others included."""
    for prop in bpy.data.bl_rna.properties:
        if prop.type == "COLLECTION":
            for data in getattr(bpy.data, prop.identifier):
                for user in (data, getattr(data, "node_tree", None)):
                    if getattr(user, "animation_data", None) is not None:
                        yield user


def _read_by_drivers(user: ID) -> set[ID]:
    """Return the data that the drivers' variables name, or pass on the way along their paths."""
    data: set[ID] = set()
    variables = [each for curve in user.animation_data.drivers for each in curve.driver.variables]
    for target in [target for variable in variables for target in variable.targets]:
        path = target.data_path
        starts = [target.id] if target.id is not None else [*bpy.data.scenes]
        data.update(starts)
        for start in starts:
            for end in (end for end, letter in enumerate(path) if letter == "."):
                with suppress(ValueError):  # a point inside a name ends no path
                    passed = start.path_resolve(path[:end])
                    if isinstance(passed, ID):
                        data.add(passed)
    return data


def _pointed_at(user: ID) -> set[ID]:
    """Return the data that an object's constraints, modifiers, effects and bones point at."""
    pointed: set[ID] = set()
    if isinstance(user, Object):
        bones = user.pose.bones if user.pose is not None else ()
        pointed |= {bone.custom_shape for bone in bones}
        constraints = [*user.constraints, *(each for bone in bones for each in bone.constraints)]
        for each in (*constraints, *user.modifiers, *user.shader_effects):
            pointed |= {
                getattr(each, prop.identifier)
                for prop in each.bl_rna.properties
                if prop.type == "POINTER"
            }
            pointed |= {target.target for target in getattr(each, "targets", ())}
            values = each.values() if isinstance(each, NodesModifier) else ()
            pointed |= {value for value in values if isinstance(value, ID)}
    return pointed


def _check(obj: Object, correspondence: Correspondence, follower: ID | None) -> None:
    """Raise MeasureError if any part of the object depends on its axes or numbering, perhaps at
    another time.
    """
    for data in (obj, obj.data):
        if not data.is_editable or data.override_library:
            raise EditRefusedError(LINKED_OBJECT)
    if follower is not None:
        raise EditRefusedError(FOLLOWS_MOVED, follower=follower.name, target=obj.name)
    if _is_mere_exchange(correspondence):
        return
    reframe.check(obj)
    frame_dependent = [
        each.name for each in obj.modifiers if each.type not in reframe.FRAME_INDEPENDENT_MODIFIERS
    ]
    if frame_dependent:
        raise EditRefusedError(MODIFIERS_CHANGE_SHAPE, modifiers=frame_dependent)
    if any(not constraint.mute for constraint in obj.constraints):
        raise EditRefusedError(TRANSFORM_CONSTRAINED, channel="location")
    for channel in CHANNELS:
        if any(path.startswith(channel) for path in driven_channels(obj)):
            raise EditRefusedError(CHANNEL_LOCKED, channel=channel)
    has_field = obj.field is not None and obj.field.type != "NONE"
    if obj.rigid_body or obj.rigid_body_constraint or has_field:
        raise EditRefusedError(OWN_AXES_USED, cause="Physics")
    if correspondence.is_still:
        return
    for material in [slot.material for slot in obj.material_slots]:
        tree = material and material.node_tree
        if tree is not None and _uses_own_axes(tree, set()):
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
    """Return whether a shader node draws by the object's own axes: by a linked output, by generated
    coordinates, or by a choice.
    """
    outputs = OWN_AXES_OUTPUTS.get(node.type, ())
    other_object = getattr(node, "object", None)  # whose coordinates the node gives instead
    if other_object is None and any(
        output.is_linked and output.name in outputs for output in node.outputs
    ):
        return True
    vector = node.inputs.get("Vector")
    if node.type.removeprefix("TEX_") in GENERATED and vector is not None and not vector.is_linked:
        return True
    return any(
        prop.type == "ENUM"
        and not prop.is_enum_flag
        and getattr(node, prop.identifier) in OWN_AXES_VALUES
        for prop in node.bl_rna.properties
    )
