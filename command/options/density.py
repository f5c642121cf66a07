# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""--material, --polynomial, --density-from and --threshold: the panel's density settings, for every object.

They change the objects' settings in memory. Only --write saves these settings, together with the results.
"""

from __future__ import annotations

from argparse import Namespace

import bpy

from ...blender.session.findings import NO_SUCH_NAME
from ...core.density.materials import BY_NAME
from ...core.density.polynomial import parse_polynomial
from ...core.verdict.finding import QueryError
from ..parser import UsageError
from .option_types import split_source


def check(options: Namespace) -> None:
    """Raise UsageError if the material is unknown, or MeasureError if the polynomial cannot be read."""
    if options.material is not None and options.material not in BY_NAME:
        raise UsageError("There is no material “{}”. Known are {}".format(options.material, ", ".join(sorted(BY_NAME))))
    if options.polynomial is not None:
        parse_polynomial(options.polynomial)


def density_of(options: Namespace) -> float | None:
    """Return the density that was given as a number or as a material's name, else None."""
    return options.density if options.material is None else BY_NAME[options.material].density


def apply(obj: bpy.types.Object, options: Namespace) -> None:
    """Set the source of the object's density and the threshold of its grid, if given. Raises MeasureError."""
    settings = obj.body_moments
    if options.threshold is not None and obj.type == "VOLUME":
        settings.grid_as, settings.threshold = "THRESHOLD", options.threshold
    if options.polynomial is not None:
        settings.mass_from, settings.density_from = "DENSITY", "POLYNOMIAL"
        settings.density_polynomial = options.polynomial
    elif options.density_from is not None:
        source, name = split_source(options.density_from)
        settings.mass_from, settings.density_from = "DENSITY", source.upper()
        if source == "attribute":
            settings.density_attribute = name
        elif source == "volume":
            volume = bpy.context.scene.objects.get(name)
            if volume is None or volume.type != "VOLUME":
                raise QueryError(NO_SUCH_NAME, kind="Volume object", name=name)
            settings.density_volume = volume
