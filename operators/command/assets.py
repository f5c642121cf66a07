# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""--asset-metadata: what was measured, in the metadata of the objects that are assets."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

import bpy

from ...core.measurement import Measurement
from ...core.verdict.finding import FileError
from ..supervisor.listing import COPY_SUFFIX
from ..write.whole_file import partial_file, replace
from .files import reason


def store(measured: Iterable[tuple[str, bpy.types.Object | None, Measurement]]) -> int:
    """Put numbers into the metadata of the assets among the objects, and return how many there are."""
    count = 0
    for _, obj, measurement in measured:
        if obj is None or obj.asset_data is None or obj.library is not None:
            continue
        data = obj.asset_data
        properties = measurement.in_object_frame()
        data["body_mass"] = float(properties.mass)
        data["body_volume"] = float(measurement.volume)
        data["body_area"] = float(measurement.area)
        data["body_center_of_mass"] = [float(value) for value in properties.center]
        data["body_principal_moments"] = [float(value) for value in properties.principal.moments]
        data["body_method"] = str(measurement.method)
        count += 1
    return count


def save_copy(path: str) -> None:
    """Save the open scene beside its file, as NAME.body_moments.blend. Raises FileError."""
    target = Path(os.path.realpath(path))
    target = target.with_name(target.stem + COPY_SUFFIX)
    try:
        with partial_file(target, True) as partial:
            bpy.ops.wm.save_as_mainfile(filepath=str(partial), copy=True, relative_remap=False, check_existing=False)
            replace(partial, target)
    except (RuntimeError, OSError) as error:
        raise FileError("file_not_saved", error=reason(error)) from error
