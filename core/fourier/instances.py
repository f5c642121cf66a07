# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Fourier transform of a body of several surfaces, each at one or many places.

Under a map x -> A x + t a transform becomes F(q) -> |det A| exp(-i q·t) F(Aᵀq). So each surface is
transformed once for every different A, and all its places with that A are one factor Σ exp(-i q·t).
A acts on the surface, not on q: a regular grid stays one.
"""

from collections.abc import Iterator, Sequence
from typing import cast

import numpy as np

from ..mesh import Surface
from ..moments import Measure, distinct_linear_parts
from ..numerics import Array, ArrayLike, NDArray, check_type, float_array, phase_factors
from ..verdict import NO_FACES, MeasureError
from .grid import GridTransform
from .transform import Transform
from .wave_vectors import FrequencyGrid, Spectrum, wave_vectors

# pairs of triangles and frequencies, about 20 s: larger grids are transformed to FOURIER_RTOL
MAX_CLOSED_FORM_PAIRS = 2e8
FOURIER_RTOL = 1e-7  # Tolerance of transforms of large grids, relative to the volume or the area.


class BodyTransform:
    """The transform of surfaces, each at one or many places: `steps` does the work, `result` has
    the spectrum.

    parts: each surface with its (k, 4, 4) maps. q: wave vectors (M, 3) or a grid. `of` is volume or
    area, `total` the body's volume or area, to which FOURIER_RTOL refers. MeasureError without
    faces, or as for `solid_transform`.
    """

    def __init__(
        self,
        parts: Sequence[tuple[Surface, NDArray]],
        q: ArrayLike | FrequencyGrid,
        of: Measure,
        total: float,
        threads: int = 1,
    ):
        self.q = q if isinstance(q, FrequencyGrid) else wave_vectors(q, 3)
        self.measure = of
        self.threads = threads
        # Surfaces, and the (k, 3) places of their copies.
        self.images = [
            image for surface, matrices in parts for image in _distinct_images(surface, matrices)
        ]
        if not self.images:
            raise MeasureError(NO_FACES)
        self.triangle_count = sum(len(surface.triangles) for surface, _ in self.images)
        self.tolerance = FOURIER_RTOL * total / sum(len(offsets) for _, offsets in self.images)
        self.spectrum: Spectrum | None = None

    def steps(self) -> Iterator[float]:
        """Do the work in parts; yield the fraction done, from 0 to 1, after each."""
        done = 0
        for surface, offsets in self.images:
            transform = self._transform(surface)
            for share in transform.steps():
                yield (done + share * len(surface.triangles)) / self.triangle_count
            spectrum = transform.result()
            phases = np.zeros(len(spectrum.q), np.complex128)
            done += len(surface.triangles)
            for offset in offsets:
                phases += phase_factors(spectrum.q, offset)
                yield done / self.triangle_count
            spectrum = spectrum.multiply_by_phases(phases, len(offsets))
            self.spectrum = spectrum if self.spectrum is None else self.spectrum + spectrum

    def _transform(self, surface: Surface) -> Transform:
        """Return the transform of a surface: to a tolerance if all together are large."""
        if isinstance(self.q, FrequencyGrid):
            pairs = self.triangle_count * self.q.count**3 / 2.0
            if pairs > MAX_CLOSED_FORM_PAIRS:
                return GridTransform(surface, self.q, self.measure, self.tolerance, self.threads)
        return Transform(surface, self.q, self.measure, self.threads)

    def result(self) -> Spectrum:
        """Return the spectrum of all surfaces together, when all steps are done."""
        return cast("Spectrum", self.spectrum)  # there are parts, and each has added to it


def _distinct_images(surface: Surface, matrices: NDArray) -> Iterator[tuple[Surface, Array]]:
    """Yield the surface about its center under each different linear map, and the places of the
    images, (k, 3).
    """
    check_type("parts", surface, Surface)
    matrices = float_array("parts", matrices, "k", 4, 4)
    triangles = surface.all_triangles()[0]
    if not len(triangles):
        return
    points = surface.points.astype(np.float64)
    center = points.min(axis=0) / 2.0 + points.max(axis=0) / 2.0
    around = Surface(points - center, triangles, displacement=surface.coordinate_error)
    offsets = matrices[:, :3, 3] + matrices[:, :3, :3] @ center
    for linear, members in distinct_linear_parts(matrices):
        yield around.transform(linear), offsets[members]
