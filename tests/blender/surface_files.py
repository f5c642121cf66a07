# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of B-spline surfaces, imported."""

import bpy

from tests.core.iges_files import IgesFile


def written(tmp_path, *patches, **more):
    file = IgesFile(**more)
    for patch in patches:
        file.surface(patch)
    return file.write(tmp_path / "body.igs")


def imported(**arguments):
    assert bpy.ops.object.body_moments_import_surfaces(**arguments) == {"FINISHED"}
    return bpy.context.object
