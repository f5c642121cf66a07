# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The folders that a description's files may be read from, and the files that it names."""

from __future__ import annotations

import os
import re
import stat
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from ...files import FILE_MISSING, FILE_TOO_LARGE, FILE_UNREADABLE, NOT_REGULAR
from ...verdict import FileError, system_reason
from ..findings import MESH_MISSING, MESH_OUTSIDE

MAX_DESCRIPTION = 64 << 20  # bytes
# Schemes of one letter are drives.
_SCHEME = re.compile(r"([A-Za-z][A-Za-z0-9+.-]+):(?://)?(.*)", re.DOTALL)
PATHS = "ROS_PACKAGE_PATH"
MAX_DEPTH = 3  # Levels of folders below a root that are searched for a package.


@dataclass(frozen=True)
class Roots:
    """Folders that files may be read from. base: that of the description. anywhere: True if all
    folders are allowed.
    """

    folders: tuple[Path, ...]
    anywhere: bool = False
    base: Path | None = None

    @classmethod
    def for_file(cls, file: Path, more: Sequence[Path] = (), anywhere: bool = False) -> Roots:
        """Return the roots of a description: its package's folder or else that above its own,
        `more`, and ROS's.
        """
        folder = Path(os.path.realpath(file)).parent
        packages = (
            above for above in (folder, *folder.parents) if os.path.isfile(above / "package.xml")
        )
        paths = [
            path for path in os.environ.get(PATHS, "").split(os.pathsep) if os.path.isabs(path)
        ]
        added = [Path(os.path.realpath(path)) for path in (*more, *paths)]
        return cls((next(packages, folder.parent), *added), anywhere, folder)

    def at(self, base: Path) -> Roots:
        """Return the same roots for names in a file of another folder."""
        return replace(self, base=base)

    def find(self, name: str) -> Path:
        """Return the file that a description names; raise FileError if it is missing, not allowed,
        or on a network.
        """
        name = name.replace("\\", "/")
        match = _SCHEME.fullmatch(name)
        scheme, rest = (match[1].lower(), match[2]) if match else ("", name)
        if scheme not in ("", "package", "model", "file"):
            raise FileError(MESH_OUTSIDE, name=name)
        is_outside = False
        for path in self._candidates(scheme, rest):
            try:
                real = Path(os.path.realpath(path))
            except (OSError, ValueError):  # no name that the system knows
                continue
            # False if the system refuses the name, as one that is too long
            if not os.path.isfile(real):
                continue
            if self.anywhere or any(real.is_relative_to(folder) for folder in self.folders):
                return real
            is_outside = True
        raise FileError(MESH_OUTSIDE if is_outside else MESH_MISSING, name=name)

    def _candidates(self, scheme: str, rest: str) -> Iterator[Path]:
        """Yield possible paths.

        A package's name may be that of a root, of a folder in it, or of neither.
        """
        if scheme in ("package", "model"):
            rest = rest.lstrip("/")  # Other readers join it so with their folders.
            package, _, inside = rest.partition("/")
            for folder in self.folders:
                if folder.name == package or _package_name(folder) == package:
                    yield folder / inside
                yield folder / rest
                yield folder / inside
            for root in self.folders[1:]:
                yield from (folder / inside for folder in _folders_named(root, package))
            if self.base is not None:
                yield from (above.parent / rest for above in (self.base, *self.base.parents))
        elif os.path.isabs(rest):
            yield Path(rest)
        else:
            for folder in (self.base, *self.folders):
                if folder is not None:
                    yield folder / rest
            # Of a description that was copied elsewhere: below its package.
            yield from (folder / rest.lstrip("./") for folder in self.folders)


def _package_name(folder: Path) -> str:
    """Return the name that the package.xml of a folder states, "" if it has none."""
    try:
        with open(folder / "package.xml", encoding="utf-8", errors="replace") as file:
            match = re.search(r"<name>\s*([\w.-]+)\s*</name>", file.read(1 << 16))
    except (OSError, ValueError):
        return ""
    return match[1] if match else ""


def _folders_named(root: Path, name: str) -> Iterator[Path]:
    """Yield the folders with a name, a few levels below a root."""
    for folder, folders, _ in os.walk(root):
        if name in folders:
            yield Path(folder, name)
        if len(Path(folder).relative_to(root).parts) >= MAX_DEPTH:
            folders.clear()


def read_bytes(path: Path) -> bytes:
    """Return the bytes of a description. FileError if it is missing, unreadable or too large."""
    try:
        if not stat.S_ISREG(path.stat().st_mode):
            raise FileError(FILE_UNREADABLE, error=NOT_REGULAR)
        with open(path, "rb") as file:
            data = file.read(MAX_DESCRIPTION + 1)
    except FileNotFoundError as error:
        raise FileError(FILE_MISSING) from error
    except OSError as error:
        raise FileError(FILE_UNREADABLE, error=system_reason(error)) from error
    check_bytes(len(data))
    return data


def check_bytes(count: int) -> None:
    """Raise FileError if a description, with the files that it includes, has too many bytes."""
    if count > MAX_DESCRIPTION:
        raise FileError(FILE_TOO_LARGE, limit=MAX_DESCRIPTION, content="bytes")
