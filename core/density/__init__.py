# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies whose density varies: by part, by face, as a polynomial, as a grid or spline of samples."""
