# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Fourier transform of the active object on a grid: its values in a file, and slices of them in
an image.
"""

from __future__ import annotations

import os
from errno import ENOENT
from math import pi
from pathlib import Path

import bpy
from bpy.props import EnumProperty, FloatProperty, IntProperty, StringProperty
from bpy.types import Context, Event, Operator
from bpy_extras.io_utils import ExportHelper

from ... import core
from ...blender import bodies, session, settings, write
from .. import modal, selection

SUFFIX = ".npz"


class OBJECT_OT_body_moments_fourier(modal.ModalSteps, selection.OnSubject, Operator, ExportHelper):
    """Write the Fourier transform of the active object on a regular grid of frequencies to an .npz
    file, and show slices of its magnitude as an image
    """

    bl_label = "Fourier Transform"
    bl_options = {"REGISTER"}  # Blender would push its undo step before the image is there
    PROGRESS = "Fourier transform: {share:.0%}. Esc to cancel"
    CANCELED = "Fourier transform canceled; nothing was written"
    filename_ext = SUFFIX

    of: EnumProperty(
        name="Domain",
        description="What the transform integrates over",
        items=(
            ("BODY", "Body", "∫ exp(−i q·x) dV in m³. For shells, area times thickness"),
            ("AREA", "Surface", "∫ exp(−i q·x) dA over the faces, in m²"),
            ("FLAT", "Flat Shape", "∫ exp(−i q·x) dA of a flat shape in its own plane, in m²"),
        ),
    )
    frame: EnumProperty(
        name="Frame",
        description="Axes and origin of the frequencies",
        items=(
            ("WORLD", "World", "World axes and origin"),
            ("OBJECT", "Object", "Location and rotation of the object, with unit scale"),
        ),
    )
    count: IntProperty(
        name="Frequencies",
        default=64,
        min=2,
        max=256,
        description="Number of frequencies along each axis. 0 is in the middle, as after "
        "numpy.fft.fftshift",
    )
    largest: FloatProperty(
        name="Max Frequency",
        min=0.0,
        soft_max=1e6,
        precision=4,
        description="Highest frequency along each axis in rad/m. 0 uses that of a discrete Fourier "
        "transform of a box "
        "of twice the object's size",
    )
    filter_glob: StringProperty(default="*" + SUFFIX, options={"HIDDEN"})

    def invoke(self, context: Context, event: Event) -> set[str]:
        obj = session.selected.require_subject(context)
        if (
            not self.properties.is_property_set("of")
            and obj.body_moments.kind == "SOLID"
            and not min(obj.dimensions)
        ):
            self.of = "FLAT"
        name = bpy.path.clean_name(obj.name) + SUFFIX
        folder = os.path.dirname(self.filepath or bpy.data.filepath)
        self.filepath = os.path.join(folder, name)
        return ExportHelper.invoke(self, context, event)

    def draw(self, context: Context) -> None:
        column = selection.draw_properties(self, "of", "frame", "count", "largest")
        if not self.largest:
            column.label(text="0 rad/m: from the object's size", icon="INFO")

    def execute(self, context: Context) -> set[str]:
        if not self.filepath:
            return selection.refuse(self, selection.NO_FILE)
        in_window = context.window is not None and not bpy.app.background
        return selection.reporting(self, self._run, context, in_window)

    def _begin(self, context: Context) -> float:
        obj = session.selected.require_subject(context)
        depsgraph = context.evaluated_depsgraph_get()
        self._path = Path(bpy.path.abspath(bpy.path.ensure_ext(self.filepath, SUFFIX)))
        if not self._path.parent.is_dir():
            raise core.verdict.FileError(
                write.findings.FILE_NOT_WRITTEN, file=self._path.name, error=os.strerror(ENOENT)
            )
        self._dimension = 2 if self.of == "FLAT" else 3
        frame = self.frame.lower()
        self._work: bodies.fourier.ObjectTransform
        if self.of == "FLAT":
            self._work = bodies.flat_transform(obj, depsgraph, self._grid, frame=frame)
        else:
            options = settings.options.MeasureOptions(threads=bodies.THREADS)
            area = self.of == "AREA"
            self._work = bodies.object_transform(
                obj, depsgraph, options, self._grid, frame=frame, area=area
            )
        self._steps = self._work.steps()
        return 1.0

    def _grid(self, size: float) -> core.fourier.FrequencyGrid:
        """Return the grid for a body of this size in m.

        Without a given largest frequency, its step is that of a discrete transform of a box of
        twice the size: 2π / (2 size) = π / size.
        """
        largest = core.numerics.shortest_decimal(self.largest) or pi / size * (self.count // 2)
        return core.fourier.FrequencyGrid(self.count, largest, self._dimension)

    def _finish(self, context: Context) -> set[str]:
        transform, findings = self._work.result()
        try:
            write.spectrum.save(self._path, transform, self.frame.lower(), plane=self._work.arrays)
        except OSError as error:
            raise core.verdict.FileError(
                write.findings.FILE_NOT_WRITTEN,
                file=self._path.name,
                error=core.verdict.system_reason(error),
            ) from error
        name = "Fourier Transform of {:s}".format(self._work.name)
        image = write.spectrum.picture(name, transform.values, self.count, self._dimension)
        for area in context.screen.areas if context.screen else ():
            if area.type == "IMAGE_EDITOR":
                area.spaces.active.image = image
        bpy.ops.ed.undo_push(message=self.bl_label)
        summary = write.reports.phrase(
            "Wrote {count} frequencies to {file}; the image {image} shows slices of their "
            "magnitude",
            count=len(transform.q),
            file=self._path.name,
            image=image.name,
        )
        return selection.report(self, summary, *findings)
