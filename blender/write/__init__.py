# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writers: results as properties on objects, records for pipelines, reports for people."""

from typing import TYPE_CHECKING

from ...core.lazy import lazy_names

if TYPE_CHECKING:
    from . import properties as properties
    from . import section as section
    from . import spectrum as spectrum
    from . import text_report as text_report
    from . import thumbnail as thumbnail

__getattr__, __dir__, __all__ = lazy_names(__name__)
