# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Copies among meshes: equal points, faces and layers of data, however the elements are numbered.

A mesh is compared with the first mesh of each kind so far. Of the similarities that lay one onto the other, the first
counts under which the layers agree, too: so UVs and materials of symmetric shapes stay in place.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import chain, islice

import numpy as np
from bpy.types import Mesh, Object, bpy_prop_collection
from numpy.typing import NDArray

from ....core.mesh.correspondence import Correspondence, Elements, correspondences
from ....core.verdict.finding import Finding, finding
from ..findings import COPY_DIFFERS
from ..transforms import FLOAT32

MAX_TURNS = 48  # similarities of one pair whose layers are compared
NORMAL_TOLERANCE = 1e-3
# Attributes that are compared otherwise, or are the interface's state.
UNSEEN = ("position", "custom_normal", ".select", ".hide", ".corner_", ".edge_verts", ".vs.", ".es.", ".pn.")
DTYPES = {"FLOAT": np.float32, "INT": np.int32, "BOOLEAN": bool}  # of attributes' values, by their type in RNA


class MeshData:
    """A mesh as arrays.

    layers: types, domains and (n, k) values of the attributes, by name. normals: (c, 3) of the corners, if they are the
    user's own. keys: the (n, 3) points of the shape keys. traits: all else that has to be equal, by
    aspect. bytes: the memory that the mesh takes, about.
    """

    def __init__(self, mesh: Mesh, may_differ: set[str]):
        self.mesh, self.may_differ, keys = mesh, may_differ, mesh.shape_keys
        points = _read(mesh.attributes["position"].data if mesh.vertices else ())
        corners = _read(mesh.loops, "vertex_index")[:, 0]
        starts = np.append(_read(mesh.polygons, "loop_start")[:, 0], len(corners))
        self.elements = Elements(points.astype(float), _read(mesh.edges, "vertices").astype(np.intp), corners, starts)
        layers = [layer for layer in mesh.attributes if not layer.name.startswith(UNSEEN)]
        self.layers = {layer.name: (layer.data_type, layer.domain, _read(layer.data)) for layer in layers}
        self.normals = _read(mesh.corner_normals) if mesh.has_custom_normals else None
        blocks = () if keys is None else keys.key_blocks
        self.keys = [_read(block.data, "co") for block in blocks]
        arrays = [corners, starts, self.elements.edges, *self.keys, *(values for _, _, values in self.layers.values())]
        self.bytes = points.nbytes + sum(array.nbytes for array in arrays)
        self.is_animated = any(data is not None and data.animation_data for data in (mesh, keys))
        names = ("name", "value", "mute", "interpolation", "vertex_group")
        relations = [(block.relative_key.name, *(getattr(block, name) for name in names)) for block in blocks]
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
        """The weights of each vertex by the number of the group; Blender gives them one by one only."""
        return [{entry.group: entry.weight for entry in vertex.groups} for vertex in self.mesh.vertices]

    @cached_property
    def labels(self) -> NDArray[np.float64]:
        """The (n,) numbers of the vertices, by the layers that have to agree."""
        found, elements = np.zeros(len(self.mesh.vertices)), self.elements
        sizes = np.diff(elements.starts)
        for name, (data_type, domain, values) in self.layers.items():
            if _aspect(name, data_type, domain) in self.may_differ or values.dtype == object:
                continue
            number = values @ np.cos(np.arange(values.shape[1])) / max(np.abs(values).max(initial=0), 1.0)
            if domain == "POINT":
                found += number
            elif domain == "EDGE":
                found += np.bincount(elements.edges.ravel(), number.repeat(2), len(found))
            elif domain in ("FACE", "CORNER"):
                number = number if domain == "CORNER" else number.repeat(sizes)
                found += np.bincount(elements.corners, number, len(found))
        return found


def _read(items: bpy_prop_collection, name: str | int = 1) -> NDArray:
    """Return the (n, k) values of a property of all items, by default the first after `rna_type`; texts as objects."""
    if not len(items):
        return np.empty((0, 3), np.int32)
    value = items[0].bl_rna.properties[name]
    if value.type not in DTYPES:
        return np.array([getattr(item, value.identifier) for item in items], object)
    values = np.empty((len(items), max(value.array_length, 1)), DTYPES[value.type])
    items.foreach_get(value.identifier, values.reshape(-1))
    return values


def _differing_aspects(
    first: MeshData, second: MeshData, groups: list[list[str]], found: Correspondence, tolerance: float
) -> set[str]:
    """Return the aspects in which two equal surfaces do not agree. groups: names of their vertex groups."""
    differing = {name for name, trait in first.traits.items() if trait != second.traits[name]}
    if first.is_animated or second.is_animated:
        differing.add("ANIMATION")
    maps = {"POINT": found.vertices, "EDGE": found.edges, "FACE": found.faces, "CORNER": found.corners}
    for name in first.layers.keys() | second.layers.keys():
        one, other = first.layers.get(name), second.layers.get(name)
        if one is None or other is None:
            data_type, domain, values = one or other or ("", "", maps["POINT"])
            is_alike = not values.any()  # a layer that is missing has zeros
        else:
            data_type, domain, values = one
            is_alike = one[:2] == other[:2] and domain in maps and _agree(values, other[2][maps[domain]])
        if not is_alike:
            differing.add(_aspect(name, data_type, domain))
    if first.normals is not None and second.normals is not None:
        turned = first.normals @ (found.linear / np.cbrt(abs(np.linalg.det(found.linear)))).T
        if np.abs(turned - second.normals[found.corners]).max(initial=0.0) > NORMAL_TOLERANCE:
            differing.add("ATTRIBUTES")
    if groups[0] != groups[1] or groups[0] and first.weights != [second.weights[i] for i in found.vertices]:
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


def _agree(values: NDArray, others: NDArray) -> bool:
    if values.dtype != np.float32:
        return np.array_equal(values, others)
    off = np.abs(values - others).max(initial=0.0)
    return bool(off <= 16.0 * FLOAT32 * np.abs(others).max(initial=1.0))


@dataclass(eq=False)
class Copies:
    """Objects that can share a mesh.

    members: objects with other meshes, and how the shared mesh's elements meet theirs. reason: the reason why the
    objects cannot share a mesh of equal surface.
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
    objects: Sequence[Object], tolerance: float, may_differ: set[str], progress: Callable[[float], None]
) -> list[Copies]:
    """Return the kinds of meshes of mesh objects. progress: called with the number of compared objects."""
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
            groups = [[group.name for group in each.objects[0].vertex_groups] for each in (kind, new)]
            labels = kind.data.labels, new.data.labels
            pair = kind.data.elements, new.data.elements
            # If the layers do not agree, the turn counts with the fewest differences.
            found_turns = chain(correspondences(*pair, tolerance, labels), correspondences(*pair, tolerance))
            best: tuple[set[str], Correspondence] | None = None
            for found in islice(found_turns, MAX_TURNS):
                differing = _differing_aspects(kind.data, new.data, groups, found, tolerance) - may_differ
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
