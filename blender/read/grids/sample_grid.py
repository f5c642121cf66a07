# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A grid of a volume, read by the node Sample Grid if Blender has no openvdb module.

A node tree stores the value of the nearest voxel at the vertices of a mesh, in a scene made for this reading only, so
that nothing in the user's scene is changed or evaluated anew.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import bpy
import numpy as np
from numpy.typing import NDArray

from ....core.bodies.findings import GRID_TOO_LARGE
from ....core.bodies.reading import float64_matrix
from ....core.density.findings import GRID_TRANSFORM_SINGULAR
from ....core.mesh.surface import Surface
from ....core.verdict.finding import ReadError
from ..findings import GRID_NEEDS_OPENVDB, GRID_UNREADABLE

VOXELS_PER_BLOCK = 1 << 21  # voxels that are sampled at a time
MAX_VOXELS = 1 << 29  # voxels that are sampled at all
KINDS = {
    "FLOAT": ("FLOAT", np.float32),
    "INT": ("INT", np.int32),
    "BOOLEAN": ("BOOLEAN", np.bool_),
    "MASK": ("BOOLEAN", np.bool_),
}


class SampledGrid:
    """A grid with the interface of `vdb.VdbGrid`; level sets are not recognized here."""

    level_set = None

    def __init__(self, obj, depsgraph, grid, bound_box) -> None:
        if grid.data_type not in KINDS or (bpy.app.version < (5, 0) and grid.data_type != "FLOAT"):
            raise ReadError(GRID_NEEDS_OPENVDB, grid=grid.name)
        self._obj, self._depsgraph, self._name = obj, depsgraph, grid.name
        self._kind, self._dtype = KINDS[grid.data_type]
        self.to_object = float64_matrix(grid.matrix_object)
        if not abs(np.linalg.det(self.to_object[:3, :3])) > 0.0:
            raise ReadError(GRID_TRANSFORM_SINGULAR)
        corners = np.array([[*corner] for corner in bound_box], np.float64)
        index = (corners - self.to_object[:3, 3]) @ np.linalg.inv(self.to_object[:3, :3]).T
        low, high = np.floor(index.min(axis=0)).astype(np.int64) - 1, np.ceil(index.max(axis=0)).astype(np.int64) + 1
        self.low, self.shape = low, high - low + 1
        if np.prod(self.shape.astype(float)) > MAX_VOXELS:
            raise ReadError(GRID_TOO_LARGE, grid=grid.name, samples=self.shape.tolist())
        with self._sampler() as sample:
            self.background = float(sample(low - 2, (1, 1, 1))[0, 0, 0])

    def blocks(self) -> Iterator[tuple[tuple[int, int, int], NDArray]]:
        """Yield the voxels of the box, as blocks, each with its offset in the box."""
        planes = max(1, VOXELS_PER_BLOCK // int(np.prod(self.shape[1:])))
        with self._sampler() as sample:
            for start in range(0, int(self.shape[0]), planes):
                shape = (min(planes, int(self.shape[0]) - start), *self.shape[1:].tolist())
                yield (start, 0, 0), sample(self.low + (start, 0, 0), shape)

    def polygons(self) -> Surface:
        raise ReadError(GRID_NEEDS_OPENVDB, grid=self._name)

    @contextmanager
    def _sampler(self) -> Iterator[Callable[[NDArray, tuple[int, int, int]], NDArray]]:
        """Yield a function that takes the first voxel of a block and its shape, and returns the values."""
        made = []

        def keep(collection, block):
            made.append((collection, block))
            return block

        try:
            mesh = keep(bpy.data.meshes, bpy.data.meshes.new("Body Moments Reading"))
            tree = keep(bpy.data.node_groups, bpy.data.node_groups.new("Body Moments Reading", "GeometryNodeTree"))
            probe = keep(bpy.data.objects, bpy.data.objects.new("Body Moments Reading", mesh))
            scene = keep(bpy.data.scenes, bpy.data.scenes.new("Body Moments Reading"))
            layer = _layer_at_frame_of(self._depsgraph.scene, scene)
            _fill(tree, self._obj, self._name, self._kind)
            probe.modifiers.new("Body Moments Reading", "NODES").node_group = tree
            scene.collection.objects.link(probe)

            def sample(first: NDArray, shape: tuple[int, int, int]) -> NDArray:
                count = int(np.prod(shape))
                positions = np.empty((*shape, 3), np.float32)
                steps = np.ogrid[tuple(slice(a, a + n) for a, n in zip(first.tolist(), shape))]
                for axis, (*row, offset) in enumerate(self.to_object[:3]):
                    positions[..., axis] = sum(factor * step for factor, step in zip(row, steps)) + offset
                if len(mesh.vertices) != count:
                    mesh.clear_geometry()
                    mesh.vertices.add(count)
                mesh.attributes["position"].data.foreach_set("vector", positions.reshape(-1))
                mesh.update_tag()
                layer.update()
                values = np.zeros(count, self._dtype)
                evaluated = probe.evaluated_get(layer.depsgraph).data
                if "value" not in evaluated.attributes:
                    raise ReadError(GRID_UNREADABLE, grid=self._name, error="Sample Grid")
                evaluated.attributes["value"].data.foreach_get("value", values)
                return values.reshape(shape)

            yield sample
        finally:
            for collection, block in reversed(made):
                collection.remove(block)


def _layer_at_frame_of(shown, scene):
    """Set an empty scene to the frame of the displayed scene; return a new view layer of the empty scene.

    Setting `frame_current` makes Blender evaluate the animation of every scene, and so revert unkeyed changes;
    `frame_set` evaluates this scene alone, but calls handlers, so they are removed meanwhile. The layer is new because
    the next content of an evaluated layer would be reported as changed.
    """
    handlers = [getattr(bpy.app.handlers, name) for name in ("frame_change_pre", "frame_change_post")]
    kept = [functions[:] for functions in handlers]
    try:
        for functions in handlers:
            functions.clear()
        scene.frame_set(shown.frame_current, subframe=shown.frame_subframe)
    finally:
        for functions, before in zip(handlers, kept):
            functions[:] = before
    return scene.view_layers.new("Body Moments Reading")


def _fill(tree, obj, name: str, kind: str) -> None:
    """Add the nodes that store the values of the object's named grid at the vertices, as the attribute "value"."""
    for direction in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=direction, socket_type="NodeSocketGeometry")
    start, end, info, named, sample, place, store = (
        tree.nodes.new(node)
        for node in (
            "NodeGroupInput",
            "NodeGroupOutput",
            "GeometryNodeObjectInfo",
            "GeometryNodeGetNamedGrid",
            "GeometryNodeSampleGrid",
            "GeometryNodeInputPosition",
            "GeometryNodeStoreNamedAttribute",
        )
    )
    info.inputs["Object"].default_value = obj
    named.data_type = sample.data_type = store.data_type = kind
    store.domain = "POINT"
    named.inputs["Name"].default_value = name
    store.inputs["Name"].default_value = "value"
    if hasattr(sample, "interpolation_mode"):
        sample.interpolation_mode = "NEAREST"
    else:
        sample.inputs["Interpolation"].default_value = "Nearest Neighbor"
    for source, target in (
        (start.outputs[0], store.inputs["Geometry"]),
        (info.outputs["Geometry"], named.inputs["Volume"]),
        (named.outputs["Grid"], sample.inputs["Grid"]),
        (place.outputs[0], sample.inputs["Position"]),
        (sample.outputs[0], store.inputs["Value"]),
        (store.outputs[0], end.inputs[0]),
    ):
        tree.links.new(source, target)
