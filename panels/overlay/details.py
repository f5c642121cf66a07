# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Details of single objects: faults, support polygons and weights, as colored shapes and texts in
the world.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from bpy.types import Context, Object, Scene

from ... import blender, core
from ...blender.scale import meters_per_unit
from ...blender.scene import fcurves
from ...blender.session import memory
from ...blender.session.character.weight import Weight
from ...blender.session.stored import balance_groups, cuts, faults, floating, stability
from ...core.cuts import cut_outline
from ...core.numerics import Array, NDArray
from ..rig import standing
from . import appearance as look
from . import draw

FILL = 0.25  # opacity of faces
ARROW = 0.12  # length of the tipping arrow's head, relative to the support polygon's extent
# half the width of a cross, relative to the size of the floating body, or the extent of the path
CROSS = 0.02
TICK = 0.01  # length of the ticks of a path, relative to its extent
# (k, c, 3) points of k shapes with c corners, and their (k, 4) colors
Colored = tuple[Array, NDArray[np.float32]]
CROSS_LINES = np.stack([-np.eye(3), np.eye(3)], axis=1)  # (3, 2, 3) segments with arms of length 1
NO_TRIANGLES: Colored = (np.zeros((0, 3, 3)), np.zeros((0, 4), np.float32))


@dataclass(frozen=True, eq=False)
class Detail:
    """Drawn shapes.

    segments: (k, 2, 3) points and (k, 4) colors. triangles: (l, 3, 3) points and (l, 4) colors.
    texts: a (3,) place, a text and its color each.
    """

    segments: Colored
    triangles: Colored = NO_TRIANGLES
    texts: tuple[tuple[Array, str, NDArray], ...] = ()


def list_details(context: Context, objects: list[Object]) -> list[Detail]:
    """Return the enabled details of drawn objects, and the paths of balance groups."""
    settings = context.scene.body_moments.overlay
    details = []
    if settings.show_path:
        for empty in balance_groups.groups(context.scene):
            if (
                empty.visible_in_viewport_get(context.space_data)
                and (path := balance_groups.path(empty)) is not None
            ):
                details.append(_path(path))
                details += _arcs(context.scene, path)
                stood = (
                    balance_groups.support(empty, context.scene.frame_current)
                    if settings.show_support
                    else None
                )
                if stood is not None:
                    details.append(support_detail(stood))
    object_faults = map(faults.of_object, objects) if settings.show_faults else ()
    details += [
        _faults(obj, mesh_faults)
        for obj, mesh_faults in zip(objects, object_faults)
        if mesh_faults is not None
    ]
    for obj in objects:
        weight = (
            blender.session.character.weight.weight(obj, context.view_layer.depsgraph)
            if draw.shows_weight(obj)
            else None
        )
        if weight is not None:
            details += _weight(context, weight)
    checked = [obj for obj in objects if obj in memory.hulls] if settings.show_support else ()
    supports = [stability.support(obj, context.scene) for obj in checked]
    details += [support_detail(support) for support in supports if support is not None]
    unit = meters_per_unit(context.scene)
    if settings.show_level and any(obj in memory.levels for obj in objects):
        levels = [cuts.level_of(obj, context.scene) for obj in objects]
        details += [_surface(level, unit) for level in levels if level is not None]
    if settings.show_waterline:
        # one object of each body: its objects share a record
        afloat = {id(memory.afloat[obj]): obj for obj in objects if obj in memory.afloat}
        floating_bodies = [floating.held_body(obj, context.scene) for obj in afloat.values()]
        details += [
            _waterline(body, unit) for body in floating_bodies if isinstance(body, floating.Held)
        ]
    return details


def _path(path: balance_groups.Path) -> Detail:
    """Return a line from frame to frame with a tick at each.

    They are orange if the center is outside the support polygon while anything touches the ground,
    and red if momentum changes while nothing does.
    """
    ticks = np.stack([path.centers, path.centers], axis=1)
    ticks[:, 1, 2] += TICK * float(np.ptp(path.centers, axis=0).max())
    inside = np.ones(len(ticks), bool) if path.inside is None else path.inside
    if path.contact is not None:
        inside = inside | ~path.contact
    line_colors, tick_colors = (
        np.where(is_inside[:, None], look.PATH, look.TIPS)
        for is_inside in (inside[:-1] & inside[1:], inside)
    )
    if path.unexplained is not None:
        line_colors[path.unexplained[:-1] | path.unexplained[1:]] = look.FAULT
        tick_colors[path.unexplained] = look.FAULT
    segments = np.concatenate([np.stack([path.centers[:-1], path.centers[1:]], axis=1), ticks])
    return Detail((segments, np.concatenate([line_colors, tick_colors]).astype(np.float32)))


def _arcs(scene: Scene, path: balance_groups.Path) -> list[Detail]:
    """Return the arc of free fall beside each flight of a path, with a cross at take-off and at
    landing.
    """
    if path.contact is None or not scene.use_gravity:
        return []
    details = []
    size = CROSS * float(np.ptp(path.centers, axis=0).max())
    for first, last in core.rig.find_flights(path.contact):
        if path.contact[first] and path.contact[last]:
            frame_count = (path.frames[last] - path.frames[first]) / fcurves.time_scale(scene)
            time = frame_count * (scene.render.fps_base / scene.render.fps)
            ends = path.centers[[first, last]]
            shares = np.linspace(0.0, 1.0, last - first + 1)
            arc = core.rig.ballistic_arc(*ends, shares, time, scene.gravity)
            crosses = ends[:, None, None] + size * CROSS_LINES
            lines = np.concatenate(
                [np.stack([arc[:-1], arc[1:]], axis=1), crosses.reshape(-1, 2, 3)]
            )
            details.append(Detail(_tinted(lines, look.EDGE)))
    return details


def _surface(level: cuts.Level, unit: float) -> Detail:
    # unit: meters per Blender unit
    hollow = level.hollow
    outline = cut_outline(hollow.points, hollow.triangles, hollow.up, level.height) / unit
    triangles = level.triangles / unit
    return Detail(_tinted(outline, look.SUPPORT), _tinted(triangles, look.SUPPORT, FILL))


def _waterline(floating_body: floating.Held, unit: float) -> Detail:
    """Return the waterline on the body, and crosses at its centers of buoyancy and gravity and its
    metacenter, with a line through these.
    """
    state = floating_body.state
    body = state.body
    line = cut_outline(body.points, body.triangles, state.up, state.level)
    buoyancy, gravity = state.center_of_buoyancy, state.center_of_gravity
    metacenter = buoyancy + state.metacentric_radii[0] * state.up
    places = np.array([buoyancy, gravity, metacenter])
    crosses = places[:, None, None] + CROSS * body.size * CROSS_LINES
    axis = np.array([[buoyancy, metacenter]])
    segments = np.concatenate([line, axis, crosses.reshape(-1, 2, 3)])
    color = look.WATER if floating_body.is_at_rest else look.EDGE
    texts = [
        (place / unit, letter, color)
        for place, letter in zip(floating_body.to_world(places), "BGM")
    ]
    return Detail(_tinted(floating_body.to_world(segments) / unit, color), texts=tuple(texts))


def _faults(obj: Object, mesh_faults: faults.Faults) -> Detail:
    matrix = np.array(obj.matrix_world, np.float64)
    edges, triangles = (
        shape @ matrix[:3, :3].T + matrix[:3, 3]
        for shape in (mesh_faults.edges, mesh_faults.triangles)
    )
    return Detail(_tinted(edges, look.FAULT), _tinted(triangles, look.FAULT, FILL))


def _weight(context: Context, weight: Weight) -> list[Detail]:
    text, lengths, _ = standing(weight, meters_per_unit(context.scene))
    polygon = None if weight.support is None else support_detail(weight.support)
    # that of the polygon's segments, which have one color
    color = look.TIPS if polygon is None else polygon.segments[1][0]
    plumb = _tinted(np.array([[weight.parts.center, weight.foot]]), color)
    texts = ((weight.foot, blender.write.reports.phrase(text, **lengths), color),)
    return [
        Detail(plumb, texts=texts),
        *([] if polygon is None else [polygon]),
    ]


def support_detail(support: core.statics.Support) -> Detail:
    """Return the support polygon, filled if the body stands, and an arrow from the foot to the
    tipping edge.
    """
    color = look.EDGE if support.is_near_edge else look.SUPPORT
    if not support.stands:
        color = look.TIPS
    corners, foot = support.polygon, support.foot
    outline = np.stack([corners, np.roll(corners, -1, axis=0)], axis=1)
    fan = np.stack(
        [np.broadcast_to(corners[0], corners[2:].shape), corners[1:-1], corners[2:]], axis=1
    )
    extent = float(np.linalg.norm(np.ptp(np.concatenate([corners, [foot]]), axis=0)))
    # The arrow reaches the edge, and is at least twice as long as its head.
    tip = foot + max(abs(support.margin), 2.0 * ARROW * extent) * support.direction
    side = np.cross(support.direction, support.up) * ARROW * extent / 2.0
    back = tip - ARROW * extent * support.direction
    arrow = np.array([[foot, tip], [tip, back + side], [tip, back - side]])
    return Detail(
        _tinted(np.concatenate([outline, arrow]), color),
        _tinted(fan if support.stands else fan[:0], color, FILL),
    )


def _tinted(shape: NDArray, color: NDArray, opacity: float = 1.0) -> Colored:
    return shape, np.tile(color * (1.0, 1.0, 1.0, opacity), (len(shape), 1)).astype(np.float32)
