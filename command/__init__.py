# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line: its options, opening of files, measurements and output of results."""

from typing import TYPE_CHECKING

from ..core.lazy import lazy_names

if TYPE_CHECKING:
    from . import audit as audit
    from . import simplex as simplex
    from .results import gather as gather
    from .results import similar as similar

__getattr__, __dir__, __all__ = lazy_names(
    __name__, gather="results.gather", similar="results.similar"
)
