# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

from .axial_harmonics import MAX_AXIAL_ORDER as MAX_AXIAL_ORDER
from .axial_harmonics import AxialHarmonics as AxialHarmonics
from .axial_harmonics import axis_last as axis_last
from .axial_harmonics import turn_by_harmonics as turn_by_harmonics
from .canonical_frame import MAX_ORDER as MAX_ORDER
from .library import UNDECIDED_HANDEDNESS as UNDECIDED_HANDEDNESS
from .library import Entry as Entry
from .library import classify as classify
from .library import rank as rank
from .library import read_library as read_library
from .point_groups import PlacedTriangles as PlacedTriangles
from .registration import MAX_AXIS_ORDER as MAX_AXIS_ORDER
from .registration import MAX_FIT_RTOL as MAX_FIT_RTOL
from .registration import Residual as Residual
from .registration import RigidMatch as RigidMatch
from .registration import flat_symmetry as flat_symmetry
from .registration import holds_by_moments as holds_by_moments
from .registration import holds_by_outline as holds_by_outline
from .registration import match as match
from .registration import match_flat as match_flat
from .signatures import Likeness as Likeness
from .signatures import Signature as Signature
from .signatures import flat_signature as flat_signature
from .signatures import signature as signature
from .signatures import similarity as similarity
from .symmetries import UNDECIDED as UNDECIDED
from .symmetries import Symmetry as Symmetry
from .symmetries import symmetry as symmetry
from .unique_frames import equivalent_frames as equivalent_frames
from .unique_frames import nearest_frame as nearest_frame
from .unique_frames import unique_frame as unique_frame
from .zernike import MAX_DESCRIPTOR_ERROR as MAX_DESCRIPTOR_ERROR
from .zernike import MAX_ORDER_BY_MOMENTS as MAX_ORDER_BY_MOMENTS
from .zernike import disc_zernike as disc_zernike
from .zernike import zernike_quadrature as zernike_quadrature

__all__ = [
    "rank",
    "read_library",
    "signature",
    "similarity",
    "symmetry",
    "unique_frame",
]

def __getattr__(name: str) -> Any: ...
