# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measuring files: the run over objects, its children and its supervisor."""

from typing import TYPE_CHECKING

from ...core.lazy import lazy_names

if TYPE_CHECKING:
    from . import robots as robots
    from . import scene as scene

# These need Blender.
__getattr__, __dir__, __all__ = lazy_names(__name__)
