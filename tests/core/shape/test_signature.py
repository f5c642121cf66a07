# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One signature for a shape however it lies, whatever its size and faces; mirror images told from copies."""

import json
from dataclasses import replace
from itertools import combinations_with_replacement
from math import factorial, pi, sqrt

import numpy as np
import pytest
from body_moments.core.flat import directed_edges, region_moments
from body_moments.core.measurement.record import plain
from body_moments.core.moments.moments import U, stack_moments
from body_moments.core.numerics.quadrature import triangle_rule
from body_moments.core.polyhedron import polyhedron_moments
from body_moments.core.shape.flat_signatures import flat_signature
from body_moments.core.shape.library import (
    SAME_SHAPE_DISTANCE,
    UNDECIDED_HANDEDNESS,
    Entry,
    classify,
    rank,
    read_library,
)
from body_moments.core.shape.signatures import FREQUENCIES, MIN_CHIRALITY, Signature, signature, signatures, similarity
from body_moments.core.verdict.finding import Finding

from tests.close import close
from tests.core import bodies, shapes
from tests.core.findings import refused
from tests.core.recursion import moments

PARTS = ("invariants", "zernike", "fourier", "chirality")


def signed(part, order=20):
    center = moments(part, 1).center
    points = part[0] - center
    return signature(moments((points, part[1]), order, np.zeros(3)), np.linalg.norm(points, axis=1).max())


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
def test_signatures_of_a_stack_are_those_of_each(shell):
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
def test_size_is_told_apart_from_shape(scale):
    first, other = signed(shapes.WEDGE), signed((shapes.WEDGE[0] * scale, shapes.WEDGE[1]))
    likeness = similarity(first, other)
    assert likeness.shape < 1e-9 and likeness.distance(any_size=True) < 1e-8
    assert close(likeness.scale, scale, rel=1e-6) and likeness.is_mirror_image is False


def test_bodies_that_are_as_alike_to_rounding_keep_their_order():
    wanted = signed(shapes.WEDGE)

    def named(name, share):
        return Entry(name, "", replace(wanted, size=wanted.size * (1.0 + share)))

    near, nearer, other = named("near", 3e-13), named("nearer", 1e-13), named("other", 3e-12)
    for entries in ([near, nearer, other], [nearer, near, other], [other, nearer, near]):
        found = [entry.name for entry, _ in rank(wanted, entries)]
        assert found == [entry.name for entry in entries if entry != other] + ["other"]


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


def test_bodies_that_are_their_own_mirror_images_have_no_hand():
    for name, (part, group) in shapes.SYMMETRIC.items():
        if group not in ("D4",):
            found = signed(bodies.moved(part, bodies.rotation(1)), 6)
            assert np.abs(found.chirality).max() < 1e-10, name
            assert similarity(found, found).is_mirror_image is False


@pytest.mark.parametrize("height", [0.1, 0.01, 1e-3])
def test_the_hand_of_a_cube_with_one_corner_moved_a_little_is_told(height):
    points, triangles = shapes.refined(bodies.box(), 1)
    points[-1] *= 1.0 + height
    part, rotation = (points, triangles), bodies.rotation(4)
    first = signed(part, 12)
    copy = signed(bodies.moved(part, rotation, (1, 2, 3)), 12)
    image = signed(bodies.moved(shapes.mirrored(part), rotation, (1, 2, 3)), 12)
    assert classify(similarity(first, copy)) == "copy" and classify(similarity(first, image)) == "mirror"


def test_what_noise_may_have_made_is_no_hand():
    """Noise gives a body of no hand one, and two noisy copies either one's opposite by chance."""
    rng = np.random.default_rng(0)
    for name, (part, group) in shapes.SYMMETRIC.items():
        if group in ("D4",):
            continue
        for noise in (1e-7, 1e-5, 1e-3):
            one, other = (signed((part[0] + noise * rng.normal(size=part[0].shape), part[1]), 12) for _ in range(2))
            likeness = similarity(one, other)
            handed = max(np.linalg.norm(found.chirality) for found in (one, other)) > MIN_CHIRALITY
            assert likeness.is_mirror_image is (None if handed else False), (name, noise)
            assert (classify(likeness) in UNDECIDED_HANDEDNESS) == (handed and likeness.shape <= SAME_SHAPE_DISTANCE)


@pytest.mark.parametrize("share, told", [(0.19, True), (0.21, False)])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_hand_is_told_where_one_difference_is_less_than_a_fifth_of_the_other(share, told, sign):
    """Of chiralities c and k c the differences are as 1 - k to 1 + k."""
    one = signed(shapes.WEDGE, 6)
    other = replace(one, chirality=sign * (1.0 - share) / (1.0 + share) * one.chirality)
    for found in (similarity(one, other), similarity(other, one)):
        assert found.is_mirror_image is ((sign < 0.0) if told else None)


@pytest.mark.parametrize("share, told", [(0.95, False), (1.05, True)])
def test_a_hand_is_told_where_it_is_ten_times_what_the_shapes_differ_by(share, told):
    one = signed(shapes.WEDGE, 6)
    size = np.linalg.norm(one.chirality)
    # of all numbers the invariants alone differ: by d, which makes a difference of d / √2
    apart = size * np.sqrt(2.0) / 10.0 / share
    assert apart < 1.0
    other = replace(one, invariants=one.invariants * (1.0 - apart))
    likeness = similarity(one, other)
    assert close(likeness.shape, apart / np.sqrt(2.0), 1e-9)
    assert likeness.is_mirror_image is (False if told else None)


@pytest.mark.parametrize("size, mirrored", [(0.9e-11, False), (1.1e-11, True)])
def test_a_chirality_that_is_rounding_is_no_hand(size, mirrored):
    one = signed(shapes.WEDGE, 6)
    tiny = one.chirality / np.linalg.norm(one.chirality) * size
    assert similarity(replace(one, chirality=tiny), replace(one, chirality=-tiny)).is_mirror_image is mirrored


def test_different_shapes_are_far_apart_and_noisy_copies_near():
    parts = {**shapes.ASYMMETRIC, **{name: part for name, (part, _) in shapes.SYMMETRIC.items()}}
    found = {name: signed(part, 10) for name, part in parts.items()}
    rng = np.random.default_rng(0)
    for name, part in parts.items():
        image = bodies.moved(shapes.refined(part, 1), bodies.rotation(2), (1, 2, 3))
        noisy = signed((image[0] + rng.normal(size=image[0].shape) * 2e-3 * np.ptp(part[0]), image[1]), 10)
        distances = {other: similarity(noisy, one).distance() for other, one in found.items()}
        assert min(distances, key=distances.get) == name


def test_orders_that_one_lacks_are_left_out():
    short, long = signed(shapes.WEDGE, 8), signed(shapes.WEDGE, 20)
    assert len(short.zernike) == 25 and len(long.zernike) == 121
    assert similarity(short, long).distance() < 1e-9


def test_a_record_gives_the_signature_back():
    found = signed(shapes.WEDGE)
    again = Signature.from_record(json.loads(json.dumps(plain(found.as_record()))))
    for name in PARTS:
        assert np.array_equal(getattr(found, name), getattr(again, name))
    assert again.size == found.size and list(found.as_record()) == ["size", *PARTS]
    assert [len(getattr(found, name)) for name in PARTS] == [37, 121, 12, 47]  # what libraries on disk hold


def test_a_flat_record_gives_the_signature_back_and_moments_beyond_order_20_add_nothing():
    points, edges = np.array([[0, 0], [3, 0.25], [2.5, 1], [1, 1], [1.25, 2.5], [0, 2.0]]), directed_edges([range(6)])
    found, more = (flat_signature(region_moments(points, edges, order), 2.5) for order in (20, 21))
    again = Signature.from_record(json.loads(json.dumps(plain(found.as_record()))))
    for name in PARTS:
        assert np.array_equal(getattr(found, name), getattr(again, name))
        assert np.array_equal(getattr(found, name), getattr(more, name))
    assert list(found.as_record()) == ["dimension", "size", *PARTS]
    assert again.dimension == 2 and [len(getattr(found, name)) for name in PARTS] == [40, 121, 0, 27]
    assert np.abs(found.chirality).min() > 1e-6  # this shape has a hand by each of them


@pytest.mark.parametrize("turn", [1.0, np.exp(0.7j), -1j])
@pytest.mark.parametrize("scale", [1e-4, 1.0, 30.0])
@pytest.mark.parametrize("is_mirrored", [False, True])
def test_flat_invariants_are_products_of_complex_moments_however_a_shape_lies(turn, scale, is_mirrored):
    """c_pq = E[z^p conj(z)^q] of z about the centroid by the radius of gyration; of two of them with one p - q, and of
    three, one of which has the p - q of both others."""
    corners = np.array([0.0, 3.0 + 0.25j, 2.5 + 1.0j, 1.0 + 1.0j, 1.25 + 2.5j, 2.0j])
    shares, weights = triangle_rule(8)
    pieces = [corners[[0, k, k + 1]] for k in range(1, 5)]
    double = [((b - a).conjugate() * (c - a)).imag for a, b, c in pieces]
    z, mass = np.array(pieces) @ shares, np.array(double)[:, None] * weights
    mass /= mass.sum()
    z = z - (mass * z).sum()
    size = np.sqrt((mass * np.abs(z) ** 2).sum())
    z /= size
    c = {(n - q, q): (mass * z ** (n - q) * z.conj() ** q).sum() for n in range(7) for q in range(n // 2 + 1)}
    turning = [(p, q) for p, q in c if p > q and p + q > 1]
    low = [key for key in turning if sum(key) < 5]
    pairs = [(a, b) for a, b in combinations_with_replacement(turning, 2) if a[0] - a[1] == b[0] - b[1]]
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


@pytest.mark.parametrize("order", [6, 8, 12])
def test_a_flat_signature_s_error_is_what_eight_units_of_rounding_make_of_it(order):
    """Of a shape in the unit disc no c_pq is the sum of more than 2^(s/2) times its area, s = p + q."""
    edges = directed_edges([range(6)])
    points = np.array([[0, 0], [3, 0.25], [2.5, 1], [1, 1], [1.25, 2.5], [0, 2.0]]) / 4.0
    moments = region_moments(points, edges, order).about_center()
    radius = float(np.linalg.norm(points - moments.about[:2], axis=1).max())
    found = flat_signature(moments, radius)

    def most(n, m):
        """Of |A_nm|, by the sizes of the coefficients of R_nm."""
        last = (n - m) // 2
        sizes = (
            (factorial(n - k) / factorial(k) / factorial(last + m - k) / factorial(last - k), n - 2 * k)
            for k in range(last + 1)
        )
        return sqrt((n + 1) / pi) * sum(size * 2.0 ** (s / 2.0) for size, s in sizes)

    limit = max(most(n, m) for n in range(order + 1) for m in range(n % 2, n + 1, 2))
    assert U * found.zernike.max() < found.error < 8.0 * U * limit * moments.total / radius**2


@pytest.mark.parametrize("damage", [{"zernike": []}, {"size": None}, {"chirality": [1.0]}, {"invariants": [None, "x"]}])
def test_a_damaged_record_is_refused(damage):
    record = {**plain(signed(shapes.WEDGE, 6).as_record()), **damage}
    with refused("signature_unrecognized", "signature_incomplete"):
        Signature.from_record(record)
    del record["size"]
    with refused("signature_unrecognized"):
        Signature.from_record(record)


@pytest.mark.parametrize(
    "name, most", [("zernike", 1e100), ("invariants", 1e100), ("fourier", 1e100), ("chirality", 1e100), ("size", 1e150)]
)
def test_numbers_of_a_record_may_be_as_large_as_their_squares_are_numbers(name, most):
    record = plain(signed(shapes.WEDGE, 6).as_record())
    sides = [1.0] if name == "size" else [1.0, -1.0]
    for sign in sides:
        for share in (0.99, 1.01, np.inf, np.nan):
            value = sign * share * most
            changed = {**record, name: value if name == "size" else [*record[name][:-1], value]}
            if share == 0.99:
                assert np.max(np.abs(getattr(Signature.from_record(changed), name))) == 0.99 * most
            else:
                with refused("signature_incomplete"):
                    Signature.from_record(changed)
    for size, is_known in ((1.01e-150, True), (0.99e-150, False), (0.0, False), (-1.0, False)):
        changed = {**record, "size": size}
        if is_known:
            assert Signature.from_record(changed).size == size
        else:
            with refused("signature_incomplete"):
                Signature.from_record(changed)


def test_a_library_has_entries_and_a_finding_for_each_body_without_a_signature(tmp_path):
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
    lines = [json.dumps({"file": "ä.blend", "objects": records}, ensure_ascii=False), "", json.dumps(last)]
    path.write_text("\n".join(lines), encoding="utf-8")
    entries, missing = read_library(path)
    assert [entry.label for entry in entries] == ["ä.blend:A", "E"]
    assert missing == [
        Finding("record_without_shape", {"name": "ä.blend:B"}),
        Finding("record_without_signature", {"name": "ä.blend:C"}),
        Finding("record_without_signature", {"name": "ä.blend:D"}),
    ]


@pytest.mark.parametrize(
    "line", [b"{", b"[]", b'{"objects": 3}', b'{"objects": [3]}', b'{"objects": [{"name": "\xff"}]}']
)
def test_a_line_that_is_no_document_is_refused_by_its_number(line, tmp_path):
    path = tmp_path / "parts.jsonl"
    path.write_bytes(b'{"objects": []}\n' + line)
    with refused("library_line", file="parts.jsonl", line=2):
        read_library(path)
