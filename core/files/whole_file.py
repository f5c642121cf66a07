# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that are written whole or not at all."""

import os
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO


@contextmanager
def whole_file(path: Path, check: Callable[[Path], None] | None = None) -> Iterator[BinaryIO]:
    """Yield an open file that replaces `path` once the block is complete, and is removed if it
    fails.

    A pipe or a device is written to directly. check: raises FileExistsError if `path` must not be
    replaced. It is called just before the replacement, because the file may have appeared
    meanwhile. Raises OSError.
    """
    if path.exists() and not path.is_file():
        with open(path, "wb") as file:
            yield file
        return
    path = Path(os.path.realpath(path))
    with partial_file(path) as partial:
        with open(partial, "wb") as file:
            yield file
        if check is not None:
            check(path)
        replace(partial, path)


@contextmanager
def partial_file(path: Path) -> Iterator[Path]:
    """Yield the path of a hidden file beside `path` for incomplete data; remove that file when the
    block ends.
    """
    partial = hidden_path(path, "{}.partial".format(os.getpid()))
    try:
        yield partial
    finally:
        partial.unlink(missing_ok=True)
        # Blender writes to this name while it saves.
        Path("{}@".format(partial)).unlink(missing_ok=True)


def hidden_path(path: Path, ending: str) -> Path:
    """Return the path of a hidden file in the same folder, named after `path`."""
    return path.with_name(".{}.{}".format(path.name, ending))


def replace(partial: Path, path: Path) -> None:
    """Flush a complete file to the disk, copy the mode of `path` to it, and replace `path` by it.

    Raises OSError.
    """
    with open(partial, "rb+") as file:
        os.fsync(file.fileno())
    with suppress(FileNotFoundError):
        shutil.copymode(path, partial)
    os.replace(partial, path)
