# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The surfaces of a file, by its suffix."""

from __future__ import annotations

from pathlib import Path

from ..scans.findings import FILE_MISSING, FILE_NOT_REGULAR, FILE_TYPE
from ..scans.limits import DEFAULT_LIMITS, Limits
from ..verdict.finding import FileError
from .iges import read_iges
from .obj import read_obj
from .surfaces import SurfaceBody, SurfaceFile

__all__ = ["SUFFIXES", "SurfaceBody", "SurfaceFile", "read_surfaces"]

_READERS = {".igs": read_iges, ".iges": read_iges, ".obj": read_obj}
SUFFIXES = tuple(_READERS)


def read_surfaces(path: str | Path, limits: Limits = DEFAULT_LIMITS) -> SurfaceFile:
    """Read the B-spline surfaces in a file, by its suffix: IGES, or .obj with ``surf``.

    Parameters
    ----------
    path : str or Path
    limits : Limits
        `text_bytes` counts.

    Returns
    -------
    SurfaceFile
        With surfaces that cannot be kept as findings.

    Raises
    ------
    FileError
        If the file is no such file, damaged, beyond a limit, or has no surface that can be kept.
    OSError
        If it cannot be opened.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from body_moments.core.cad import read_surfaces
    >>> text = "v 0 0 0\\nv 1 0 0\\nv 0 1 0\\nv 1 1 0\\ncstype bezier\\ndeg 1 1\\nsurf 0 1 0 1 1 2 3 4\\n"
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = Path(folder) / "square.obj"
    ...     _ = path.write_text(text + "parm u 0 1\\nparm v 0 1\\nend\\n")
    ...     len(read_surfaces(path).bodies[0].patches)
    1
    """
    path = Path(path)
    read = _READERS.get(path.suffix.lower())
    if read is None:
        raise FileError(FILE_TYPE, suffixes=" ".join(SUFFIXES))
    if not path.is_file():
        raise FileError(FILE_NOT_REGULAR if path.exists() else FILE_MISSING)
    limits.check(path, "text_bytes", path.stat().st_size)
    return read(path)
