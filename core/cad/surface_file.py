# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reader of the surfaces of a file, chosen by its suffix."""

from __future__ import annotations

from pathlib import Path

from ..scans.findings import FILE_MISSING, FILE_NOT_REGULAR, FILE_TYPE
from ..scans.limits import DEFAULT_LIMITS, Limits
from ..verdict.finding import FileError
from .iges import read_iges
from .obj import read_obj
from .surfaces import SurfaceFile

_READERS = {".igs": read_iges, ".iges": read_iges, ".obj": read_obj}
SUFFIXES = tuple(_READERS)


def read_surfaces(path: str | Path, limits: Limits = DEFAULT_LIMITS, for_blender: bool = True) -> SurfaceFile:
    """Return the B-spline surfaces of an IGES or .obj file of up to `limits.text_bytes`. Raise FileError or OSError.

    for_blender: only those that Blender's surfaces can be.
    """
    path = Path(path)
    read = _READERS.get(path.suffix.lower())
    if read is None:
        raise FileError(FILE_TYPE, suffixes=" ".join(SUFFIXES))
    if not path.is_file():
        raise FileError(FILE_NOT_REGULAR if path.exists() else FILE_MISSING)
    limits.check(path, "text_bytes", path.stat().st_size)
    return read(path, for_blender)
