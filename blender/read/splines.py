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
    kept = _kept_faces(original)
    if kept is not None:
        return kept
    if spline_modifiers(original)[1]:
        return None
    splines = [spline for spline in evaluated.data.splines if spline.type == "NURBS"]
    if not splines or len(splines) < len(evaluated.data.splines):
        return None
    control_points = [weighted_points(spline) for spline in splines]
    coordinates = np.concatenate(control_points)
    points = coordinates[:, :3].astype(np.float64)
    if is_deformed(evaluated):
        try:
            points = deform(evaluated, points, depsgraph)
        except ReadError:
            return None
    if (
        nonpositive_weights(splines)
        or not np.isfinite(coordinates).all()
        or not np.isfinite(points).all()
    ):
        return None
    ends = np.cumsum([len(row) for row in control_points])[:-1]
    patches = []
    samples = []
    for spline, moved, row in zip(splines, np.split(points, ends), control_points):
        # with v first, a patch's normal points as Blender's faces do
        v, u = (blender_space(*(getattr(spline, name + axis) for name in SPACE)) for axis in "vu")
        if v is not None and u is not None:
            shape = (spline.point_count_v, spline.point_count_u)
            weights = row[:, 3].astype(np.float64).reshape(shape)
            patches.append(Patch((v, u), moved.reshape(*shape, 3), weights))
            samples.append(
                (
                    display_table(v, display_parameters(v, spline.resolution_v)),
                    display_table(u, display_parameters(u, spline.resolution_u)),
                )
            )
    if not patches:
        return None
    largest = float(np.abs(points).max())
    size = float(np.ptp(points, axis=0).max())
    stored = FLOAT32_HALF_ULP * (
        1.8 * largest + (2.0 * size if any(patch.weights is not None for patch in patches) else 0.0)
    )
    findings = []
    left_out = len(splines) - len(patches)
    if left_out:
        findings.append(finding(SPLINES_LEFT_OUT, count=left_out, total=len(splines)))
    proved: list[Patch] | None = patches
    if mesh is not None:
        proved = _verified(patches, samples, vertex_points(mesh), AGREEMENT_RTOL * largest)
    if proved is None:
        return None
    if proved is not patches:
        stored = stored + RECOVERY_RTOL * size
        findings.append(finding(CONTROL_POINTS_RECOVERED))
    return SplineReading(tuple(proved), stored, tuple(findings))


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
    pieces = [
        piece.reshape(len(u), len(v), 3).swapaxes(0, 1).astype(np.float64)
        for piece, (v, u) in zip(np.split(shown, np.cumsum(counts)[:-1]), samples)
    ]

    def agree(candidates: list[Patch]) -> bool:
        return len(candidates) == len(patches) and all(
            np.abs(patch.apply_weights(*sample) - piece).max() <= tolerance
            for patch, sample, piece in zip(candidates, samples, pieces)
        )

    if agree(patches):
        return patches
    attempts = map(_interpolating_patch, patches, samples, pieces)
    solved = [patch for patch in attempts if patch is not None]
    return solved if agree(solved) else None


def _interpolating_patch(
    patch: Patch, sample: tuple[NDArray, NDArray], piece: NDArray
) -> Patch | None:
    """Return the patch with the same spaces and weights that interpolates the samples; None if
    singular.
    """
    inverses = []
    for table in sample:
        acting = table.any(axis=0)
        if np.linalg.cond(table[:, acting]) > MAX_CONDITION:
            return None
        inverses.append(np.linalg.pinv(table))
    if patch.weights is not None:
        piece = piece * np.einsum("ai,ij,bj->ab", sample[0], patch.weights, sample[1])[..., None]
    points = np.einsum("ia,abd,jb->ijd", inverses[0], piece, inverses[1])
    return replace(
        patch, points=points if patch.weights is None else points / patch.weights[..., None]
    )


def spline_modifiers(obj) -> tuple[list, list]:
    """Return the modifiers that move control points, and the later modifiers, which change the
    mesh.
    """
    shown = [
        modifier
        for modifier in obj.modifiers
        if modifier.show_viewport and (obj.mode != "EDIT" or modifier.show_in_editmode)
    ]
    first = takewhile(lambda modifier: modifier.type not in CONSTRUCTIVE, shown)
    moving = [
        number
        for number, modifier in enumerate(first, 1)
        if modifier.type in ALWAYS_ON_SPLINE or modifier.use_apply_on_spline
    ]
    last = max(moving, default=0)
    return shown[:last], shown[last:]


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
        center = np.array(modifier.center[:], np.float64)
        arms = before - center
        if modifier.use_falloff_uniform:
            arms = arms @ float64_matrix(modifier.matrix_inverse)[:3, :3].T
        distance = np.linalg.norm(arms, axis=1) / modifier.falloff_radius
        share = np.where(
            distance <= 1.0, share * FALLOFFS[modifier.falloff_type](np.minimum(distance, 1.0)), 0.0
        )
    after = before @ matrix[:3, :3].T + matrix[:3, 3]
    result = points.copy()
    result[indices] = before + share[:, None] * (after - before)
    return result
