# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measuring files: the run over objects, its children and its supervisor."""

from ...core.lazy import lazy_names

# These need Blender.
__getattr__, __dir__, __all__ = lazy_names(__name__)
