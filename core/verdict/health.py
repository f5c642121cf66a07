# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The state of a surface before any repair, and its defective elements."""

from dataclasses import dataclass, field, fields
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from .findings import FLIPPED_FACES, SELF_INTERSECTION

NO_PAIRS = np.empty((0, 2), np.int64)
EMPTY = np.empty(0, np.int64)


class Intersection(StrEnum):
    """Result of a search for self-intersections; for several surfaces, the first member that any of
    them has.
    """

    FOUND = "found"
    NOT_CHECKED = "not_checked"
    NOT_FOUND = "not_found"  # a search found none
    EXCLUDED = "excluded"  # proved to be impossible


@dataclass(frozen=True, eq=False)
class DefectiveElements:
    """Elements with defects, in the input mesh's own numbers, sorted: faces (k,), edges (k, 2) as
    vertex pairs.

    flipped_faces: turned to agree with the rest of their part (not in a part that is inside out as
    a whole). boundary_edges, non_manifold_edges, inconsistent_edges: as counted in `MeshHealth`,
    but each with all the mesh's edges that lie there. duplicate_faces: the later copies.
    degenerate_faces: faces without area.
    """

    flipped_faces: NDArray[np.integer] = field(default_factory=EMPTY.view)
    boundary_edges: NDArray[np.integer] = field(default_factory=NO_PAIRS.view)
    non_manifold_edges: NDArray[np.integer] = field(default_factory=NO_PAIRS.view)
    inconsistent_edges: NDArray[np.integer] = field(default_factory=NO_PAIRS.view)
    duplicate_faces: NDArray[np.integer] = field(default_factory=EMPTY.view)
    degenerate_faces: NDArray[np.integer] = field(default_factory=EMPTY.view)


@dataclass(frozen=True, eq=False)
class MeshHealth:
    """Defects of the input, before any repair, and the extent of the repair.

    closed: True if the surface closes in space: equal positions count as one, gaps without area as
    closed. welded: True if positions had to be welded to find that out. boundary_edges: edges with
    one face, after that welding, unless the gap that they bound has no area. non_manifold_edges:
    edges with more than two faces. inconsistent_edges: edges with two faces that run the same way.
    components: parts connected across edges. inverted_components: parts inside out.
    nested_components: outward parts in
        the material of others, counted twice. cavities: inward parts in the material of others.
        overlapping_components: parts that share a piece of their interiors with another one, or are
        a copy of it.
    duplicate_faces: later copies of faces. degenerate_faces: faces without area. non_planar_faces,
    volume_spread: faces
        that are not flat, and the volume (unit³) that the choice of their diagonals can change.
    cap_area_share: the area of the caps that were needed, divided by the area of the faces.
    self_intersection: the result of the search for components that go through themselves.
    """

    closed: bool
    welded: bool = False
    boundary_edges: int = 0
    non_manifold_edges: int = 0
    inconsistent_edges: int = 0
    components: int = 1
    inverted_components: int = 0
    nested_components: int = 0
    cavities: int = 0
    overlapping_components: int = 0
    duplicate_faces: int = 0
    degenerate_faces: int = 0
    non_planar_faces: int = 0
    volume_spread: float = 0.0
    cap_area_share: float = 0.0
    self_intersection: Intersection = Intersection.NOT_CHECKED
    defective_elements: DefectiveElements = field(default_factory=DefectiveElements)

    def as_record(self) -> dict:
        """Return plain values for JSON, with the flipped faces as the only defective elements."""
        record = {
            entry.name: getattr(self, entry.name)
            for entry in fields(self)
            if entry.name != "defective_elements"
        }
        record[SELF_INTERSECTION] = str(self.self_intersection)
        record[FLIPPED_FACES] = self.defective_elements.flipped_faces.tolist()
        return record
