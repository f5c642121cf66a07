# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The bpy operators, one folder or module per subject, and `batch.py`, the published entry of the
command line.
"""

# The modules that are registered, in this order.
MODULES = (
    *("setup." + name for name in ("presets", "remedies", "rigid_bodies", "colliders")),
    *("imports", "assembly"),
    *(
        "measure." + name
        for name in ("measure_selected", "moments", "select_faults", "copy", "library", "fourier")
    ),
    *("snap.frames", "snap.balance"),
    *("statics", "floating", "cuts"),
    *("export." + name for name in ("robot", "audit")),
    "rig",
    "motion",
    *("shape." + name for name in ("match_pose", "find_similar", "find_symmetry", "link_copies")),
    "help",
    "batch",
    # is removed first: its last notes need the properties of all others
    ".blender.session.subscriptions",
)
