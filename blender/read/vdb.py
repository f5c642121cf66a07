# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A grid of a volume, read by Blender's openvdb module in blocks, without the empty space.

An OpenVDB tree has nodes of 4096, 128 and 8 voxels a side; the depth of a value shows if its node
of 128 exists.
"""

import importlib
from collections.abc import Iterator
from itertools import product
from types import ModuleType

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.bodies import GRID_TOO_LARGE
from ...core.mesh import Surface
from ...core.moments import affine_matrices
from ...core.verdict import ReadError
from .findings import GRID_UNREADABLE, GRID_UNSUPPORTED, NEEDS_OPENVDB, NO_SCALARS

NODE_VOXELS = 128  # voxels along a side of the blocks that are read
ROOT_VOXELS = 4096  # along a side of the largest nodes
MAX_ROOTS = 100_000
MAX_INDEX = 1 << 29  # above this index the module fails silently
DTYPES = {
    "float": np.float32,
    "double": np.float64,
    "int32": np.int32,
    "int64": np.int64,
    "bool": np.bool_,
}


def openvdb() -> ModuleType | None:
    """Return the module that comes with Blender, or None if this Blender was built without it."""
    bpy.utils.expose_bundled_modules()
    try:
        return importlib.import_module("openvdb")
    except ImportError:
        return None


class VdbGrid:
    """A grid of a .vdb file.

    low, shape: (3,) the box of its active voxels, in voxels. background: value of all other voxels.
    level_set: true if the file marks the grid as one. to_object: (4, 4) from voxels. Raises
    ReadError if the grid cannot be measured.
    """

    def __init__(self, path: str, name: str) -> None:
        module = openvdb()
        if module is None:
            raise ReadError(GRID_UNSUPPORTED, fault=NEEDS_OPENVDB, grid=name)
        try:
            self._grid = module.read(path, name)
        except (RuntimeError, KeyError, TypeError, OSError) as error:
            raise ReadError(GRID_UNREADABLE, grid=name, error=str(error).rstrip(".")) from error
        if self._grid.valueTypeName not in DTYPES:
            raise ReadError(GRID_UNSUPPORTED, fault=NO_SCALARS, grid=name)
        self._dtype = DTYPES[self._grid.valueTypeName]
        transform = self._grid.transform
        if not transform.isLinear:
            raise ReadError(
                GRID_UNSUPPORTED,
                fault="has a frustum transform. Resample it with a linear transform",
                grid=name,
            )
        self.background = float(self._grid.background)
        self.level_set = self._grid.gridClass == "level set"
        places = np.array(
            [
                transform.indexToWorld(voxel)
                for voxel in ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))
            ]
        )
        self.to_object = affine_matrices((places[1:] - places[0]).T, places[0])
        low, high = (np.array(end, np.int64) for end in self._grid.evalActiveVoxelBoundingBox())
        if self._grid.activeVoxelCount() == 0:
            low = np.zeros(3, np.int64)
            high = np.full(3, -1)
        self.low = low
        self.shape = high - low + 1
        if np.prod(high // ROOT_VOXELS - low // ROOT_VOXELS + 1.0) > MAX_ROOTS:
            raise ReadError(GRID_TOO_LARGE, grid=name, samples=self.shape.tolist())
        if np.abs([low, high]).max() > MAX_INDEX:
            raise ReadError(
                GRID_UNSUPPORTED,
                fault="has voxel indices too far from zero. Move its origin nearer",
                grid=name,
            )

    def blocks(self) -> Iterator[tuple[tuple[int, int, int], NDArray]]:
        """Yield the stored voxels, as blocks, each with its offset in the box."""
        values = self._grid.getConstAccessor()
        background = self._grid.background

        def is_empty(corner: tuple[int, int, int], depth: int) -> bool:
            """Return whether no node of the tree at this depth begins at a corner."""
            is_stored = values.getValueDepth(corner) >= depth
            return not is_stored and values.getValue(corner) == background

        end = self.low + self.shape
        for root in _cells(self.low, end, ROOT_VOXELS):
            if is_empty(root, 1):
                continue
            root_low = np.maximum(root, self.low)
            root_end = np.minimum(np.array(root) + ROOT_VOXELS, end)
            for node in _cells(root_low, root_end, NODE_VOXELS):
                if is_empty(node, 2):
                    continue
                first = np.maximum(node, self.low)
                node_end = np.minimum(np.array(node) + NODE_VOXELS, end)
                array = np.zeros(node_end - first, self._dtype)
                self._grid.copyToArray(array, ijk=tuple(first.tolist()))
                is_used = array != self._dtype(background)
                if is_used.any():  # a node may be empty but for a corner
                    used = [
                        np.flatnonzero(is_used.any(axis=other_axes))
                        for other_axes in ((1, 2), (0, 2), (0, 1))
                    ]
                    offset = first - self.low + [indices[0] for indices in used]
                    box = tuple(slice(indices[0], indices[-1] + 1) for indices in used)
                    yield tuple(offset.tolist()), array[box]

    def polygons(self) -> Surface:
        """Return the zero surface of a level set, in the object's coordinates, facing outward."""
        points, _triangles, quads = self._grid.convertToPolygons()  # only quads without adaptivity
        return Surface(
            np.ascontiguousarray(points, np.float32),
            quads=np.ascontiguousarray(quads[:, ::-1], np.int32),
        )


def _cells(low: NDArray, end: NDArray, size: int) -> Iterator[tuple[int, int, int]]:
    """Yield the corners of the cells of `size` that hold voxels of the box."""
    i, j, k = (range(int(a) // size * size, int(b), size) for a, b in zip(low, end))
    return product(i, j, k)
