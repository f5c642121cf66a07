# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's own exporters, over whose files the masses are written: what they are asked for and what may come of it."""

from types import SimpleNamespace

import pytest
from body_moments.operators.actions.export import robot

from tests.blender.findings import refused

pytestmark = pytest.mark.usefixtures("scene")
ANSWERS = {
    "finished": ({"FINISHED"}, True),
    "canceled": ({"CANCELLED"}, True),
    "no file": ({"FINISHED"}, False),
    "nothing": ({"CANCELLED"}, False),
}


@pytest.mark.parametrize("case", ANSWERS)
def test_an_exporter_has_finished_where_it_says_so_and_its_file_is_there(case, tmp_path, monkeypatch):
    answer, writes = ANSWERS[case]
    path, asked = tmp_path / "made.usdc", []

    def export(**options):
        asked.append(options)
        if writes:
            path.write_bytes(b"made")
        return answer

    monkeypatch.setattr(robot, "bpy", SimpleNamespace(ops=SimpleNamespace(wm=SimpleNamespace(usd_export=export))))
    exporter = SimpleNamespace(collection="Parts")
    if case == "finished":
        robot.GeometryExport._run_exporter(exporter, "wm.usd_export", path, {"only": True})
    else:
        with refused("robot_geometry_not_written", error="wm.usd_export"):
            robot.GeometryExport._run_exporter(exporter, "wm.usd_export", path, {"only": True})
    assert asked == [{"filepath": str(path), "collection": "Parts", "only": True}]


def test_a_blender_that_is_built_without_an_exporter_or_whose_exporter_fails_says_so(tmp_path, monkeypatch):
    def export(**_options):
        raise RuntimeError("Error: no\n   room")

    monkeypatch.setattr(robot, "bpy", SimpleNamespace(ops=SimpleNamespace(wm=SimpleNamespace(usd_export=export))))
    exporter = SimpleNamespace(collection="")
    with refused("robot_geometry_not_written", error="Error: no room"):
        robot.GeometryExport._run_exporter(exporter, "wm.usd_export", tmp_path / "a", {})
    with refused("robot_geometry_not_written"):
        robot.GeometryExport._run_exporter(exporter, "wm.none_export", tmp_path / "a", {})
