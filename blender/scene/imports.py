# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects of imported files: patches with Blender's knots as surface objects, and scans as Volume
objects.

Only Blender's operators make a grid of control points out of nothing, and only in Edit Mode. So a
grid of each size is made once in a temporary scene; the patches of an object are joined there, and
get their points last. Nothing of the user's scene is selected, changed or evaluated. Blender takes
voxels from .vdb files only, so one is written beside the scan.
"""

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import NamedTuple

import bpy
import numpy as np
from bpy.types import Context, Curve, Object, Scene

from ...core.bodies import SplineReading
from ...core.cad import SurfaceBody, is_storable, read_surfaces
from ...core.density import DENSITY_NON_FINITE, positions_text
from ...core.files import FILE_UNREADABLE, Limits
from ...core.numerics import Array, NDArray, shortest_decimal
from ...core.nurbs import Patch, bezier_space
from ...core.scans import (
    Positions,
    Scan,
    place_samples,
    read_all_positions,
    read_raw,
    read_scan,
    sample_matrix,
    scan_suffix,
)
from ...core.verdict import FileError, Finding, finding, system_reason
from ..read.splines import keep_faces, keep_source
from ..scale import meters_per_unit
from .findings import SURFACES_ROUNDED

MAX_DISTANCE = 16.0  # from the origin, in sizes: farther away float32 would lose more than a digit
SHOWN_SAMPLES = 8  # per span, of surfaces that Blender's splines cannot be
QUADS_PER_BAND = 64
MIN_LOFTED_POINTS = 3  # along v: with fewer Blender does not loft
GRID_NAME = "density"
SAMPLES_PER_SLAB = 1 << 22  # samples at a time


def surface_object(
    name: str, patches: Sequence[Patch], factor: float = 1.0
) -> tuple[Object, float]:
    """Return a surface object of *Bézier* patches in no collection, and the effect of float32 as a
    share.
    """
    data, moved, origin = surface_data(name, patches, factor)
    obj = bpy.data.objects.new(name, data)
    obj.location = origin
    return obj, moved


def surface_data(
    name: str, patches: Sequence[Patch], factor: float
) -> tuple[Curve, float, NDArray[np.float32]]:
    """Return the data of `surface_object`, its points' movement as a share of the size, and its
    origin's place.
    """
    low = factor * np.min([patch.points.min(axis=(0, 1)) for patch in patches], axis=0)
    high = factor * np.max([patch.points.max(axis=(0, 1)) for patch in patches], axis=0)
    size = float((high - low).max())
    distance = float(np.abs([low, high]).max())
    origin = np.zeros(3, np.float32)
    if distance > MAX_DISTANCE * size > 0.0:
        origin = ((low + high) / 2.0).astype(np.float32)
    data = _grids(name, [patch.points.shape[:2] for patch in patches])
    largest_move = 0.0
    for spline, patch in zip(data.splines, patches):
        values, move = _stored(patch, factor, origin.astype(np.float64))
        _fill(spline, patch, values)
        largest_move = max(largest_move, move)
    return data, largest_move / (size or 1.0), origin


def _stored(patch: Patch, factor: float, origin: NDArray) -> tuple[NDArray[np.float32], float]:
    """Return (n, 4) control points and weights as Blender has them, and the largest move of the
    surface.
    """
    points = factor * patch.points - origin
    values = np.ones((*points.shape[:2], 4), np.float32)
    values[..., :3] = points
    moved = float(np.linalg.norm(values[..., :3] - points, axis=2).max())
    if patch.weights is not None:
        weights = patch.weights / patch.weights.max()
        values[..., 3] = weights
        # The point is a mean of control points; its weights change by at most twice this share, and
        # control points are apart by at most twice their distance from the first one.
        share = float(np.abs(values[..., 3] / weights - 1.0).max())
        moved += 4.0 * share * float(np.linalg.norm(points - points[0, 0], axis=2).max())
    return values.reshape(-1, 4), moved


def _fill(spline, patch: Patch, values: NDArray[np.float32]) -> None:
    spline.points.foreach_set("co", values.ravel())
    spline.order_v, spline.order_u = (space.order for space in patch.spaces)
    spline.use_cyclic_u = spline.use_cyclic_v = False
    spline.use_bezier_u = spline.use_bezier_v = True
    spline.use_endpoint_u = spline.use_endpoint_v = True
    # Across strips of flat faces, smooth shading shows bands.
    spline.use_smooth = max(space.order for space in patch.spaces) > 2


def _grids(name: str, shapes: Sequence[tuple[int, int]]) -> Curve:
    """Return surface data with one spline, a grid of (count_v, count_u) points, for each of these
    pairs, in order.
    """
    scene = bpy.data.scenes.new("Body Moments Import")
    try:
        models = {shape: _grid(scene, shape) for shape in dict.fromkeys(shapes)}
        objects = [bpy.data.objects.new(name, models[shape]) for shape in shapes]
        for obj in objects:
            scene.collection.objects.link(obj)
        first = objects[0]
        first.data = models[shapes[0]].copy()
        if len(objects) > 1:
            with _active(scene, first, objects):
                bpy.ops.object.join()
        data = first.data
        bpy.data.objects.remove(first)
        for model in models.values():
            bpy.data.curves.remove(model)
    finally:
        bpy.data.batch_remove([*scene.collection.objects, scene])
    data.name = name
    data.dimensions = "3D"
    return data


@contextmanager
def _active(scene: Scene, obj: Object, selected: Sequence[Object]) -> Iterator[None]:
    layer = scene.view_layers[0]
    layer.objects.active = obj
    for each in selected:
        each.select_set(True, view_layer=layer)
    with bpy.context.temp_override(
        scene=scene,
        object=obj,
        active_object=obj,
        edit_object=obj,
        selected_objects=list(selected),
        selected_editable_objects=list(selected),
    ):
        yield


def _grid(scene: Scene, shape: tuple[int, int]) -> Curve:
    """Return surface data with one spline of (count_v, count_u) points at arbitrary places."""
    rows = max(shape[0], MIN_LOFTED_POINTS)
    data = bpy.data.curves.new("Body Moments Import", "SURFACE")
    for _ in range(shape[1]):
        spline = data.splines.new("NURBS")
        spline.points.add(rows - 1)
        spline.points.foreach_set("select", np.ones(rows, np.bool_))
    obj = bpy.data.objects.new("Body Moments Import", data)
    scene.collection.objects.link(obj)
    with _active(scene, obj, [obj]):
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.curve.make_segment()
        if rows > shape[0]:
            # points row by row; the surplus rows are deleted
            surplus = np.arange(rows).repeat(shape[1]) >= shape[0]
            data.splines[0].points.foreach_set("select", surplus)
            bpy.ops.curve.delete(type="VERT")
        bpy.ops.object.mode_set(mode="OBJECT")
    bpy.data.objects.remove(obj)
    (spline,) = data.splines
    assert (spline.point_count_v, spline.point_count_u) == shape
    return data


def import_bodies(
    bodies: Sequence[SurfaceBody], collection: bpy.types.Collection, factor: float
) -> list[tuple[Object, float]]:
    """Add an object of each body, of patches alone, to a collection; return the pairs of
    `surface_object`.
    """
    pairs = []
    for body in bodies:
        patches = [face for face in body.patches if isinstance(face, Patch)]
        obj, moved = surface_object(body.name, patches, factor)
        collection.objects.link(obj)
        pairs.append((obj, moved))
    return pairs


def show_bodies(
    bodies: Sequence[SurfaceBody], collection: bpy.types.Collection, factor: float
) -> list[Object]:
    """Add an object for each body to a collection; it shows the body's faces and is measured by
    them.
    """
    readings = {}
    made = []
    for body in bodies:
        obj, _ = surface_object(body.name, list(_shown(body)), factor)
        for spline in obj.data.splines:
            if spline.order_u == spline.order_v == 2:
                spline.resolution_u = spline.resolution_v = 1
        matrix = np.diag([factor, factor, factor, 1.0])
        matrix[:3, 3] -= obj.location
        faces = tuple(face.transform(matrix) for face in body.patches)
        readings[obj.data] = SplineReading(faces, factor * body.rounding, ())
        if body.source and body.matrix is not None:
            keep_source(obj.data, body.source(), (matrix @ body.matrix).ravel().tolist())
        if body.color:
            obj.data.materials.append(_material(body.color))
        collection.objects.link(obj)
        made.append(obj)
    keep_faces(readings)
    return made


def _shown(body: SurfaceBody) -> Iterator[Patch]:
    """Yield patches that Blender can hold and that look like a body: its own, or bands along
    quadrilaterals.
    """
    quads_of_faces = []
    for face in body.patches:
        if not isinstance(face, Patch):
            quads_of_faces.append(face.quads(SHOWN_SAMPLES))
        elif not body.source and is_storable(face):
            yield face
        else:
            grid = face.samples(SHOWN_SAMPLES)
            corners = grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]
            quads_of_faces.append(np.stack(corners, axis=2).reshape(-1, 4, 3))
    if not quads_of_faces:
        return
    quads = np.concatenate(quads_of_faces)
    # Blender's effort grows with the square of a band's length, so all have the same short length;
    # quadrilaterals without area fill up the last one.
    point_quad = np.repeat(quads[-1:, :1], 4, axis=1)
    filling = np.repeat(point_quad, -len(quads) % QUADS_PER_BAND, axis=0)
    quads = np.concatenate([quads, filling])
    yield from map(_band, quads.reshape(-1, QUADS_PER_BAND, 4, 3))


def _band(quads: Array) -> Patch:
    """Return a band along quadrilaterals, with folds of no width between them."""
    a, b, c, d = np.moveaxis(quads, 1, 0)
    points = np.stack(
        [np.stack([a, b, c, d], axis=1), np.stack([a, a, d, d], axis=1)], axis=2
    ).reshape(-1, 2, 3)
    return Patch((bezier_space(len(points), 2), bezier_space(2, 2)), points)


def _material(color: Sequence[float]) -> bpy.types.Material:
    """Return the material of a color in sRGB, by its name if it was made before."""
    linear = [
        value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4 for value in color
    ]
    name = "#{:02x}{:02x}{:02x}".format(*(round(255.0 * value) for value in color))
    material = bpy.data.materials.get(name)
    if material is None:
        material = bpy.data.materials.new(name)
        material.diffuse_color = (*linear, 1.0)
        for node in material.node_tree.nodes if material.node_tree else ():
            if node.type == "BSDF_PRINCIPLED":
                node.inputs["Base Color"].default_value = (*linear, 1.0)
    return material


class ImportedSurfaces(NamedTuple):
    """Objects of a file of surfaces, with the number and the highest order of their patches, and
    findings. Solids have order 0.
    """

    objects: list[Object]
    patches: int
    order: int
    findings: list[Finding]


def import_surfaces(path: Path, limits: Limits, unit: float, context: Context) -> ImportedSurfaces:
    """Make an object of each body in a file. unit: meters per unit of a file that states none.

    Raises FileError.
    """
    try:
        file = read_surfaces(path, limits)
    except OSError as error:
        raise FileError(FILE_UNREADABLE, error=system_reason(error)) from error
    stated = shortest_decimal(unit) if file.unit is None else file.unit
    factor = stated / meters_per_unit(context.scene)
    if file.bodies[0].source:
        objects = show_bodies(file.bodies, context.collection, factor)
        return ImportedSurfaces(objects, len(objects), 0, [*file.refused, *file.notes])
    pairs = import_bodies(file.bodies, context.collection, factor)
    patches = [face for body in file.bodies for face in body.patches if isinstance(face, Patch)]
    order = max(space.order for patch in patches for space in patch.spaces)
    moved = max(share for _, share in pairs)
    rounded = [finding(SURFACES_ROUNDED, share=moved)] if moved else []
    return ImportedSurfaces(
        [obj for obj, _ in pairs], len(patches), order, [*rounded, *file.refused, *file.notes]
    )


class PlacedScan(NamedTuple):
    """A scan with the (4, 4) map from its voxels to meters, uneven sample positions by axis, and
    findings.

    target: the .vdb file beside the scan.
    """

    scan: Scan
    matrix: Array
    positions: Positions
    findings: Sequence[Finding]
    target: Path


def read_placed(
    path: Path,
    limits: Limits,
    raw: tuple[Sequence[int], str, bool] | None,
    spacing: Sequence[float] | None,
    files: dict[str, str],
    unit: float,
) -> PlacedScan:
    """Read a scan and place its samples. raw: shape, type and byte order for `read_raw`. files: of
    sample positions, in `unit` meters, by axis. spacing: of samples in place of the file's, in m.

    Raises FileError.
    """
    try:
        is_raw = scan_suffix(path) == ".raw"
        scan = (
            read_raw(path, *raw, limits) if raw is not None and is_raw else read_scan(path, limits)
        )
        positions = read_all_positions(files, scan.samples.shape)
    except OSError as error:
        raise FileError(FILE_UNREADABLE, error=system_reason(error)) from error
    matrix, findings = sample_matrix(
        scan, tuple(map(shortest_decimal, spacing)) if spacing else None, None, None
    )
    matrix, positions = place_samples(matrix, positions, shortest_decimal(unit))
    for axis, row in enumerate(positions):
        # Blender's voxels are even: the first and the last are where they belong
        if row is not None:
            matrix[:3, axis] *= row[-1] / (len(row) - 1)
    target = path.with_name(path.name[: -len(scan_suffix(path))] + ".vdb")
    return PlacedScan(scan, matrix, positions, (*scan.findings, *findings), target)


def write_volume(module: ModuleType, placed: PlacedScan, unit: float) -> float:
    """Write the scan whole, with `unit` meters per unit and a background of 0 or less; return the
    least value.
    """
    scan = placed.scan
    matrix = placed.matrix.copy()
    matrix[:3] /= unit
    least = np.inf
    fits_float32 = True
    for _, slab in _slabs(scan):
        if not np.isfinite(slab.min()) or not np.isfinite(slab.max()):
            raise FileError(DENSITY_NON_FINITE)
        least = min(least, float(slab.min()))
        fits_float32 = fits_float32 and np.array_equal(slab.astype(np.float32), slab)
    dtype, grid_type = (
        (np.float32, module.FloatGrid) if fits_float32 else (np.float64, module.DoubleGrid)
    )
    # 0, or just below the least sample if that is negative
    background = 0.0 if least >= 0.0 else float(np.nextafter(dtype(least), dtype(-np.inf)))
    grid = grid_type(background)
    grid.name = GRID_NAME
    grid.gridClass = "fog volume"
    grid.transform = module.createLinearTransform(matrix.T.tolist())
    for start, slab in _slabs(scan):
        grid.copyFromArray(np.ascontiguousarray(slab), ijk=(start, 0, 0))
    target = placed.target
    partial = target.with_name("{:s}.{:d}.partial.vdb".format(target.stem, os.getpid()))
    try:
        module.write(str(partial), grid)
        os.replace(partial, target)
    finally:
        partial.unlink(missing_ok=True)
    return least


def _slabs(scan: Scan) -> Iterator[tuple[int, Array]]:
    """Yield slabs of a scan's values along the first axis, each after the index of its start."""
    planes = max(1, SAMPLES_PER_SLAB // scan.samples[0].size)
    for start in range(0, len(scan.samples), planes):
        slab = scan.samples[start : start + planes].astype(np.float64)
        yield start, slab * scan.slope + scan.intercept


def add_volume(context: Context, placed: PlacedScan) -> Object:
    """Add a Volume object with the file of a scan, selected and active."""
    path = placed.target
    volume = bpy.data.volumes.new(path.stem)
    volume.filepath = str(path)
    obj = bpy.data.objects.new(path.stem, volume)
    obj.body_moments.grid = GRID_NAME
    obj.body_moments.sample_positions = positions_text(placed.positions)
    context.collection.objects.link(obj)
    for previous in context.selected_objects:
        previous.select_set(False)
    obj.select_set(True)
    context.view_layer.objects.active = obj
    return obj
