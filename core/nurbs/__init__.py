# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies that B-spline curves and patches bound (Soldea, Elber and Rivlin, sections 2 and 3)."""
