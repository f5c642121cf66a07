# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""--write and --asset-metadata: saving into the opened .blend file, unless it has changed
meanwhile, or beside it.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import bpy

from ...blender import read, settings, write
from ...core.files import partial_file, replace
from ...core.measurement import Measurement
from ...core.verdict import FileError, Finding, finding
from ..findings import ASSETS_NOT_MEASURED, RESULTS_NOT_STORED
from ..supervisor.listing import COPY_SUFFIX
from .opening import reason

_PACKED = (b"\x28\xb5\x2f\xfd", b"\x1f\x8b")  # start of a .blend compressed with zstd or gzip
_METADATA = (
    "body_mass",
    "body_volume",
    "body_area",
    "body_center_of_mass",
    "body_principal_moments",
    "body_method",
)
_WITH_GEOMETRY = {"MESH", "CURVE", "SURFACE", "META", "FONT", "VOLUME"}


@dataclass
class Place:
    """A .blend file that is going to take results: its path without symbolic links, a digest of its
    content, and whether it is compressed.

    Its size and time may not change if two programs save within one tick of a file system's clock,
    hence the digest.
    """

    path: Path
    digest: bytes
    is_packed: bool

    @classmethod
    def of_file(cls, path: str) -> Place:
        """Return the present state of a file, before it is opened or right after.

        Raises FileError.
        """
        real = Path(os.path.realpath(path))
        try:
            with open(real, "rb") as file:
                is_packed = file.read(4).startswith(_PACKED)
                file.seek(0)
                return cls(real, hashlib.file_digest(file, "blake2b").digest(), is_packed)
        except OSError as error:
            values = {"file": real.name, "error": reason(error)}
            raise FileError(write.findings.FILE_NOT_WRITTEN, **values) from error

    def save(self) -> None:
        """Save the open scene, whole or not at all.

        FileError if this fails, or the file has changed meanwhile.
        """
        _save(self.path, self._check, compress=self.is_packed)

    def _check(self) -> None:
        # Replacing a file takes only the right to write in its folder.
        if not os.access(self.path, os.W_OK):
            raise OSError("it is gone, or read-only")
        if Place.of_file(str(self.path)) != self:
            cause = "another program has saved the file since it was opened. Measure it again"
            raise FileError(RESULTS_NOT_STORED, cause=cause)


def _save(target: Path, check: Callable[[], None] = lambda: None, **options: bool) -> None:
    """Save the open scene to a file, whole or not at all. check: raises an error if the file must
    stay as it is. options: of Blender's operator. Raises FileError.
    """
    try:
        with partial_file(target) as partial:
            bpy.ops.wm.save_as_mainfile(
                filepath=str(partial),
                copy=True,
                relative_remap=False,
                check_existing=False,
                **options,
            )
            check()
            replace(partial, target)
    except (RuntimeError, OSError) as error:
        values = {"file": target.name, "error": reason(error)}
        raise FileError(write.findings.FILE_NOT_WRITTEN, **values) from error


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
        target = Path(os.path.realpath(path))
        _save(target.with_name(target.stem + COPY_SUFFIX))
    return where == "file" and bool(stored), [*_without_numbers({*measured})]


def _store(data: bpy.types.AssetMetaData, measurement: Measurement) -> None:
    """Store a measurement as metadata, of an object in its own frame, of a collection in the
    scene's.
    """
    values = next(write.properties.values_of(measurement))
    for key in _METADATA:
        data[key] = values[key]


def _without_numbers(measured_roots: set[read.assembly.Root]) -> Iterator[Finding]:
    """Yield a finding if assets of the open file have geometry and were not measured."""
    data = bpy.data
    geometry = (*data.meshes, *data.curves, *data.metaballs, *data.volumes)
    roots = (
        data_block
        for data_block in (*data.objects, *data.collections)
        if data_block not in measured_roots and _has_geometry(data_block)
    )
    names = sorted(
        data_block.name
        for data_block in (*roots, *geometry)
        if data_block.asset_data is not None and data_block.library is None
    )
    if names:
        yield finding(ASSETS_NOT_MEASURED, names=names)


def _has_geometry(root: read.assembly.Root) -> bool:
    """Return whether an object or a collection shows geometry, its own or that of instances."""
    if isinstance(root, bpy.types.Collection):
        return any(map(_has_geometry, root.all_objects))
    return root.type in _WITH_GEOMETRY or settings.given.shows_collection(root)
