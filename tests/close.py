# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Comparison to a relative tolerance and nothing else.

`pytest.approx` and `np.allclose` add an absolute tolerance that is not seen where they are called:
beside it a volume of 1e-18 m³ equals any other.
"""

import numpy as np


def close(found, truth, rel: float) -> bool:
    """Whether each number found is within `rel` times its true value; only zero meets zero, nothing
    NaN or infinity.

    found, truth: numbers or arrays that have one shape, or of which the truth is one number. rel:
    at least zero.
    """
    found, truth = np.asarray(found), np.asarray(truth)
    if truth.ndim and found.shape != truth.shape:
        return False
    with np.errstate(invalid="ignore"):
        near = np.abs(found - truth) <= rel * np.abs(truth)
    return bool((near & np.isfinite(truth)).all())
