# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Kinds of files by their suffixes, and checks of a file before anything reads it."""

import zipfile
from pathlib import Path

from ...core import files, verdict
from ...core.scans import formats as scans
from ..supervisor.listing import BLEND, IMPORTED

STREAMED = (".stl", ".ply")  # formats that can be measured in blocks


def file_suffix(path: str) -> str:
    """Return the file's suffix in lower case."""
    return scans.scan_suffix(path) or Path(path.lower()).suffix


def check_file(path: str) -> None:
    """Raise FileError if a file cannot be opened, or is visibly cut short."""
    kind = file_suffix(path)
    if kind != BLEND and kind not in IMPORTED:
        raise verdict.FileError(
            files.FILE_TYPE, suffixes=" ".join((BLEND, *IMPORTED, *scans.SUFFIXES))
        )
    files.check_regular(path)
    try:
        with open(path, "rb") as file:
            if not file.read(1):
                raise verdict.FileError(files.FILE_UNREADABLE, error="it is empty")
    except OSError as error:
        reason = verdict.system_reason(error)
        raise verdict.FileError(files.FILE_UNREADABLE, error=reason) from error
    if kind == ".usdz":
        _check_usdz(Path(path))


def _check_usdz(path: Path) -> None:
    """Raise FileError if the checksum of a stored entry is wrong, which Blender's reader
    ignores.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            stored = [
                entry for entry in archive.infolist() if entry.compress_type == zipfile.ZIP_STORED
            ]
            if sum(entry.file_size for entry in stored) > path.stat().st_size:
                raise zipfile.BadZipFile("overlapping entries")
            for entry in stored:
                with archive.open(entry) as file:
                    while file.read(1 << 20):
                        pass
    except (
        zipfile.BadZipFile,
        NotImplementedError,
        RuntimeError,
        EOFError,
        OSError,
        ValueError,
    ) as error:
        raise files.damaged(
            path, files.DAMAGE_INCOMPLETE, kind="archive", error=str(error).rstrip(".")
        ) from error
