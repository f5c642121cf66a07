# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""IGES and .obj files written by hand from patches."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from body_moments.core.nurbs.splines import Patch


class IgesFile:
    """Entities are added one after the other; `add` returns the number by which others point to
    one.
    """

    def __init__(self, unit: int | None = 6, unit_name: str = "M", scale: float = 1.0) -> None:
        self._unit, self._unit_name, self._scale = unit, unit_name, scale
        self._directory: list[str] = []
        self._parameters: list[str] = []
        self.delimiter, self.end = ",", ";"

    def add(
        self,
        kind: int,
        fields,
        form: int = 0,
        matrix: int = 0,
        status: str = "00000000",
        label: str = "",
    ) -> int:
        number = 2 * len(self._directory) // 2 + 1
        words = [
            str(kind),
            *(word if isinstance(word, str) else "{!r}".format(word) for word in fields),
        ]
        lines, line = [], ""
        for word in [*(word + self.delimiter for word in words[:-1]), words[-1] + self.end]:
            if len(line) + len(word) > 64:
                lines.append(line)
                line = ""
            line += word
        lines.append(line)
        first = len(self._parameters) + 1
        self._parameters += ["{:<64}{:>8}".format(text, number) for text in lines]
        top = (kind, first, 0, 0, 0, 0, matrix, 0)
        self._directory.append("".join("{:>8}".format(word) for word in top) + status)
        self._directory.append(
            "".join(
                "{:>8}".format(word) for word in (kind, 0, 0, len(lines), form, "", "", label, 0)
            )
        )
        return number

    def surface(self, patch: Patch, domain=None, **more) -> int:
        return self.add(128, surface_fields(patch, domain), **more)

    def transformation(self, rows, **more) -> int:
        return self.add(
            124, [float(value) for value in np.asarray(rows, float)[:3].ravel()], **more
        )

    def text(self) -> str:
        d, e = self.delimiter, self.end
        unit = "" if self._unit is None else str(self._unit)
        opening = "1H{}{}1H{}".format(d, d, e)
        fields = [
            "4Htest",
            "6Ha.iges",
            "1Ha",
            "1Ha",
            "32",
            "38",
            "6",
            "308",
            "15",
            "1Ha",
            repr(self._scale),
            unit,
        ]
        fields += [
            "{}H{}".format(len(self._unit_name), self._unit_name),
            "1",
            "0.1",
            "15H20260101.000000",
            "1e-7",
        ]
        text = opening + d + d.join(fields) + e
        rows = [("S", ["Written by a test"])]
        rows.append(("G", [text[at : at + 72] for at in range(0, len(text), 72)]))
        rows += [("D", self._directory), ("P", self._parameters)]
        lines = [
            "{:<72}{}{:>7}".format(line, letter, number)
            for letter, section in rows
            for number, line in enumerate(section, 1)
        ]
        counts = "".join("{}{:>7}".format(letter, len(section)) for letter, section in rows)
        return "\n".join([*lines, "{:<72}T{:>7}".format(counts, 1)]) + "\n"

    def write(self, path: Path) -> Path:
        path.write_text(self.text(), encoding="latin-1")
        return path


def surface_fields(patch: Patch, domain=None) -> list:
    """The parameters of type 128."""
    (s, t), (counts) = patch.spaces, patch.points.shape[:2]
    assert (s.count, t.count) == (s.function_count, t.function_count) == counts
    weights = np.ones(counts) if patch.weights is None else patch.weights
    ends = domain or (s.domain, t.domain)
    return [
        *(
            counts[0] - 1,
            counts[1] - 1,
            s.order - 1,
            t.order - 1,
            0,
            0,
            int(patch.weights is None),
            0,
            0,
        ),
        *map(float, (*s.knots, *t.knots, *weights.T.ravel(), *patch.points.swapaxes(0, 1).ravel())),
        *map(float, (*ends[0], *ends[1])),
    ]


def obj_text(patches, kind: str = "bspline", name: str | None = None) -> str:
    """A file of .obj surfaces, Z up turned into Y up."""
    lines, count = ["# surfaces", "v 9 9 9"], 1
    for patch in patches:
        lines += ["o " + name] if name else []
        weights = np.ones(patch.points.shape[:2]) if patch.weights is None else patch.weights
        for (x, y, z), w in zip(
            patch.points.swapaxes(0, 1).reshape(-1, 3).tolist(), weights.T.ravel().tolist()
        ):
            lines.append("v {!r} {!r} {!r} {!r}".format(x, z, -y, w))
        s, t = patch.spaces
        lines.append("cstype rat " + kind)
        lines.append("deg {} {}".format(s.order - 1, t.order - 1))
        used = range(count + 1, count + 1 + weights.size)
        lines.append("surf {!r} {!r} {!r} {!r} \\".format(*s.domain, *t.domain))
        lines += ["{} \\".format(number) for number in used[:-1]] + [str(used[-1])]
        for letter, space in zip("uv", (s, t)):
            knots = space.knots if kind == "bspline" else dict.fromkeys(space.knots)
            lines.append("parm {} {}".format(letter, " ".join(map(repr, knots))))
        lines.append("end")
        count += weights.size
    return "\n".join(lines) + "\n"


def unrolled(patch: Patch) -> Patch:
    """The same surface without cyclic directions: control points repeated, for files that have no
    such flag.
    """
    points, weights, spaces = patch.points, patch.weights, []
    for axis, space in enumerate(patch.spaces):
        rows = np.arange(space.function_count) % space.count
        points = points.take(rows, axis)
        weights = None if weights is None else weights.take(rows, axis)
        spaces.append(type(space)(space.knots, space.order, space.function_count))
    return Patch(tuple(spaces), points, weights)


def labels(values):
    """The labels of refused entities, without their lines in the directory."""
    assert all(re.fullmatch(r"(.* \()?D\d+\)?", name) for name in values["names"])
    return [name.split(" (")[0] for name in values["names"]]
