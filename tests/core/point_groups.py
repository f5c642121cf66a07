# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Point groups, and bodies that have them."""

import numpy as np

from tests.core import bodies


def about(axis, n):
    """The turn about an axis by an n-th of a whole one."""
    x, y, z = np.array(axis) / np.linalg.norm(axis)
    c, s = np.cos(2.0 * np.pi / n), np.sin(2.0 * np.pi / n)
    return (
        c * np.eye(3)
        + s * np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        + (1.0 - c) * np.outer([x, y, z], [x, y, z])
    )


def group_of(generators):
    """All products of some matrices."""
    found = [np.eye(3)]
    for one in found:  # the list grows meanwhile
        for other in generators:
            product = other @ one
            if min(np.abs(product - known).max() for known in found) > 1e-6:
                found.append(product)
    return np.array(found)


X, Y, Z, DIAGONAL = [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]

ACROSS, UPRIGHT, INVERSION = np.diag([1.0, 1.0, -1.0]), np.diag([1.0, -1.0, 1.0]), -np.eye(3)

GOLDEN = (1.0 + 5.0**0.5) / 2.0

POINT_GROUPS = {
    "C1": (1, []),
    "Cs": (2, [ACROSS]),
    "Ci": (2, [INVERSION]),
    "T": (12, [about(Z, 2), about(DIAGONAL, 3)]),
    "Th": (24, [about(Z, 2), about(DIAGONAL, 3), INVERSION]),
    "Td": (24, [about(Z, 4) @ ACROSS, about(DIAGONAL, 3)]),
    "O": (24, [about(Z, 4), about(DIAGONAL, 3)]),
    "Oh": (48, [about(Z, 4), about(DIAGONAL, 3), INVERSION]),
    "I": (60, [about([0, 1, GOLDEN], 5), about(DIAGONAL, 3)]),
    "Ih": (120, [about([0, 1, GOLDEN], 5), about(DIAGONAL, 3), INVERSION]),
}

for n in (2, 3, 4, 5, 6, 7, 10, 16):
    turn, both = about(Z, n), about(Z, 2 * n) @ ACROSS
    POINT_GROUPS |= {
        f"C{n}": (n, [turn]),
        f"C{n}v": (2 * n, [turn, UPRIGHT]),
        f"C{n}h": (2 * n, [turn, ACROSS]),
        f"S{2 * n}": (2 * n, [both]),
        f"D{n}": (2 * n, [turn, about(X, 2)]),
        f"D{n}h": (4 * n, [turn, about(X, 2), ACROSS]),
        f"D{n}d": (4 * n, [both, about(X, 2)]),
    }


def orbit(operations, corners):
    """The images of a tetrahedron under all operations, as one body."""
    faces = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    images = [
        (corners @ operation.T, faces if np.linalg.det(operation) > 0.0 else faces[:, ::-1])
        for operation in operations
    ]
    return bodies.joined(*images)


def orbit_of(name):
    corners = np.array([[0.0, 0.0, 0.0], [0.35, 0.02, 0.05], [0.05, 0.3, 0.02], [0.03, 0.08, 0.4]])
    return orbit(group_of(POINT_GROUPS[name][1]), corners + [1.1, 0.45, 0.7])
