# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""German. Menus of Blender are named as Blender's own German does."""

from . import (
    densities,
    editing,
    labels,
    labels_of_settings,
    meshes,
    objects,
    reports,
    robots,
    scans,
    surfaces,
    tooltips,
    tooltips_of_settings,
)

TEXTS = labels.TEXTS | labels_of_settings.TEXTS | tooltips.TEXTS | tooltips_of_settings.TEXTS | robots.TEXTS
MESSAGES = (
    meshes.MESSAGES
    | objects.MESSAGES
    | densities.MESSAGES
    | scans.MESSAGES
    | editing.MESSAGES
    | reports.MESSAGES
    | robots.MESSAGES
    | surfaces.MESSAGES
)
