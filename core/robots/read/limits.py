# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Limits of the resources for a description or a mesh."""

MAX_DESCRIPTION = 64 << 20  # bytes
MAX_MESH = 1 << 30  # bytes
MAX_ELEMENTS = 1_000_000
MAX_DEPTH = 200
MAX_LINKS = 100_000
MAX_TRIANGLES = 50_000_000
