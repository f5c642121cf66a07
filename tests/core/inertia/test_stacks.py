# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A stack of bodies is each of them: moments, mass properties and frames with a leading axis."""

import numpy as np
import pytest
from body_moments.core.inertia.mass_properties import MassProperties
from body_moments.core.inertia.principal_frames import principal_frame, principal_frames
from body_moments.core.inertia.third_moment_frames import third_moment_frames
from body_moments.core.moments import Measure, stack_moments, sum_of_images

from tests.close import close
from tests.core import bodies, shapes
from tests.core.recursion import moments

PARTS = {**shapes.ASYMMETRIC, **{name: part for name, (part, _) in shapes.SYMMETRIC.items()}}
SIXTH = {name: moments(part, 6) for name, part in PARTS.items()}
RNG = np.random.default_rng(14)


def placed(count):
    """Similar maps, every third one mirrored; far away, tiny and huge."""
    matrices = np.tile(np.eye(4), (count, 1, 1))
    for i, matrix in enumerate(matrices):
        matrix[:3, :3] = (
            bodies.rotation(i) * 10.0 ** RNG.uniform(-4, 4) * (-1.0 if i % 3 == 2 else 1.0)
        )
        matrix[:3, 3] = RNG.normal(size=3) * 10.0 ** RNG.uniform(-3, 5)
    return matrices


def same(stack, i, alone):
    assert close(stack.about[i], alone.about, 1e-13)
    assert (np.abs(stack.raw[i] - alone.raw) <= alone.rounding_error).all()
    assert close(stack.rounding_error[i], alone.rounding_error, 1e-9)
    assert close(stack.input_error[i], alone.input_error, 1e-9)


def test_stacked_moments_match_single_bodies():
    parts = [found.truncate(3) for found in SIXTH.values()]
    stack, matrices = stack_moments(parts), placed(len(PARTS))
    points, factors = RNG.normal(size=(len(parts), 3)), RNG.uniform(0.1, 9.0, len(parts))
    images, shifted, scaled = stack.transform(matrices), stack.about_point(points), stack * factors
    turned = stack.in_frame(np.array([bodies.rotation(i) for i in range(len(parts))]), points)
    assert (
        stack.order == 3 and (images.total == [images.at(i).total for i in range(len(parts))]).all()
    )
    for i, part in enumerate(parts):
        same(images, i, part.transform(matrices[i]))
        same(shifted, i, part.about_point(points[i]))
        same(scaled, i, part * float(factors[i]))
        found = part.in_frame(bodies.rotation(i), points[i])
        assert (np.abs(turned.raw[i] - found.raw) <= found.rounding_error).all()
        close(images.center[i], sum_of_images(part, matrices[i : i + 1]).center, 1e-14)


def test_stretched_stack_has_no_areas():
    area = stack_moments([found.truncate(0) for found in SIXTH.values()])
    matrices = placed(len(PARTS))
    matrices[3, 0, :3] *= 2.0
    with pytest.raises(ValueError, match="similarity"):
        type(area)(area.raw, area.about, Measure.AREA).transform(matrices)


def test_stacked_frames_match_single_bodies():
    matrices = placed(len(PARTS))
    parts = [part.transform(matrix) for part, matrix in zip(SIXTH.values(), matrices)]
    sixth = stack_moments(parts)
    preferred = np.array([bodies.rotation(100 + i) for i in range(len(parts))])
    density = RNG.uniform(1e-3, 1e4, len(parts))
    third = sixth.truncate(3)
    stack = MassProperties.of_stack(
        third,
        density,
        preferred,
        third_moment_frames(third),
    )
    for i, part in enumerate(parts):
        alone = MassProperties.from_moments(part.truncate(3), float(density[i]), preferred[i])
        found = stack.at(i)
        for name in ("mass", "center", "inertia"):
            assert (
                np.abs(getattr(found, name) - getattr(alone, name)).max()
                <= alone.rounding_error[name]
            )
        for bound in ("rounding_error", "input_error"):
            for name, value in getattr(alone, bound).items():
                assert close(getattr(found, bound)[name], value, 1e-9), name
        assert (
            np.abs(found.principal.moments - alone.principal.moments).max()
            <= alone.rounding_error["inertia"]
        )
        assert np.abs(found.principal.axes - alone.principal.axes).max() < 1e-12
        for name in ("symmetry", "is_unique", "finding", "undetermined_axes"):
            assert getattr(found.principal, name) == getattr(alone.principal, name)


def test_one_body_or_some_are_taken_out_of_a_stack():
    """A single body yields Python's own numbers."""
    parts = stack_moments([SIXTH[name].truncate(3) for name in ("wedge", "box", "cube")])
    stack = MassProperties.of_stack(
        parts, np.array([2.0, 3.0, 5.0]), np.tile(np.eye(3), (3, 1, 1)), third_moment_frames(parts)
    )
    some, one = stack.at([2, 0]), stack.at(2)
    assert (
        some.mass.tolist() == [stack.mass[2], stack.mass[0]]
        and type(one.mass) is float
        and one.mass == stack.mass[2]
    )
    assert (some.center == stack.center[[2, 0]]).all() and (one.center == stack.center[2]).all()
    assert (some.inertia == stack.inertia[[2, 0]]).all() and (one.inertia == stack.inertia[2]).all()
    for name in ("rounding_error", "input_error"):
        for key, values in getattr(stack, name).items():
            assert getattr(some, name)[key].tolist() == [values[2], values[0]]
            assert type(getattr(one, name)[key]) is float and getattr(one, name)[key] == values[2]
    frames, alone = some.principal, one.principal
    assert frames.is_unique.tolist() == [False, True] and alone.is_unique is False
    assert frames.symmetry.tolist() == ["isotropic", "asymmetric"] and alone.symmetry == "isotropic"
    assert frames.undetermined_axes.tolist() == [(0, 1, 2), ()] and alone.undetermined_axes == (
        0,
        1,
        2,
    )
    assert [found and found.code for found in frames.finding] == ["axes_free", None]
    assert alone.finding.code == "axes_free"
    for entry in ("moments", "axes"):
        assert (getattr(frames, entry) == getattr(stack.principal, entry)[[2, 0]]).all()
        assert (getattr(alone, entry) == getattr(stack.principal, entry)[2]).all()


@pytest.mark.parametrize("name", PARTS)
def test_copies_share_the_axes_of_their_shape(name):
    """However a copy is turned and scaled, its frame is its shape's, turned with it."""
    matrices = placed(6)
    matrices = matrices[np.linalg.det(matrices[:, :3, :3]) > 0.0]
    scale = np.cbrt(np.linalg.det(matrices[:, :3, :3]))
    rotation = matrices[:, :3, :3] / scale[:, None, None]
    third = SIXTH[name].truncate(3)
    stack = principal_frames(
        third_moment_frames(stack_moments([third.transform(matrix) for matrix in matrices])),
        rotation,
    )
    alone = principal_frame(third)
    for i, turn in enumerate(rotation):
        assert stack.finding[i] == alone.finding and stack.symmetry[i] == alone.symmetry
        assert np.abs(turn.T @ stack.axes[i] - alone.axes).max() < 1e-7
