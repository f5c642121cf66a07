# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Drawings of bodies, as arrays: colored segments in the world, and discs and digits of constant size."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ...blender.settings.overlay import BodyMomentsOverlaySettings
from . import appearance as look
from . import glyphs, solids
from .bodies import Bodies
from .view import View

MARGIN = 40.0  # pixels around the view in which discs are still made
MIN_NAMED = 8.0  # pixels of the longest axis from which on axes are named
Segments = tuple[NDArray[np.float64], NDArray[np.float32]]  # (k, 2, 3) in the world, (k, 4) colors


def body_lines(bodies: Bodies, settings: BodyMomentsOverlaySettings) -> Iterator[Segments]:
    """Yield the segments of the enabled drawings."""
    place = bodies.centers, bodies.axes, bodies.gyration
    if settings.show_axes:
        yield _colored(solids.axis_lines(*place), bodies)
    if settings.show_drop_line:
        yield _colored(solids.drop_lines(bodies.centers, bodies.gyration), bodies)
    if settings.equivalent == "BOX":
        yield _colored(solids.box_lines(*place), bodies)
    elif settings.equivalent == "ELLIPSOID":
        yield _colored(solids.ellipsoid_lines(*place), bodies)


def _colored(segments: NDArray, bodies: Bodies) -> Segments:
    return segments.reshape(-1, 2, 3), look.COLORS[bodies.verdicts].repeat(segments.shape[1], axis=0)


def disc_triangles(
    bodies: Bodies, view: View, scale: float, with_digits: bool
) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.int32]]:
    """Make the discs at the centers, and the digits at the ends of the axes if `with_digits`.

    Return (k, 3) points, (2, k, 4) colors, hidden by something in front and visible, and (l, 3) triangles, the nearest
    bodies last. `scale` is in pixels for one of `appearance`.
    """
    sizes = view.pixel_sizes(bodies.centers).max(axis=1)
    reach = np.divide(bodies.gyration.max(axis=1), sizes, out=np.zeros(len(bodies)), where=sizes > 0.0)  # in pixels
    away = np.abs(view.pixels(bodies.centers) - view.size / 2.0) - view.size / 2.0
    seen = np.flatnonzero((sizes > 0.0) & (away <= (reach + scale * MARGIN)[:, None]).all(axis=1))
    seen = seen[np.argsort(-view.depths(bodies.centers[seen]), kind="stable")]
    named = with_digits & (reach[seen] >= scale * MIN_NAMED)
    parts = [
        _glyphs(bodies, group, view, scale, digits) for group, digits in ((seen[~named], False), (seen[named], True))
    ]
    starts = np.cumsum([0, *(len(points) for points, _, _ in parts)], dtype=np.int32)
    points, colors, triangles = zip(*parts)
    numbered = [corners + start for corners, start in zip(triangles, starts)]
    return np.concatenate(points), np.concatenate(colors, axis=1), np.concatenate(numbered)


def _glyphs(
    bodies: Bodies, group: NDArray[np.intp], view: View, scale: float, with_digits: bool
) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.int32]]:
    """Make the `disc_triangles` of some bodies, in this order."""
    count, centers, verdicts = len(group), bodies.centers[group], bodies.verdicts[group]
    discs = glyphs.discs()
    points, colors = [view.place(centers, scale * discs.corners[verdicts])], [discs.colors[:, verdicts]]
    triangles = [discs.triangles[verdicts]]
    if with_digits:
        digits = glyphs.digits()
        arms = bodies.axes[group] * bodies.gyration[group][:, None, :]
        tips = (centers[:, None] + arms.transpose(0, 2, 1)).reshape(-1, 3)
        away = _digit_offsets(view.pixels(centers), view.pixels(tips).reshape(-1, 3, 2), scale).astype(np.float32)
        offsets = (scale * digits.corners + away[:, :, None]).reshape(3 * count, digits.corners.shape[1], 2)
        points.append(view.place(tips, offsets).reshape(count, 3 * digits.corners.shape[1], 3))
        tints = digits.colors.reshape(2, 1, -1, 4)
        colors.append(np.broadcast_to(tints, (2, count, *tints.shape[2:])))
        first = discs.corners.shape[1] + digits.corners.shape[1] * np.arange(3, dtype=np.int32)[:, None, None]
        named = (digits.triangles + first).reshape(1, -1, 3)
        triangles.append(np.broadcast_to(named, (count, *named.shape[1:])))
    placed, tints = np.concatenate(points, axis=1), np.concatenate(colors, axis=2)
    start = placed.shape[1] * np.arange(count, dtype=np.int32)[:, None, None]
    corners = np.concatenate(triangles, axis=1) + start
    return placed.reshape(-1, 3), tints.reshape(2, -1, 4), corners.reshape(-1, 3)


def _digit_offsets(centers: NDArray, tips: NDArray, scale: float) -> NDArray[np.float64]:
    """Return (n, 3, 2) pixels from the ends of axes, (n, 3, 2), to their digits: beyond the end, and off the disc."""
    arms = tips - centers[:, None]
    lengths = np.linalg.norm(arms, axis=2, keepdims=True)
    fallback = np.array([(1.0, 0.3), (-0.3, 1.0), (-1.0, -0.3)])
    directions = np.where(lengths > 1e-3, arms / np.maximum(lengths, 1e-3), fallback)
    wanted = np.maximum(lengths + scale * 2.5 * look.DIGIT, scale * (look.FRAME + 3.0 * look.DIGIT))
    return directions * (wanted - lengths)
