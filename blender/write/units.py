# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""SI numbers in the scene's units, with their units, digits and grouping.

Blender's own formatter has no density and no inertia, and shows a microgram as "0 kg". Areas,
volumes and inertias follow the scene's length and mass unit; the numbers of a column share an
adaptive unit and their decimals.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite
from typing import NamedTuple

from ...core.density import DENSITY_UNITS, FOOT, POUND, density_unit
from ...core.numerics import shortest_decimal

LENGTHS = {
    "METRIC": {
        "KILOMETERS": (1e3, "km"),
        "METERS": (1.0, "m"),
        "CENTIMETERS": (1e-2, "cm"),
        "MILLIMETERS": (1e-3, "mm"),
        "MICROMETERS": (1e-6, "µm"),
    },
    "IMPERIAL": {
        "MILES": (5280.0 * FOOT, "mi"),
        "FEET": (FOOT, "ft"),
        "INCHES": (FOOT / 12.0, "in"),
        "THOU": (FOOT / 12000.0, "thou"),
    },
}
MASSES = {
    "METRIC": {
        "TONNES": (1e3, "t"),
        "KILOGRAMS": (1.0, "kg"),
        "GRAMS": (1e-3, "g"),
        "MILLIGRAMS": (1e-6, "mg"),
    },
    "IMPERIAL": {
        "TONNES": (2000.0 * POUND, "ton"),
        "CENTUM_WEIGHTS": (100.0 * POUND, "cwt"),
        "STONES": (14.0 * POUND, "st"),
        "POUNDS": (POUND, "lb"),
        "OUNCES": (POUND / 16.0, "oz"),
    },
}
BASES = {"METRIC": ("METERS", "KILOGRAMS"), "IMPERIAL": ("FEET", "POUNDS")}
# Choices of an adaptive unit. Hundredweights and stones are for people who ask for them.
ADAPTIVE_MASSES = {
    "METRIC": ("TONNES", "KILOGRAMS", "GRAMS", "MILLIGRAMS"),
    "IMPERIAL": ("TONNES", "POUNDS", "OUNCES"),
}
ADAPTIVE_INERTIAS = {
    "METRIC": ((1.0, "kg·m²"), (1e-4, "kg·cm²"), (1e-9, "g·mm²")),
    "IMPERIAL": ((POUND * FOOT**2, "lb·ft²"), (POUND * (FOOT / 12.0) ** 2, "lb·in²")),
}
POWERS = {"length": ("", 1), "area": ("²", 2), "volume": ("³", 3), "area_moment": ("⁴", 4)}
SI_UNITS = {
    "length": "m",
    "area": "m²",
    "volume": "m³",
    "mass": "kg",
    "density": "kg/m³",
    "inertia": "kg·m²",
    "area_moment": "m⁴",
}
DIGITS = 6
SMALL_LENGTHS = ("CENTIMETERS", "MILLIMETERS", "MICROMETERS")  # beside these, masses are in grams
HEAVY = 1e4  # kg: from here on, masses are in tonnes
GROUPS = {"SPACE": "\u2009", "COMMA": ",", "NONE": ""}  # separators of groups of three digits
MIN_GROUPED = 5  # integers of fewer digits are read at a glance
# beyond these, powers of ten are shown
MIN_EXPONENT = -5
MAX_EXPONENT = 10
# digits of reports in SI units: float32 coordinates carry as many
REPORT_DIGITS = 7
# shown as 0, relative to the largest component: float32 matrices miss right angles by as much
ZERO_DISPLAY_RTOL = 2.5e-7
INDENT, REPORT_WIDTH = "  ", 22


class Units(NamedTuple):
    """A scene's unit settings.

    With system "NONE", lengths, areas and volumes are in the scene's own units, without a name;
    quantities with mass are SI, with its name.
    """

    system: str
    length: str
    mass: str
    scale: float
    density: str = "AUTO"
    digits: int = DIGITS
    grouping: str = "SPACE"

    @classmethod
    def from_settings(cls, settings) -> Units:
        """Return the units of a scene's `unit_settings`, and the number format of that scene."""
        units = (
            settings.system,
            settings.length_unit,
            settings.mass_unit,
            shortest_decimal(settings.scale_length),
        )
        scene_settings = getattr(getattr(settings, "id_data", None), "body_moments", None)
        if scene_settings is None:
            return cls(*units)
        return cls(
            *units,
            scene_settings.density_unit,
            scene_settings.digits,
            scene_settings.digit_grouping,
        )

    def text(self, quantity: str, value: float) -> str:
        """Return one SI value as text: "1.5 kg", "12.3457 cm²"; a density in g/cm³ too where grams
        are shown.
        """
        text = self.texts(quantity, (value,))[0]
        if quantity == "density" and self.shows_grams and text.endswith(SI_UNITS["density"]):
            text += " ({:s} g/cm³)".format(number(1e-3 * value, self.digits, self.grouping))
        return text

    def texts(self, quantity: str, values: Sequence[float], size: float = 0.0) -> list[str]:
        """Return SI values of one quantity as a column of texts, in one unit and with equally many
        decimals.

        The largest value decides the unit. size: of the body that they belong to; rounding beside
        it is shown as 0.
        """
        largest = max((abs(value) for value in values if isfinite(value)), default=0.0)
        # Beside the largest value, the rest of a sum that cancels is noise, and beside the size,
        # rounding in float32: 1e-17 kg·m² is shown as 0.
        noise = max(1e-12 * largest, 1e-7 * size)
        factor, name = self.unit(quantity, 0.0 if largest < noise else largest)
        scaled = [0.0 if abs(value) < noise else value / factor for value in values]
        texts = column(scaled, self.digits, self.grouping)
        return ["{:s} {:s}".format(text, name).rstrip() for text in texts]

    def bound(self, quantity: str, bound: float, beside: float) -> str:
        """Return an SI error bound, rounded up to two digits, in the unit of its value: "± 4.5e-15
        m³".
        """
        factor, name = self.unit(quantity, abs(beside))
        return "± {:s} {:s}".format(
            number(rounded_up(bound / factor), 2, self.grouping), name
        ).rstrip()

    def unit(self, quantity: str, value: float) -> tuple[float, str]:
        """Return (SI value of one unit, its name): the unit in which an SI `value` is shown."""
        if self.system == "NONE" and quantity != "density":
            if quantity in POWERS:
                return self.scale ** POWERS[quantity][1], ""
            return 1.0, SI_UNITS[quantity]
        if quantity in POWERS:
            sign, power = POWERS[quantity]
            factor, name = self._length(value ** (1.0 / power) if value > 0.0 else 0.0)
            return factor**power, name + sign
        if quantity == "mass":
            return self._mass(value)
        if quantity == "density":
            return DENSITY_UNITS[density_unit(self.density, self.system)]
        return self._inertia(value)

    @property
    def _has_default_mass(self) -> bool:
        return self.system == "METRIC" and self.mass == "KILOGRAMS"

    @property
    def shows_grams(self) -> bool:
        """True if masses are in grams: by choice, or because lengths are in centimeters or less."""
        return self.mass == "GRAMS" or self._has_default_mass and self.length in SMALL_LENGTHS

    def _length(self, value: float) -> tuple[float, str]:
        table = LENGTHS[self.system]
        if self.length != "ADAPTIVE":
            return table[self.length]
        return _fitting_unit([*table.values()], value, table[BASES[self.system][0]])

    def _mass(self, value: float) -> tuple[float, str]:
        table = MASSES[self.system]
        if self.shows_grams or self._has_default_mass:
            if value > HEAVY:
                return table["TONNES"]
            is_light = self.length == "ADAPTIVE" and 0.0 < value < 1.0
            return table["GRAMS" if self.shows_grams or is_light else "KILOGRAMS"]
        if self.mass != "ADAPTIVE":
            return table[self.mass]
        base = table[BASES[self.system][1]]
        return _fitting_unit([table[key] for key in ADAPTIVE_MASSES[self.system]], value, base)

    def _inertia(self, value: float) -> tuple[float, str]:
        masses = MASSES[self.system]
        lengths = LENGTHS[self.system]
        if self.mass != "ADAPTIVE" or self.length != "ADAPTIVE":
            base_length, base_mass = BASES[self.system]
            mass = masses["GRAMS"] if self.shows_grams else masses.get(self.mass, masses[base_mass])
            length = lengths.get(self.length, lengths[base_length])
            return mass[0] * length[0] ** 2, "{:s}·{:s}²".format(mass[1], length[1])
        return _fitting_unit(
            ADAPTIVE_INERTIAS[self.system], value, ADAPTIVE_INERTIAS[self.system][0]
        )


def _fitting_unit(
    units: Sequence[tuple[float, str]], value: float, base: tuple[float, str]
) -> tuple[float, str]:
    """Return the largest unit that is at most `value`, else the smallest; the base for zero."""
    if value == 0.0:
        return base
    for unit in units:
        if value >= unit[0] * (1.0 - 1e-6):  # a value that rounds to 1 unit is shown in it
            return unit
    return units[-1]


def rounded_up(bound: float) -> float:
    """Return a bound rounded up to two digits, so that it stays a bound."""
    text = "{:.1e}".format(bound)
    if not float(text) < bound:
        return float(text)
    mantissa, _, exponent = text.partition("e")
    return float("{:.1f}e{:s}".format(float(mantissa) + 0.1, exponent))


def number(value: float, digits: int = DIGITS, grouping: str = "SPACE") -> str:
    """Return a readable number: `digits` significant digits, no trailing zeros, powers of ten only
    if needed.
    """
    return column((value,), digits, grouping)[0]


def column(values: Sequence[float], digits: int = DIGITS, grouping: str = "SPACE") -> list[str]:
    """Return numbers as text for a column, with equally many decimals, and with the same power of
    ten if needed.

    Common trailing zeros are left out. digits: significant digits of the largest number. grouping:
    one of `GROUPS`.
    """
    largest = max((abs(value) for value in values if isfinite(value)), default=0.0)
    if largest == 0.0:
        return [_plain_number(value, 0, "") for value in values]
    exponent = int("{:.{:d}e}".format(largest, digits - 1).partition("e")[2])
    power = exponent if not MIN_EXPONENT < exponent < MAX_EXPONENT else 0
    decimals = digits - 1 - (exponent - power)
    # `round` takes negative decimals, too; the text then has none.
    texts = [
        _plain_number(round(value / 10.0**power, decimals), max(decimals, 0), GROUPS[grouping])
        for value in values
    ]
    while "." in texts[0] and all(text.endswith("0") for text in texts):
        texts = [text[:-1].removesuffix(".") for text in texts]
    suffix = "e{:d}".format(power).replace("-", "−") if power else ""
    return [text + suffix if isfinite(value) else text for text, value in zip(texts, values)]


def _plain_number(value: float, decimals: int, separator: str) -> str:
    if not isfinite(value):
        return "{}".format(value)
    text = "{:.{:d}f}".format(abs(value), decimals)
    whole, point, fraction = text.partition(".")
    if len(whole) >= MIN_GROUPED:
        whole = "{:,d}".format(int(whole)).replace(",", separator)
    negative = value < 0.0 and text.strip("0.")
    return ("−" if negative else "") + whole + point + fraction


def report_line(label: str, value: str, unit: str = "") -> str:
    return "{}{:<{}}{} {}".format(INDENT, label, REPORT_WIDTH, value, unit).rstrip()


def report_number(value: float | None) -> str:
    """Return an SI number as text for a report, "unknown" for None."""
    return "unknown" if value is None else "{:.{}g}".format(value, REPORT_DIGITS)


def report_vector(values: Sequence[float | None], size: float = 0.0) -> str:
    """Return a vector of SI numbers as text for a report, after `clean`."""
    return "({})".format(", ".join(report_number(value) for value in clean(values, size)))


def clean(values: Sequence[float | None], size: float = 0.0) -> list[float | None]:
    """Return the values, with 0.0 for values within rounding of the largest one or of the body's
    size.
    """
    largest = max([size, *(abs(value) for value in values if value is not None)])
    return [
        0.0 if value is not None and abs(value) <= ZERO_DISPLAY_RTOL * largest else value
        for value in values
    ]
