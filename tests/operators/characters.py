# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A rigged character, measured."""

import bpy
from body_moments.blender.bodies.rig import measure_rig

from tests.blender.characters import PARENTS, armature_of, skin_of
from tests.blender.objects import only
from tests.core import characters as made


def character(shape=None, density=1000.0):
    shape = shape or made.box_skeleton()
    armature = armature_of(shape, parents=PARENTS if shape.names == made.NAMES else None)
    skin = skin_of(shape, armature, density=density)
    only(armature)
    return armature, skin


def measured(armature):
    return measure_rig(bpy.context, armature)
