# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The declared code of a stored finding, found by its name."""

from functools import cache
from importlib import import_module

from .finding_types import Code

ROOT = __name__.removesuffix(".core.verdict.catalog")
# The packages that declare findings, each in a module `findings` that imports `core.verdict` alone.
PACKAGES = (
    "blender.bodies",
    "blender.read",
    "blender.scene",
    "blender.session",
    "blender.settings",
    "blender.write",
    "command",
    "core.bodies",
    "core.cad",
    "core.colliders",
    "core.cuts",
    "core.density",
    "core.files",
    "core.floating",
    "core.flat",
    "core.fourier",
    "core.inertia",
    "core.measurement",
    "core.mesh",
    "core.moments",
    "core.nurbs",
    "core.polyhedron",
    "core.robots",
    "core.scans",
    "core.shape",
    "core.solid",
    "core.statics",
    "core.streams",
    "core.verdict",
    "core.wall",
    "operators",
)


@cache
def declared(code: str) -> Code:
    """Return the declaration of a code.

    KeyError if no package declares it: it may be of another version.
    """
    if isinstance(code, Code):
        return code
    for package in PACKAGES:
        module = import_module(".".join((ROOT, package, "findings")))
        value = getattr(module, str(code).upper(), None)
        if isinstance(value, Code):
            return value
    raise KeyError(code)
