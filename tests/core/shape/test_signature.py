# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One signature for a shape however it lies, whatever its size and faces; mirror images told from
copies.
"""

import json
from dataclasses import replace
from itertools import combinations_with_replacement

import numpy as np
import pytest
from body_moments.core.flat import directed_edges, region_moments
from body_moments.core.measurement.record import plain
from body_moments.core.moments.raw import stack_moments
from body_moments.core.numerics.quadrature import triangle_rule
from body_moments.core.polyhedron import polyhedron_moments
from body_moments.core.shape.findings import NO_SHAPE
from body_moments.core.shape.library import (
    SAME_SHAPE_DISTANCE,
    UNDECIDED_HANDEDNESS,
    classify,
    read_library,
)
from body_moments.core.shape.signatures import (
    FREQUENCIES,
    MIN_CHIRALITY,
    Signature,
    flat_signature,
    signature,
    signatures,
    similarity,
)
from body_moments.core.verdict import Finding

from tests.close import close
from tests.core import bodies, shapes
from tests.core.findings import refused
from tests.core.recursion import moments

PARTS = ("invariants", "zernike", "fourier", "chirality")

MEASURE = "Measure with --signature"


def signed(part, order=20):
    center = moments(part, 1).center
    points = part[0] - center
    return signature(
        moments((points, part[1]), order, np.zeros(3)), np.linalg.norm(points, axis=1).max()
    )


@pytest.mark.parametrize("part", [shapes.WEDGE, shapes.THREE_BOXES, bodies.box(), bodies.sphere(1)])
def test_motion_and_faces_change_nothing(part):
    first, rng = signed(part), np.random.default_rng(0)
    for seed in range(3):
        image = bodies.moved(part, bodies.rotation(seed), rng.normal(size=3) * 10)
        other = signed(shapes.refined(image, seed) if seed == 0 else image)
        for name in PARTS:
            assert np.abs(getattr(first, name) - getattr(other, name)).max() < 1e-9
        assert other.size == pytest.approx(first.size)
        assert similarity(first, other).distance() < 1e-8


@pytest.mark.parametrize("shell", [False, True])
def test_stacked_signatures_match_single_ones(shell):
    """Only bodies have a power spectrum."""
    each = []
    for part in (shapes.WEDGE, shapes.THREE_BOXES, bodies.box((0, 0, 0), (1, 2, 3))):
        each.append(polyhedron_moments(bodies.surface(part), 8, area_order=8)[shell].about_center())
    alone, radius = [], np.array([4.0, 5.0, 2.0])
    for of_one, size in zip(each, radius.tolist()):
        alone.append(signature(of_one, size))
    found = signatures(stack_moments(each), radius)
    assert len(found) == 3
    for one, other in zip(found, alone):
        assert one.fourier.shape == other.fourier.shape == ((0,) if shell else (len(FREQUENCIES),))
        for name in PARTS:
            assert np.abs(getattr(one, name) - getattr(other, name)).max(initial=0.0) < 1e-12
        assert close([one.size, one.error], [other.size, other.error], rel=1e-12)


@pytest.mark.parametrize("scale", [1e-5, 3.0, 1e5])
def test_size_is_separate_from_shape(scale):
    first, other = signed(shapes.WEDGE), signed((shapes.WEDGE[0] * scale, shapes.WEDGE[1]))
    likeness = similarity(first, other)
    assert likeness.shape < 1e-9 and likeness.distance(any_size=True) < 1e-8
    assert close(likeness.scale, scale, rel=1e-6) and likeness.is_mirror_image is False


def test_a_mirror_image_differs_in_its_hand_alone():
    for part in (
        shapes.WEDGE,
        shapes.THREE_BOXES,
        shapes.SYMMETRIC["twisted square prism"][0],
        shapes.prism(3, twist=0.3),
    ):
        first = signed(part)
        image = signed(bodies.moved(shapes.mirrored(part), bodies.rotation(4), (1, 2, 3)))
        for name in PARTS[:3]:
            assert np.abs(getattr(first, name) - getattr(image, name)).max() < 1e-9
        assert np.abs(first.chirality).max() > 1e-4
        assert np.abs(first.chirality + image.chirality).max() < 1e-9
        likeness = similarity(first, image)
        assert likeness.is_mirror_image is True
        assert likeness.distance() > 1e-4 and likeness.distance(any_hand=True) < 1e-9


def test_mirror_symmetric_bodies_have_no_hand():
    for name, (part, group) in shapes.SYMMETRIC.items():
        if group not in ("D4",):
            found = signed(bodies.moved(part, bodies.rotation(1)), 6)
            assert np.abs(found.chirality).max() < 1e-10, name
            assert similarity(found, found).is_mirror_image is False


@pytest.mark.parametrize("height", [0.1, 0.01, 1e-3])
def test_hand_of_a_slightly_asymmetric_cube_is_told(height):
    points, triangles = shapes.refined(bodies.box(), 1)
    points[-1] *= 1.0 + height
    part, rotation = (points, triangles), bodies.rotation(4)
    first = signed(part, 12)
    copy = signed(bodies.moved(part, rotation, (1, 2, 3)), 12)
    image = signed(bodies.moved(shapes.mirrored(part), rotation, (1, 2, 3)), 12)
    assert (
        classify(similarity(first, copy)) == "copy"
        and classify(similarity(first, image)) == "mirror"
    )


def test_handedness_within_noise_is_not_told():
    """Noise gives a body of no hand one, and two noisy copies either one's opposite by chance."""
    rng = np.random.default_rng(0)
    for name, (part, group) in shapes.SYMMETRIC.items():
        if group in ("D4",):
            continue
        for noise in (1e-7, 1e-5, 1e-3):
            one, other = (
                signed((part[0] + noise * rng.normal(size=part[0].shape), part[1]), 12)
                for _ in range(2)
            )
            likeness = similarity(one, other)
            handed = max(np.linalg.norm(found.chirality) for found in (one, other)) > MIN_CHIRALITY
            assert likeness.is_mirror_image is (None if handed else False), (name, noise)
            assert (classify(likeness) in UNDECIDED_HANDEDNESS) == (
                handed and likeness.shape <= SAME_SHAPE_DISTANCE
            )


@pytest.mark.parametrize("size, mirrored", [(0.9e-11, False), (1.1e-11, True)])
def test_chirality_within_rounding_is_no_hand(size, mirrored):
    one = signed(shapes.WEDGE, 6)
    tiny = one.chirality / np.linalg.norm(one.chirality) * size
    assert (
        similarity(replace(one, chirality=tiny), replace(one, chirality=-tiny)).is_mirror_image
        is mirrored
    )


def test_different_shapes_are_far_apart_and_noisy_copies_near():
    parts = {**shapes.ASYMMETRIC, **{name: part for name, (part, _) in shapes.SYMMETRIC.items()}}
    found = {name: signed(part, 10) for name, part in parts.items()}
    rng = np.random.default_rng(0)
    for name, part in parts.items():
        image = bodies.moved(shapes.refined(part, 1), bodies.rotation(2), (1, 2, 3))
        noisy = signed(
            (image[0] + rng.normal(size=image[0].shape) * 2e-3 * np.ptp(part[0]), image[1]), 10
        )
        distances = {other: similarity(noisy, one).distance() for other, one in found.items()}
        assert min(distances, key=distances.get) == name


def test_orders_missing_in_one_signature_are_left_out():
    short, long = signed(shapes.WEDGE, 8), signed(shapes.WEDGE, 20)
    assert len(short.zernike) == 25 and len(long.zernike) == 121
    assert similarity(short, long).distance() < 1e-9


def test_a_record_gives_the_signature_back():
    found = signed(shapes.WEDGE)
    again = Signature.from_record(json.loads(json.dumps(plain(found.as_record()))))
    for name in PARTS:
        assert np.array_equal(getattr(found, name), getattr(again, name))
    assert again.size == found.size and list(found.as_record()) == ["size", *PARTS]
    # libraries on disk hold these lengths
    assert [len(getattr(found, name)) for name in PARTS] == [
        37,
        121,
        12,
        47,
    ]


def test_flat_record_restores_the_signature_to_order_20():
    points, edges = (
        np.array([[0, 0], [3, 0.25], [2.5, 1], [1, 1], [1.25, 2.5], [0, 2.0]]),
        directed_edges([range(6)]),
    )
    found, more = (flat_signature(region_moments(points, edges, order), 2.5) for order in (20, 21))
    again = Signature.from_record(json.loads(json.dumps(plain(found.as_record()))))
    for name in PARTS:
        assert np.array_equal(getattr(found, name), getattr(again, name))
        value, other = getattr(found, name), getattr(more, name)
        assert value.shape == other.shape
        assert np.abs(value - other).max(initial=0.0) <= 1e-9 * np.abs(value).max(initial=0.0)
    assert list(found.as_record()) == ["dimension", "size", *PARTS]
    assert again.dimension == 2 and [len(getattr(found, name)) for name in PARTS] == [
        40,
        121,
        0,
        27,
    ]
    assert np.abs(found.chirality).min() > 1e-6  # this shape has a hand by each of them


@pytest.mark.parametrize("turn", [1.0, np.exp(0.7j), -1j])
@pytest.mark.parametrize("scale", [1e-4, 1.0, 30.0])
@pytest.mark.parametrize("is_mirrored", [False, True])
def test_flat_invariants_are_products_of_complex_moments(turn, scale, is_mirrored):
    """c_pq = E[z^p conj(z)^q] of z about the centroid by the radius of gyration; of two of them
    with one p - q, and of three, one of which has the p - q of both others.
    """
    corners = np.array([0.0, 3.0 + 0.25j, 2.5 + 1.0j, 1.0 + 1.0j, 1.25 + 2.5j, 2.0j])
    shares, weights = triangle_rule(8)
    pieces = [corners[[0, k, k + 1]] for k in range(1, 5)]
    double = [((b - a).conjugate() * (c - a)).imag for a, b, c in pieces]
    z, mass = np.array(pieces) @ shares, np.array(double)[:, None] * weights
    mass /= mass.sum()
    z = z - (mass * z).sum()
    size = np.sqrt((mass * np.abs(z) ** 2).sum())
    z /= size
    c = {
        (n - q, q): (mass * z ** (n - q) * z.conj() ** q).sum()
        for n in range(7)
        for q in range(n // 2 + 1)
    }
    turning = [(p, q) for p, q in c if p > q and p + q > 1]
    low = [key for key in turning if sum(key) < 5]
    pairs = [
        (a, b) for a, b in combinations_with_replacement(turning, 2) if a[0] - a[1] == b[0] - b[1]
    ]
    couplings = [c[a] * c[b].conjugate() for a, b in pairs]
    is_chiral = [a != b for a, b in pairs]
    for a, b in combinations_with_replacement(low, 2):
        thirds = [key for key in turning if key[0] - key[1] == a[0] + b[0] - a[1] - b[1]]
        couplings += [c[a] * c[b] * c[key].conjugate() for key in thirds]
        is_chiral += [True] * len(thirds)
    couplings = np.array(couplings)

    placed = scale * turn * (corners.conj()[::-1] if is_mirrored else corners)
    points = np.stack([placed.real, placed.imag], axis=1)
    moments = region_moments(points, directed_edges([range(6)]), 6).about_center()
    found = flat_signature(moments, 3.0 * scale)
    assert close(found.invariants, [c[2, 2].real, c[3, 3].real, *couplings.real], 1e-11)
    assert close(found.chirality, (-1.0 if is_mirrored else 1.0) * couplings.imag[is_chiral], 1e-10)
    assert close(found.size, scale * size, 1e-13) and len(found.fourier) == 0


@pytest.mark.parametrize(
    "damage", [{"zernike": []}, {"size": None}, {"chirality": [1.0]}, {"invariants": [None, "x"]}]
)
def test_a_damaged_record_is_refused(damage):
    record = {**plain(signed(shapes.WEDGE, 6).as_record()), **damage}
    with refused("signature_invalid", "signature_invalid"):
        Signature.from_record(record)
    del record["size"]
    with refused("signature_invalid"):
        Signature.from_record(record)


def test_library_has_entries_and_findings_for_failed_bodies(tmp_path):
    shape = plain(signed(shapes.WEDGE, 6).as_record())
    damaged = {**shape, "size": 0.0}
    records = [
        {"name": "A", "signature": shape},
        {"name": "B", "signature": None},
        {"name": "C"},
        {"name": "D", "signature": damaged},
    ]
    last = {"objects": [{"name": "E", "signature": shape}]}
    path = tmp_path / "parts.jsonl"
    lines = [
        json.dumps({"file": "ä.blend", "objects": records}, ensure_ascii=False),
        "",
        json.dumps(last),
    ]
    path.write_text("\n".join(lines), encoding="utf-8")
    entries, missing = read_library(path)
    assert [entry.label for entry in entries] == ["ä.blend:A", "E"]
    assert missing == [
        Finding("record_without_signature", {"name": "ä.blend:B", "remedy": NO_SHAPE}),
        Finding("record_without_signature", {"name": "ä.blend:C", "remedy": MEASURE}),
        Finding("record_without_signature", {"name": "ä.blend:D", "remedy": MEASURE}),
    ]


@pytest.mark.parametrize(
    "line",
    [b"{", b"[]", b'{"objects": 3}', b'{"objects": [3]}', b'{"objects": [{"name": "\xff"}]}'],
)
def test_malformed_line_is_refused_by_its_number(line, tmp_path):
    path = tmp_path / "parts.jsonl"
    path.write_bytes(b'{"objects": []}\n' + line)
    with refused("library_line", file="parts.jsonl", line=2):
        read_library(path)
