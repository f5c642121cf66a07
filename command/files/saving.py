# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""--write: saving of results into the opened .blend file, unless another program has saved it meanwhile."""

from __future__ import annotations

import hashlib
import os
from dataclasses import dataclass
from pathlib import Path

import bpy

from ...blender.write.findings import FILE_NOT_WRITTEN
from ...core.files.whole_file import partial_file, replace
from ...core.verdict.finding import FileError
from ..findings import FILE_CHANGED_MEANWHILE
from .files import reason

_PACKED = (b"\x28\xb5\x2f\xfd", b"\x1f\x8b")  # start of a .blend compressed with zstd or gzip


@dataclass
class Place:
    """A .blend file that is going to take results: its path without symbolic links, and a digest of its content.

    Its size and time may not change if two programs save within one tick of a file system's clock, hence the digest.
    """

    path: Path
    digest: bytes

    @classmethod
    def of_file(cls, path: str) -> Place:
        """Return the present state of a file, before it is opened or right after. Raises FileError."""
        real = Path(os.path.realpath(path))
        try:
            return cls(real, _digest(real))
        except OSError as error:
            raise FileError(FILE_NOT_WRITTEN, file=real.name, error=reason(error)) from error

    def save(self) -> None:
        """Save the open scene, whole or not at all. FileError if this fails, or the file has changed meanwhile."""
        try:
            self._save()
        except (RuntimeError, OSError) as error:
            raise FileError(FILE_NOT_WRITTEN, file=self.path.name, error=reason(error)) from error

    def _save(self) -> None:
        if not os.access(self.path, os.W_OK):  # the folder alone decides whether a file can be replaced
            raise OSError("it is gone, or read-only")
        with open(self.path, "rb") as file:
            packed = file.read(4).startswith(_PACKED)
        with partial_file(self.path) as partial:
            bpy.ops.wm.save_as_mainfile(filepath=str(partial), copy=True, compress=packed, relative_remap=False)
            if _digest(self.path) != self.digest:
                raise FileError(FILE_CHANGED_MEANWHILE)
            replace(partial, self.path)


def _digest(path: Path) -> bytes:
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "blake2b").digest()
