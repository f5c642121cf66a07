# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Copies among meshes: equal points, faces and layers of data, however the elements are
numbered. `linking` lets them share a mesh.

A mesh is compared with the first mesh of each kind so far. The first similarity counts that lays
one onto the other and under which the layers agree, too. So UVs and materials of symmetric shapes
stay in place.
"""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import chain, islice

import numpy as np
from bpy.types import Mesh, Object, bpy_prop_collection

from ...core.mesh import Correspondence, Elements, correspondences
from ...core.numerics import Array, NDArray
from ...core.verdict import Finding, finding
from .findings import COPY_DIFFERS
from .transforms import FLOAT32

MAX_TURNS = 48  # similarities of one pair whose layers are compared
NORMAL_TOLERANCE = 1e-3
Layer = tuple[str, str, NDArray]  # type, domain and (n, k) values of an attribute
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
DTYPES = {"FLOAT": np.float32, "INT": np.int32, "BOOLEAN": bool}  # by type in RNA


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
        """(n,) labels of the vertices: corresponding vertices have equal ones if all layers agree
        that may not differ. They limit the similarities that are compared.
        """
        labels = np.zeros(len(self.mesh.vertices))
        elements = self.elements
        for name, (data_type, domain, values) in self.layers.items():
            if _aspect(name, data_type, domain) in self.may_differ or values.dtype == object:
                continue
            # The weights of the components are distinct, so that swapped components change labels.
            mixture = np.cos(np.arange(values.shape[1]))
            label = values @ mixture / max(np.abs(values).max(initial=0), 1.0)
            if domain == "POINT":
                labels += label
            elif domain == "EDGE":
                labels += np.bincount(elements.edges.ravel(), label.repeat(2), len(labels))
            elif domain in ("FACE", "CORNER"):
                if domain == "FACE":
                    label = label.repeat(np.diff(elements.starts))
                labels += np.bincount(elements.corners, label, len(labels))
        return labels


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
    correspondence: Correspondence,
    tolerance: float,
) -> set[str]:
    """Return the aspects in which two equal surfaces do not agree. groups: names of their vertex
    groups.
    """
    differing = {name for name, trait in first.traits.items() if trait != second.traits[name]}
    if first.is_animated or second.is_animated:
        differing.add("ANIMATION")
    for name in first.layers.keys() | second.layers.keys():
        layer = first.layers.get(name)
        other_layer = second.layers.get(name)
        if not _is_same_layer(layer, other_layer, correspondence):
            data_type, domain, _ = layer or second.layers[name]
            differing.add(_aspect(name, data_type, domain))
    linear = correspondence.linear
    if first.normals is not None and second.normals is not None:
        turned = first.normals @ (linear / np.cbrt(abs(np.linalg.det(linear)))).T
        off = np.abs(turned - second.normals[correspondence.corners])
        if off.max(initial=0.0) > NORMAL_TOLERANCE:
            differing.add("ATTRIBUTES")
    has_same_weights = groups[0] == groups[1] and (
        not groups[0] or first.weights == [second.weights[i] for i in correspondence.vertices]
    )
    if not has_same_weights:
        differing.add("GROUPS")
    for points, other_points in zip(first.keys, second.keys):
        placed = points @ linear.T + correspondence.offset
        off = np.abs(placed - other_points[correspondence.vertices])
        if off.max(initial=0.0) > tolerance * second.elements.radius:
            differing.add("SHAPE_KEYS")
    return differing


def _is_same_layer(
    layer: Layer | None, other: Layer | None, correspondence: Correspondence
) -> bool:
    """Return whether two layers have equal values on corresponding elements; a missing layer has
    zeros.
    """
    if layer is None or other is None:
        present = layer or other
        return present is None or not present[2].any()
    data_type, domain, values = layer
    indices_by_domain = {
        "POINT": correspondence.vertices,
        "EDGE": correspondence.edges,
        "FACE": correspondence.faces,
        "CORNER": correspondence.corners,
    }
    if other[:2] != (data_type, domain) or domain not in indices_by_domain:
        return False
    other_values = other[2][indices_by_domain[domain]]
    if values.dtype != np.float32:
        return np.array_equal(values, other_values)
    off = np.abs(values - other_values).max(initial=0.0)
    # Two values computed in float32 may differ by a few roundings; 16 is chosen with a margin.
    return bool(off <= 16.0 * FLOAT32 * np.abs(other_values).max(initial=1.0))


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
    # Meshes with the most users come first, so that these users need not change.
    by_user_count = sorted(users.items(), key=lambda item: (-len(item[1]), item[0].name_full))
    for mesh, mesh_users in by_user_count:
        counts = len(mesh.vertices), len(mesh.edges), len(mesh.loops), len(mesh.polygons)
        same_counts = by_counts.setdefault(counts, [])
        new = Copies(MeshData(mesh, may_differ), mesh_users)
        if not _join_kind(new, same_counts, tolerance, may_differ):
            kinds.append(new)
            same_counts.append(new)
        done += len(mesh_users)
        progress(done)
    return kinds


def _join_kind(
    new: Copies, kinds: Sequence[Copies], tolerance: float, may_differ: set[str]
) -> bool:
    """Make the objects of a mesh members of the first kind whose mesh they can share; return
    whether there is one. Otherwise note the reason if a surface is equal.
    """
    for kind in kinds:
        best = _best_correspondence(kind, new, tolerance, may_differ)
        if best is None:
            continue
        differing, correspondence = best
        if not differing:
            kind.members += [(obj, new.data, correspondence) for obj in new.objects]
            return True
        aspects = sorted(name.lower().replace("_", " ") for name in differing)
        new.reason = finding(COPY_DIFFERS, object=kind.data.mesh.name, aspects=aspects)
    return False


def _best_correspondence(
    kind: Copies, new: Copies, tolerance: float, may_differ: set[str]
) -> tuple[set[str], Correspondence] | None:
    """Return the differing aspects and the similarity of two surfaces that has the fewest of them;
    None if the surfaces differ.
    """
    groups = [[group.name for group in each.objects[0].vertex_groups] for each in (kind, new)]
    labels = kind.data.labels, new.data.labels
    pair = kind.data.elements, new.data.elements
    # Similarities under which the labels agree, too, come first.
    candidates = chain(correspondences(*pair, tolerance, labels), correspondences(*pair, tolerance))
    best: tuple[set[str], Correspondence] | None = None
    for candidate in islice(candidates, MAX_TURNS):
        differing = _differing_aspects(kind.data, new.data, groups, candidate, tolerance)
        differing -= may_differ
        if best is None or len(differing) < len(best[0]):
            best = differing, candidate
        if not differing:
            break
    return best
