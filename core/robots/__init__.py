# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Robots as plain data: links with their inertials and shapes, joints between them."""

from ..lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(
    __name__,
    FreeAxis="model",
    Inertial="model",
    Joint="model",
    Link="model",
    Pose="model",
    Robot="model",
    Shape="model",
)
