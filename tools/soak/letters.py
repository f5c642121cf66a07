# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Retrieval rate of letters that were moved, turned, scaled, drawn otherwise and made noisy.

The letters are the 62 letters and digits of each font, all of them in one library. Those that are
one shape up to turn and scale count as one class, as I and 1 of Blender's font; a mirror image is a
class of its own.
"""

from __future__ import annotations

import string
import time
from collections.abc import Iterator

import numpy as np

# the one that Blender starts with, and one of those that it ships
FONTS = (
    "",
    "DejaVuSansMono.woff2",
)
CHARACTERS = string.ascii_letters + string.digits
NOISES = (0.0, 1e-4, 1e-3)  # standard deviations of the corners, by the letter's largest extent
SAME_CLASS = 1e-6  # letters whose signatures are nearer, whatever their size, are one shape
RESOLUTIONS = 6, 40


def outline(character: str, font_name: str, resolution: int):
    """(n, 2) the corners of a letter and its directed edges."""
    import bpy
    from body_moments.blender.read.section import read_section
    from body_moments.core.flat.polygon import orient_loops

    from tests.blender.flat_objects import text

    obj = text(character, font_name=font_name, resolution=resolution)
    reading = read_section(obj, bpy.context.evaluated_depsgraph_get())
    data = obj.data
    bpy.data.objects.remove(obj)
    bpy.data.curves.remove(data)
    points = reading.points[:, :2].astype(float)
    return points, orient_loops(points, reading.loops)


def signed(points, edges):
    from body_moments.core.flat import region_moments
    from body_moments.core.shape.signatures import flat_signature

    moments = region_moments(points, edges, 20)
    return flat_signature(moments, float(np.hypot(*(points - moments.about[:2]).T).max()))


def library():
    """[(label, character, font, signature)] and {label: the label of its class}."""
    from body_moments.core.shape import similarity

    letters, classes = [], {}
    for font_name in FONTS:
        for character in CHARACTERS:
            label = "{:s} {:s}".format(font_name.split(".")[0] or "Bfont", character)
            own = signed(*outline(character, font_name, 12))
            letters.append((label, character, font_name, own))
            alike = (
                other
                for other, *_, known in letters
                if similarity(known, own).distance(True) < SAME_CLASS
            )
            classes[label] = classes.get(first := next(alike), first)
    return letters, classes


def altered(character: str, font_name: str, noise: float, rng: np.random.Generator):
    points, edges = outline(character, font_name, int(rng.integers(*RESOLUTIONS)))
    points = points + rng.normal(size=points.shape) * noise * np.ptp(points, axis=0).max()
    angle = rng.uniform(0.0, 2.0 * np.pi)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    points = (points @ turn.T + rng.normal(size=2) * 10.0) * 10.0 ** rng.uniform(-3.0, 3.0)
    return points.astype(np.float32).astype(float), edges


def missed(letters, classes, noise: float, rng: np.random.Generator) -> Iterator[tuple[str, str]]:
    """Each letter that another class is nearer to, and the letter that is."""
    from body_moments.core.shape import similarity

    for label, character, font_name, _ in letters:
        found = signed(*altered(character, font_name, noise, rng))
        nearest = min(letters, key=lambda row: similarity(found, row[3]).distance(any_size=True))[0]
        if classes[nearest] != classes[label]:
            yield label, nearest


def run(budget_seconds: float, seed: int) -> str:
    """Repeat until the time is used up.

    Fail if less than 99 % are found at a noise of 0.01 % or less.
    """
    rng, end = np.random.default_rng(seed), time.monotonic() + budget_seconds
    letters, classes = library()
    count = len(set(classes.values()))
    lines = ["{} letters, {} classes".format(len(letters), count)]
    lines += [
        "one shape: {} and {}".format(*pair) for pair in classes.items() if pair[0] != pair[1]
    ]
    tried, failures = 0, {noise: [] for noise in NOISES}
    while not tried or time.monotonic() < end:
        tried += len(letters)
        for noise in NOISES:
            failures[noise] += missed(letters, classes, noise, rng)
    for noise in NOISES:
        share = 1.0 - len(failures[noise]) / tried
        assert share >= 0.99 or noise > 1e-4, failures[noise]
        pairs = sorted({"{} as {}".format(*pair) for pair in failures[noise]})
        lines.append(
            "noise {:g}: {:.2%} of {} found; {}".format(
                noise, share, tried, ", ".join(pairs) or "none missed"
            )
        )
    return "\n".join(lines)
