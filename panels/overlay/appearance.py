# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Colors and sizes of the overlay.

Each shape has a dark outline and a bright filling, so that it shows on every background. A verdict
has a color, from the palette of Okabe and Ito (2008) that all kinds of color vision tell apart, and
a form: the frame around the disc.
"""

import numpy as np

VERDICTS = ("exact", "repaired", "doubtful", "out of date", "sum")
COLORS = np.array(
    [
        (0.15, 0.85, 0.60, 1.0),  # exact: bluish green, circle
        (0.96, 0.80, 0.10, 1.0),  # repaired: yellow, square
        (0.95, 0.35, 0.10, 1.0),  # doubtful: vermilion, triangle
        (0.68, 0.72, 0.76, 1.0),  # out of date: gray, dashed circle
        (0.90, 0.50, 0.80, 1.0),  # sum of the selection: purple, diamond
    ],
    np.float32,
)
DARK = np.array((0.03, 0.03, 0.03, 1.0), np.float32)
WHITE = np.array((1.0, 1.0, 1.0, 1.0), np.float32)
FAULT = np.array((0.95, 0.15, 0.30, 1.0), np.float32)
SUPPORT = np.array((0.35, 0.70, 0.95, 1.0), np.float32)  # sky blue
WATER = np.array((0.25, 0.65, 1.0, 1.0), np.float32)
EDGE = np.array((0.96, 0.80, 0.10, 1.0), np.float32)  # stands, but near the edge of its support
TIPS = np.array((0.95, 0.35, 0.10, 1.0), np.float32)
PATH = np.array((0.35, 0.70, 0.95, 1.0), np.float32)

BEHIND = 0.5  # opacity of lines behind surfaces
GLASS = 0.0  # opacity of the white quadrants of discs behind surfaces
# pixels at a resolution scale of 1
DISC = 8.0
DOT = 2.5
FRAME = 12.0  # middle of the frame around the disc
STROKE = 2.0
OUTLINE = 1.5
MIN_NAMED = 8.0  # length of the longest axis from which on axes are named
LINE = 1.8
TEXT = 15.0
