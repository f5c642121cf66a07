# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The grid of voxels that an object shows: a Volume object, or an object that nodes turn into a
volume.

With Blender's openvdb module, unchanged grids are read from their .vdb file and others from a
temporary one; without it, the node Sample Grid stores the value of the nearest voxel at the
vertices of a mesh, in a scene made for this reading only, so that nothing in the user's scene is
changed or evaluated anew.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import bpy
import numpy as np

from ...core.bodies import GRID_TOO_LARGE, Reading, float64_matrix, name_subject
from ...core.density import GRID_TRANSFORM_SINGULAR
from ...core.files import OTHERS_LEFT_OUT
from ...core.mesh import Surface
from ...core.numerics import Array, NDArray, shortest_decimal
from ...core.verdict.finding import Finding, ReadError, finding
from .decisions import modifier_findings
from .findings import (
    GRID_MISSING,
    GRID_NAMES_REPEATED,
    GRID_SIMPLIFIED,
    GRID_UNREADABLE,
    GRID_UNSUPPORTED,
    HIDDEN_OBJECT_MEASURED,
    KIND_COUNT,
    NEEDS_OPENVDB,
    NO_SCALAR_GRID,
    NO_SCALARS,
    SURFACELESS_LEFT_OUT,
    TEMPORARY_FOLDER_FULL,
    VOLUME_WITHOUT_GRIDS,
)
from .objects import locate
from .vdb import VdbGrid, openvdb
from .visibility import hidden_reason, why_not_evaluated

SCALARS = {"BOOLEAN", "MASK", "FLOAT", "DOUBLE", "INT", "INT64"}
PREFERRED = "density"
VOXELS_PER_BLOCK = 1 << 21  # voxels that are sampled at a time
MAX_VOXELS = 1 << 29  # voxels that are sampled at all
KINDS = {
    "FLOAT": ("FLOAT", np.float32),
    "INT": ("INT", np.int32),
    "BOOLEAN": ("BOOLEAN", np.bool_),
    "MASK": ("BOOLEAN", np.bool_),
}


@dataclass(kw_only=True)
class VolumeReading(Reading):
    """One grid, and its place.

    grid: its name. level_set: True if it is marked as one, None if unknown. to_object: (4, 4)
    float64 from voxels to the object. shape: (3,) of the box that holds its voxels; low: (3,) its
    offset. background: value outside all voxels. blocks: yields the stored voxels, (offset in the
    box, array). polygons: gives the surface of a level set.
    """

    grid: str
    level_set: bool | None
    to_object: Array
    low: NDArray[np.int64]
    shape: tuple[int, int, int]
    background: float
    blocks: Callable[[], Iterable[tuple[tuple[int, int, int], NDArray]]]
    polygons: Callable[[], Surface]


@contextmanager
def volume_reading(obj, depsgraph, grid: str = "") -> Iterator[VolumeReading | None]:
    """Yield the named grid, else “density” or the first scalar grid; None if polygons or no volume
    are shown.
    """
    obj = obj.original
    shown = _volume(obj, depsgraph)
    if shown is None:
        yield None
        return
    volume, geometry = shown  # the set of geometry may own the volume
    place = locate(obj, depsgraph)
    findings = place.findings
    chosen = _choose_grid(obj, volume, grid, findings)
    hidden = hidden_reason(obj, depsgraph)
    if hidden:
        findings.append(finding(HIDDEN_OBJECT_MEASURED, cause=hidden.as_record()))
    findings.extend(modifier_findings(obj, depsgraph.scene))
    if geometry.instances_pointcloud() is not None:
        count = len(geometry.instances_pointcloud().points)
        kinds = [finding(KIND_COUNT, kind="instances beside the volume", count=count).as_record()]
        findings.append(finding(SURFACELESS_LEFT_OUT, kinds=kinds))
    with name_subject(obj.name), _open_grid(obj, volume, chosen, depsgraph, findings) as source:
        yield VolumeReading(
            **vars(place),
            grid=chosen.name,
            level_set=source.level_set,
            to_object=source.to_object,
            low=source.low,
            shape=tuple(source.shape.tolist()),
            background=source.background,
            blocks=source.blocks,
            polygons=source.polygons,
        )


def _volume(obj, depsgraph) -> tuple[bpy.types.Volume, bpy.types.GeometrySet] | None:
    """Return the evaluated volume, its grids loaded, and its geometry set; None if polygons or no
    volume are shown.
    """
    if obj.type not in {"VOLUME", "MESH", "CURVE", "FONT", "SURFACE", "POINTCLOUD", "CURVES"}:
        return None
    evaluated = obj.evaluated_get(depsgraph)
    try:
        geometry = evaluated.evaluated_geometry()
    except (TypeError, RuntimeError):
        raise ReadError(why_not_evaluated(obj, depsgraph), subject=obj.name) from None
    if geometry.mesh is not None and len(geometry.mesh.polygons):
        return None
    # An object's own volume lives as long as the object, that of a geometry set as long as the set.
    volume = evaluated.data if isinstance(evaluated.data, bpy.types.Volume) else geometry.volume
    if volume is None:
        return None
    # A saved file turns an empty path into that of a folder.
    folder = os.path.isdir(bpy.path.abspath(volume.filepath, library=obj.data.library))
    if not volume.grids.load() and not folder:
        error = volume.grids.error_message.rstrip(".") or bpy.path.basename(volume.filepath)
        raise ReadError(GRID_UNREADABLE, subject=obj.name, grid=volume.name, error=error)
    if not len(volume.grids):
        if obj.type != "VOLUME" or geometry.instances_pointcloud() is not None:
            return None
        raise ReadError(VOLUME_WITHOUT_GRIDS, subject=obj.name)
    return volume, geometry


def _choose_grid(obj, volume: bpy.types.Volume, name: str, findings: list[Finding]):
    """Return the grid of that name, or if the name is empty “density”, else the first scalar
    grid.
    """
    grids = {grid.name: grid for grid in volume.grids}
    if len(grids) < len(volume.grids):
        findings.append(finding(GRID_NAMES_REPEATED))
    if name:
        if name not in grids:
            raise ReadError(GRID_MISSING, subject=obj.name, grid=name, grids=list(grids))
        if grids[name].data_type not in SCALARS:
            raise ReadError(GRID_UNSUPPORTED, fault=NO_SCALARS, subject=obj.name, grid=name)
        return grids[name]
    scalars = {grid_name: grid for grid_name, grid in grids.items() if grid.data_type in SCALARS}
    if not scalars:
        raise ReadError(NO_SCALAR_GRID, subject=obj.name, grids=list(grids))
    chosen = scalars.get(PREFERRED) or next(iter(scalars.values()))
    if len(grids) > 1:
        left_out = [other for other in grids if other != chosen.name]
        findings.append(finding(OTHERS_LEFT_OUT, kind="grid", name=chosen.name, others=left_out))
    return chosen


@contextmanager
def _open_grid(
    obj, volume: bpy.types.Volume, grid, depsgraph, findings: list[Finding]
) -> Iterator[VdbGrid | SampledGrid]:
    path = None if openvdb() is None else _unchanged_file(obj, volume)
    render = depsgraph.scene.render
    if not path and render.use_simplify and render.simplify_volumes < 1.0:
        findings.append(finding(GRID_SIMPLIFIED, share=shortest_decimal(render.simplify_volumes)))
    if openvdb() is None:
        yield SampledGrid(obj, depsgraph, grid, obj.evaluated_get(depsgraph).bound_box)
        return
    if path:
        yield VdbGrid(path, grid.name)
        return
    with tempfile.TemporaryDirectory(prefix="body_moments_", dir=bpy.app.tempdir) as folder:
        path = os.path.join(folder, "volume.vdb")
        try:
            volume.grids.save(filepath=path)
        except RuntimeError:
            raise ReadError(TEMPORARY_FOLDER_FULL) from None
        yield VdbGrid(path, grid.name)


def _unchanged_file(obj, volume: bpy.types.Volume) -> str | None:
    """Return the file of the grids, if they were not changed after loading."""
    if (
        any(modifier.show_viewport for modifier in obj.modifiers)
        or obj.data.packed_file is not None
    ):
        return None
    path = volume.grids.frame_filepath
    return path if os.path.isfile(path) else None


class SampledGrid:
    """A grid with the interface of `vdb.VdbGrid`; level sets are not recognized here."""

    level_set = None

    def __init__(self, obj, depsgraph, grid, bound_box) -> None:
        if grid.data_type not in KINDS or (bpy.app.version < (5, 0) and grid.data_type != "FLOAT"):
            raise ReadError(GRID_UNSUPPORTED, fault=NEEDS_OPENVDB, grid=grid.name)
        self._obj = obj
        self._depsgraph = depsgraph
        self._name = grid.name
        self._kind, self._dtype = KINDS[grid.data_type]
        self.to_object = float64_matrix(grid.matrix_object)
        if not abs(np.linalg.det(self.to_object[:3, :3])) > 0.0:
            raise ReadError(GRID_TRANSFORM_SINGULAR)
        corners = np.array([[*corner] for corner in bound_box], np.float64)
        index = (corners - self.to_object[:3, 3]) @ np.linalg.inv(self.to_object[:3, :3]).T
        low = np.floor(index.min(axis=0)).astype(np.int64) - 1
        high = np.ceil(index.max(axis=0)).astype(np.int64) + 1
        self.low = low
        self.shape = high - low + 1
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
        raise ReadError(GRID_UNSUPPORTED, fault=NEEDS_OPENVDB, grid=self._name)

    @contextmanager
    def _sampler(self) -> Iterator[Callable[[NDArray, tuple[int, int, int]], NDArray]]:
        """Yield a function that takes the first voxel of a block and its shape, and returns the
        values.
        """
        name = "Body Moments Reading"
        made = []
        try:
            made.append(mesh := bpy.data.meshes.new(name))
            made.append(tree := bpy.data.node_groups.new(name, "GeometryNodeTree"))
            made.append(probe := bpy.data.objects.new(name, mesh))
            made.append(scene := bpy.data.scenes.new(name))
            layer = _layer_at_frame_of(self._depsgraph.scene, scene)
            _fill(tree, self._obj, self._name, self._kind)
            probe.modifiers.new(name, "NODES").node_group = tree
            scene.collection.objects.link(probe)

            def sample(first: NDArray, shape: tuple[int, int, int]) -> NDArray:
                count = int(np.prod(shape))
                positions = np.empty((*shape, 3), np.float32)
                steps = np.ogrid[tuple(slice(a, a + n) for a, n in zip(first.tolist(), shape))]
                for axis, (*row, offset) in enumerate(self.to_object[:3]):
                    positions[..., axis] = (
                        sum(factor * step for factor, step in zip(row, steps)) + offset
                    )
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
            bpy.data.batch_remove(made)


def _layer_at_frame_of(shown, scene):
    """Set an empty scene to the frame of the displayed scene; return a new view layer of the empty
    scene.

    Setting `frame_current` makes Blender evaluate the animation of every scene, and so revert
    unkeyed changes; `frame_set` evaluates this scene alone, but calls handlers, so they are removed
    meanwhile. The layer is new because the next content of an evaluated layer would be reported as
    changed.
    """
    handlers = [
        getattr(bpy.app.handlers, name) for name in ("frame_change_pre", "frame_change_post")
    ]
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
    """Add the nodes that store the values of the object's named grid at the vertices, as the
    attribute "value".
    """
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
