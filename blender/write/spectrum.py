# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A Fourier transform as a file of arrays, and as a picture."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import bpy
import numpy as np

from ...core import fourier, measurement
from ...core.files.whole_file import whole_file
from ...core.numerics import Complex

# property of the images that may be overwritten; its value is their name
IMAGE_MARK = "body_fourier"
DECADES = 6.0  # from white to black
SLICE_GAP = 2  # pixels between slices


def save(
    path: Path,
    spectrum: fourier.Spectrum,
    frame: str,
    check: Callable[[Path], None] | None = None,
    plane: Mapping[str, Any] | None = None,
) -> None:
    """Write a spectrum as an .npz file, complete or not at all.

    The arrays are q, (M, 3) in rad/m; F, (M,) complex in m³ or m²; error, (M,) bounds of the
    rounding; input, a bound of the error by float32 coordinates; method; frame. check: as in
    `whole_file`. plane: the further `FLAT_SPECTRUM_ARRAYS` of a flat shape, for which q is (M, 2).
    Raises OSError.
    """
    with whole_file(path, check) as file:
        arrays = (
            spectrum.q,
            spectrum.values,
            spectrum.error,
            spectrum.input_error,
            spectrum.method,
            frame,
        )
        np.savez(file, **dict(zip(measurement.SPECTRUM_ARRAYS, arrays)), **(plane or {}))


def picture(name: str, values: Complex, count: int, dimension: int = 3) -> bpy.types.Image:
    """Return an image of the slices z = 0, y = 0 and x = 0, from left to right, of a transform on a
    grid of count³.

    With two dimensions, on a grid of count², the image shows all of it.

    Gray is log |F|: white at the maximum, black from six decades below on. The first remaining axis
    runs to the right, the second upward.
    """
    half = count // 2
    size = np.abs(values).reshape((count,) * dimension)
    largest = size.max() or 1.0
    slices = (size,) if dimension == 2 else (size[:, :, half], size[:, half, :], size[half, :, :])
    gray = np.zeros((count, len(slices) * (count + SLICE_GAP) - SLICE_GAP))
    for i, slice_ in enumerate(slices):
        decades = np.log10(np.maximum(slice_.T / largest, 10.0**-DECADES))
        gray[:, i * (count + SLICE_GAP) :][:, :count] = 1.0 + decades / DECADES
    pixels = np.ones((*gray.shape, 4), np.float32)
    pixels[..., :3] = gray[..., None]
    image = next(
        (image for image in bpy.data.images if image.get(IMAGE_MARK) == name and image.is_editable),
        None,
    )
    if image is None:
        image = bpy.data.images.new(name, gray.shape[1], count)
        image[IMAGE_MARK] = name
    elif tuple(image.size) != (gray.shape[1], count):
        image.scale(gray.shape[1], count)
    image.pixels.foreach_set(pixels.ravel())
    image.update()
    image.pack()  # or it would be lost with the session
    return image
