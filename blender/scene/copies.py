# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Copies among meshes: equal points, faces and layers of data, however the elements are numbered;
and their linking.

A mesh is compared with the first mesh of each kind so far. The first similarity counts that lays
one onto the other and under which the layers agree, too. So UVs and materials of symmetric shapes
stay in place.

If M lays the shared mesh onto an object's own one, its matrix W becomes W · M. `reframe` makes that
change and keeps it only if neither the object nor anything that refers to it looks different. It
compares the present frame, without shading: an object that would look different at another time, or
in a render, is left out before.
"""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cached_property
from itertools import chain, islice
from typing import NamedTuple

import bpy
import numpy as np
from bpy.types import ID, Context, Mesh, Node, NodesModifier, NodeTree, Object, bpy_prop_collection

from ...core.mesh import Correspondence, Elements, correspondences
from ...core.moments import affine_matrices
from ...core.numerics import Array, NDArray
from ...core.verdict import LINKED_OBJECT, EditRefusedError, Finding, MeasureError, finding
from . import reframe
from .dependents import SAME_SHAPE_RTOL
from .findings import (
    CHANNEL_LOCKED,
    COPY_DIFFERS,
    FOLLOWS_MOVED,
    MODIFIERS_CHANGE_SHAPE,
    OWN_AXES_USED,
    TRANSFORM_CONSTRAINED,
)
from .transforms import FLOAT32, driven_channels, world

MAX_TURNS = 48  # similarities of one pair whose layers are compared
NORMAL_TOLERANCE = 1e-3
# Attributes that are compared otherwise, or are the interface's state.
UNSEEN = (
    "position",
    "custom_normal",
    ".select",
    ".hide",
    ".corner_",
    ".edge_verts",
    ".vs.",
    ".es.",
    ".pn.",
)
# names of attributes' values, by their type in RNA
DTYPES = {
    "FLOAT": np.float32,
    "INT": np.int32,
    "BOOLEAN": bool,
}
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
# if nothing is linked
GENERATED = {
    "NOISE",
    "VORONOI",
    "WAVE",
    "MAGIC",
    "CHECKER",
    "BRICK",
    "GRADIENT",
    "GABOR",
}


class MeshData:
    """A mesh as arrays.

    layers: types, domains and (n, k) values of the attributes, by name. normals: (c, 3) of the
    corners, if they are the user's own. keys: the (n, 3) points of the shape keys. traits: all else
    that has to be equal, by aspect. bytes: the approximate memory of the mesh.
    """

    def __init__(self, mesh: Mesh, may_differ: set[str]):
        self.mesh = mesh
        self.may_differ = may_differ
        keys = mesh.shape_keys
        points = _read(mesh.attributes["position"].data if mesh.vertices else ())
        corners = _read(mesh.loops, "vertex_index")[:, 0]
        starts = np.append(_read(mesh.polygons, "loop_start")[:, 0], len(corners))
        self.elements = Elements(
            points.astype(float), _read(mesh.edges, "vertices").astype(np.intp), corners, starts
        )
        # Custom normals alone decide the shading; importers set these two by comparing floats.
        unseen = (*UNSEEN, "sharp_") if mesh.has_custom_normals else UNSEEN
        layers = [layer for layer in mesh.attributes if not layer.name.startswith(unseen)]
        self.layers = {
            layer.name: (layer.data_type, layer.domain, _read(layer.data)) for layer in layers
        }
        self.normals = _read(mesh.corner_normals) if mesh.has_custom_normals else None
        blocks = () if keys is None else keys.key_blocks
        self.keys = [_read(block.data, "co") for block in blocks]
        arrays = [
            corners,
            starts,
            self.elements.edges,
            *self.keys,
            *(values for _, _, values in self.layers.values()),
        ]
        self.bytes = points.nbytes + sum(array.nbytes for array in arrays)
        self.is_animated = any(data is not None and data.animation_data for data in (mesh, keys))
        names = ("name", "value", "mute", "interpolation", "vertex_group")
        relations = [
            (block.relative_key.name, *(getattr(block, name) for name in names)) for block in blocks
        ]
        space = () if mesh.use_auto_texspace else (*mesh.texspace_location, *mesh.texspace_size)
        self.traits = {
            "UV": [layer.name for layer in mesh.uv_layers if layer.active_render],
            "ATTRIBUTES": (mesh.color_attributes.render_color_index, mesh.has_custom_normals),
            "MATERIALS": [material and material.session_uid for material in mesh.materials],
            "PROPERTIES": (mesh.id_properties_ensure().to_dict(), space),
            "SHAPE_KEYS": (relations, keys and keys.use_relative),
        }

    @cached_property
    def weights(self) -> list[dict[int, float]]:
        """The weights of each vertex by the number of the group; Blender gives them one by one
        only.
        """
        return [
            {entry.group: entry.weight for entry in vertex.groups} for vertex in self.mesh.vertices
        ]

    @cached_property
    def labels(self) -> Array:
        """The (n,) numbers of the vertices, by the layers that have to agree."""
        found = np.zeros(len(self.mesh.vertices))
        elements = self.elements
        sizes = np.diff(elements.starts)
        for name, (data_type, domain, values) in self.layers.items():
            if _aspect(name, data_type, domain) in self.may_differ or values.dtype == object:
                continue
            number = (
                values
                @ np.cos(np.arange(values.shape[1]))
                / max(np.abs(values).max(initial=0), 1.0)
            )
            if domain == "POINT":
                found += number
            elif domain == "EDGE":
                found += np.bincount(elements.edges.ravel(), number.repeat(2), len(found))
            elif domain in ("FACE", "CORNER"):
                number = number if domain == "CORNER" else number.repeat(sizes)
                found += np.bincount(elements.corners, number, len(found))
        return found


def _read(items: bpy_prop_collection, name: str | int = 1) -> NDArray:
    """Return the (n, k) values of a property of all items, by default the first after `rna_type`;
    texts as objects.
    """
    if not len(items):
        return np.empty((0, 3), np.int32)
    value = items[0].bl_rna.properties[name]
    if value.type not in DTYPES:
        return np.array([getattr(item, value.identifier) for item in items], object)
    values = np.empty((len(items), max(value.array_length, 1)), DTYPES[value.type])
    items.foreach_get(value.identifier, values.reshape(-1))
    return values


def _differing_aspects(
    first: MeshData,
    second: MeshData,
    groups: list[list[str]],
    found: Correspondence,
    tolerance: float,
) -> set[str]:
    """Return the aspects in which two equal surfaces do not agree. groups: names of their vertex
    groups.
    """
    differing = {name for name, trait in first.traits.items() if trait != second.traits[name]}
    if first.is_animated or second.is_animated:
        differing.add("ANIMATION")
    maps = {
        "POINT": found.vertices,
        "EDGE": found.edges,
        "FACE": found.faces,
        "CORNER": found.corners,
    }
    for name in first.layers.keys() | second.layers.keys():
        one = first.layers.get(name)
        other = second.layers.get(name)
        if one is None or other is None:
            data_type, domain, values = one or other or ("", "", maps["POINT"])
            is_alike = not values.any()  # a layer that is missing has zeros
        else:
            data_type, domain, values = one
            is_alike = one[:2] == other[:2] and domain in maps
            if is_alike and values.dtype == np.float32:
                others = other[2][maps[domain]]
                off = np.abs(values - others).max(initial=0.0)
                is_alike = off <= 16.0 * FLOAT32 * np.abs(others).max(initial=1.0)
            elif is_alike:
                is_alike = np.array_equal(values, other[2][maps[domain]])
        if not is_alike:
            differing.add(_aspect(name, data_type, domain))
    if first.normals is not None and second.normals is not None:
        turned = first.normals @ (found.linear / np.cbrt(abs(np.linalg.det(found.linear)))).T
        if np.abs(turned - second.normals[found.corners]).max(initial=0.0) > NORMAL_TOLERANCE:
            differing.add("ATTRIBUTES")
    if (
        groups[0] != groups[1]
        or groups[0]
        and first.weights != [second.weights[i] for i in found.vertices]
    ):
        differing.add("GROUPS")
    for points, others in zip(first.keys, second.keys):
        off = points @ found.linear.T + found.offset - others[found.vertices]
        if np.abs(off).max(initial=0.0) > tolerance * second.elements.radius:
            differing.add("SHAPE_KEYS")
    return differing


def _aspect(name: str, data_type: str, domain: str) -> str:
    if name == "material_index":
        return "MATERIALS"
    return "UV" if (data_type, domain) == ("FLOAT2", "CORNER") else "ATTRIBUTES"


@dataclass(eq=False)
class Copies:
    """Objects that can share a mesh.

    members: objects with other meshes, and how the shared mesh's elements meet theirs. reason: the
    reason why the objects cannot share a mesh of equal surface.
    """

    data: MeshData
    objects: list[Object]
    members: list[tuple[Object, MeshData, Correspondence]] = field(default_factory=list)
    reason: Finding | None = None

    @property
    def saved_bytes(self) -> int:
        """The memory of the meshes that nobody would use any more."""
        counts = Counter(data for _, data, _ in self.members)
        return sum(data.bytes for data, count in counts.items() if data.mesh.users == count)


def find_copies(
    objects: Sequence[Object],
    tolerance: float,
    may_differ: set[str],
    progress: Callable[[float], None],
) -> list[Copies]:
    """Return the kinds of meshes of mesh objects. progress: called with the number of compared
    objects.
    """
    users: dict[Mesh, list[Object]] = {}
    for obj in objects:
        users.setdefault(obj.data, []).append(obj)
    kinds: list[Copies] = []
    by_counts: dict[tuple, list[Copies]] = {}
    done = 0
    for mesh, own in sorted(users.items(), key=lambda item: (-len(item[1]), item[0].name_full)):
        counts = len(mesh.vertices), len(mesh.edges), len(mesh.loops), len(mesh.polygons)
        same_counts = by_counts.setdefault(counts, [])
        new = Copies(MeshData(mesh, may_differ), own)
        for kind in same_counts:
            groups = [
                [group.name for group in each.objects[0].vertex_groups] for each in (kind, new)
            ]
            labels = kind.data.labels, new.data.labels
            pair = kind.data.elements, new.data.elements
            # If the layers do not agree, the turn counts with the fewest differences.
            found_turns = chain(
                correspondences(*pair, tolerance, labels), correspondences(*pair, tolerance)
            )
            best: tuple[set[str], Correspondence] | None = None
            for found in islice(found_turns, MAX_TURNS):
                differing = (
                    _differing_aspects(kind.data, new.data, groups, found, tolerance) - may_differ
                )
                if best is None or len(differing) < len(best[0]):
                    best = differing, found
                if not differing:
                    break
            if best is not None and not best[0]:
                kind.members += [(obj, new.data, best[1]) for obj in own]
                break
            if best is not None:
                aspects = sorted(name.lower().replace("_", " ") for name in best[0])
                new.reason = finding(COPY_DIFFERS, object=kind.data.mesh.name, aspects=aspects)
        else:
            kinds.append(new)
            same_counts.append(new)
        done += len(own)
        progress(done)
    return kinds


class Linked(NamedTuple):
    """The linked objects, reasons for those left out, the farthest move of a vertex, and the bytes
    saved.
    """

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
    """Let the members of each kind share its mesh; no vertex moves by more than the tolerance,
    relative to the size.
    """
    left_out = [
        (obj, kind.reason)
        for kind in kinds
        if kind.reason and not kind.members
        for obj in kind.objects
    ]
    plans: list[reframe.Plan] = []
    members: dict[Object, tuple] = {}  # own and shared mesh, places of the vertices, materials
    followers = _followers(
        {
            target
            for kind in kinds
            for obj, _, found in kind.members
            for target in ((obj.data,) if _is_mere_exchange(found) else (obj, obj.data))
        }
    )
    for kind in kinds:
        for obj, data, found in kind.members:
            try:
                _check(obj, found, followers.get(obj) or followers.get(obj.data))
            except MeasureError as error:
                left_out.append((obj, error.finding))
                continue
            matrix = world(obj)
            change = affine_matrices(found.linear, found.offset)
            points = data.elements.points[found.vertices] @ matrix[:3, :3].T + matrix[:3, 3]
            members[obj] = data, kind.data, points, [slot.material for slot in obj.material_slots]
            if not _is_mere_exchange(found):
                radius = float(np.linalg.norm(points - points.mean(axis=0), axis=1).max())
                plans.append(
                    reframe.Plan(
                        obj,
                        matrix @ change,
                        radius * tolerance / SAME_SHAPE_RTOL,
                        move_only=False,
                        mesh=kind.data.mesh,
                        order=None if found.is_ordered else found.vertices,
                    )
                )
    refused = dict(reframe.reframe(context, plans, progress)[1])
    farthest = 0.0
    linked = [obj for obj in members if obj not in refused]
    for obj in linked:
        _, shared, points, materials = members[obj]
        obj.data = shared.mesh
        for slot, material in zip(obj.material_slots, materials):
            if keep_materials and slot.material != material:
                slot.link = "OBJECT"
                slot.material = material
        matrix = world(obj)
        off = shared.elements.points @ matrix[:3, :3].T + matrix[:3, 3] - points
        farthest = max(farthest, float(np.linalg.norm(off, axis=1).max()))
    unused = {data for data, *_ in members.values() if data.mesh.users == 0}
    bpy.data.batch_remove([data.mesh for data in unused])
    context.view_layer.update()
    return Linked(
        linked, left_out + [*refused.items()], farthest, sum(data.bytes for data in unused)
    )


def _is_mere_exchange(found: Correspondence) -> bool:
    """Return whether neither the transform nor the number of any element changes."""
    return found.is_still and found.is_ordered


def _followers(objects: set[ID]) -> dict[ID, ID]:
    """Return, by object or mesh, data that may show its transform or values at another time, as by
    a driver or a constraint.
    """
    found: dict[ID, ID] = {}
    for obj, users in (bpy.data.user_map(subset=objects) if objects else {}).items():
        for user in users - {getattr(obj, "shape_keys", None)}:
            if not isinstance(user, (Object, *PLACES)) or obj in _pointed_at(user):
                found[obj] = user
    for user in _animated_data():
        for obj in _read_by_drivers(user) & objects:
            found.setdefault(obj, user)
    return found


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
    found: set[ID] = set()
    variables = [each for curve in user.animation_data.drivers for each in curve.driver.variables]
    for target in [target for variable in variables for target in variable.targets]:
        path = target.data_path
        starts = [target.id] if target.id is not None else [*bpy.data.scenes]
        found.update(starts)
        for start in starts:
            for end in (end for end, letter in enumerate(path) if letter == "."):
                with suppress(ValueError):  # of a point inside a name
                    passed = start.path_resolve(path[:end])
                    found |= {passed} if isinstance(passed, ID) else set()
    return found


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


def _check(obj: Object, found: Correspondence, follower: ID | None) -> None:
    """Raise MeasureError if any part of the object depends on its axes or numbering, perhaps at
    another time.
    """
    if (
        not (obj.is_editable and obj.data.is_editable)
        or obj.override_library
        or obj.data.override_library
    ):
        raise EditRefusedError(LINKED_OBJECT)
    if follower is not None:
        raise EditRefusedError(FOLLOWS_MOVED, follower=follower.name, target=obj.name)
    if _is_mere_exchange(found):
        return
    reframe.check(obj)
    own = [
        each.name for each in obj.modifiers if each.type not in reframe.FRAME_INDEPENDENT_MODIFIERS
    ]
    if own:
        raise EditRefusedError(MODIFIERS_CHANGE_SHAPE, modifiers=own)
    if any(not constraint.mute for constraint in obj.constraints):
        raise EditRefusedError(TRANSFORM_CONSTRAINED, channel="location")
    for channel in CHANNELS:
        if any(path.startswith(channel) for path in driven_channels(obj)):
            raise EditRefusedError(CHANNEL_LOCKED, channel=channel)
    if (
        obj.rigid_body
        or obj.rigid_body_constraint
        or obj.field is not None
        and obj.field.type != "NONE"
    ):
        raise EditRefusedError(OWN_AXES_USED, cause="Physics")
    for material in [slot.material for slot in obj.material_slots if not found.is_still]:
        if (
            material is not None
            and material.node_tree is not None
            and _uses_own_axes(material.node_tree, set())
        ):
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
    vector = node.inputs.get("Vector")
    if getattr(node, "object", None) is None and any(
        out.is_linked and out.name in outputs for out in node.outputs
    ):
        return True
    if node.type.removeprefix("TEX_") in GENERATED and vector is not None and not vector.is_linked:
        return True
    choices = [
        each.identifier
        for each in node.bl_rna.properties
        if each.type == "ENUM" and not each.is_enum_flag
    ]
    return any(getattr(node, name) in OWN_AXES_VALUES for name in choices)
