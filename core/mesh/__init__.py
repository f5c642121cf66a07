# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangle and quad surfaces: arrays, edges, welding, planarity, boxes, bounding-volume hierarchy."""
