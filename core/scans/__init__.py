# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of samples, and the samples in them: NRRD, NIfTI, numpy's formats."""

from ..lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
