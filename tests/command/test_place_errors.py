# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bounds of the rounding of objects' places, against places in double precision."""

from math import comb

import numpy as np
import pytest

pytest.importorskip("bpy")
import bpy

from tests.blender import batch_files as files
from tests.blender.batch_files import measured

pytestmark = pytest.mark.usefixtures("registered")


@pytest.mark.parametrize("far", [0.0, 1234.5678, 12345678.3])
@pytest.mark.parametrize("seed", range(4))
def test_center_in_a_blend_is_within_its_bound(tmp_path, far, seed):
    files.empty_scene()
    rng = np.random.default_rng(seed)
    place = np.eye(4)
    parent = None
    for number in range(seed):
        angles, scale = rng.uniform(-180, 180, 3), rng.uniform(0.5, 2.0, 3) * [1, -1, 1]
        obj = bpy.data.objects.new(str(number), None)
        bpy.context.scene.collection.objects.link(obj)
        obj.location = move = rng.uniform(-1, 1, 3) * far
        obj.rotation_euler, obj.scale = np.radians(angles), scale
        obj.parent = parent
        own = np.eye(4)
        own[:3, :3], own[:3, 3] = files.turn(angles) * scale, move
        place, parent = place @ own, obj
    box = files.add_box(center=(0, 0, 0))
    box.location = move = rng.uniform(0.5, 1.0, 3) * (far or 1.0)
    box.parent = parent
    body = measured(files.save(tmp_path / "t.blend"))
    center = (place @ [*move, 1.0])[:3]
    bound = body["error_bound"]["input"]["center_of_mass"]
    assert np.linalg.norm(body["center_of_mass"] - center) <= bound
    assert bound <= 1e-5 * max(np.linalg.norm(center), far, 1.0)


def test_bounds_of_moments_contain_the_rounding_of_the_place(tmp_path):
    files.empty_scene()
    move = 1234.5678
    files.add_box(center=(0, 0, 0), size=(2, 2, 2)).location = (move, move / 3, 0.0)
    path = files.save(tmp_path / "t.blend")
    found = measured("--order", 3, path)["moments"]

    def moment(center, power):  # of a side of length 2
        even = [(0, 1), (2, 1 / 3)]
        return sum(comb(power, k) * center ** (power - k) * 2 * m for k, m in even if k <= power)

    for key, raw in found["volume"].items():
        p, q, r = map(int, key.split(","))
        right = moment(move, p) * moment(move / 3, q) * moment(0.0, r)
        assert abs(raw - right) <= found["input"]["volume"][key] + found["error"]["volume"][key]
    about = measured("--order", 3, "--about", "center", path)["moments"]
    assert about["input"]["volume"]["2,0,0"] < 1e-3 < found["input"]["volume"]["2,0,0"]


def test_place_does_not_count_in_the_frame_of_the_object(tmp_path):
    files.empty_scene()
    files.add_box(center=(0, 0, 0)).location.x = 12345678.0
    path = files.save(tmp_path / "t.blend")
    bounds = [
        measured("--frame", frame, path)["error_bound"]["input"]["center_of_mass"]
        for frame in ("object", "world")
    ]
    assert bounds[0] < 1e-5 and bounds[1] > 0.5
