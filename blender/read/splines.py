# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The splines of a surface object as patches, checked against the mesh that Blender displays.

Shape keys, hooks, and knots that Blender's interface does not show can make patches differ from
this mesh. Then control points are recovered from its vertices, a linear problem in each direction;
if a difference remains, the mesh is measured. Blender does not show evaluated control points, so
shape keys and hooks are applied by the formulas of key.cc and MOD_hook.cc in float64. Splines of an
object read from a file are a picture of the file's faces, which `keep_faces` keeps.
"""

import hashlib
from collections.abc import Sequence
from dataclasses import replace
from itertools import chain, takewhile

import numpy as np
from bpy.types import Curve

from ...core.bodies import SplineReading, float64_matrix
from ...core.cad import read_source
from ...core.moments import FLOAT32_HALF_ULP
from ...core.numerics import Array, NDArray
from ...core.nurbs import Patch, blender_space, display_parameters, display_table
from ...core.verdict import ReadError, finding
from .findings import CONTROL_POINTS_RECOVERED, SCALE_ZERO_AXIS, SOLID_CHANGED, SPLINES_LEFT_OUT
from .mesh import read_array, vertex_points

# relative to the largest coordinate: error of float32 evaluation, up to order 6 by order 6
AGREEMENT_RTOL = 4e-6
RECOVERY_RTOL = 1e-6  # relative to the size: error of recovered control points
MAX_CONDITION = 1e4  # largest condition number of a direction's samples
# beginnings of a spline's properties, as arguments of `blender_space`
SPACE = ("point_count_", "order_", "use_cyclic_", "use_bezier_", "use_endpoint_")


SOURCE = "body_cad"  # property of the data that show a body of a CAD file
_faces_of_file: dict[int, SplineReading] = {}  # by the identifier of the data in this session
# These move control points whatever their switch says (curve_get_tessellate_point in displist.cc);
# other modifiers only with `use_apply_on_spline`. None does after the first constructive modifier.
ALWAYS_ON_SPLINE = {"HOOK", "SOFT_BODY", "MESH_DEFORM"}
CONSTRUCTIVE = {
    "ARRAY",
    "BEVEL",
    "BOOLEAN",
    "BUILD",
    "DECIMATE",
    "EDGE_SPLIT",
    "MASK",
    "MIRROR",
    "NODES",
    "REMESH",
    "SCREW",
    "SOLIDIFY",
    "SUBSURF",
    "TRIANGULATE",
    "WELD",
    "WIREFRAME",
    "VOLUME_TO_MESH",
    "SKIN",
}
# Functions of the distance from the hook's center, 0 there and 1 at the radius.
FALLOFFS = {
    "CONSTANT": lambda d: np.ones_like(d),
    "LINEAR": lambda d: 1.0 - d,
    "SMOOTH": lambda d: (3.0 - 2.0 * (1.0 - d)) * (1.0 - d) ** 2,
    "SHARP": lambda d: (1.0 - d) ** 2,
    "ROOT": lambda d: np.sqrt(1.0 - d),
    "SPHERE": lambda d: np.sqrt(2.0 * (1.0 - d) - (1.0 - d) ** 2),
    "INVERSE_SQUARE": lambda d: 1.0 - d**2,
}


def keep_faces(readings: dict[Curve, SplineReading]) -> None:
    """Register the faces of a file, by which objects are measured instead of by their splines;
    forget other files.
    """
    _faces_of_file.clear()
    _faces_of_file.update({data.session_uid: reading for data, reading in readings.items()})


def keep_source(data: Curve, source: bytes, matrix: Sequence[float]) -> None:
    """Store a body of a CAD file and its (4, 4) matrix with the data that show it."""
    data[SOURCE] = {"source": source, "matrix": matrix, "shown": _shown_digest(data)}


def _shown_digest(data: Curve) -> str:
    digests = [hashlib.sha256(weighted_points(spline).tobytes()) for spline in data.splines]
    return "".join(digest.hexdigest() for digest in digests)


def _kept_faces(original) -> SplineReading | None:
    """Return the faces of a file that an object shows, None if it shows none.

    ReadError if it was changed since.
    """
    data = original.data
    source = data.get(SOURCE)
    if source is not None:
        is_changed = any(spline_modifiers(original)) or data.shape_keys is not None
        if is_changed or _shown_digest(data) != source["shown"]:
            raise ReadError(SOLID_CHANGED, subject=original.name)
        if data.session_uid not in _faces_of_file:
            faces, rounding = read_source(source["source"], source["matrix"])
            _faces_of_file[data.session_uid] = SplineReading(faces, rounding, ())
    return _faces_of_file.get(data.session_uid)


def spline_reading(evaluated, depsgraph, mesh) -> SplineReading | None:
    """Return the patches of a surface object, checked against `mesh` if given; None if the mesh
    must be measured.
    """
    original = evaluated.original
    faces_of_file = _kept_faces(original)
    if faces_of_file is not None:
        return faces_of_file
    if spline_modifiers(original)[1]:
        return None
    splines = [spline for spline in evaluated.data.splines if spline.type == "NURBS"]
    if not splines or len(splines) < len(evaluated.data.splines):
        return None
    control_points = np.concatenate([weighted_points(spline) for spline in splines])
    points = control_points[:, :3].astype(np.float64)
    if is_deformed(evaluated):
        try:
            points = deform(evaluated, points, depsgraph)
        except ReadError:
            return None
    is_finite = np.isfinite(control_points).all() and np.isfinite(points).all()
    if nonpositive_weights(splines) or not is_finite:
        return None
    patches, samples = _patches_and_samples(splines, points, control_points[:, 3])
    if not patches:
        return None
    largest = float(np.abs(points).max())
    size = float(np.ptp(points, axis=0).max())
    has_weights = any(patch.weights is not None for patch in patches)
    # A point has three coordinates: √3 < 1.8. Rounded weights move a mean of points within `size`.
    stored = FLOAT32_HALF_ULP * (1.8 * largest + (2.0 * size if has_weights else 0.0))
    findings = []
    left_out = len(splines) - len(patches)
    if left_out:
        findings.append(finding(SPLINES_LEFT_OUT, count=left_out, total=len(splines)))
    if mesh is not None:
        tolerance = AGREEMENT_RTOL * largest
        verified = _verified(patches, samples, vertex_points(mesh), tolerance)
        if verified is None:
            return None
        if verified is not patches:
            patches = verified
            stored = stored + RECOVERY_RTOL * size
            findings.append(finding(CONTROL_POINTS_RECOVERED))
    return SplineReading(tuple(patches), stored, tuple(findings))


def _patches_and_samples(
    splines, points: Array, weights: NDArray
) -> tuple[list[Patch], list[tuple[NDArray, NDArray]]]:
    """Return a patch of each spline that is long enough, and the tables (v, u) that sample it where
    Blender draws vertices. points, weights: (n, 3), (n,) of all splines in turn.
    """
    patches = []
    samples = []
    ends = np.cumsum([len(spline.points) for spline in splines])[:-1]
    for spline, spline_points, spline_weights in zip(
        splines, np.split(points, ends), np.split(weights, ends)
    ):
        # with v first, a patch's normal points as Blender's faces do
        v, u = (blender_space(*(getattr(spline, name + axis) for name in SPACE)) for axis in "vu")
        if v is None or u is None:
            continue
        shape = (spline.point_count_v, spline.point_count_u)
        patches.append(
            Patch(
                (v, u),
                spline_points.reshape(*shape, 3),
                spline_weights.astype(np.float64).reshape(shape),
            )
        )
        samples.append(
            (
                display_table(v, display_parameters(v, spline.resolution_v)),
                display_table(u, display_parameters(u, spline.resolution_u)),
            )
        )
    return patches, samples


def nonpositive_weights(splines) -> int:
    """Return the number of control points with nonpositive weights, which make a patch unusable."""
    return sum(
        int((~(weighted_points(spline)[:, 3] > 0.0)).sum())
        for spline in splines
        if spline.type == "NURBS"
    )


def weighted_points(spline) -> NDArray[np.float32]:
    """Return (n, 4) control points and weights of a spline that is not a Bézier one."""
    return read_array(spline.points, "co", (len(spline.points), 4), np.float32)


def _verified(
    patches: list[Patch], samples: list[tuple[NDArray, NDArray]], shown: NDArray, tolerance: float
) -> list[Patch] | None:
    """Return the patches if they agree with the display mesh, else patches computed from the mesh,
    or None.
    """
    counts = [len(v) * len(u) for v, u in samples]
    if sum(counts) != len(shown):
        return None
    # Vertices run along v within each step of u.
    vertex_grids = [
        vertices.reshape(len(u), len(v), 3).swapaxes(0, 1).astype(np.float64)
        for vertices, (v, u) in zip(np.split(shown, np.cumsum(counts)[:-1]), samples)
    ]

    def agree(candidates: list[Patch]) -> bool:
        return all(
            np.abs(patch.apply_weights(*sample) - grid).max() <= tolerance
            for patch, sample, grid in zip(candidates, samples, vertex_grids)
        )

    if agree(patches):
        return patches
    solutions = map(_interpolating_patch, patches, samples, vertex_grids)
    recovered = [patch for patch in solutions if patch is not None]
    return recovered if len(recovered) == len(patches) and agree(recovered) else None


def _interpolating_patch(
    patch: Patch, sample: tuple[NDArray, NDArray], vertex_grid: NDArray
) -> Patch | None:
    """Return the patch with the same spaces and weights that interpolates the samples; None if
    singular.
    """
    inverses = []
    for table in sample:
        has_effect = table.any(axis=0)  # other control points show in no sample
        if np.linalg.cond(table[:, has_effect]) > MAX_CONDITION:
            return None
        inverses.append(np.linalg.pinv(table))
    if patch.weights is None:
        points = np.einsum("ia,abd,jb->ijd", inverses[0], vertex_grid, inverses[1])
        return replace(patch, points=points)
    # Homogeneous coordinates are interpolated, and then divided by the weights.
    weights = np.einsum("ai,ij,bj->ab", sample[0], patch.weights, sample[1])
    homogeneous = np.einsum(
        "ia,abd,jb->ijd", inverses[0], vertex_grid * weights[..., None], inverses[1]
    )
    return replace(patch, points=homogeneous / patch.weights[..., None])


def spline_modifiers(obj) -> tuple[list, list]:
    """Return the modifiers that move control points, and the later modifiers, which change the
    mesh.
    """
    shown = [
        modifier
        for modifier in obj.modifiers
        if modifier.show_viewport and (obj.mode != "EDIT" or modifier.show_in_editmode)
    ]
    before_mesh = takewhile(lambda modifier: modifier.type not in CONSTRUCTIVE, shown)
    moving = [
        number
        for number, modifier in enumerate(before_mesh, 1)
        if modifier.type in ALWAYS_ON_SPLINE or modifier.use_apply_on_spline
    ]
    count = max(moving, default=0)
    return shown[:count], shown[count:]


def is_deformed(evaluated) -> bool:
    """Return whether shape keys or modifiers move control points."""
    return bool(spline_modifiers(evaluated.original)[0]) or (
        evaluated.data.shape_keys is not None and evaluated.original.mode != "EDIT"
    )


def deform(evaluated, points: NDArray, depsgraph) -> Array:
    """Return (n, 3) control points of all splines in turn, moved by shape keys and hooks, or raise
    ReadError.
    """
    points = np.asarray(points, np.float64)
    keys = evaluated.data.shape_keys
    if keys is not None and evaluated.original.mode != "EDIT":
        points = _apply_shape_keys(evaluated, keys, points)
    for modifier in spline_modifiers(evaluated.original)[0]:
        if modifier.type == "HOOK":
            points = _apply_hook(evaluated, modifier, points, depsgraph)
    return points


def _apply_shape_keys(evaluated, keys, points: NDArray) -> Array:
    blocks = list(keys.key_blocks)
    if evaluated.original.show_only_shape_key:
        return _block_points(blocks[evaluated.original.active_shape_key_index])
    if not keys.use_relative:
        return points  # their interpolation in time is left to the display mesh
    result = _block_points(keys.reference_key)
    for block in blocks:
        if block != keys.reference_key and not block.mute and block.value != 0.0:
            result += block.value * (_block_points(block) - _block_points(block.relative_key))
    return result


def _block_points(block) -> Array:
    coordinates = [
        (item.handle_left[:], item.co[:], item.handle_right[:])
        if hasattr(item, "handle_left")
        else (item.co[:3],)
        for item in block.data
    ]
    return np.array([*chain(*coordinates)], np.float64).reshape(-1, 3)


def _apply_hook(evaluated, modifier, points: NDArray, depsgraph) -> Array:
    indices = np.array(list(modifier.vertex_indices), np.intp)
    if modifier.object is None or not len(indices):
        return points
    indices = indices[indices < len(points)]
    target = modifier.object.evaluated_get(depsgraph)
    matrix = float64_matrix(target.matrix_world)
    if modifier.subtarget and target.pose and modifier.subtarget in target.pose.bones:
        matrix = matrix @ float64_matrix(target.pose.bones[modifier.subtarget].matrix)
    try:
        to_object = np.linalg.inv(float64_matrix(evaluated.matrix_world))
    except np.linalg.LinAlgError:
        raise ReadError(SCALE_ZERO_AXIS, subject=evaluated.original.name) from None
    matrix = to_object @ matrix @ float64_matrix(modifier.matrix_inverse)
    before = points[indices]
    share = np.full(len(indices), float(modifier.strength))
    if modifier.falloff_type in FALLOFFS and modifier.falloff_radius != 0.0:
        arms = before - np.array(modifier.center[:], np.float64)
        if modifier.use_falloff_uniform:
            arms = arms @ float64_matrix(modifier.matrix_inverse)[:3, :3].T
        distance = np.linalg.norm(arms, axis=1) / modifier.falloff_radius
        falloff = FALLOFFS[modifier.falloff_type](np.minimum(distance, 1.0))
        share = np.where(distance <= 1.0, share * falloff, 0.0)
    after = before @ matrix[:3, :3].T + matrix[:3, 3]
    result = points.copy()
    result[indices] = before + share[:, None] * (after - before)
    return result
