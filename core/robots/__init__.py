# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Robots as plain data: links with their inertials and shapes, joints between them; formats, audit and repair."""

from typing import TYPE_CHECKING

from ..lazy import lazy_names

if TYPE_CHECKING:
    from . import audit as audit
    from . import from_records as from_records
    from . import model as model
    from . import repair as repair

__getattr__, __dir__, __all__ = lazy_names(
    __name__,
    audit="audit",
    from_records="from_records",
    model="model",
    repair="repair",
)
