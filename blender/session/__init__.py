# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Session state while a file is open: staleness, results, live numbers, walls, moments."""
