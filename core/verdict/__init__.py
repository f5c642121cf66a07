# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reports about a body beside its numbers: findings, refusals, method, health, tolerances.

Nothing that is offered here imports numpy: a process without it can read findings.
"""

from ..lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
