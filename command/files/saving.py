# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""--write and --asset-metadata: saving into the opened .blend file, unless it has changed
meanwhile, or beside it.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import bpy

from ...blender import read, settings, write
from ...core.files import partial_file, replace
from ...core.measurement import Measurement
from ...core.verdict import FileError, Finding, finding
from ..findings import ASSETS_NOT_MEASURED, RESULTS_NOT_STORED
from ..supervisor.listing import COPY_SUFFIX
from .files import reason

_PACKED = (b"\x28\xb5\x2f\xfd", b"\x1f\x8b")  # start of a .blend compressed with zstd or gzip
_WITH_GEOMETRY = {"MESH", "CURVE", "SURFACE", "META", "FONT", "VOLUME"}


@dataclass
class Place:
    """A .blend file that is going to take results: its path without symbolic links, and a digest of
    its content.

    Its size and time may not change if two programs save within one tick of a file system's clock,
    hence the digest.
    """

    path: Path
    digest: bytes

    @classmethod
    def of_file(cls, path: str) -> Place:
        """Return the present state of a file, before it is opened or right after.

        Raises FileError.
        """
        real = Path(os.path.realpath(path))
        try:
            return cls(real, _digest(real))
        except OSError as error:
            raise FileError(
                write.findings.FILE_NOT_WRITTEN, file=real.name, error=reason(error)
            ) from error

    def save(self) -> None:
        """Save the open scene, whole or not at all.

        FileError if this fails, or the file has changed meanwhile.
        """
        try:
            # the folder alone decides whether a file can be replaced
            if not os.access(self.path, os.W_OK):
                raise OSError("it is gone, or read-only")
            with open(self.path, "rb") as file:
                packed = file.read(4).startswith(_PACKED)
            with partial_file(self.path) as partial:
                _save_as(partial, compress=packed)
                if _digest(self.path) != self.digest:
                    raise FileError(
                        RESULTS_NOT_STORED,
                        cause=(
                            "another program has saved the file since it was opened. "
                            "Measure it again"
                        ),
                    )
                replace(partial, self.path)
        except (RuntimeError, OSError) as error:
            raise FileError(
                write.findings.FILE_NOT_WRITTEN, file=self.path.name, error=reason(error)
            ) from error


def _digest(path: Path) -> bytes:
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "blake2b").digest()


def _save_as(path: Path, **options: bool) -> None:
    bpy.ops.wm.save_as_mainfile(
        filepath=str(path), copy=True, relative_remap=False, check_existing=False, **options
    )


def save_copy(path: str) -> None:
    """Save the open scene beside its file, as NAME.body_moments.blend. Raises FileError."""
    target = Path(os.path.realpath(path))
    target = target.with_name(target.stem + COPY_SUFFIX)
    try:
        with partial_file(target) as partial:
            _save_as(partial)
            replace(partial, target)
    except (RuntimeError, OSError) as error:
        raise FileError(
            write.findings.FILE_NOT_WRITTEN, file=target.name, error=reason(error)
        ) from error


def write_assets(
    measured: Mapping[read.assembly.Root, Measurement], path: str, where: str
) -> tuple[bool, list[Finding]]:
    """Store measurements in the metadata of the measured assets of the open file.

    Return whether the file itself is to be saved, and findings about assets without numbers. where:
    "copy" saves a copy beside the file. Raises FileError.
    """
    stored = [root for root in measured if root.asset_data is not None and root.library is None]
    for root in stored:
        _store(root.asset_data, measured[root])
    if where == "copy" and stored:
        save_copy(path)
    return where == "file" and bool(stored), [*_without_numbers({*measured})]


def _store(data: bpy.types.AssetMetaData, measurement: Measurement) -> None:
    """Store a measurement as metadata, of an object in its own frame, of a collection in the
    scene's.
    """
    properties = measurement.in_object_frame()
    data["body_mass"] = float(properties.mass)
    data["body_volume"] = float(measurement.volume)
    data["body_area"] = float(measurement.area)
    data["body_center_of_mass"] = [float(value) for value in properties.center]
    data["body_principal_moments"] = [float(value) for value in properties.principal.moments]
    data["body_method"] = str(measurement.method)


def _without_numbers(known: set[read.assembly.Root]) -> Iterator[Finding]:
    """Yield a finding if assets of the open file have geometry and were not measured."""
    geometry = (bpy.data.meshes, bpy.data.curves, bpy.data.metaballs, bpy.data.volumes)
    roots = [
        one
        for one in (*bpy.data.objects, *bpy.data.collections)
        if one not in known and _has_geometry(one)
    ]
    assets = (
        one
        for one in (*roots, *(data for group in geometry for data in group))
        if one.asset_data is not None
    )
    names = sorted(one.name for one in assets if one.library is None)
    if names:
        yield finding(ASSETS_NOT_MEASURED, names=names)


def _has_geometry(root: read.assembly.Root) -> bool:
    if isinstance(root, bpy.types.Collection):
        return any(map(_has_geometry, root.all_objects))
    return root.type in _WITH_GEOMETRY or settings.given.shows_collection(root)
