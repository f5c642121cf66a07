# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line: what it accepts, how a file is opened, what is measured in it, and where the
result goes.
"""
