# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fixtures of the tests that need Blender."""

from tests.in_blender import reported  # noqa: F401
