# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Solids of a STEP file (AP203, AP214, AP242): one body for each solid that an assembly places.

A body is kept whole or not at all. Units follow the context of each representation; a file's bodies
are in the unit of the first.
"""

from __future__ import annotations

import math
import zlib
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..files import FILE_TOO_LARGE
from ..numerics import Array, NDArray, clamped_space
from ..nurbs import Curve, Face, close_pairs, patches_size, reverse_curves
from ..verdict import WELDING_RTOL, FileError, finding
from .findings import CURVES_LEFT_OUT, SURFACE_DAMAGED, SURFACES_HIDDEN
from .iges_entities import MAX_DEPTH
from .part21 import Part21, Reference, untyped
from .step_shapes import EntityError, Shapes, blame
from .surfaces import MISSING, RECURSION, Refusals, SurfaceBody, SurfaceFile, refuse

SOLIDS = (
    "MANIFOLD_SOLID_BREP",
    "BREP_WITH_VOIDS",
    "FACETED_BREP",
    "SHELL_BASED_SURFACE_MODEL",
    "FACE_BASED_SURFACE_MODEL",
)
SHELLS = ("CLOSED_SHELL", "OPEN_SHELL", "CONNECTED_FACE_SET")
ORIENTED_SHELLS = ("ORIENTED_CLOSED_SHELL", "ORIENTED_OPEN_SHELL")
# Items with these ends of their names have a volume or an area; others are refused by name.
BODIES = ("_BREP", "_WITH_VOIDS", "_SOLID", "_MODEL", "_SHELL", "_FACE", "_SURFACE", "_FACE_SET")
BODIES += ("_SURFACE_SET", "_SURFACE_WITH_KNOTS")
_POWERS = ("ATTO", "FEMTO", "PICO", "NANO", "MICRO", "MILLI", "", "KILO", "MEGA", "GIGA", "TERA")
PREFIXES: dict[str | None, float] = {None: 1.0, ".CENTI.": 1e-2, ".DECI.": 1e-1}
PREFIXES |= {".{}.".format(name): 10.0 ** (3 * k - 18) for k, name in enumerate(_POWERS)}
COLORS = {
    name: tuple(float(k >> channel & 1) for channel in range(3))
    for k, name in enumerate(
        ("black", "red", "green", "yellow", "blue", "magenta", "cyan", "white")
    )
}
MAX_PLACED = 200_000  # faces and parts placed by a file
MAX_STYLES = 64  # entities between a styled item and its color


class _Child(NamedTuple):
    """A placed representation, with the placements in it and in its parent that coincide."""

    number: int
    frame: int
    parent_frame: int


class StepReader:
    """A reader of the solids of a STEP file."""

    def __init__(self, path: Path, data: bytes | None = None) -> None:
        self._text = Part21(path.read_bytes() if data is None else data)
        self._stem = path.stem
        self._shapes = Shapes(self._text)
        self._refusals = Refusals()
        self._edges: dict[int, list[Curve]] = {}  # curves of the present solid
        self._uses: Counter[int] = Counter()  # uses of edges in the present shell
        self._solids: dict[int, tuple[list[Face], float]] = {}  # with the gaps of their edges
        self._places: set[tuple[int, bytes]] = set()  # solids with the matrices that placed them
        self._contexts: dict[int, tuple[float, float, float]] = {}  # results of `_units`
        self._children: dict[int, list[_Child]] = {}  # by representation
        self._twins: dict[int, list[int]] = {}  # representations of the same coordinates
        self._owners: dict[int, int] = {}  # product definitions by representation
        self._aspects: set[int] = set()  # representations of parts of a shape
        self._items: set[int] = set()  # items of all representations
        self._relations: dict[int, int] = {}  # child definitions by relationship
        self._colors: dict[int, tuple[float, ...]] = {}
        self._hidden: set[int] = set()
        self._left_out: Counter[str] = Counter()  # items by the code of a note
        self._bodies: list[SurfaceBody] = []
        self._visited: set[int] = set()  # representations
        self._noted: set[int] = set()  # refused entities
        self._placed = 0
        self._unit = 0.0  # m, of the first context; 0 before it is read
        self._is_whole = True  # False if a part of the present solid was refused

    def read(self) -> SurfaceFile:
        """Read the solids. FileError if none can be kept."""
        text = self._text
        if text.torn:
            fault = "the end of the file, which comes too early: parts and places are missing"
            self._note(EntityError(text.torn, SURFACE_DAMAGED, {"fault": fault}))
        for name, take in (
            ("SHAPE_DEFINITION_REPRESENTATION", self._take_owner),
            ("CONTEXT_DEPENDENT_SHAPE_REPRESENTATION", self._take_usage),
            ("SHAPE_REPRESENTATION_RELATIONSHIP", self._take_twins),
            ("REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION", self._take_placed_part),
            ("INVISIBILITY", self._take_hidden),
            ("STYLED_ITEM", self._take_style),
            ("OVER_RIDING_STYLED_ITEM", self._take_style),
        ):
            for number in text.named.get(name, ()):
                with self._noting(number):
                    take(number, text[number][name])
        representations = [
            number
            for name, numbers in text.named.items()
            if name.endswith("SHAPE_REPRESENTATION") and not name.startswith("CONTEXT_DEPENDENT")
            for number in numbers
        ]
        for number in representations:
            with self._noting(number):
                self._take_items(number)
        placed = {
            representation
            for children in self._children.values()
            for child in children
            for representation in self._group(child.number)
        }
        # First the roots, then what only a circle of assemblies places.
        roots = [number for number in representations if number not in placed | self._aspects]
        for number in [*roots, *representations]:
            # The items of a damaged representation are noted where it is placed, not read here.
            is_known = number in self._aspects and self._solids.keys() & self._attribute(number, 1)
            if number not in self._visited and not is_known:
                self._place(number, np.eye(4), ())
        notes = [finding(code, count=count) for code, count in self._left_out.items() if count]
        # A body is kept whole or not at all, so no body lacks an unread face.
        return replace(self._refusals.file(self._bodies, self._unit or None, notes), unread=0)

    @contextmanager
    def _noting(self, number: int) -> Iterator[None]:
        """Note refusals within an entity, except for those that the file's end explains; the
        present solid is not whole then.
        """
        torn = self._text.torn
        try:
            with blame(number):
                yield
        except EntityError as error:
            self._is_whole = False
            is_torn = bool(torn) and error.values.get("fault") == MISSING
            if not is_torn and error.number not in self._noted:
                self._note(error)

    def _note(self, error: EntityError) -> None:
        """Note the refusal of an entity."""
        self._noted.add(error.number)
        name = self._text.entity(error.number)
        place = "#{} (line {})".format(error.number, self._text.line(error.number))
        self._refusals.add(error.code, name, place, **error.values)

    def _attribute(self, number: int, index: int) -> Any:
        """Return an attribute of the first entity of an instance."""
        return next(iter(self._text[number].values()))[index]

    def _take_owner(self, _: int, values: list[Any]) -> None:
        """Take the product that has a representation, or note one of a part of its shape."""
        owner = self._attribute(values[0], 2)
        if any(name.startswith("PRODUCT_DEFINITION") for name in self._text[owner]):
            self._owners[values[1]] = owner
        else:
            self._aspects.add(values[1])

    def _take_usage(self, _: int, values: list[Any]) -> None:
        """Take the part that a relationship places: the related one of a usage."""
        # The shape's definition is the usage, whose fifth attribute is the part.
        self._relations[values[0]] = self._attribute(self._attribute(values[1], 2), 4)

    def _take_twins(self, number: int, values: list[Any]) -> None:
        """Take two representations in the same coordinates."""
        if "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION" not in self._text[number]:
            first, second = values[2:4]
            self._twins.setdefault(first, []).append(second)
            self._twins.setdefault(second, []).append(first)

    def _take_placed_part(self, number: int, values: list[Any]) -> None:
        """Take a placed part of an assembly: by custom the first representation, or the second if
        only that belongs to the product of the part.
        """
        _, _, child, parent = self._text[number]["REPRESENTATION_RELATIONSHIP"]
        _, frames = self._shapes.pick(values[0], ("ITEM_DEFINED_TRANSFORMATION",))
        part = self._relations.get(number)
        child_owners, parent_owners = (
            {self._owners.get(twin) for twin in self._group(end)} for end in (child, parent)
        )
        frame, parent_frame = frames[2:4]
        if part in parent_owners and part not in child_owners:
            child, parent, frame, parent_frame = parent, child, parent_frame, frame
        self._children.setdefault(parent, []).append(_Child(child, frame, parent_frame))

    def _take_items(self, number: int) -> None:
        """Take the items of a representation, and the representations that it maps."""
        items = self._attribute(number, 1)
        self._items.update(items)
        for item in items:
            values = self._text[item].get("MAPPED_ITEM")
            if values and item not in self._hidden:
                origin, child = self._text[values[1]]["REPRESENTATION_MAP"]
                self._children.setdefault(number, []).append(_Child(child, origin, values[2]))

    def _take_hidden(self, _: int, values: list[Any]) -> None:
        """Take the items of hidden styles and layers."""
        for style_or_layer in values[0]:
            with self._noting(style_or_layer):
                kinds = "STYLED_ITEM", "PRESENTATION_LAYER_ASSIGNMENT"
                # Of both, the items are the third attribute.
                items = self._shapes.pick(style_or_layer, kinds)[1][2]
                self._hidden.update(items if isinstance(items, list) else [items])

    def _take_style(self, _: int, values: list[Any]) -> None:
        """Take the first color of a styled item."""
        color = self._color(values[1], set())
        if color:
            self._colors[values[2]] = color

    def _color(self, value: Any, seen: set[int]) -> tuple[float, ...] | None:
        """Return the first color to which attributes lead, or None. seen: references on the way."""
        if isinstance(value, (list, tuple)):
            return next(filter(None, (self._color(member, seen) for member in value)), None)
        if not isinstance(value, Reference) or value in seen or len(seen) > MAX_STYLES:
            return None
        seen.add(value)
        parts = self._text[value]
        if "COLOUR_RGB" in parts:
            return tuple(map(float, parts["COLOUR_RGB"][1:4]))
        if "DRAUGHTING_PRE_DEFINED_COLOUR" in parts:
            return COLORS.get(parts["DRAUGHTING_PRE_DEFINED_COLOUR"][0].lower())
        return self._color(list(parts.values()), seen)

    def _group(self, number: int) -> list[int]:
        """Return the representations in the same coordinates as one, itself first."""
        group = [number]
        for member in group:  # It grows by the twins of its members.
            group += [twin for twin in self._twins.get(member, ()) if twin not in group]
        return group

    def _units(self, number: int) -> tuple[float, float, float]:
        """Return the meters and the radians per unit of a representation, and its uncertainty."""
        context = self._attribute(number, 2)
        if context not in self._contexts:
            with blame(context):
                sizes = {"LENGTH_UNIT": 0.0, "PLANE_ANGLE_UNIT": 1.0}
                parts = self._text[context]
                for unit in parts.get("GLOBAL_UNIT_ASSIGNED_CONTEXT", [[]])[0]:
                    for kind in sizes.keys() & self._text[unit].keys():
                        sizes[kind] = self._size(unit, 0)
                if not min(sizes.values()) > 0.0:
                    raise refuse("a unit of no known length")
                length, angle = sizes["LENGTH_UNIT"], sizes["PLANE_ANGLE_UNIT"]
                uncertainty = 0.0
                for measure in parts.get("GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT", [[]])[0]:
                    value, unit = self._measure(measure)
                    if "LENGTH_UNIT" in self._text[unit]:
                        uncertainty = max(uncertainty, value * self._size(unit, 0) / length)
                self._contexts[context] = length, angle, uncertainty
                self._unit = self._unit or length
        return self._contexts[context]

    def _size(self, number: int, depth: int) -> float:
        """Return the size of a unit in SI units, 0 if it is unknown."""
        parts = self._text[number]
        if "SI_UNIT" in parts:
            prefix, name = parts["SI_UNIT"][-2:]
            return PREFIXES.get(prefix, 0.0) if name in (".METRE.", ".RADIAN.") else 0.0
        if "CONVERSION_BASED_UNIT" not in parts or depth == MAX_DEPTH:
            return 0.0
        name, factor = parts["CONVERSION_BASED_UNIT"]
        if name.upper().startswith("DEG"):
            # Files state the factor of a degree, the only such unit, with few digits.
            return math.radians(1.0)
        value, unit = self._measure(factor)
        return value * self._size(unit, depth + 1)

    def _measure(self, number: int) -> tuple[float, int]:
        """Return the value of a measure and its unit."""
        # Of several entities only MEASURE_WITH_UNIT has more than one attribute: first these two.
        # OpenCascade leaves out the type of the value in AP203.
        entities = self._text[number].values()
        value, unit = next(attributes for attributes in entities if len(attributes) > 1)[:2]
        return float(untyped(value)), unit

    def _matrix(self, frame: int, representation: int) -> Array:
        """Return the (4, 4) matrix of a placement in a representation, in the file's unit."""
        matrix = self._shapes.frame(frame)
        matrix[:3, 3] *= self._units(representation)[0] / self._unit
        return matrix

    def _place(self, number: int, matrix: NDArray, path: tuple[int, ...]) -> None:
        """Add the bodies of a representation and of its parts. path: representations around it."""
        if number in path or len(path) >= MAX_DEPTH:
            raise refuse(RECURSION)
        self._count(1)  # Parts without a body take time, too.
        group = self._group(number)
        self._visited |= set(group)
        for twin in group:
            with self._noting(twin):
                length, self._shapes.angle, self._shapes.uncertainty = self._units(twin)
                scaled = matrix @ np.diag([*[length / self._unit] * 3, 1.0])
                self._add_items(self._attribute(twin, 1), twin, scaled)
                for child, frame, parent_frame in self._children.get(twin, ()):
                    with self._noting(child):
                        from_child = np.linalg.inv(self._matrix(frame, child))
                        to_parent = self._matrix(parent_frame, twin) @ from_child
                        self._place(child, matrix @ to_parent, (*path, *group))

    def _count(self, more: int) -> None:
        """Count placed faces and parts; FileError if there are too many."""
        self._placed += more
        if self._placed > MAX_PLACED:
            raise FileError(FILE_TOO_LARGE, limit=MAX_PLACED, content="surfaces")

    def _is_body(self, number: int) -> bool:
        """Return whether an item has a volume or an area; not a tessellation of a placed item."""
        parts = self._text[number]
        if "GEOMETRIC_SET" in parts:
            return any(
                name.endswith(BODIES) for k in parts["GEOMETRIC_SET"][1] for name in self._text[k]
            )
        # The last attribute of a tessellated solid is the exact one.
        is_shown = parts.get("TESSELLATED_SOLID", [None])[-1] in self._items
        return not is_shown and any(name.endswith(BODIES) for name in parts)

    def _add_items(self, items: Sequence[int], owner: int, matrix: NDArray) -> None:
        """Add the visible solids and surface models of a representation; count the other items."""
        solids = [item for item in items if self._is_body(item)]
        hidden = self._hidden.intersection(solids)
        self._left_out[SURFACES_HIDDEN] += len(hidden)
        for item in items:
            _, curves = self._text[item].get("GEOMETRIC_CURVE_SET", ("", ()))
            self._left_out[CURVES_LEFT_OUT] += len(curves)
        for item in solids:
            if item not in hidden:
                self._add(item, owner, matrix, len(solids) == 1)

    def _add(self, number: int, owner: int, matrix: NDArray, is_alone: bool) -> None:
        """Add a solid, in place, unless another representation has put it there.

        A solid is read once for all its places; one that cannot be read whole, which `_noting` has
        reported, is kept as no faces.
        """
        if number not in self._solids:
            self._is_whole = True
            self._shapes.gap = 0.0
            self._edges.clear()
            faces: list[Face] = []
            with self._noting(number):
                faces = self._solid(number)
            self._solids[number] = (faces if self._is_whole else []), self._shapes.gap
        local, gap = self._solids[number]
        place = number, matrix.tobytes()
        if not local or place in self._places:
            return
        self._places.add(place)
        is_moved = not np.array_equal(matrix, np.eye(4))
        faces = [face.transform(matrix) for face in local] if is_moved else local
        self._count(len(faces))
        label = self._attribute(number, 0)
        scale = float(np.linalg.norm(matrix[:3, :3], 2))
        # The numbers of a file are rounded where they stand: in the solid's own place, and in the
        # matrix.
        reach = max(_reach(faces), scale * _reach(local))
        styled = [number, *np.ravel(self._attribute(number, 1)).tolist(), owner]
        representation = "#{}=SHAPE_REPRESENTATION('',(#{}),#{});\n".format(
            owner, number, self._attribute(owner, 2)
        )
        self._bodies.append(
            SurfaceBody(
                name=(self._product(owner) if is_alone or not label else label) or self._stem,
                patches=tuple(faces),
                rounding=scale * gap + 4.0 * self._text.precision * reach,
                color=next((self._colors[item] for item in styled if item in self._colors), None),
                source=lambda: zlib.compress(self._text.extract(representation)),
                matrix=matrix,
            )
        )

    def _product(self, number: int) -> str:
        """Return the name of the product that has a representation, or an empty text."""
        for twin in self._group(number):
            if twin in self._owners:
                # A definition is of a formation, which is of a product.
                product = self._attribute(self._attribute(self._owners[twin], 2), 2)
                return self._attribute(product, 1) or self._attribute(product, 0)
        return ""

    def _solid(self, number: int) -> list[Face]:
        """Return the faces of a solid, or of a model of surfaces."""
        _, values = self._shapes.pick(number, SOLIDS)
        faces: list[Face] = []
        # The outer shell of a solid is a single reference, other shells are lists.
        for value in values[1:]:
            for shell in value if isinstance(value, list) else [value]:
                faces += self._shell(shell)
        return faces

    def _shell(self, number: int) -> list[Face]:
        """Return the faces of a shell, without those that are refused."""
        name, values = self._shapes.pick(number, (*SHELLS, *ORIENTED_SHELLS))
        outward = True
        if name in ORIENTED_SHELLS:
            outward = values[3]
            number = values[2]
            name, values = self._shapes.pick(number, SHELLS)
        faces: list[Face] = []
        self._uses.clear()
        for face in values[1]:
            with self._noting(face):
                faces.append(self._face(face, outward))
        if name == "CLOSED_SHELL" and self._is_whole and self._has_lone_edge(faces):
            with blame(number):
                raise refuse("a face that is missing")
        return faces

    def _has_lone_edge(self, faces: Sequence[Face]) -> bool:
        """Return whether one of the edges that the present shell uses once has its middle where no
        other one has.
        """
        used_once = [self._edges[edge] for edge, uses in self._uses.items() if uses == 1]
        if not used_once:
            return False
        middles = np.array([curves[len(curves) // 2].samples(2)[1] for curves in used_once])
        pairs = close_pairs(middles, WELDING_RTOL * patches_size(faces))
        return len(np.unique(pairs)) < len(used_once)

    def _face(self, number: int, outward: bool) -> Face:
        """Return a face, on the outward or the inward side of its shell."""
        _, (_, bounds, surface, same, *_) = self._shapes.pick(
            number, ("ADVANCED_FACE", "FACE_SURFACE")
        )
        loops = []
        for bound in bounds:
            _, (_, loop, ahead) = self._shapes.pick(bound, ("FACE_OUTER_BOUND", "FACE_BOUND"))
            with blame(loop):
                loops.append(self._loop(loop, ahead == same))
        face = self._shapes.face(surface, [loop for loop in loops if loop])
        return face if same == outward else face.reverse_orientation()

    def _loop(self, number: int, is_ahead: bool) -> list[Curve]:
        """Return the curves of a loop, end to end; none for a vertex."""
        name, values = self._shapes.pick(number, ("EDGE_LOOP", "POLY_LOOP", "VERTEX_LOOP"))
        if name == "VERTEX_LOOP":
            return []
        curves: list[Curve] = []
        if name == "POLY_LOOP":
            points = np.array([self._shapes.point(corner) for corner in values[1]])
            pairs = np.stack([points, np.roll(points, -1, axis=0)], axis=1)
            curves = [Curve(clamped_space(2), pair) for pair in pairs]
        else:
            for use in values[1]:
                _, (_, _, _, edge, ahead) = self._shapes.pick(use, ("ORIENTED_EDGE",))
                edge_curves = self._edge(edge)
                curves += edge_curves if ahead else reverse_curves(edge_curves)
                self._uses[edge] += 1
        ends = np.array([curve.points[[0, -1]] for curve in curves])
        gap = np.abs(ends[:, 0] - np.roll(ends[:, 1], 1, axis=0)).max()
        extent = np.ptp(np.concatenate([curve.points for curve in curves]), axis=0).max()
        if gap > WELDING_RTOL * extent:
            raise refuse("a loop that does not close")
        return curves if is_ahead else reverse_curves(curves)

    def _edge(self, number: int) -> list[Curve]:
        """Return the curves of an edge from its first to its last vertex."""
        if number not in self._edges:
            with blame(number):
                _, (_, *vertices, curve, same) = self._shapes.pick(number, ("EDGE_CURVE",))
                ends = [
                    self._shapes.point(self._shapes.attribute(vertex, "VERTEX_POINT", 1))
                    for vertex in vertices
                ]
                curves = self._shapes.curve(curve, ends if same else ends[::-1])
                self._edges[number] = curves if same else reverse_curves(curves)
        return self._edges[number]


def _reach(faces: Sequence[Face]) -> float:
    """Return the largest coordinate of faces."""
    return max(float(np.abs(face.points).max()) for face in faces)
