# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Connected components, compared with a walk from node to node."""

import numpy as np
import pytest
from body_moments.core.numerics.graph import connected_components


def walked(count, a, b):
    """The component of each node, numbered in the order of their first nodes."""
    links = [[] for _ in range(count)]
    for i, j in zip(a.tolist(), b.tolist()):
        links[i].append(j)
        links[j].append(i)
    component, number = [-1] * count, 0
    for first in range(count):
        if component[first] < 0:
            waiting, component[first] = [first], number
            while waiting:
                for other in links[waiting.pop()]:
                    if component[other] < 0:
                        component[other] = number
                        waiting.append(other)
            number += 1
    return component, number


@pytest.mark.parametrize(
    "count, links",
    [(1, 0), (5, 0), (40, 15), (60, 50), (200, 150), (300, 2000), (200_000, 250_000)],
)
@pytest.mark.parametrize("seed", range(3))
def test_components_match_a_walk(count, links, seed):
    a, b = np.random.default_rng(seed).integers(0, count, (2, links))
    component, number = connected_components(count, a, b)
    assert (component.tolist(), number) == walked(count, a, b)


@pytest.mark.parametrize("count", [100, 40_000])
@pytest.mark.parametrize("kind", ["chain", "backwards", "zigzag"])
def test_long_paths_are_one_component(kind, count):
    """A second component lies beside each path."""
    order = {
        "chain": np.arange(count),
        "backwards": np.arange(count)[::-1],
        "zigzag": np.stack(
            [np.arange(count // 2), count - 1 - np.arange(count // 2)], axis=1
        ).ravel(),
    }[kind]
    a, b = np.append(order[:-1], count + 1), np.append(order[1:], count)
    component, number = connected_components(count + 2, a, b)
    assert number == 2 and component.tolist() == [0] * count + [1, 1]
