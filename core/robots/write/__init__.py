# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Robots as text: one module a format, each from `core/robots/model.py:Robot` alone."""

from typing import TYPE_CHECKING

from ...lazy import lazy_names

if TYPE_CHECKING:
    from . import audit_report as audit_report
    from . import gltf as gltf
    from . import shapes as shapes
    from . import texts as texts
    from . import usd as usd

__getattr__, __dir__, __all__ = lazy_names(
    __name__,
    audit_report="audit_report",
    gltf="gltf",
    shapes="shapes",
    texts="texts",
    usd="usd",
)
