# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The half of the window harness that runs inside Blender and answers questions about it.

    blender ... --python inside.py -- MAILBOX

The other half (harness.py) puts `N.request`, Python source that sets `result`, into the folder
MAILBOX. A timer runs it between two events of the window, in the context of its first 3D View, and
answers with `N.reply`, JSON. While a file browser takes the window, that is the area. The timer
runs before the events that wait: a request is answered the second time that it is seen, after them.
"""

import json
import sys
import traceback
from pathlib import Path

import bpy

MAILBOX = Path(sys.argv[sys.argv.index("--") + 1])
PERIOD = 0.005  # seconds
seen: list[Path] = []


def answer(source: str) -> dict:
    window = bpy.context.window_manager.windows[0]
    # a file browser may take the whole window
    area = next(
        (area for area in window.screen.areas if area.type == "VIEW_3D"), window.screen.areas[0]
    )
    regions = {region.type: region for region in area.regions}
    names = {"bpy": bpy, "window": window, "area": area, "regions": regions, "result": None}
    try:
        with bpy.context.temp_override(window=window, area=area, region=regions["WINDOW"]):
            exec(source, names)
        return {"result": names["result"]}
    except Exception:
        return {"error": traceback.format_exc()}


def look() -> float:
    for request in seen:
        source = request.read_text(encoding="utf-8")
        request.unlink()
        partial = request.with_suffix(".partial")
        partial.write_text(json.dumps(answer(source)), encoding="utf-8")
        partial.rename(request.with_suffix(".reply"))
    seen[:] = sorted(MAILBOX.glob("*.request"))
    return PERIOD


bpy.app.timers.register(look, persistent=True)
