# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies that stand or fall."""

from itertools import product

import numpy as np

from tests.blender.objects import mesh_of

# of a box whose corners are counted with z fastest
QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


def box(sides, offset=(0.0, 0.0, 0.0), name="Box"):
    """A closed box as a mesh."""
    corners = np.array(list(product((0.0, 1.0), repeat=3))) * sides + offset
    return mesh_of(corners, QUADS, name)


def wedge():
    """A leaning prism, 2 high, whose center is beyond its base of length 1 by 1/4."""
    profile = ((0.0, 0.0), (1.0, 0.0), (2.5, 2.0), (1.5, 2.0))
    return mesh_of(
        [(x, y, z) for y in (0.0, 1.0) for x, z in profile],
        [(0, 1, 2, 3), (7, 6, 5, 4), *((i, 4 + i, 4 + (i + 1) % 4, (i + 1) % 4) for i in range(4))],
        "Wedge",
    )
