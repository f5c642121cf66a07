# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

from . import cuts as cuts
from .channels import divide_frames as divide_frames
from .channels import handle_values as handle_values
from .channels import in_pieces as in_pieces
from .channels import rotation_values as rotation_values
from .channels import rotations as rotations
from .cuts import VertexWeights as VertexWeights
from .cuts import bone_pieces as bone_pieces
from .cuts import bones_of_caps as bones_of_caps
from .cuts import dominant_bones as dominant_bones
from .motion import ballistic_arc as ballistic_arc
from .motion import continuous as continuous
from .motion import find_flights as find_flights
from .parts import Parts as Parts

__all__ = [
    "cuts",
]

def __getattr__(name: str) -> Any: ...
