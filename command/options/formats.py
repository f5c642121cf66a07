# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The formats of `--format`: those of documents, and those of robots. Standard library only."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from ...core.measurement import documents
from ...core.robots.formats import FORMATS as ROBOT_FORMATS


def _to_robot(file_documents: Iterable[dict[str, Any]]) -> Iterator[str]:
    """Yield the robot description of each file, as written by the process that measured it."""
    return (one.get("robot", "") for one in file_documents)


# Functions from documents, which may be iterated twice, to pieces of text.
FORMATS = {**documents.FORMATS, **dict.fromkeys(ROBOT_FORMATS, _to_robot)}
