# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The highest order of moments that is offered; a setting of the interface reads it without numpy."""

MAX_ORDER = 30  # 5456 moments; the core knows no limit, but beyond it double precision says little
