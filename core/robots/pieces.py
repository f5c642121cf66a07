# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measured shapes of links, and a link's geometry as a hull and as an evenly filled body."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import product
from math import pi, radians
from pathlib import Path

import numpy as np

# Robots without meshes start without the modules of these packages.
from .. import solid
from ..mesh import Surface
from ..moments import SECOND_MOMENT_INDEX, Moments
from ..numerics import Array, NDArray, first_occurrence, inertia_of_second
from ..verdict import Finding, MeasureError, Procedure, finding
from . import read
from .comparison import Reference
from .entries import Entry
from .findings import AUDIT_ANGLES
from .model import Pose, Shape
from .plausibility import Hull, spread_directions
from .primitives import primitive_moments
from .read.mjcf_meshes import CLOSED
from .read.roots import Roots
from .stated import StatedShape, rotation_of_angles
from .totals import Body

BALL = 2000  # points of a ball
MOST_POINTS = 10_000_000  # points of measured meshes that are kept for other links and files
ROUND = 1.01  # Factor that encloses a round shape, of which only some points are known.
RELIABLE = (Procedure.EXACT, Procedure.REORIENTED, Procedure.CAPPED)


@dataclass(frozen=True, eq=False)
class Piece:
    """A measured shape in its own coordinates: hull points, moments if certain, the rotation to z
    up, if any, and the moments of the mass that it states, kg, if any.
    """

    points: Array
    moments: Moments | None
    upright: Array | None = None
    mass: Moments | None = None

    def placed(self, pose: Pose) -> Piece:
        """Return the piece in the coordinates in which its own have a pose."""
        moments, mass = (
            None if one is None else one.transform(pose.matrix) for one in (self.moments, self.mass)
        )
        return Piece(pose.apply(self.points), moments, mass=mass)


Pieces = Sequence[tuple[StatedShape, Piece]]


@dataclass
class Measurer:
    """A measurer of shapes, which measures each mesh once, even if several links name it.

    meshes: measured meshes, which several measurers may share.
    """

    roots: Roots
    meshes: dict[tuple, Piece] = field(default_factory=dict)

    def measure(self, shapes: Iterable[StatedShape]) -> tuple[Pieces, list[Entry]]:
        """Return the measured shapes, and entries about shapes that cannot be measured."""
        pieces = []
        unread: dict[Finding, Entry] = {}
        for stated in shapes:
            try:
                pieces.append((stated, self._piece(stated)))
            except MeasureError as error:
                unread.setdefault(error.finding, Entry(error.finding, stated.place))
        return pieces, [*unread.values()]

    def _piece(self, stated: StatedShape) -> Piece:
        """Return a measured shape in its own coordinates; raise MeasureError if its mesh cannot be
        read.
        """
        shape, weight = stated.shape, stated.weight
        if shape.kind != "mesh":
            piece = primitive(shape)
            return replace(piece, mass=weight.moments(shape)) if weight else piece
        # Meshes of an included SDF model or an attached one of MJCF are beside its file.
        roots = self.roots.at(Path(stated.beside).parent) if stated.beside else self.roots
        source = shape.surface or roots.find(shape.file)
        key = source, shape.size, stated.fit, weight
        piece = self.meshes.get(key)
        if piece is None:
            surface, upright = (
                read.meshes.read_mesh(source) if isinstance(source, Path) else (source, None)
            )
            surface = surface.transform(np.diag(shape.size))
            fit = stated.fit.shape(surface) if stated.fit else None
            piece = _measured(surface, upright) if fit is None else primitive(fit)
            if weight:
                filled = replace(shape, surface=surface) if fit is None else fit
                if weight.inertia != CLOSED:
                    piece = replace(piece, mass=weight.moments(filled))
                elif piece.moments is not None:
                    piece = replace(piece, mass=weight.fill(piece.moments))
            piece = piece if fit is None else piece.placed(fit.pose)
            if sum(len(other.points) for other in [*self.meshes.values()]) > MOST_POINTS:
                self.meshes.clear()
            self.meshes[key] = piece
        return piece


@dataclass(frozen=True, eq=False)
class Geometry:
    """A link's measured shapes. is_whole: False if some are unknown; then nothing is compared."""

    pieces: Pieces
    is_whole: bool

    @cached_property
    def hull(self) -> Hull | None:
        """The hull of all shapes, None if it is unknown."""
        points = [stated.shape.pose.apply(piece.points) for stated, piece in self.pieces]
        return Hull(np.concatenate(points)) if points and self.is_whole else None

    @cached_property
    def references(self) -> dict[str, Reference]:
        """The evenly filled geometry by role, of roles whose bodies are all certain."""
        roles = ("visual", "collision") if self.is_whole else ()
        references = ((role, _reference(self._of_role(role))) for role in roles)
        return {role: reference for role, reference in references if reference is not None}

    def upright(self) -> Geometry | None:
        """Return the geometry with the up axes of its mesh files as z; None if they are."""
        if all(piece.upright is None for _, piece in self.pieces):
            return None
        turned = [
            (
                stated,
                piece.placed(Pose(rotation=piece.upright)) if piece.upright is not None else piece,
            )
            for stated, piece in self.pieces
        ]
        return replace(self, pieces=turned)

    def in_degrees(self) -> Iterator[tuple[Finding, Reference]]:
        """Yield, for each role with angles, the finding and the geometry if those angles were meant
        in degrees.
        """
        for role in self.references:
            turned = []
            for stated, piece in self._of_role(role):
                shape = stated.shape
                if stated.angles is not None:
                    turn = rotation_of_angles(*map(radians, stated.angles))
                    shape = replace(shape, pose=Pose(shape.pose.position, turn))
                turned.append((replace(stated, shape=shape), piece))
            reference = _reference(turned)
            if reference is not None and any(any(stated.angles or ()) for stated, _ in turned):
                change = finding(AUDIT_ANGLES, part="geometry", unit="degrees", wanted="radians")
                yield change, reference

    def _of_role(self, role: str) -> Pieces:
        return [(stated, piece) for stated, piece in self.pieces if stated.role == role]


def _measured(surface: Surface, upright: NDArray | None = None) -> Piece:
    """Return a surface's points, with the moments of the body that it bounds if they are
    certain.
    """
    points = np.asarray(surface.points, np.float64)
    first = first_occurrence(*points.T.copy())
    points = points[first == np.arange(len(first))]  # Many files repeat them for each triangle.
    try:
        body = solid.measure_solid(surface)
    except MeasureError:
        return Piece(points, None, upright)
    certain = Procedure(body.method) in RELIABLE and body.volume.raw[0] > 0.0
    return Piece(points, body.volume if certain else None, upright)


def _reference(pieces: Pieces) -> Reference | None:
    """Return all shapes of one role as evenly filled geometry; None if there is none, or one bounds
    no certain body.
    """
    if not pieces:
        return None
    whole = Body()
    for stated, piece in pieces:
        if piece.moments is None:
            return None
        own = piece.moments.transform(stated.shape.pose.matrix).about_center()
        inertia = inertia_of_second(own.raw[SECOND_MOMENT_INDEX])
        whole = whole.add(Body(float(own.raw[0]), own.about, inertia))
    if whole.center is None or whole.inertia is None:
        return None
    origins = tuple(stated.shape.pose.position for stated, _ in pieces)
    return Reference(whole.mass, whole.center, whole.inertia / whole.mass, origins)


def primitive(shape: Shape) -> Piece:
    """Return a primitive in its own frame, with its moments, and (n, 3) points whose hull encloses
    it.
    """
    if shape.kind == "box":
        points = np.array([*product((-0.5, 0.5), repeat=3)]) * shape.size
    elif shape.kind in ("sphere", "ellipsoid"):
        points = spread_directions(BALL) * shape.size * ROUND
    else:
        radius, length = shape.size
        if shape.kind == "capsule":
            ring = spread_directions(BALL)
        else:
            # The hull of 48 points on a circle has the radius cos(π/48) = 1/1.002, which ROUND
            # covers.
            turn = np.linspace(0.0, 2.0 * pi, 48, endpoint=False)
            ring = np.stack([np.cos(turn), np.sin(turn), np.zeros_like(turn)], axis=1)
        end = np.array([0.0, 0.0, length / 2.0])
        points = np.concatenate([ring * radius * ROUND + end, ring * radius * ROUND - end])
    return Piece(points, primitive_moments(shape))
