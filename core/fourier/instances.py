# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Fourier transform of a body of several surfaces, each at one or many places.

Under a map x -> A x + t a transform becomes F(q) -> |det A| exp(-i q·t) F(Aᵀq). So each surface is transformed once for
every different A, and all its places with that A are one factor Σ exp(-i q·t). A acts on the surface, not on q: a
regular grid stays one.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..mesh.surface import Surface
from ..moments.affine_maps import distinct_linear
from ..moments.moments import Measure
from ..numerics.compensated import wave
from ..verdict.finding import MeasureError
from .grid import GridTransform
from .spectrum import Spectrum
from .transform import Transform
from .wave_vectors import Grid, wave_vectors

CLOSED_FORM = 2e8  # pairs of triangles and frequencies, about 20 s: a grid of more is transformed to the tolerance
TOLERANCE = 1e-7  # of the volume or the area, then


class BodyTransform:
    """The transform of surfaces at their places: `steps` does the work, `result` gives the outcome.

    parts: surfaces with their (k, 4, 4) maps. q: (M, 3) wave vectors or a Grid. of: volume or area.
    total: the body's volume or area, to which `TOLERANCE` refers.
    """

    def __init__(
        self, parts: Sequence[tuple[Surface, NDArray]], q: ArrayLike | Grid, of: Measure, total: float, threads: int = 1
    ):
        self.q = q if isinstance(q, Grid) else wave_vectors(q, 3)
        self.of, self.threads = of, threads
        self.jobs = [job for surface, matrices in parts for job in _placed(surface, matrices)]
        if not self.jobs:
            raise MeasureError("no_faces")
        self.weights = [len(surface.triangles) for surface, _ in self.jobs]
        places = sum(len(offsets) for _, offsets in self.jobs)
        self.tolerance = None
        if isinstance(q, Grid) and sum(self.weights) * q.count**3 / 2.0 > CLOSED_FORM:
            self.tolerance = TOLERANCE * total / places
        self.spectrum: Spectrum | None = None

    def steps(self) -> Iterator[float]:
        """Do the work. Yields after each part of it the fraction done, from 0 to 1. MeasureError as `Transform`."""
        done, everything = 0, sum(self.weights)
        for weight, (surface, offsets) in zip(self.weights, self.jobs):
            if self.tolerance is None:
                transform = Transform(surface, self.q, self.of, self.threads)
            else:
                transform = GridTransform(surface, self.q, self.of, self.tolerance, self.threads)
            for share in transform.steps():
                yield (done + share * weight) / everything
            one = transform.result()
            waves = np.zeros(len(one.q), np.complex128)
            done += weight
            for offset in offsets:
                waves += wave(one.q, offset)
                yield done / everything
            one = one.times(waves, len(offsets))
            self.spectrum = one if self.spectrum is None else self.spectrum + one

    def result(self) -> Spectrum:
        """The spectrum of everything together, when all steps are done."""
        return self.spectrum


def _placed(surface: Surface, matrices: NDArray) -> Iterator[tuple[Surface, NDArray[np.float64]]]:
    """The surface about its center under each different linear map, and where those images stand, (k, 3)."""
    triangles = surface.all_triangles()[0]
    if not len(triangles):
        return
    points = surface.points.astype(np.float64)
    center = points.min(axis=0) / 2.0 + points.max(axis=0) / 2.0
    around = Surface(points - center, triangles, moved=surface.coordinate_error)
    offsets = matrices[:, :3, 3] + matrices[:, :3, :3] @ center
    for linear, own in distinct_linear(matrices):
        yield around.mapped(linear), offsets[own]
