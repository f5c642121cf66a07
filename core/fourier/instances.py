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
        self.measure, self.threads = of, threads
        self.jobs = [
            job for surface, matrices in parts for job in _distinct_images(surface, matrices)
        ]
        if not self.jobs:
            raise MeasureError(NO_FACES)
        self.weights = [len(surface.triangles) for surface, _ in self.jobs]
        instance_count = sum(len(offsets) for _, offsets in self.jobs)
        self.tolerance = None
        if (
            isinstance(q, FrequencyGrid)
            and sum(self.weights) * q.count**3 / 2.0 > MAX_CLOSED_FORM_PAIRS
        ):
            self.tolerance = FOURIER_RTOL * total / instance_count
        self.spectrum: Spectrum | None = None

    def steps(self) -> Iterator[float]:
        """Do the work in parts; yield the fraction done, from 0 to 1, after each."""
        done = 0
        everything = sum(self.weights)
        for weight, (surface, offsets) in zip(self.weights, self.jobs):
            if self.tolerance is None or not isinstance(self.q, FrequencyGrid):
                transform = Transform(surface, self.q, self.measure, self.threads)
            else:
                transform = GridTransform(
                    surface, self.q, self.measure, self.tolerance, self.threads
                )
            for share in transform.steps():
                yield (done + share * weight) / everything
            part_spectrum = transform.result()
            waves = np.zeros(len(part_spectrum.q), np.complex128)
            done += weight
            for offset in offsets:
                waves += phase_factors(part_spectrum.q, offset)
                yield done / everything
            part_spectrum = part_spectrum.multiply_by_phases(waves, len(offsets))
            self.spectrum = (
                part_spectrum if self.spectrum is None else self.spectrum + part_spectrum
            )

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
