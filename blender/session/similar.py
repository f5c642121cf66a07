# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Comparison of the shapes of objects with the shape of a wanted object."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import NamedTuple

from bpy.types import Depsgraph, Object

from ...core.shape import (
    MAX_FIT_RTOL,
    UNDECIDED_HANDEDNESS,
    Entry,
    Likeness,
    Signature,
    classify,
    rank,
    read_library,
    similarity,
)
from ...core.verdict import Finding
from .. import bodies

DESCRIPTOR_ORDER = 12  # ample to separate parts, in a fourth of the time of order 20


class Match(NamedTuple):
    """A compared shape. verdict: relation to the wanted shape. distance: between signatures. scale:
    relative size.
    """

    name: str
    file: str
    verdict: str
    distance: float
    scale: float
    obj: Object | None


class SimilarSearch:
    """A search for objects that are similar in shape to a measured one.

    The scene must not change meanwhile.

    signature: the signature of the measured object, once `measure` has ended.
    """

    signature: Signature

    def __init__(self, obj: Object, depsgraph: Depsgraph):
        self._obj, self._depsgraph = obj, depsgraph
        self._objects: dict[Entry, Object] = {}
        # whether a shape is a mirror image, by its surface; None if the surface leaves it open, too
        self._mirror_images: dict[Entry, bool | None] = {}

    def measure(self) -> Iterator[float]:
        """Measure the wanted object, in steps that yield the finished share. Raises MeasureError if
        it has no signature.
        """
        self._shape = bodies.flat.flat_shape.comparable_shape_of(self._obj, self._depsgraph)
        yield 0.0
        self.signature = self._shape.signature(DESCRIPTOR_ORDER)

    def comparison(
        self, objects: Sequence[Object]
    ) -> Callable[[Object], Generator[float, None, None]]:
        """Return a function that compares one of the objects with the wanted object, keeps the
        outcome for `find_nearest`, and yields the finished share. To be called after `measure`, for
        the objects in their order.
        """
        wanted_shape = self._shape
        wanted_skin = None  # computed when a comparison of surfaces first needs it
        depsgraph = self._depsgraph
        flat = isinstance(wanted_shape, bodies.flat.flat_shape.FlatShape)
        if flat:
            shape_of_body = partial(bodies.shape.object_shape.surface_shape_of, depsgraph=depsgraph)
        else:
            shape_of_body = bodies.shape.signatures.signatures_in_turn(
                objects, depsgraph, DESCRIPTOR_ORDER
            )

        def compare(obj: Object) -> Generator[float, None, None]:
            nonlocal wanted_skin
            shape = bodies.flat.flat_shape.body_or_flat(obj, depsgraph, shape_of_body, flat)
            yield 0.3
            signature = shape if isinstance(shape, Signature) else shape.signature(DESCRIPTOR_ORDER)
            entry = Entry(obj.name_full, "", signature)
            likeness = similarity(self.signature, entry.signature)
            if classify(likeness) in UNDECIDED_HANDEDNESS:
                yield 0.6
                wanted_skin = wanted_skin or bodies.flat.flat_shape.distance_from(wanted_shape)
                if isinstance(shape, Signature):
                    shape = bodies.shape.object_shape.surface_shape_of(obj, depsgraph)
                skin = bodies.flat.flat_shape.distance_from(shape)
                yield 0.9
                match = bodies.shape.surface_distance.register_surfaces(
                    shape, wanted_shape, skin, wanted_skin, 1.0 / likeness.scale
                )
                is_copy = match.max_distance <= MAX_FIT_RTOL * wanted_shape.size
                self._mirror_images[entry] = None
                if is_copy or match.is_mirror_image:
                    self._mirror_images[entry] = not is_copy
            self._objects[entry] = obj

        return compare

    def find_nearest(self, scaled: bool, mirrored: bool) -> list[Match]:
        """Return the matches, nearest first. scaled, mirrored: rank scaled copies and mirror images
        like copies.
        """
        matches = []
        for entry, likeness in rank(self.signature, self._objects, scaled, mirrored):
            is_mirror_image = self._mirror_images.get(entry, likeness.is_mirror_image)
            likeness = replace(likeness, is_mirror_image=is_mirror_image)
            matches.append(_match(entry, likeness, scaled, mirrored, self._objects[entry]))
        return matches

    def find_in_library(
        self, path: Path, scaled: bool, mirrored: bool
    ) -> tuple[list[Match], list[Finding]]:
        """Measure the wanted object; return the bodies of a library, the most similar first, and
        findings about records that are left out.
        """
        entries, missing = read_library(path)
        for _ in self.measure():
            pass
        ranked = rank(self.signature, entries, scaled, mirrored)
        return [_match(entry, likeness, scaled, mirrored) for entry, likeness in ranked], missing


def _match(
    entry: Entry, likeness: Likeness, scaled: bool, mirrored: bool, obj: Object | None = None
) -> Match:
    verdict = classify(likeness).value
    return Match(
        entry.name, entry.file, verdict, likeness.distance(scaled, mirrored), likeness.scale, obj
    )
