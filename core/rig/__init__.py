# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Skinned bodies cut into the pieces of their bones."""

from .cuts import BonePiece, bone_pieces, bones_of_caps
from .dominance import VertexWeights, dominant_bones

__all__ = ["BonePiece", "VertexWeights", "bone_pieces", "bones_of_caps", "dominant_bones"]
