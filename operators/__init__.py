# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The bpy operators, one folder per subject, and `batch.py`, the published entry of the command line."""

# The modules that are registered, in this order.
MODULES = (
    *("setup." + name for name in ("presets", "remedies", "node_group", "rigid_bodies")),
    *("imports.import_scan", "imports.import_surfaces"),
    *("assembly.assembly", "assembly.assembly_snap", "assembly.bill"),
    *("measure." + name for name in ("measure_selected", "live", "section", "select_faults", "clear", "copy")),
    *("measure." + name for name in ("listed", "moments", "library", "reference", "fourier")),
    *("snap." + name for name in ("origin", "principal_axes", "align", "empty", "cursor", "orientation")),
    *("snap.rigid_body", "snap.sculpt_balance"),
    *("statics." + name for name in ("stability", "rest_on_ground", "balance_group")),
    *("export." + name for name in ("robot", "copy_inertial", "primitive", "audit")),
    *("rig." + name for name in ("measure", "physics", "center")),
    *("shape." + name for name in ("match_pose", "find_similar", "find_symmetry")),
    "batch",
    ".blender.session.subscriptions",  # is removed first: its last notes need the properties of all others
)
