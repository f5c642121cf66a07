# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Results of an open file: stored on objects or cached, one module per kind of result."""
