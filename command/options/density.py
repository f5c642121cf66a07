# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""--material and --polynomial: the density, for every object."""

from __future__ import annotations

from argparse import Namespace

from ...core.density.materials import BY_NAME
from ...core.density.polynomial import parse_polynomial
from ..parser import UsageError


def check(options: Namespace) -> None:
    """Raise UsageError if the material is unknown, or MeasureError if the polynomial cannot be read."""
    if options.material is not None and options.material not in BY_NAME:
        raise UsageError("There is no material “{}”. Known are {}".format(options.material, ", ".join(sorted(BY_NAME))))
    if options.polynomial is not None:
        parse_polynomial(options.polynomial)


def density_of(options: Namespace) -> float | None:
    """Return the density that was given as a number or as a material's name, else None."""
    return options.density if options.material is None else BY_NAME[options.material].density
