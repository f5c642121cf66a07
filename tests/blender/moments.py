# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments computed by the operator."""

import bpy


def settings(**values):
    for name, value in values.items():
        setattr(bpy.context.scene.body_moments, name, value)


def compute(order=4):
    settings(moments_order=order)
    assert bpy.ops.object.body_moments_compute_moments() == {"FINISHED"}
