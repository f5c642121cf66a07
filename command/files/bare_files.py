# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that Blender does not open: arrays and scans, and meshes that are larger than memory.

Each file is one body, named after the file.
"""

from __future__ import annotations

import os
from argparse import Namespace
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

from ...blender.bodies.files.array import ArrayOptions, measure_array
from ...blender.bodies.files.stream import measure_mesh_file
from ...blender.bodies.findings import SHAPE_OF_GRID
from ...blender.session.findings import DENSITY_DEFAULTED, NO_SUCH_NAME
from ...blender.settings.options import MeasureOptions
from ...core.measurement import record
from ...core.measurement.measurement import Measurement
from ...core.scans import formats as scans
from ...core.verdict.finding import MeasureError, QueryError, finding
from ..findings import FOURIER_OBJECT_COUNT, STREAM_OPTIONS
from ..measure.objects import failure
from ..options.file import OF_ARRAYS, body_findings, file_findings, unused, words
from .files import STREAMED, check_file, file_suffix

BYTES_PER_FACE = 500  # approximate memory for importing and measuring a mesh
BYTES_OF_FILE = {".stl": 50, ".ply": 19}  # Least bytes for each face: a file's size limits its faces.
_NOT_OF_STREAMS = ("wall", "polynomial", "density_from", "fourier")


@dataclass
class BareFile:
    """A file measured without Blender.

    options: those of the command line. objects, errors: entries of the document. measured: the name, None in place of
    an object, and the measurement. refusal: the error if there is no measurement.
    """

    path: str
    options: Namespace
    objects: list[dict[str, Any]] = field(default_factory=list)
    measured: list[tuple[str, None, Measurement]] = field(default_factory=list)
    errors: list[dict[str, Any]] = field(default_factory=list)
    refusal: MeasureError | None = None

    def measure(self, measure_options: MeasureOptions, progress: Callable[[str, str], Callable[[int], None]]) -> None:
        """Measure the file. progress: returns a counter of the samples or faces read from a file."""
        is_scan = bool(scans.scan_suffix(self.path))
        name = os.path.basename(self.path)[: -len(file_suffix(self.path))]
        names = [name] if self.options.object is None else self.options.object
        self.errors = [
            failure(other, finding(NO_SUCH_NAME, kind="object", name=other)) for other in names if other != name
        ]
        if is_scan and self.options.fourier:
            self.errors.append(failure(None, finding(FOURIER_OBJECT_COUNT, count=0)))
        if name not in names:
            return
        measure = self._measure_array if is_scan else self._measure_mesh
        count = progress(self.path, "samples" if is_scan else "faces")
        try:
            measurement = measure(name, measure_options, count)
        except MeasureError as refusal:
            self.refusal = refusal
            self.errors.append(failure(None, refusal.finding))
            return
        requested = [more for more in ("pose", "signature") if getattr(self.options, more)]
        shapeless = unused(requested) if not is_scan else [finding(SHAPE_OF_GRID)] if requested else []
        findings = (*measurement.findings, *body_findings(self.options, measurement), *shapeless)
        measurement = replace(measurement, findings=findings)
        surface = measurement.area_moments if self.options.surface_moments else None
        more = dict.fromkeys([*requested, *["thumbnail"] * bool(self.options.thumbnails)])
        order, frame, about = self.options.order, self.options.frame, self.options.about
        self.objects = [record.record(measurement, frame, order, surface, more, about)]
        self.measured = [(name, None, measurement)]

    def _measure_array(
        self, name: str, measure_options: MeasureOptions, progress: Callable[[int], None]
    ) -> Measurement:
        taken = {one: getattr(self.options, one) for one in (*OF_ARRAYS, "unit_scale", "limits", "threshold")}
        taken["positions"] = dict(self.options.positions or ())
        array = ArrayOptions(**{one: value for one, value in taken.items() if value is not None})
        return measure_array(self.path, name, array, measure_options, progress)

    def _measure_mesh(self, name: str, measure_options: MeasureOptions, progress: Callable[[int], None]) -> Measurement:
        check_file(self.path)
        options = self.options
        given = [one for one in _NOT_OF_STREAMS if getattr(options, one) not in (None, "thin", "value")]
        given += ["overlap"] * (options.overlap == "union") + ["kind"] * (options.kind == "wire")
        if given:
            raise QueryError(STREAM_OPTIONS, options=words(given))
        findings = [*file_findings(self.path, options)]
        if options.density is None and options.mass is None and options.material is None:
            findings.append(finding(DENSITY_DEFAULTED, density="1000 kg/m³"))
        wanted = replace(measure_options, unit_scale=options.unit_scale)
        return measure_mesh_file(self.path, name, wanted, tuple(findings), progress)


def is_bare(path: str, options: Namespace, memory: int | None) -> bool:
    """Return whether a file is measured without Blender. memory: bytes that measuring it may take, None for any."""
    if scans.scan_suffix(path):
        return True
    suffix = file_suffix(path)
    if suffix not in STREAMED or options.stream == "never":
        return False
    if options.stream == "always":
        return True
    try:
        size = os.path.getsize(path)
    except (OSError, ValueError):
        return False  # opening reports the error, as for any other file
    return memory is not None and size / BYTES_OF_FILE[suffix] * BYTES_PER_FACE > memory
