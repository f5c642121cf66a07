# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What stands between Blender and the core: operators, what reads objects, what writes results, the command line.

Modules are imported when the add-on is registered: the command line uses some of them without registering any.
"""

from contextlib import ExitStack
from importlib import import_module
from types import ModuleType

# Everything that is registered, in this order: modules with `register`, or with CLASSES only.
PARTS = (
    "write.translations",
    "settings.properties",
    "settings.assembly",
    "settings.reference",
    "settings.bone",
    "session.handlers",
    "session.updates",
    "session.density",
    "session.walls",
    "session.threshold",
    "session.live",
    "session.assembly",
    "session.rig",
    "session.outcome",
    *(
        "actions.setup." + name
        for name in (
            "presets",
            "remedies",
            "node_group",
            "rigid_bodies",
        )
    ),
    "actions.imports.import_scan",
    "actions.imports.import_surfaces",
    "actions.assembly.assembly",
    "actions.assembly.assembly_snap",
    "actions.assembly.bill",
    *(
        "actions.measure." + name
        for name in (
            "measure_selected",
            "live",
            "section",
            "select_faults",
            "clear",
            "copy",
            "listed",
            "moments",
            "library",
            "reference",
            "fourier",
        )
    ),
    *(
        "actions.snap." + name
        for name in (
            "origin",
            "principal_axes",
            "align",
            "empty",
            "cursor",
            "orientation",
            "rigid_body",
            "sculpt_balance",
        )
    ),
    *("actions.statics." + name for name in ("stability", "rest_on_ground", "balance_group")),
    *("actions.export." + name for name in ("robot", "copy_inertial", "primitive", "audit")),
    *("actions.rig." + name for name in ("measure", "physics", "center")),
    *("actions.shape." + name for name in ("match_pose", "find_similar", "find_symmetry")),
    "batch",
    "session.staleness",
)


def _parts() -> list[ModuleType]:
    return [import_module("." + name, __name__) for name in PARTS]


def register() -> None:
    """Register every part; where one fails, remove the others and let the error rise."""
    with ExitStack() as undo:
        for part in _parts():
            register_module(part)
            undo.callback(unregister_module, part)
        undo.pop_all()


def unregister() -> None:
    """Remove everything that `register` added, in reverse."""
    for part in reversed(_parts()):
        unregister_module(part)


def register_module(part: ModuleType) -> None:
    if hasattr(part, "register"):
        part.register()
        return
    import bpy

    with ExitStack() as undo:
        for cls in part.CLASSES:
            bpy.utils.register_class(cls)
            undo.callback(bpy.utils.unregister_class, cls)
        undo.pop_all()


def unregister_module(part: ModuleType) -> None:
    if hasattr(part, "unregister"):
        part.unregister()
        return
    import bpy

    for cls in reversed(part.CLASSES):
        bpy.utils.unregister_class(cls)
