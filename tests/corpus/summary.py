# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Summaries of measured entries: few numbers, each with its tolerance, as one line of text an
entry.

A summary maps names to `Numbers` or to text (method, findings, counts). Long lists become one
weighted sum: a change of any element changes the sum, and distinct weights notice two exchanged
elements. The file holds as many digits as the tolerance needs.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

RELATIVE = 1e-8  # Relative to the largest number of its kind.
BOUND = 0.1  # the share of a reported error bound that a number may move by
OF_BOUNDS = 0.2  # Bounds are sums of roundings, or differences of two rules that agree.
OF_FLOAT32 = 1e-6  # Relative, for points that Blender computes.
TURN = 1e-6  # in radians, of axes that the inertia determines
# Zernike descriptors are differences of far larger numbers, and the chirality of a symmetric body
# is rounding.
OF_SIGNATURE = {"zernike": 1e-7, "chirality": 1e-5}
BOUNDED = ("volume", "area", "center_of_mass", "inertia")
WORDS = ("type", "kind", "symmetry", "frame")
PLAIN = ("mass", "density", "thickness", "length", "linear_density", "display_volume")
HEALTHY = {"closed": True, "components": 1, "self_intersection": "not_found"}
GOLDEN = 0.6180339887498949


class Numbers(NamedTuple):
    """Numbers that may differ by `allowed` each, or by a share of themselves."""

    values: list[float]
    allowed: float
    share: float = 0.0

    def tolerance(self, value: float) -> float:
        return max(self.allowed, self.share * abs(value))


def summarize(table: dict[str, object], loose: set[str]) -> dict[str, dict[str, object]]:
    """Return the summary of each entry.

    `loose`: scenes and bodies with points that Blender computes.

    Stored properties repeat the record in the object frame: only their differences remain.
    """
    found = {key: _Entry(entry, _is_in(key, loose)).summary() for key, entry in table.items()}
    for key in found:
        if key.startswith("properties/"):
            _, scene, name = key.split("/", 2)
            record = found.get("object/{}.blend/{}".format(scene, name), {})
            found[key] = {
                part: value
                for part, value in found[key].items()
                if part not in record or _differ(record[part], value)
            }
    return found


def _is_in(key: str, places: set[str]) -> bool:
    """Return whether the entry belongs to one of the places: "SCENE", "SCENE/OBJECT" or "SCENE
    total".
    """
    place = key.partition("/")[2].replace(".blend", "", 1)
    return any(place == name or place.startswith((name + "/", name + " ")) for name in places)


def changes(
    before: dict[str, dict], after: dict[str, dict]
) -> Iterator[tuple[str, object, object]]:
    """Yield (place, before, after) of each difference beyond the tolerances of `after`; new entries
    are none.
    """
    for key, old in before.items():
        new = after.get(key)
        if new is None:
            yield key, "an entry", None
            continue
        for name in [*old, *(name for name in new if name not in old)]:
            if name not in old or name not in new or _differ(old[name], new[name]):
                yield "{} › {}".format(key, name), old.get(name), new.get(name)


def _differ(old: object, new: object) -> bool:
    if not isinstance(new, Numbers) or not isinstance(old, Numbers):
        return old != new
    pairs = zip(old.values, new.values)
    # "Not at most" is true for NaN too.
    return len(old.values) != len(new.values) or any(
        not abs(a - b) <= new.tolerance(b) for a, b in pairs
    )


def write(summaries: dict[str, dict]) -> str:
    """Return the text of summaries: a tab between the key and the parts of an entry."""
    lines = []
    for key in sorted(summaries):
        parts = ["{}={}".format(name, _text(value)) for name, value in summaries[key].items()]
        lines.append("\t".join([key, *parts]))
    return "\n".join(lines) + "\n"


def _text(value: object) -> str:
    if not isinstance(value, Numbers):
        return "'" + value
    return " ".join(_digits(number, value.tolerance(number)) for number in value.values)


def _digits(number: float, tolerance: float) -> str:
    """Return the number, rounded by at most half the tolerance."""
    if not tolerance or not math.isfinite(number):
        return "{:.17g}".format(number)
    decimals = math.ceil(-math.log10(tolerance))
    rounded = round(number, decimals)
    if not rounded:
        return "0"
    digits = math.floor(math.log10(abs(rounded))) + decimals + 1
    return (
        "{:.{}g}".format(rounded, max(1, min(digits, 17))).replace("e-0", "e-").replace("e+0", "e")
    )


def read(text: str) -> dict[str, dict]:
    """Return the summaries of a text, without tolerances."""
    summaries = {}
    for line in text.splitlines():
        key, *parts = line.split("\t")
        pairs = [part.split("=", 1) for part in parts]
        summaries[key] = {
            name: value[1:]
            if value.startswith("'")
            else Numbers([float(word) for word in value.split()], 0.0)
            for name, value in pairs
        }
    return summaries


def numbers_in(value: object) -> list[float]:
    """Return the numbers of nested tables and lists in their order; a null counts as zero and a
    bool as a number.
    """
    if isinstance(value, (dict, list)):
        return [
            one
            for part in (value.values() if isinstance(value, dict) else value)
            for one in numbers_in(part)
        ]
    return [] if isinstance(value, str) else [float(value or 0.0)]


def weighted(values: list[float]) -> float:
    """Return the sum with weights between 1 and 2 that differ from element to element."""
    return float(np.dot(values, 1.0 + np.arange(len(values)) * GOLDEN % 1.0)) if values else 0.0


def _largest(values: list[float]) -> float:
    return max(map(abs, values), default=0.0)


class _Entry:
    """One entry of the corpus, its error bounds and its scales."""

    def __init__(self, entry: object, loose: bool) -> None:
        self.loose, self.names = loose, entry if isinstance(entry, list) else None
        table = entry if isinstance(entry, dict) else {}
        self.table = {name.removeprefix("body_"): value for name, value in table.items()}
        bound = self.table.get("error_bound") or {}
        if isinstance(bound, list):  # Operators store the bounds as a list.
            bound = dict(zip(BOUNDED, bound[:4])) | {"input": dict(zip(BOUNDED, bound[4:]))}
        self.bound, self.input = bound, bound.get("input") or {}
        self.relative = OF_FLOAT32 if loose else RELATIVE

    def allowed(self, name: str, size: float) -> float:
        """Return the tolerance of a bounded quantity."""
        given = BOUND * (self.bound.get(name) or 0.0)
        from_points = BOUND * (self.input.get(name) or 0.0) if self.loose else 0.0
        return max(given + from_points, self.relative * size)

    def summary(self) -> dict[str, object]:
        if self.names is not None:
            return {"names": " ".join(sorted(map(str, self.names)))}
        words = [str(self.table[name]) for name in WORDS if name in self.table]
        found = {"words": " ".join(word for word in words if word != "solid")}
        found |= {
            "method": self.table.get("method"),
            "findings": self.table.get("findings"),
            "health": self.health(),
        }
        found |= self.quantities() | self.moments() | self.bounds() | self.shape()
        return {name: value for name, value in found.items() if value}

    def health(self) -> str:
        """Return the counts and answers that a sound body does not have."""
        health = self.table.get("health") or {}
        if not health:
            return ""
        differing = {
            name: len(value) if isinstance(value, list) else value
            for name, value in health.items()
            if not isinstance(value, float)
            and (value or name in HEALTHY)
            and HEALTHY.get(name) != value
        }
        return " ".join(
            "{}={:d}".format(k, v) if isinstance(v, int) else v for k, v in differing.items()
        )

    def share(self) -> float:
        """Return the share of itself by which the mass may differ, and quantities that grow with
        it.
        """
        volume = abs(self.table.get("volume") or 0.0)
        return self.allowed("volume", volume) / volume if volume else self.relative

    def quantities(self) -> dict[str, Numbers]:
        table, found = self.table, {}
        share = max(self.share(), self.relative)
        mass, density, volume = (table.get(name) or 0.0 for name in ("mass", "density", "volume"))
        redundant = "density" if math.isclose(mass, density * volume, rel_tol=RELATIVE) else None
        for name in PLAIN:
            if name != redundant and table.get(name) is not None:
                found[name] = Numbers([table[name]], share * abs(table[name]))
        for name in ("volume", "area"):
            if table.get(name):
                found[name] = Numbers([table[name]], self.allowed(name, abs(table[name])))
        center, principal = (
            table.get("center_of_mass"),
            numbers_in(table.get("principal_moments") or []),
        )
        reach = math.sqrt(abs(_largest(principal) / mass)) if mass else 0.0
        if center and None not in center:
            found["center"] = Numbers(
                center, self.allowed("center_of_mass", _largest(center) + reach)
            )
        inertia = table.get("inertia")
        if inertia:
            if len(inertia) == 3:
                inertia = [
                    inertia[i][j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
                ]
            values = numbers_in(inertia)
            allowed = self.allowed("inertia", _largest(values))
            found["inertia"] = Numbers(values, allowed)
            found["principal"] = Numbers([weighted(principal)], allowed)
            if table.get("principal_axes_unique"):
                found["axes"] = Numbers([weighted(numbers_in(table["principal_axes"]))], TURN)
        display = numbers_in(table.get("display_mesh") or [])
        if display:
            found["display"] = Numbers(display, OF_FLOAT32 * _largest(display))
        spread = [
            (table.get("health") or {}).get(name) for name in ("volume_spread", "cap_area_share")
        ]
        if any(spread):
            found["spread"] = Numbers([one or 0.0 for one in spread], share * max(1.0, abs(volume)))
        return found

    def bounds(self) -> dict[str, Numbers]:
        """Return the bounds by rounding and by the input, those of bounded quantities before those
        of moments.
        """
        moments = self.table.get("moments") or {}
        sums = [
            weighted([part.get(name) or 0.0 for name in BOUNDED])
            for part in (self.bound, self.input)
        ]
        sums += [
            weighted(numbers_in(moments[name])) for name in ("error", "input") if name in moments
        ]
        return {"bounds": Numbers(sums, 0.0, OF_BOUNDS)} if any(sums) else {}

    def moments(self) -> dict[str, Numbers]:
        """Return the weighted sum of the moments of each kind and order.

        Left out: moments of mass that are the density times those of volume, and a volume or area
        that the record has.
        """
        moments, found = self.table.get("moments") or {}, {}
        for kind, entries in moments.items():
            if not isinstance(entries, dict) or kind in ("error", "input"):
                continue
            table = {
                tuple(map(int, key.split(","))): value or 0.0 for key, value in entries.items()
            }
            bound = (moments.get("error") or {}).get(kind) or {}
            extent, second = (
                abs(table.get((0, 0, 0), 0.0)),
                _largest([table[key] for key in table if sum(key) == 2]),
            )
            length = math.sqrt(second / extent) if extent else 0.0
            for order in sorted({sum(key) for key in table}):
                values = [value for key, value in table.items() if sum(key) == order]
                size = max(_largest(values), extent * length**order)
                bounds = [
                    bound.get(",".join(map(str, key))) or 0.0 for key in table if sum(key) == order
                ]
                share = max(self.share() if self.loose else 0.0, self.relative)
                sums = Numbers([weighted(values)], max(share * size, BOUND * weighted(bounds)))
                found["{}{:d}".format(kind[:4], order)] = sums
                if self.is_redundant(kind, order, sums, found):
                    del found["{}{:d}".format(kind[:4], order)]
        return found

    def is_redundant(self, kind: str, order: int, sums: Numbers, found: dict[str, Numbers]) -> bool:
        """Return whether the record or the moments of volume determine the weighted sum."""
        if kind == "mass":
            volume = found.get("volu{:d}".format(order), Numbers([self.table.get("volume")], 0.0))
            expected = (
                None
                if volume.values[0] is None
                else volume.values[0] * (self.table.get("density") or 0.0)
            )
        else:
            expected = (
                None if order else self.table.get({"volume": "volume", "surface": "area"}.get(kind))
            )
        return expected is not None and abs(sums.values[0] - expected) <= sums.allowed

    def shape(self) -> dict[str, object]:
        """Return pose, signature, section and Fourier transform."""
        table, found = self.table, {}
        pose = table.get("pose")
        if pose:
            found["pose"] = "{} {}".format(pose.get("unique"), pose.get("symmetry"))
            if pose["unique"] is True:
                distance = _largest(numbers_in(table.get("center_of_mass") or []))
                found["matrix"] = Numbers(
                    [weighted(numbers_in(pose["matrix"]))], TURN * (1.0 + distance)
                )
        for name, value in (table.get("signature") or {}).items():
            values = numbers_in(value)
            if values:
                share = max(OF_SIGNATURE.get(name, RELATIVE), self.relative)
                found["signature " + name] = Numbers([weighted(values)], share * _largest(values))
        section = table.get("section") or {}
        side = math.sqrt(section["area"][0]) if section else 0.0
        for name, value in section.items():
            values = numbers_in(value)
            if values and name in ("error", "input"):
                found["section " + name] = Numbers([weighted(values)], 0.0, OF_BOUNDS)
            elif values:
                found["section " + name] = Numbers(
                    [weighted(values)], RELATIVE * max(side, _largest(values))
                )
        for name in ("real", "imag"):
            if name in table:
                values = numbers_in(table[name])
                found[name] = Numbers(
                    [weighted(values)], self.relative * max(_largest(values), side, 1e-9)
                )
        return found
