# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Apply measured frames and masses to objects: origins, axes, empties, a node group, the balance of
vertices.
"""
