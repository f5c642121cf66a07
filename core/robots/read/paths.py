# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Paths of the files that a description names, never outside of the allowed folders."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from ...verdict.finding import FileError
from ..findings import MESH_MISSING, MESH_ON_NETWORK

_SCHEME = re.compile(r"([A-Za-z][A-Za-z0-9+.-]+):(?://)?(.*)", re.DOTALL)  # Schemes of one letter are drives.
MAX_LEVELS = 4  # Folders, from the description's up, that are searched for a package.


@dataclass(frozen=True)
class Roots:
    """Folders that files may be read from. anywhere: True if all folders are allowed."""

    folders: tuple[Path, ...]
    anywhere: bool = False

    @classmethod
    def for_file(cls, file: Path, more: Sequence[Path] = (), anywhere: bool = False) -> Roots:
        """Return the roots of a description: its own folder, its package's folder, and `more`."""
        folder = Path(os.path.realpath(file)).parent
        folders = [folder]
        for above in [folder, *folder.parents][:MAX_LEVELS]:
            if os.path.isfile(above / "package.xml"):
                folders.append(above)
                break
        return cls((*folders, *(Path(os.path.realpath(path)) for path in more)), anywhere)

    def find(self, name: str) -> Path:
        """Return the file that a description names; raise FileError if it is missing, not allowed, or on a network."""
        name = name.replace("\\", "/")
        match = _SCHEME.fullmatch(name)
        scheme, rest = (match[1].lower(), match[2]) if match else ("", name)
        if scheme not in ("", "package", "model", "file"):
            raise FileError(MESH_ON_NETWORK, name=name)
        for path in self._candidates(scheme, rest):
            try:
                real = Path(os.path.realpath(path))
            except (OSError, ValueError):  # no name that the system knows
                continue
            is_allowed = self.anywhere or any(real.is_relative_to(folder) for folder in self.folders)
            if is_allowed and os.path.isfile(real):  # False if the system refuses the name, as one that is too long
                return real
        raise FileError(MESH_MISSING, name=name)

    def _candidates(self, scheme: str, rest: str) -> Iterator[Path]:
        """Yield possible paths. A package's name may be that of a root, of a folder in it, or of neither."""
        if scheme in ("package", "model"):
            package, _, inside = rest.partition("/")
            for folder in self.folders:
                if folder.name == package:
                    yield folder / inside
                yield folder / rest
                yield folder / inside
        elif os.path.isabs(rest):
            yield Path(rest)
        else:
            for folder in self.folders:
                yield folder / rest
