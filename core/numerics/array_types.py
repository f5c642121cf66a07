# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Short names of the types of arrays that stand everywhere."""

from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

Array: TypeAlias = NDArray[np.float64]
Mask: TypeAlias = NDArray[np.bool_]
Index: TypeAlias = NDArray[np.intp]
Int64: TypeAlias = NDArray[np.int64]
Integers: TypeAlias = NDArray[np.integer]
Floats: TypeAlias = NDArray[np.floating]
Complex: TypeAlias = NDArray[np.complex128]

__all__ = [
    "Array",
    "ArrayLike",
    "Complex",
    "DTypeLike",
    "Floats",
    "Index",
    "Int64",
    "Integers",
    "Mask",
    "NDArray",
]
