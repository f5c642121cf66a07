# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How much a description or a mesh may ask for."""

MAX_DESCRIPTION = 64 << 20  # bytes
MAX_MESH = 1 << 30  # bytes
MAX_ELEMENTS = 1_000_000
MAX_DEPTH = 200
MAX_LINKS = 100_000
MAX_TRIANGLES = 50_000_000
