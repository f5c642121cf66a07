# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Live numbers of scaled objects: area, volume, density and mass."""

import bpy
import pytest
from body_moments.blender.session.live import live

from tests.blender.objects import add, mesh_body, only
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")


class Clock:
    """Stands for the module `time`."""

    now = 100.0

    def thread_time(self):
        return self.now

    monotonic = thread_time


@pytest.fixture
def clock(monkeypatch):
    made = Clock()
    monkeypatch.setattr(live, "time", made)
    monkeypatch.setattr(live, "_budget", lambda: 1.0)
    return made


@pytest.mark.parametrize("given_mass", [False, True])
def test_what_is_scaled_has_its_area_and_its_density(given_mass, clock):
    obj = add(mesh_body(), location=(1, 2, 3))
    if given_mass:
        obj.body_moments.mass_from, obj.body_moments.mass = "MASS", 3.5
    only(obj)
    bpy.ops.object.body_moments_live()
    before = live.current_properties(obj, bpy.context.scene)
    obj.scale = (2, 2, 2)
    bpy.context.view_layer.update()
    after = live.current_properties(obj, bpy.context.scene)
    assert close(after.area, 4.0 * before.area, 1e-9) and close(after.volume, 8.0 * before.volume, 1e-9)
    assert close(after.density, before.density / (8.0 if given_mass else 1.0), 1e-9)
    assert close(after.body.mass, before.body.mass * (1.0 if given_mass else 8.0), 1e-9)
