# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Libraries of signatures: what is a copy, what is as alike, and how long a line may be."""

import os

import numpy as np
import pytest
from body_moments.core.shape import library
from body_moments.core.shape.library import Entry, Similarity, classify, rank, read_library
from body_moments.core.shape.signatures import Likeness, Signature
from body_moments.core.verdict.finding import FileError


@pytest.mark.parametrize("hand, copy, scaled", [(False, "copy", "scaled_copy"), (True, "mirror", "scaled_mirror")])
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_ten_thousandth_in_shape_or_size_is_what_a_careless_export_changes(hand, copy, scaled, way):
    for shape in (0.0, 0.99e-4):
        assert classify(Likeness(shape, 1.0 + 0.99e-4 * way, 0.0, hand)) == Similarity(copy)
        assert classify(Likeness(shape, 1.0 + 1.01e-4 * way, 0.0, hand)) == Similarity(scaled)
    assert classify(Likeness(1.01e-4, 1.0, 0.0, hand)) == Similarity.SIMILAR


def test_a_shape_is_the_same_to_a_ten_thousandth_and_similar_to_a_tenth():
    for limit, within, beyond in ((1e-4, "copy", "similar"), (0.1, "similar", "different")):
        assert classify(Likeness(limit, 1.0, 0.0, False)) == Similarity(within)
        assert classify(Likeness(np.nextafter(limit, 1.0), 1.0, 0.0, False)) == Similarity(beyond)


@pytest.mark.parametrize("apart, order", [(4e-13, ["first", "second"]), (2e-12, ["second", "first"])])
def test_what_is_as_alike_to_rounding_stays_in_its_order(monkeypatch, apart, order):
    distances = {"first": 0.25 + apart, "second": 0.25}
    monkeypatch.setattr(library, "similarity", lambda _, name: Likeness(distances[name], 1.0, 0.0, False))
    query = Signature(1.0, *4 * (np.empty(0),))
    found = rank(query, [Entry(name, "", name) for name in distances])
    assert [entry.name for entry, _ in found] == order


def test_a_line_of_more_than_256_mebibytes_is_none_of_a_library(tmp_path):
    path = tmp_path / "a.jsonl"
    path.touch()
    os.truncate(path, 2**28 + 1)
    with pytest.raises(FileError) as caught:
        read_library(path)
    assert caught.value.finding.code == "library_line_too_long"
    assert caught.value.finding.values == {"file": "a.jsonl", "line": 1, "limit": 2**28}
