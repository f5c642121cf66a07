# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measure Library from the menu, by mouse: the window lives on, shows how far it is, and Esc ends it."""

import json
import os

import numpy as np

from tests.soak import commands

RUNNING = "[op.bl_idname for op in window.modal_operators if 'LIBRARY' in op.bl_idname.upper()]"
BROWSER = """
found = [(one, area) for one in bpy.context.window_manager.windows for area in one.screen.areas
         if area.type == "FILE_BROWSER"]
"""
PLACE = (
    BROWSER
    + """
one, area = found[0]
if area.spaces.active.params is not None:
    area.spaces.active.params.directory = {!r}.encode()
    buttons = next(region for region in area.regions if region.type == "EXECUTE")
    result = [one.x, one.y, buttons.x, buttons.y, buttons.width, buttons.height]
"""
)
COUNT = 3


def library(folder, slow):
    """Scans that take no time, and, where that is asked for, one that would take minutes."""
    for number in range(COUNT):
        np.save(folder / "{}.npy".format(number), np.full((3, 4, 5), number + 1, "u2"))
    if slow:
        path = folder / "z_2048x2048x2048_uint8.raw"
        path.touch()
        os.truncate(path, 1 << 33)


def start(window, folder):
    """Choose the entry of the menu, the folder, and the button of the file browser, which is a window of its own."""
    window.choose("VIEW3D_MT_body_moments", "object.body_moments_measure_library")
    window.wait("len(bpy.context.window_manager.windows) > 1")
    places = []
    assert commands.wait_until(lambda: places.append(window.ask(PLACE.format(str(folder)))) or places[-1], 240.0)
    x, y, left, bottom, width, height = places[-1]
    window.picture("library browser")
    window.click(x + left + 0.92 * width, y + bottom + 0.5 * height)  # the button to the right of Cancel
    window.wait("len(bpy.context.window_manager.windows) == 1")


def test_esc_keeps_measured_files_for_resuming(window, tmp_path):
    library(tmp_path, slow=True)
    start(window, tmp_path)
    journal = tmp_path / "body_moments.jsonl.journal"
    assert commands.wait_until(lambda: journal.exists() and journal.read_bytes().count(b"\n") == COUNT, 240.0)
    assert window.get(RUNNING)
    window.redraw()
    window.picture("library running")
    window.point_at_view()
    window.key("Escape")
    window.wait("not " + RUNNING)
    assert sorted(path.name for path in tmp_path.iterdir() if path.suffix not in (".npy", ".raw")) == [journal.name]


def test_left_alone_it_leaves_results_and_a_report(window, tmp_path):
    library(tmp_path, slow=False)
    start(window, tmp_path)
    assert commands.wait_until((tmp_path / "body_moments.html").exists, 240.0)
    window.wait("not " + RUNNING)
    lines = (tmp_path / "body_moments.jsonl").read_text(encoding="utf-8").splitlines()
    assert [json.loads(line)["objects"][0]["mass"] for line in lines] == [60.0 * (1 + one) for one in range(COUNT)]
    window.redraw()
    window.picture("library done")
