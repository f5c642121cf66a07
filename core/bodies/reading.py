# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The result of reading an object: surfaces, their places, a finding for each decision; the
measurement of its body.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace

import numpy as np

from .. import files, mesh, nurbs, verdict
from ..measurement import Body, Measurement, Settings, fingerprint, measure_body
from ..moments import are_singular
from ..numerics import Array, ArrayLike, Integers

NO_SLOTS = np.empty(0, np.intp)
NO_VALUES = np.empty(0)


@dataclass(frozen=True, eq=False)
class FaceAttributes:
    """Attributes of the faces and vertices of a surface.

    materials: the original materials of its slots, None for empty ones. face_slots: (f,) the slot
    of each mesh face, -1 if there are no slots. vertex_values: (n,) values of the requested
    attribute, else none.
    """

    materials: tuple = ()
    face_slots: Integers = field(default_factory=NO_SLOTS.view)
    vertex_values: Array = field(default_factory=NO_VALUES.view)


@dataclass(frozen=True, eq=False)
class SplineReading:
    """Faces of a surface object.

    patches: of the splines that show a surface, each facing as Blender's faces do, or faces of a
    file. stored: largest effect of rounding in storage on their points. findings: the decisions.
    """

    patches: tuple[nurbs.Face, ...]
    stored: float
    findings: tuple[verdict.Finding, ...]


@dataclass
class Part:
    """One surface and its places.

    matrices: (k, 4, 4) float64, k >= 1, world from the surface's coordinates, Blender units, column
    vectors. attributes: of its faces and vertices, if requested. source_object_name: the name of
    the object with this surface, or with its nodes; empty for the object that was read. splines:
    B-spline patches, if `surface` is but their display mesh.
    """

    surface: mesh.Surface
    matrices: Array
    attributes: FaceAttributes = field(default_factory=FaceAttributes)
    splines: SplineReading | None = None
    source_object_name: str = ""


@dataclass
class Reading:
    """An object as arrays.

    type: Blender's object type.
    matrix: (4, 4) float64, the object's `matrix_world`.
    rotation: (3, 3), orthonormal to float64, and location: (3,), Blender units, as
        `matrix_world.decompose()` gives them: the object frame.
    curves: of a curve object that is read as lines, in its own coordinates; else none.
    singular_instance_count: number of places with a matrix that flattens the surface, so that it
    encloses nothing. all_singular: all places have such a matrix. instance_count: number of places
    of all surfaces. findings: one for each decision.
    """

    name: str
    type: str
    matrix: Array
    rotation: Array
    location: Array
    parts: list[Part] = field(default_factory=list)
    curves: list[nurbs.Curve] = field(default_factory=list)
    findings: list[verdict.Finding] = field(default_factory=list)

    @property
    def has_patches(self) -> bool:
        """True if any part has B-spline patches."""
        return any([part.splines is not None for part in self.parts])

    @property
    def is_singular(self) -> bool:
        """True if the object's own matrix is singular, so that it flattens bodies."""
        return bool(are_singular(self.matrix[None, :3, :3])[0])

    @property
    def singular_instance_count(self) -> int:
        return sum([int(are_singular(part.matrices[:, :3, :3]).sum()) for part in self.parts])

    @property
    def all_singular(self) -> bool:
        return self.singular_instance_count == self.instance_count

    @property
    def instance_count(self) -> int:
        return sum([len(part.matrices) for part in self.parts])

    def join(self) -> mesh.Surface:
        """Return all parts, in their places, as one surface of triangles in the world, float64."""
        return mesh.join_surfaces(
            [
                part.surface.transform(matrix[:3, :3], matrix[:3, 3])
                for part in self.parts
                for matrix in part.matrices
            ]
        )


def attribute_to_source(result: verdict.Finding, source: str, whole: str) -> verdict.Finding:
    """Return a finding about a surface of the object `whole`, naming the surface's own object if it
    is different.
    """
    return result if source in ("", whole) else result.of_sources([source])


def to_si(matrices: ArrayLike, unit: float) -> Array:
    """Return (k, 4, 4) world matrices in SI units; `unit` is in meters per Blender unit."""
    scaled = np.array(matrices, np.float64)
    scaled[:, :3] *= unit
    return scaled


def float64_matrix(matrix) -> Array:
    """Return a `mathutils.Matrix` as a (4, 4) float64 array, to the bit."""
    return np.array([row[:] for row in matrix], np.float64)


def measure_reading(
    reading: Reading, body: Body, settings: Settings, transform: str = ""
) -> Measurement:
    """Return the results of measuring a body, or raise MeasureError if it has no mass or unknown
    moments.

    transform: the key of the object's transform in the fingerprint.
    """
    settings = replace(settings, varying=body.density_key)
    digested = [
        moments
        for moments in (body.volume, body.area, body.mass, body.length)
        if moments is not None
    ]
    geometry = b"".join([moments.raw.tobytes() for moments in digested])
    return measure_body(
        body,
        settings,
        findings=tuple(reading.findings),
        name=reading.name,
        type=reading.type,
        rotation=reading.rotation,
        location=reading.location * settings.unit,
        fingerprint=fingerprint(geometry, transform, settings.digest),
    )


def bare_reading(name: str, kind: str) -> Reading:
    """Return the frame of a file: the world's origin and axes; `kind` is its type in the
    records.
    """
    return Reading(name, kind, np.eye(4), np.eye(3), np.zeros(3))


@contextmanager
def name_subject(name: str) -> Iterator[None]:
    """Add the name of an object or file to errors without a subject."""
    try:
        yield
    except verdict.MeasureError as error:
        error.about(name)
        raise


@contextmanager
def about_file(name: str) -> Iterator[None]:
    """Add the file's name to errors; errors of the system become a ReadError."""
    try:
        with name_subject(name):
            yield
    except OSError as error:
        raise verdict.ReadError(
            files.FILE_UNREADABLE, subject=name, error=verdict.system_reason(error)
        ) from error
