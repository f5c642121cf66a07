# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Control points, moved by shape keys and hooks.

Blender does not show evaluated control points, so both are applied here, by the formulas of key.cc and MOD_hook.cc in
float64; the readers of surfaces compare the patches with the display mesh.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ....core.bodies.reading import float64_matrix
from ....core.verdict.finding import ReadError
from ..findings import SCALE_ZERO_AXIS

# These move control points whatever their switch says (curve_get_tessellate_point in displist.cc); other modifiers only
# with `use_apply_on_spline`. None does after the first constructive modifier.
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


def spline_modifiers(obj) -> tuple[list, list]:
    """Return the modifiers that move control points, and the later modifiers, which change the mesh."""
    shown = [
        modifier
        for modifier in obj.modifiers
        if modifier.show_viewport and (obj.mode != "EDIT" or modifier.show_in_editmode)
    ]
    last = 0
    for number, modifier in enumerate(shown, 1):
        if modifier.type in CONSTRUCTIVE:
            break
        if modifier.type in ALWAYS_ON_SPLINE or modifier.use_apply_on_spline:
            last = number
    return shown[:last], shown[last:]


def is_deformed(evaluated) -> bool:
    """Return whether shape keys or modifiers move control points."""
    return bool(spline_modifiers(evaluated.original)[0]) or (
        evaluated.data.shape_keys is not None and evaluated.original.mode != "EDIT"
    )


def deform(evaluated, points: NDArray, depsgraph) -> NDArray[np.float64]:
    """Return (n, 3) control points of all splines in turn, moved by shape keys and hooks, or raise ReadError."""
    points = np.asarray(points, np.float64)
    keys = evaluated.data.shape_keys
    if keys is not None and evaluated.original.mode != "EDIT":
        points = _apply_shape_keys(evaluated, keys, points)
    for modifier in spline_modifiers(evaluated.original)[0]:
        if modifier.type == "HOOK":
            points = _apply_hook(evaluated, modifier, points, depsgraph)
    return points


def _apply_shape_keys(evaluated, keys, points: NDArray) -> NDArray[np.float64]:
    blocks = list(keys.key_blocks)
    if evaluated.original.show_only_shape_key:
        return _block_points(blocks[evaluated.original.active_shape_key_index])
    if not keys.use_relative:
        return points  # their interpolation in time is left to the display mesh
    result = _block_points(keys.reference_key)
    for block in blocks:
        if block == keys.reference_key or block.mute or block.value == 0.0:
            continue
        result += block.value * (_block_points(block) - _block_points(block.relative_key))
    return result


def _block_points(block) -> NDArray[np.float64]:
    coordinates = []
    for item in block.data:
        if hasattr(item, "handle_left"):
            coordinates += [item.handle_left[:], item.co[:], item.handle_right[:]]
        else:
            coordinates.append(item.co[:3])
    return np.array(coordinates, np.float64).reshape(-1, 3)


def _apply_hook(evaluated, modifier, points: NDArray, depsgraph) -> NDArray[np.float64]:
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
        share = np.where(distance <= 1.0, share * FALLOFFS[modifier.falloff_type](np.minimum(distance, 1.0)), 0.0)
    after = before @ matrix[:3, :3].T + matrix[:3, 3]
    result = points.copy()
    result[indices] = before + share[:, None] * (after - before)
    return result
