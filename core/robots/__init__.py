# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Robots as plain data: links with their inertials and shapes, joints between them."""

from .model import FreeAxis, Inertial, Joint, Link, Pose, Robot, Shape

__all__ = ["FreeAxis", "Inertial", "Joint", "Link", "Pose", "Robot", "Shape"]
