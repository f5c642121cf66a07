# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""--asset-metadata: measurements in the metadata of the objects and collections that are assets."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from pathlib import Path

import bpy

from ...blender.read.assembly import Root
from ...blender.settings.given import shows_collection
from ...blender.write.findings import FILE_NOT_WRITTEN
from ...core.files.whole_file import partial_file, replace
from ...core.measurement.measurement import Measurement
from ...core.verdict.finding import FileError, Finding, finding
from ..files.files import reason
from ..findings import ASSETS_NOT_MEASURED
from ..supervisor.listing import COPY_SUFFIX

_WITH_GEOMETRY = {"MESH", "CURVE", "SURFACE", "META", "FONT", "VOLUME"}


def write(measured: Mapping[Root, Measurement], path: str, where: str) -> tuple[bool, list[Finding]]:
    """Store measurements in the metadata of the measured assets of the open file.

    Return whether the file itself is to be saved, and findings about assets without numbers. where: "copy" saves a copy
    beside the file. Raises FileError.
    """
    stored = [root for root in measured if root.asset_data is not None and root.library is None]
    for root in stored:
        _store(root.asset_data, measured[root])
    if where == "copy" and stored:
        save_copy(path)
    return where == "file" and bool(stored), [*_without_numbers({*measured})]


def _store(data: bpy.types.AssetMetaData, measurement: Measurement) -> None:
    """Store a measurement as metadata, of an object in its own frame, of a collection in the scene's."""
    properties = measurement.in_object_frame()
    data["body_mass"] = float(properties.mass)
    data["body_volume"] = float(measurement.volume)
    data["body_area"] = float(measurement.area)
    data["body_center_of_mass"] = [float(value) for value in properties.center]
    data["body_principal_moments"] = [float(value) for value in properties.principal.moments]
    data["body_method"] = str(measurement.method)


def _without_numbers(known: set[Root]) -> Iterator[Finding]:
    """Yield a finding if assets of the open file have geometry and were not measured."""
    geometry = (bpy.data.meshes, bpy.data.curves, bpy.data.metaballs, bpy.data.volumes)
    roots = [one for one in (*bpy.data.objects, *bpy.data.collections) if one not in known and _has_geometry(one)]
    assets = (one for one in (*roots, *(data for group in geometry for data in group)) if one.asset_data is not None)
    names = sorted(one.name for one in assets if one.library is None)
    if names:
        yield finding(ASSETS_NOT_MEASURED, names=names)


def _has_geometry(root: Root) -> bool:
    if isinstance(root, bpy.types.Collection):
        return any(map(_has_geometry, root.all_objects))
    return root.type in _WITH_GEOMETRY or shows_collection(root)


def save_copy(path: str) -> None:
    """Save the open scene beside its file, as NAME.body_moments.blend. Raises FileError."""
    target = Path(os.path.realpath(path))
    target = target.with_name(target.stem + COPY_SUFFIX)
    try:
        with partial_file(target) as partial:
            bpy.ops.wm.save_as_mainfile(filepath=str(partial), copy=True, relative_remap=False, check_existing=False)
            replace(partial, target)
    except (RuntimeError, OSError) as error:
        raise FileError(FILE_NOT_WRITTEN, file=target.name, error=reason(error)) from error
