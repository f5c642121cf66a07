# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The kernels' scratch: which arrays share memory, and what is kept."""

import weakref

import numpy as np
from body_moments.core.polyhedron.workspace import ROW_PADDING, Workspace


class Block:
    def __init__(self, workspace, rows, columns):
        self.first = workspace.take(rows, columns)
        (self.second, self.third), (self.longest,), (self.short,) = workspace.overlay(
            [(rows, columns), (columns,)], [(2 * rows, columns)], [(columns,)]
        )
        self.last = workspace.take(columns)

    def arrays(self):
        return self.first, self.second, self.third, self.longest, self.short, self.last


def test_only_the_groups_of_an_overlay_share_memory_and_arrays_do_not_follow_on_each_other():
    block = Workspace(Block).block((3, 64), (3 + 6 + 1) * 64)
    shared = {(1, 3), (2, 3), (1, 4), (3, 4)}
    arrays = block.arrays()
    assert [array.shape for array in arrays] == [(3, 64), (3, 64), (64,), (6, 64), (64,), (64,)]
    for i, one in enumerate(arrays):
        assert one.flags.c_contiguous and one.ctypes.data % 64 == 0
        for j, other in enumerate(arrays[i + 1 :], i + 1):
            assert np.shares_memory(one, other) == ((i, j) in shared)
            if (i, j) not in shared and one is not block.third:  # which the short one is before
                assert other.ctypes.data - (one.ctypes.data + one.nbytes) >= 8 * ROW_PADDING


def test_a_block_is_kept_until_another_shape_is_asked_for_and_never_beside_it():
    alive = []

    def make(workspace, *shape):
        alive.append(sum(ref() is not None for ref in made))
        block = Block(workspace, *shape)
        made.append(weakref.ref(block))
        return block

    made = []
    workspace = Workspace(make)
    first = workspace.block((3, 64), 640)
    assert workspace.block((3, 64), 640) is first
    place = first.first.ctypes.data
    del first
    smaller = workspace.block((2, 64), 448)
    assert smaller.first.ctypes.data == place  # in the same buffer
    del smaller
    workspace.block((3, 6400), 64000)
    assert len(made) == 3 and alive == [0, 0, 0]
