# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel in the 3D Viewport's sidebar and the object's properties, its menus, and the overlay.

They draw stored or cached values and compute nothing.
"""

# The modules that are registered, in this order. A sub-panel comes after its panel; `places.ORDER`
# sorts them.
MODULES = (
    *(
        "menus",
        "material_menus",
        "body",
        "inertia",
        "density",
        "colliders",
        "statics",
        "floating",
        "selection",
        "assembly",
        "rig",
    ),
    *("advanced", "section", "cuts", "shape"),
    "overlay.draw",
)
