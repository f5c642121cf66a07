# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

from .findings import AXES_FREE as AXES_FREE
from .findings import DIRECTIONS_OF_SHAPE as DIRECTIONS_OF_SHAPE
from .findings import MOMENTS_OVERFLOW as MOMENTS_OVERFLOW
from .findings import NEGATIVE_INERTIA as NEGATIVE_INERTIA
from .findings import NO_CERTAIN_VOLUME as NO_CERTAIN_VOLUME
from .mass_properties import MassProperties as MassProperties
from .mass_properties import affine_image as affine_image
from .mass_properties import are_physical as are_physical
from .mass_properties import combine as combine
from .mass_properties import has_certain_total as has_certain_total
from .plain_body import BOUND_KEYS as BOUND_KEYS
from .plain_body import COLUMNS as COLUMNS
from .plain_body import ENTRIES as ENTRIES
from .plain_body import EQUAL_AXES as EQUAL_AXES
from .plain_body import EQUAL_MOMENTS_RTOL as EQUAL_MOMENTS_RTOL
from .plain_body import ROWS as ROWS
from .plain_body import SYMMETRIES as SYMMETRIES
from .plain_body import TENSOR as TENSOR
from .plain_body import PlainBody as PlainBody
from .plain_body import Reference as Reference
from .plain_body import ReferredInertia as ReferredInertia
from .plain_body import add_bodies as add_bodies
from .plain_body import frame_about as frame_about
from .plain_body import principal_axes as principal_axes
from .plain_body import rotation_axes as rotation_axes
from .plain_body import tensor_rows as tensor_rows
from .principal_frames import CHOICES as CHOICES
from .principal_frames import PrincipalFrame as PrincipalFrame
from .principal_frames import frames_of_body as frames_of_body
from .principal_frames import pose_matrix as pose_matrix
from .principal_frames import principal_frame as principal_frame
from .principal_frames import zhang_chen_frame as zhang_chen_frame
from .third_moment_frames import HALF_TURN_SIGNS as HALF_TURN_SIGNS
from .third_moment_frames import NOISE_LEVEL as NOISE_LEVEL
from .third_moment_frames import SecondMomentAxes as SecondMomentAxes
from .third_moment_frames import complete_free_axes as complete_free_axes
from .third_moment_frames import nearest_frames as nearest_frames

__all__ = [
    "MassProperties",
    "combine",
    "pose_matrix",
    "principal_frame",
]

def __getattr__(name: str) -> Any: ...
