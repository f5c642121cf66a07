# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender in: evaluated objects as arrays, with their places and a finding for each decision."""
