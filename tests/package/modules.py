# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The modules of the add-on."""

from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent

# Each wing may import those before it and itself.
WINGS = ("core", "blender", "command", "operators", "panels")

# Each package of a wing may import those of the rows above its own and itself; those of one row do
# not know each other, but for those of one row of the core.
ORDER = {
    "core": (
        ("lazy",),
        ("numerics", "verdict"),
        ("files",),
        ("moments",),
        ("mesh", "inertia", "papers"),
        ("polyhedron", "shape", "scans"),
        ("solid", "flat", "fourier", "rig", "streams"),
        ("density", "nurbs", "wall"),
        ("statics", "cuts", "cad"),
        ("measurement",),
        ("bodies",),
        ("floating",),
        ("robots",),
        ("colliders",),
    ),
    "blender": (
        ("registration", "scale"),
        ("settings", "write"),
        ("read",),
        ("bodies",),
        ("scene",),
        ("session",),
    ),
}


def shipped() -> dict[tuple[str, ...], Path]:
    files = [ROOT / "__init__.py"]
    for part in WINGS:
        files += (ROOT / part).rglob("*.py")
    return {path.relative_to(ROOT).with_suffix("").parts: path for path in files}


MODULES = shipped()
