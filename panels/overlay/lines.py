# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is drawn of bodies, as arrays: colored segments in the world, and discs and digits of constant size."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ...operators.settings.overlay import BodyMomentsOverlaySettings
from . import appearance as look
from . import glyphs, solids
from .bodies import Bodies
from .view import View

Segments = tuple[NDArray[np.float64], NDArray[np.float32]]  # (k, 2, 3) in the world, (k, 4) colors


def body_lines(bodies: Bodies, settings: BodyMomentsOverlaySettings) -> Iterator[Segments]:
    """Yield the segments of what is switched on."""
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
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Make the discs at the centers, and the digits at the ends of the axes.

    Parameters
    ----------
    bodies : Bodies
    view : View
    scale : float
        Pixels for one of `appearance`.
    with_digits : bool
        Whether the axes are named.

    Returns
    -------
    points, colors : (3 k, 3) and (3 k, 4) arrays
        Triangles, the nearest bodies last.
    """
    order = np.argsort(-view.depths(bodies.centers), kind="stable")
    centers, verdicts = bodies.centers[order], bodies.verdicts[order]
    offsets, colors = glyphs.discs()
    points = [view.place(centers, scale * offsets[verdicts]).reshape(len(order), -1, 3)]
    tints = [colors[verdicts]]
    if with_digits:
        offsets, colors = glyphs.digits()
        tips = centers[:, None] + (bodies.axes * bodies.gyration[:, None, :]).transpose(0, 2, 1)[order]
        away = _digit_offsets(view.pixels(centers), view.pixels(tips.reshape(-1, 3)).reshape(-1, 3, 2), scale)
        placed = view.place(
            tips.reshape(-1, 3), (scale * offsets + away[:, :, None, None]).reshape(-1, *offsets.shape[1:])
        )
        points.append(placed.reshape(len(order), -1, 3))
        tints.append(np.broadcast_to(colors.reshape(-1, 4), (len(order), colors[..., 0].size, 4)))
    joined, tint = np.concatenate(points, axis=1), np.concatenate(tints, axis=1).repeat(3, axis=1)
    return joined.reshape(-1, 3).astype(np.float32), np.ascontiguousarray(tint.reshape(-1, 4), np.float32)


def _digit_offsets(centers: NDArray, tips: NDArray, scale: float) -> NDArray[np.float64]:
    """(n, 3, 2) pixels from the ends of axes, (n, 3, 2), to their digits: beyond the end, and off the disc."""
    arms = tips - centers[:, None]
    lengths = np.linalg.norm(arms, axis=2, keepdims=True)
    fallback = np.array([(1.0, 0.3), (-0.3, 1.0), (-1.0, -0.3)])
    directions = np.where(lengths > 1e-3, arms / np.maximum(lengths, 1e-3), fallback)
    wanted = np.maximum(lengths + scale * 2.5 * look.DIGIT, scale * (look.FRAME + 3.0 * look.DIGIT))
    return directions * (wanted - lengths)
