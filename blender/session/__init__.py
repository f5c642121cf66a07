# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is remembered while a file is open: staleness, results, live numbers, walls, moments."""
