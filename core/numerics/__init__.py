# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What every subject computes with: vectors, exact sums, rotations, quadrature, splines, graphs, segments."""
