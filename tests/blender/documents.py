# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Documents about a turned box."""

import numpy as np
from body_moments.core.robots.model import Inertial

TURN = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])


def of_box(mass, sides, center=(0.0, 0.0, 0.0), turn=TURN):
    moments = mass * (np.square(sides).sum() - np.square(sides)) / 12.0
    order = np.argsort(moments)
    axes = turn[:, order] * (1.0, 1.0, np.linalg.det(turn[:, order]))
    return Inertial(mass, np.array(center), turn @ np.diag(moments) @ turn.T, moments[order], axes)
