# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces of an IGES file come by the file browser, are drawn and measured; what was refused is said."""

import numpy as np
import pytest

from tests.core.exact_splines import sphere, torus
from tests.core.iges_files import IgesFile, unrolled
from tests.window.conftest import open_window

OPERATOR = "object.body_moments_import_surfaces"


@pytest.fixture(scope="module")
def window(run_blender, cube_file, tmp_path_factory):
    with open_window(run_blender, cube_file, tmp_path_factory.mktemp("log")) as opened:
        yield opened


def test_surfaces_come_by_the_file_browser(window, tmp_path):
    file = IgesFile()
    file.surface(unrolled(torus()))
    lifted = np.eye(4)
    lifted[2, 3] = 1.5
    file.surface(unrolled(sphere()), matrix=file.transformation(lifted))
    file.add(120, [1, 3, 0.0, 1.0], label="VASE")
    path = file.write(tmp_path / "parts.igs")
    before = window.get("[len(bpy.data.objects), len(bpy.data.scenes), len(bpy.data.curves)]")
    window.ask(f"bpy.ops.{OPERATOR}('INVOKE_DEFAULT')")
    browsers = "[a for w in bpy.context.window_manager.windows for a in w.screen.areas if a.type == 'FILE_BROWSER']"
    window.wait(f"bool({browsers}) and {browsers}[0].spaces.active.params is not None")
    window.ask(
        f"space = {browsers}[0].spaces.active\n"
        f"space.params.directory = {str(tmp_path).encode()!r}\n"
        f"space.params.filename = {path.name!r}"
    )
    window.redraw()
    window.picture("import-surfaces-browser")
    window.ask(
        "w, a = [(w, a) for w in bpy.context.window_manager.windows for a in w.screen.areas "
        "if a.type == 'FILE_BROWSER'][0]\n"
        "with bpy.context.temp_override(window=w, area=a, region=a.regions[-1]):\n"
        "    bpy.ops.file.execute('INVOKE_DEFAULT')"
    )
    window.wait("'parts' in bpy.data.objects")
    window.wait(f"not {browsers}")
    assert window.get("[len(bpy.data.objects), len(bpy.data.scenes), len(bpy.data.curves)]") == [
        before[0] + 1,
        before[1],
        before[2] + 1,
    ]
    assert window.get("[o.name for o in bpy.context.selected_objects]") == ["parts"]
    assert window.get("bpy.context.mode") == "OBJECT"
    window.picture("import-surfaces-report")
    window.point_at_view()
    window.key("Escape")  # the report of what was refused
    window.ask("bpy.data.objects['Cube'].hide_set(True)\nbpy.ops.view3d.view_selected()")
    window.open_tab("Moments")
    window.press("object.body_moments_measure")
    window.wait("'body_volume' in bpy.data.objects['parts']")
    window.point_at_view()
    window.redraw()
    window.picture("import-surfaces")
    truth = 2.0 * np.pi**2 * 0.75 * 0.25**2 + 4.0 / 3.0 * np.pi
    assert window.get("bpy.data.objects['parts']['body_volume']") == pytest.approx(truth, rel=4e-7)
    assert window.get("bpy.data.objects['parts']['body_method']") == "NURBS exact"
    assert "Traceback" not in window.output()
