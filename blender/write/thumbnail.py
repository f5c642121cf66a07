# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A small picture of a body with its principal axes, drawn without a window or a graphics card."""

import base64
import struct
import zlib

import numpy as np

from ...core.numerics import Array, Floats, Integers, NDArray

SIZE = 128  # pixels
_SAMPLES = 5_000  # points of the surface, so that parts thinner than a pixel are drawn, too
_MAX_TESTS = 1_000_000  # pairs of a pixel and a triangle; many long slivers would have far more
_MANY_SAMPLES = 200_000  # in their place
_MARGIN = 0.1
_VIEW = np.array(
    [[0.8, -0.6, 0.0], [0.36, 0.48, 0.8], [0.48, 0.64, -0.6]]
).T  # columns: right, up, away from the eye
_AXES = ((214, 64, 64), (72, 160, 72), (72, 96, 214))  # red, green, blue: axes 1, 2 and 3
_BODY = np.array([205.0, 208.0, 214.0])


def thumbnail(
    points: Floats,
    triangles: Integers,
    center: Array,
    axes: Array,
) -> str:
    """Draw triangles from an oblique direction, and return a PNG as a data URL.

    points (n, 3), the center of mass (3,) and the principal axes (3, 3) as columns share any one
    frame and unit. triangles: (m, 3) integers.
    """
    corners = np.asarray(points, np.float64)[triangles] @ _VIEW
    low = corners.reshape(-1, 3).min(axis=0)
    high = corners.reshape(-1, 3).max(axis=0)
    scale = (1.0 - 2.0 * _MARGIN) * SIZE / (max(high[:2] - low[:2]) or 1.0)
    middle = 0.5 * (low + high)
    corners = (corners - middle) * scale
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(normals, axis=1)
    image = np.full((SIZE, SIZE, 4), 0, np.uint8)
    if areas.sum() > 0.0:
        _draw(image, corners, normals, areas)
    start = (np.asarray(center, np.float64) @ _VIEW - middle) * scale
    for axis, color in zip(np.asarray(axes, np.float64).T @ _VIEW, _AXES):
        # Half an axis is 0.42 of the picture; its steps are less than a pixel, its width is two.
        steps = np.linspace(-1.0, 1.0, 2 * SIZE)[:, None] * axis * 0.42 * SIZE + start
        for right, up in ((0, 0), (1, 0), (0, 1)):
            _put(image, steps + (right, up, 0), np.array([*color, 255], np.uint8))
    return "data:image/png;base64," + base64.b64encode(_png(image)).decode()


def _draw(image: NDArray, corners: NDArray, normals: NDArray, areas: NDArray) -> None:
    """Draw the triangles at the centers of pixels, the nearest in front, each shaded by its
    normal.
    """
    owner, spots = _covered_pixels(corners)
    sampled, samples = _sample(corners, areas, _SAMPLES if len(owner) else _MANY_SAMPLES)
    owner = np.concatenate([sampled, owner])
    spots = np.concatenate([samples, spots])
    # the farthest first: the last one put at a pixel stays
    order = np.argsort(-spots[:, 2], kind="stable")
    light = np.abs(normals @ (0.75, 0.75, -0.35)) / np.maximum(areas, np.finfo(float).tiny)
    colors = np.full((len(areas), 4), 255, np.uint8)
    colors[:, :3] = _BODY * (0.35 + 0.65 * np.minimum(light, 1.0)[:, None])
    _put(image, spots[order], colors[owner[order]])


def _covered_pixels(corners: NDArray) -> tuple[NDArray, Array]:
    """Return the (k,) triangles that cover centers of pixels, and these (k, 3) points; none if too
    many.
    """
    flat = corners[:, :, :2]
    first = np.ceil(flat.min(axis=1)).astype(int)
    last = np.floor(flat.max(axis=1)).astype(int)
    spans = np.maximum(last - first + 1, 0)
    # pairs of a triangle and a pixel in its box; the pixels of a box are numbered from 0
    counts = spans.prod(axis=1)
    counts *= counts.sum() <= _MAX_TESTS  # zero if there are too many
    owner = np.repeat(np.arange(len(corners)), counts)
    number = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    points = first[owner] + np.stack(np.divmod(number, np.maximum(spans[owner, 1], 1)), axis=1)
    origin = corners[owner, 0]
    sides = (corners[:, 1:] - corners[:, :1])[owner]
    (x, y) = sides[:, :, :2].transpose(1, 0, 2)
    offset = points - origin[:, :2]
    doubled_area = x[:, 0] * y[:, 1] - x[:, 1] * y[:, 0]
    with np.errstate(all="ignore"):  # triangles seen from their edge
        # offset = a x + b y, by Cramer's rule
        a = (offset[:, 0] * y[:, 1] - offset[:, 1] * y[:, 0]) / doubled_area
        b = (x[:, 0] * offset[:, 1] - x[:, 1] * offset[:, 0]) / doubled_area
        depth = origin[:, 2] + a * sides[:, 0, 2] + b * sides[:, 1, 2]
    inside = (a >= 0.0) & (b >= 0.0) & (a + b <= 1.0)
    return owner[inside], np.column_stack([points, depth])[inside]


def _sample(corners: NDArray, areas: NDArray, count: int) -> tuple[NDArray, Array]:
    """Return the (count,) triangles of random points, evenly spread over the surface, and these
    points.
    """
    chance = np.random.default_rng(0)
    # A triangle is chosen as often as its share of the summed area.
    chosen = np.searchsorted(np.cumsum(areas), chance.random(count) * areas.sum())
    chosen = np.minimum(chosen, len(areas) - 1)  # the sums may be rounded differently
    a, b = chance.random((2, count, 1))
    is_outside = a + b > 1.0  # in the other half of the parallelogram, which is turned over
    a = np.where(is_outside, 1.0 - a, a)
    b = np.where(is_outside, 1.0 - b, b)
    origin, first, second = corners[chosen].swapaxes(0, 1)
    return chosen, origin + a * (first - origin) + b * (second - origin)


def _put(image: NDArray, spots: NDArray, colors: NDArray) -> None:
    """Color the pixels at (k, 2 or 3) spots, in pixels from the middle, by one or by (k, 4) colors;
    spots outside are left out.
    """
    places = np.rint(spots[:, :2] + 0.5 * SIZE).astype(int)
    inside = ((places >= 0) & (places < SIZE)).all(axis=1)
    column, row = places[inside].T
    image[SIZE - 1 - row, column] = colors[inside] if colors.ndim == 2 else colors


def _png(image: NDArray[np.uint8]) -> bytes:
    """Return a PNG file (https://www.w3.org/TR/png/): 8 bits, red, green, blue, opacity."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        return (
            struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        )

    height, width, _ = image.shape
    rows = np.concatenate(
        [np.zeros((height, 1), np.uint8), image.reshape(height, 4 * width)], axis=1
    )
    head = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    body = zlib.compress(rows.tobytes())
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", body) + chunk(b"IEND", b"")
