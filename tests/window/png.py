# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays as animated PNG (the PNG specification, third edition), with numpy and zlib alone.

There is one palette, and of each frame only the rectangle that has changed.
"""

import struct
import zlib
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

SIGNATURE = b"\x89PNG\r\n\x1a\n"
Image = NDArray[np.uint8]  # (height, width, 3), from the top


def write_animation(path: Path, frames: Sequence[Image], seconds: Sequence[float]) -> None:
    """Write frames that are shown for so many seconds each, again and again."""
    palette, indexed = quantize(np.stack(frames))
    height, width = indexed.shape[1:]
    parts = [
        _chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 3, 0, 0, 0)),
        _chunk(b"PLTE", palette.tobytes()),
        _chunk(b"acTL", struct.pack(">II", len(indexed), 0)),
    ]
    number = 0
    for place, (frame, shown) in enumerate(zip(indexed, seconds, strict=True)):
        top, bottom, left, right = _changed(indexed[place - 1], frame) if place else (0, height, 0, width)
        control = (number, right - left, bottom - top, left, top, round(1000 * shown), 1000, 0, 0)
        parts.append(_chunk(b"fcTL", struct.pack(">IIIIIHHBB", *control)))
        rows = frame[top:bottom, left:right]
        packed = zlib.compress(np.pad(rows, ((0, 0), (1, 0))).tobytes(), 9)
        number += 1
        if place:
            parts.append(_chunk(b"fdAT", struct.pack(">I", number) + packed))
            number += 1
        else:
            parts.append(_chunk(b"IDAT", packed))
    path.write_bytes(SIGNATURE + b"".join([*parts, _chunk(b"IEND", b"")]))


def _changed(before: NDArray, after: NDArray) -> tuple[int, int, int, int]:
    """The rows and columns in which two frames differ: at least one of each."""
    differs = before != after
    rows, columns = np.flatnonzero(differs.any(axis=1)), np.flatnonzero(differs.any(axis=0))
    return (rows[0], rows[-1] + 1, columns[0], columns[-1] + 1) if len(rows) else (0, 1, 0, 1)


def quantize(images: NDArray[np.uint8], count: int = 256) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """Find a palette of at most `count` colors by median cut, and the entry of each pixel."""
    flat = images.reshape(-1, 3)
    # five bits a channel are a table of 32768 entries
    keys = (flat[:, 0] >> 3).astype(np.intp) << 10 | (flat[:, 1] >> 3).astype(np.intp) << 5 | flat[:, 2] >> 3
    weights = np.bincount(keys, minlength=1 << 15)
    sums = np.stack([np.bincount(keys, flat[:, axis], 1 << 15) for axis in range(3)], axis=1)
    used = np.flatnonzero(weights)
    colors, masses = sums[used] / weights[used, None], weights[used]
    boxes = [np.arange(len(used))]
    while len(boxes) < count:
        spreads = [np.ptp(colors[box], axis=0).max() * masses[box].sum() ** 0.3 for box in boxes]
        largest = int(np.argmax(spreads))
        if not spreads[largest]:
            break
        box = boxes.pop(largest)
        box = box[np.argsort(colors[box, np.ptp(colors[box], axis=0).argmax()], kind="stable")]
        total = np.cumsum(masses[box])
        half = int(np.clip(np.searchsorted(total, total[-1] / 2), 1, len(box) - 1))
        boxes += [box[:half], box[half:]]
    entry = np.zeros(1 << 15, np.uint8)
    for number, box in enumerate(boxes):
        entry[used[box]] = number
    palette = [np.average(colors[box], axis=0, weights=masses[box]) for box in boxes]
    return np.round(palette).astype(np.uint8), entry[keys].reshape(images.shape[:-1])


def _chunk(name: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
