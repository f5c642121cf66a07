# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""glTF files as objects of the open scene, corrected by the file's nodes.

Blender's importer ignores KHR_node_visibility and MSFT_lod, drops the shear of a matrix and of
joints, and clamps the weights of morph targets. Its hook tells the object of each node.
"""

import math
import re
from bisect import bisect_right
from typing import Any, NamedTuple

import addon_utils
import bpy
import numpy as np
from bpy.types import Object

from ...core.cad import UPRIGHT
from ...core.files import FILE_UNREADABLE, MALFORMED, GltfFile, map_file, node_matrix
from ...core.numerics import Array
from ...core.verdict import FileError, Finding, finding
from ..findings import FILE_HIDES, PLACES_UNCHECKED
from .placing import measure_at, place_objects, show_points, shown_seconds
from .references import Opened

ADD_ON = "io_scene_gltf2"  # It comes with Blender, and may be switched off.
# Errors of the importer about a library, which the bpy module and some builds lack.
_MISSING_DECODER = re.compile("(?:extern_|intern_|EXT_|KHR_)(draco|meshopt)|(Meshopt) decoder")
_NO_DECODER = (
    "this Blender lacks the library that decodes {} compression. Measure it with another "
    "Blender 5 (blender -b, not the Python module bpy), or export it without compression"
)
_PARTS = "translation", "rotation", "scale", "weights"


class _Shown(NamedTuple):
    """The node whose mesh an object shows.

    number: of the node. local: (4, 4) the place of an instance in the node, in Blender's axes.
    is_skinned: joints place it.
    """

    number: int
    local: Array
    is_skinned: bool


def import_gltf(path: str, frame: float | None) -> Opened:
    """Import a .gltf or .glb file: each object at the place, and each morph target with the weight,
    that the file states at the frame, by default its first. Raise FileError, RuntimeError, and
    AttributeError without an importer.
    """
    hidden: dict[str, Finding] = {}
    shown_nodes: dict[str, _Shown] = {}

    class Nodes:
        """An extension of the importer, which is called for each object."""

        def gather_import_node_after_hook(
            self, vnode: Any, _node: Any, obj: Object, gltf: Any
        ) -> None:
            if obj.type == "MESH":
                shown_nodes[obj.name] = _node_of(vnode, gltf)
            nodes = gltf.data.nodes
            line = _line_of(vnode, gltf)
            coarse = {
                number_of_level
                for node in nodes
                for number_of_level in _extension(node, "MSFT_lod").get("ids", ())
            }
            cause = "it is a coarser level of detail" if coarse & {*line} else None
            shows = [_extension(nodes[number], "KHR_node_visibility") for number in line]
            if any(extension.get("visible") is False for extension in shows):
                cause = "it is invisible"
            if cause is not None:
                hidden[obj.name] = finding(FILE_HIDES, cause=cause)

    # The importer looks for extensions in add-ons of the preferences, of which it is one itself.
    is_known = ADD_ON in bpy.context.preferences.addons
    module = addon_utils.enable(ADD_ON, default_set=not is_known)
    module.glTF2ImportUserExtension = Nodes
    try:
        # Without disable_bone_shape, it adds objects that would be measured.
        bpy.ops.import_scene.gltf(filepath=path, disable_bone_shape=True)
    except RuntimeError as error:
        missing = _MISSING_DECODER.search(str(error))
        if missing is None:
            raise
        name = (missing[1] or missing[2]).capitalize()
        raise FileError(FILE_UNREADABLE, error=_NO_DECODER.format(name)) from error
    finally:
        del module.glTF2ImportUserExtension
    notes = measure_at(frame)
    try:
        _correct(
            _Pose(GltfFile(map_file(path), path), shown_seconds() if notes else 0.0), shown_nodes
        )
    except MALFORMED:
        cause = "its animations, joints or nodes are compressed, or unreadable"
        notes = (*notes, finding(PLACES_UNCHECKED, cause=cause))
    return Opened(notes=notes, hidden=hidden)


def _line_of(vnode: Any, gltf: Any) -> list[int]:
    """Return the numbers of a node and of those above it. vnode: the importer's node; its own ones
    have no number.
    """
    line = [number for number, other_node in gltf.vnodes.items() if other_node is vnode]
    while vnode.parent is not None:
        line.append(vnode.parent)
        vnode = gltf.vnodes[vnode.parent]
    return [number for number in line if isinstance(number, int)]


def _extension(node: Any, name: str) -> dict[str, Any]:
    extension = (node.extensions or {}).get(name)
    return extension if isinstance(extension, dict) else {}


def _node_of(vnode: Any, gltf: Any) -> _Shown:
    """Return the node whose mesh an object shows. vnode: the importer's node of the object; of an
    instance (EXT_mesh_gpu_instancing), it is below the node, and has no number of its own.
    """
    number = vnode.mesh_node_idx
    if number is not None:
        return _Shown(number, np.eye(4), gltf.data.nodes[number].skin is not None)
    translation, rotation, scale = vnode.trs()
    local = node_matrix(
        {"translation": translation, "rotation": np.roll(rotation, -1), "scale": scale}
    )
    return _Shown(vnode.parent, local, False)


class _Pose:
    """The nodes of a glTF file at a time of its first animation, the one that Blender shows."""

    def __init__(self, file: GltfFile, seconds: float) -> None:
        self._file = file
        self._document = file.document
        self._nodes = self._document.get("nodes", [])
        self._parents = {
            child: number
            for number, node in enumerate(self._nodes)
            for child in node.get("children", ())
        }
        self._animated: dict[int, dict[str, Array]] = {}
        for animation in self._document.get("animations", [])[:1]:
            for channel in animation["channels"]:
                target = _target(channel["target"])
                if target is not None:
                    number, part = target
                    sampler = animation["samplers"][channel["sampler"]]
                    values = _sampled(file, sampler, seconds, part)
                    self._animated.setdefault(number, {})[part] = values

    def place(self, number: int) -> Array:
        """Return the (4, 4) place of a node in the world, in the file's axes."""
        matrix = np.eye(4)
        line: int | None = number
        while line is not None:
            matrix = node_matrix(self._nodes[line] | self._animated.get(line, {})) @ matrix
            line = self._parents.get(line)
        return matrix

    def weights(self, number: int) -> Array:
        """Return the weights of the morph targets of a node's mesh, none if they are all 0."""
        node = self._nodes[number]
        rest = node.get("weights") or self._document["meshes"][node["mesh"]].get("weights", ())
        return np.array(self._animated.get(number, {}).get("weights", rest), np.float64)

    def points(self, number: int) -> Array:
        """Return the (n, 3) points of a node's mesh in the file's axes, in the order of Blender's
        vertices: moved by weights, and by joints, if it has some, into the world.
        """
        node = self._nodes[number]
        no_skin: dict[str, Any] = {"joints": ()}
        skin = self._document["skins"][node["skin"]] if "skin" in node else no_skin
        joints = np.array([self.place(joint) for joint in skin["joints"]])
        if "inverseBindMatrices" in skin:
            inverse = self._file.numbers(skin["inverseBindMatrices"]).reshape(-1, 4, 4)
            joints = joints @ inverse.transpose(0, 2, 1)
        blocks = [np.empty((0, 3))]
        for part in self._document["meshes"][node["mesh"]]["primitives"]:
            arrays = {
                name: self._file.numbers(accessor)
                for name, accessor in part["attributes"].items()
                if name.startswith(("POSITION", "JOINTS_", "WEIGHTS_"))
            }
            points = np.ones((len(arrays["POSITION"]), 4))
            points[:, :3] = arrays.pop("POSITION")
            for weight, target in zip(self.weights(number), part.get("targets", ())):
                if weight and "POSITION" in target:
                    points[:, :3] += weight * self._file.numbers(target["POSITION"])
            moved_points = np.zeros_like(points) if "skin" in node else points
            for name in (name for name in arrays if "skin" in node and name[0] == "J"):
                shares = arrays["WEIGHTS" + name.removeprefix("JOINTS")]
                for joint, share in zip(arrays[name].T.astype(int), shares.T):
                    moved_points += share[:, None] * (joints[joint] @ points[..., None])[..., 0]
            # Blender has only the vertices that faces use.
            used_indices = np.arange(len(points))
            if "indices" in part:
                used_indices = np.unique(self._file.numbers(part["indices"])).astype(int)
            if not moved_points[used_indices, 3].all():
                raise ValueError("WEIGHTS")
            blocks.append(moved_points[used_indices, :3] / moved_points[used_indices, 3:])
        return np.concatenate(blocks)


def _target(target: dict[str, Any]) -> tuple[int, str] | None:
    """Return the node and the part of it that a channel animates, None for other parts."""
    pointer = target.get("extensions", {}).get("KHR_animation_pointer", {}).get("pointer", "")
    words = pointer.split("/")
    if len(words) == 4 and words[1] == "nodes" and words[2].isdecimal():
        number, part = int(words[2]), words[3]
    else:
        number, part = target.get("node"), target["path"]
    return (number, part) if number is not None and part in _PARTS else None


def _sampled(file: GltfFile, sampler: dict[str, Any], seconds: float, part: str) -> Array:
    """Return the (k,) values of a sampler of an animation at a time: constant outside of its keys.

    Rotations are unit quaternions, between which the shorter arc is followed.
    """
    times = file.numbers(sampler["input"])[:, 0]
    values = file.numbers(sampler["output"])
    kind = sampler.get("interpolation", "LINEAR")
    # A key of a cubic spline has an arriving tangent, a value and a leaving tangent.
    key_values = values.reshape(len(times), 3 if kind == "CUBICSPLINE" else 1, -1)
    first = max(bisect_right(times, seconds) - 1, 0)
    last = min(first + 1, len(times) - 1)
    step = times[last] - times[first]
    share = min(max((seconds - times[first]) / step, 0.0), 1.0) if step > 0.0 else 0.0
    if kind == "CUBICSPLINE":
        (_, start, leaving), (arriving, end, _) = key_values[first], key_values[last]
        value = (
            (1.0 + 2.0 * share) * (1.0 - share) ** 2 * start
            + share * (1.0 - share) ** 2 * step * leaving
            + share**2 * (3.0 - 2.0 * share) * end
            + share**2 * (share - 1.0) * step * arriving
        )
    else:
        start, end = key_values[first, 0], key_values[last, 0]
        share = 0.0 if kind == "STEP" and share < 1.0 else share
        angle = 0.0
        if part == "rotation":
            end = -end if start @ end < 0.0 else end
            # Chord and sum of unit vectors are 2 sin and 2 cos of half the angle between them.
            angle = 2.0 * math.atan2(np.linalg.norm(end - start), np.linalg.norm(end + start))
        # The arc lacks the divisor sin(angle), as rotations are normalized in the end.
        value = (
            (math.sin((1.0 - share) * angle) * start + math.sin(share * angle) * end)
            if math.sin(angle) > 0.0
            else (1.0 - share) * start + share * end
        )
    return value / np.linalg.norm(value) if part == "rotation" else value


def _correct(pose: _Pose, shown_nodes: dict[str, _Shown]) -> None:
    """Bring objects to the places, and vertices that weights or joints move to the points, that a
    file states.
    """
    places = {
        name: UPRIGHT @ pose.place(node.number) @ np.linalg.inv(UPRIGHT) @ node.local
        for name, node in shown_nodes.items()
        if not node.is_skinned
    }
    place_objects(places)
    for name, node in shown_nodes.items():
        obj = bpy.data.objects[name]
        blocks = getattr(obj.data.shape_keys, "key_blocks", ())
        is_mixed = pose.weights(node.number).any() or any(block.value for block in blocks)
        if node.is_skinned or is_mixed:
            points = pose.points(node.number) @ UPRIGHT[:3, :3].T
            show_points(obj, points, places.get(name, np.eye(4)))
