# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writers: results as properties on objects, records for pipelines, reports for people."""

from ...core.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
