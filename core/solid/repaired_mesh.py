# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The mesh that the steps of a repair hand on to each other.

No step changes the mesh that it receives.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, TypeVar

import numpy as np

from .. import mesh, verdict
from ..numerics import Array, Floats, Index, Integers, Mask, NDArray
from .boundary_loops import side_ends

NO_EDGES = np.empty((0, 2), np.intp)
NO_INDICES = np.empty(0, np.intp)
Record = TypeVar("Record")
# A value that no step has found yet: the order of the steps ensures that none reads it before.
UNKNOWN: Any = None


def copy_with(record: Record, **values: Any) -> Record:
    """Return a copy of a dataclass with other values, twenty times faster than
    `dataclasses.replace`.
    """
    copy = object.__new__(type(record))
    copy.__dict__.update(record.__dict__, **values)
    return copy


@dataclass(frozen=True, eq=False)
class OpenParts:
    """Connected parts that are not closed; only these may be welded.

    `rows`: their triangles with three different vertices; all such if `are_all`. `vertices`: their
    vertices along open edges, or all if no edge is known, sorted.
    """

    rows: Index
    vertices: Index
    are_all: bool


@dataclass(frozen=True, eq=False)
class ZeroAreaLoops:
    """Boundary loops without area (T-junctions): there the surface closes in space, though not in
    the mesh.

    `sides`, `loop`: (k,) their sides, and the loop of each, 0 to `number` - 1. `first`, `second`,
    `misoriented`: (l,) the two sides of each joint; True if the faces there disagree.
    """

    sides: Index
    loop: Index
    number: int
    first: Index
    second: Index
    misoriented: Mask


@dataclass(frozen=True, eq=False)
class FoldedLoops:
    """The `number` loops without area that remain in components with edges of three faces or more.

    `components`: (c,) mask of those components that close. `sides`, `caps`: (k,) and (k, 3)
    triangles that close them.
    """

    components: Mask
    sides: Index
    caps: Index
    number: int


@dataclass(frozen=True, eq=False)
class RepairState:
    """Knowledge of earlier steps for later ones; dropped when the repair is done.

    `given`: (t, 3) triangles over the input's vertices; side 3t + i runs from corner i of triangle
    t to the next one. `tolerance`: positions nearer than this (unit) count as equal at open edges,
    and loops narrower than this have no area. `edges`: of the triangles with three different
    vertices, with sides numbered as if there were no others; `component_edges`: with vertices of
    its own for each component. `one_sided`: (c,) mask of components in which faces
    cannot agree, as on a Möbius strip. `uncapped_sides`: (k,) boundary sides that bound no gap, of
    components that may still be closed.
    """

    given: Index
    tolerance: float
    edges: mesh.Edges = UNKNOWN
    component_edges: mesh.Edges = UNKNOWN
    open_parts: OpenParts | None = None
    gaps: ZeroAreaLoops = UNKNOWN
    folded: FoldedLoops = UNKNOWN
    one_sided: Mask = UNKNOWN
    uncapped_sides: Index = field(default_factory=NO_INDICES.view)


@dataclass(frozen=True, eq=False)
class RepairedMesh:
    """A surface as triangles, repaired as far as the steps have come.

    `points`: (n, 3) in the input's type and unit. `triangles`: (t, 3) vertices; in the end all face
    as `flipped` says, caps last. `face`: (t,) mesh face of each triangle, -1 for caps. `flipped`:
    (t,) triangles that are, or are to be, reversed. `component`: (t,) 0 to `number` - 1. `open`:
    (number,) components that cannot be closed. `caps`: (number, 3) number of flat caps, of curved
    caps, and their area (unit²). `report`: the input as far as the steps have seen it; its edges
    are pairs of the surface's vertices. `topology_changed`: True if the triangles, apart from their
    direction and from caps, differ from the input's. `max_displacement`: largest displacement of a
    vertex by welding (unit). `left_out`: (k,) mesh faces that are surplus copies of others, sorted.
    `capped_edges`, `capped_component`: (k, 2) boundary edges of capped holes, and (k,) their
    components. `findings`: decisions, except for welding and caps, which depend on the volume.
    """

    points: Floats
    triangles: Integers
    face: Integers
    flipped: Mask
    component: Index
    number: int
    open: Mask
    caps: Array
    report: verdict.MeshHealth
    topology_changed: bool = False
    max_displacement: float = 0.0
    left_out: Integers = field(default_factory=NO_INDICES.view)
    capped_edges: Index = field(default_factory=NO_EDGES.view)
    capped_component: Index = field(default_factory=NO_INDICES.view)
    findings: tuple[verdict.Finding, ...] = ()
    state: RepairState = UNKNOWN

    def with_state(self, **changes: Any) -> RepairedMesh:
        """Return the mesh with more knowledge for later steps."""
        return copy_with(self, state=copy_with(self.state, **changes))

    def with_report(
        self, *, elements: dict[str, Integers] | None = None, **counts: Any
    ) -> RepairedMesh:
        """Return the mesh with entries of its report replaced. elements: entries of its
        `DefectiveElements`.
        """
        if elements:
            counts["defective_elements"] = copy_with(self.report.defective_elements, **elements)
        return copy_with(self, report=copy_with(self.report, **counts))

    def with_findings(self, *findings: verdict.Finding) -> RepairedMesh:
        """Return the mesh with more findings."""
        return copy_with(self, findings=(*self.findings, *findings))

    def with_rows(self, rows: Integers) -> RepairedMesh:
        """Return the mesh of some of the triangles alone. Their edges are not known."""
        return copy_with(
            self,
            triangles=self.triangles[rows],
            face=self.face[rows],
            flipped=self.flipped[rows],
            component=self.component[rows],
            state=copy_with(self.state, given=self.state.given[rows], edges=UNKNOWN),
        )

    def with_caps(self, caps: Integers, owner: Integers) -> RepairedMesh:
        """Return the mesh with caps added. owner: (k,) a triangle of each cap's component."""
        return copy_with(
            self,
            triangles=np.concatenate([self.triangles, caps]),
            face=np.concatenate([self.face, np.full(len(caps), -1)]),
            flipped=np.concatenate([self.flipped, np.zeros(len(caps), bool)]),
            component=np.concatenate([self.component, self.component[owner]]),
        )

    def oriented_ends(self, sides: Integers) -> tuple[NDArray, NDArray]:
        """Return the start vertices and the end vertices of sides once the faces are turned."""
        start, stop = side_ends(self.triangles, sides)
        flipped = self.flipped[sides // 3]
        return np.where(flipped, stop, start), np.where(flipped, start, stop)

    def faces_of(self, components: Mask) -> Integers:
        """Return the mesh faces of some components, sorted."""
        return np.unique(self.face[components[self.component] & (self.face >= 0)])
