# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that are measured without an object in Blender: scans, and streamed meshes."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from ..streams.findings import FILE_UNREADABLE
from ..verdict.finding import MeasureError, ReadError, system_reason
from .reading import Reading


def bare_reading(name: str, kind: str) -> Reading:
    """Return the frame of a file: the world's origin and axes; `kind` is its type in the records."""
    return Reading(name, kind, np.eye(4), np.eye(3), np.zeros(3))


@contextmanager
def about_file(name: str) -> Iterator[None]:
    """Add the file's name to errors; errors of the system become a ReadError."""
    try:
        yield
    except MeasureError as error:
        error.about(name)
        raise
    except OSError as error:
        raise ReadError(FILE_UNREADABLE, subject=name, error=system_reason(error)) from error
