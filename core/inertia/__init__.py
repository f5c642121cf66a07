# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Mass, center, inertia and radii of gyration; the principal frame, made unique by higher moments."""

from .mass_properties import MassProperties, combine
from .principal_frames import (
    PrincipalFrame,
    equivalent_frames,
    nearest_frame,
    pose_matrix,
    principal_frame,
    zhang_chen_frame,
)
from .reference import Reference

__all__ = [
    "MassProperties",
    "PrincipalFrame",
    "Reference",
    "combine",
    "equivalent_frames",
    "nearest_frame",
    "pose_matrix",
    "principal_frame",
    "zhang_chen_frame",
]
