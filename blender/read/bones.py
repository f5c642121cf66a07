# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The bones of a character at rest, and their weights on the vertices of its skin."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from bpy.types import Depsgraph, Object

from ...core.bodies import Part, float64_matrix
from ...core.numerics import Array, rotation_matrix
from ...core.rig import VertexWeights
from .visibility import evaluated_geometry


@dataclass(frozen=True, eq=False)
class RestBones:
    """The bones of an armature object in their rest pose.

    `names`: of all bones; `deforming`: of the bones that deform meshes, numbered in this order.
    `segments`: (b, 2, 3), head and tail of the deforming bones in the world, Blender units.
    `frames`: rest frame of each bone in the world: rotation (3, 3), and head (3,), Blender units.
    """

    names: tuple[str, ...]
    deforming: tuple[str, ...]
    segments: Array
    frames: dict[str, tuple[Array, Array]]

    @classmethod
    def read(cls, armature: Object) -> RestBones:
        place = float64_matrix(armature.matrix_world)
        bones = list(armature.data.bones)
        deforming = [bone for bone in bones if bone.use_deform]
        ends = np.array(
            [[bone.head_local[:], bone.tail_local[:]] for bone in deforming], np.float64
        ).reshape(-1, 2, 3)
        frames = {
            bone.name: (
                rotation_matrix((armature.matrix_world @ bone.matrix_local).decompose()[1]),
                (place @ float64_matrix(bone.matrix_local))[:3, 3],
            )
            for bone in bones
        }
        return cls(
            tuple(bone.name for bone in bones),
            tuple(bone.name for bone in deforming),
            ends @ place[:3, :3].T + place[:3, 3],
            frames,
        )


def vertex_weights(
    obj: Object, part: Part, bones: RestBones, depsgraph: Depsgraph
) -> VertexWeights:
    """Return the weights of the deforming bones on an object's own vertices; none if the mesh has
    others.
    """
    bone_indices = {name: k for k, name in enumerate(bones.deforming)}
    bone_of_group = [bone_indices.get(group.name) for group in obj.vertex_groups]
    geometry = evaluated_geometry(obj, depsgraph, obj)  # it owns its mesh
    vertices = [] if geometry.mesh is None else geometry.mesh.vertices
    is_own = part.source_object_name in ("", obj.name) and len(vertices) == len(part.surface.points)
    entries = [
        (index, bone_of_group[entry.group], entry.weight)
        for index, mesh_vertex in enumerate(vertices if is_own else [])
        for entry in mesh_vertex.groups
        if bone_of_group[entry.group] is not None
    ]
    vertex, bone, weight = np.array(entries, np.float64).reshape(-1, 3).T
    return VertexWeights(vertex.astype(np.intp), bone.astype(np.intp), weight)
