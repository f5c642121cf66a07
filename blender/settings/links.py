# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Links to the manual and to the reporting of a bug, for the preferences and the panel.

They lead to the website that the manifest names; until it names one, to the manual that the build puts beside the
add-on's code. A checkout has neither, and so no links.
"""

from __future__ import annotations

import sys
from pathlib import Path

from bpy.types import UILayout

_PACKAGE = __name__.removesuffix(".blender.settings.links")
PAGES = {"Manual": ("index.html", "HELP"), "Report a Bug": ("faq.html#report-a-bug", "URL")}


def folder() -> Path:
    """Return the folder of the manual, which need not exist."""
    return Path(sys.modules[_PACKAGE].__path__[0]) / "manual"


def address(page: str) -> str:
    """Return the address of a page of the manual, or the website; "" if there is neither."""
    website = getattr(sys.modules[_PACKAGE], "bl_info", {}).get("doc_url", "")  # from the manifest
    return website or (folder().as_uri() + "/" + page if folder().is_dir() else "")


def draw_links(layout: UILayout, icons_only: bool = False) -> None:
    """Draw the buttons that open the links, if there is anything to open."""
    for name, (page, icon) in PAGES.items():
        url = address(page)
        if url:
            emboss = {"text": "", "emboss": False} if icons_only else {"text": name}
            layout.operator("wm.url_open", icon=icon, **emboss).url = url
