# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Units of imported surface files."""

import bpy
import pytest

from tests.blender.surface_files import imported, written
from tests.core.exact_splines import sphere
from tests.core.iges_files import obj_text, unrolled

pytestmark = pytest.mark.usefixtures("scene")


@pytest.mark.parametrize("scale", [1.0, 0.5])
def test_unitless_surface_file_takes_unit_of_option(scale, tmp_path):
    bpy.context.scene.unit_settings.scale_length = scale
    written(tmp_path, unrolled(sphere()), unit=6)
    (tmp_path / "two.obj").write_text(obj_text([unrolled(sphere())], name="Ball"))
    for name, meters in (("body.igs", 1.0), ("two.obj", 0.25)):
        obj = imported(filepath=str(tmp_path / name), unit=0.25)
        assert max(obj.dimensions) == pytest.approx(2.0 * meters / scale, rel=0.05)
