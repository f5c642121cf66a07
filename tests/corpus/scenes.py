# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The scenes of the corpus: each function fills the open, empty scene.

Names of objects say what they are.

Of the product, only the settings of objects and materials are used (`body_moments`), which
README.md names. What Blender computes the points of may differ by an ulp of float32 from one
processor to another: EVALUATED.
"""

from itertools import cycle

import bpy
import numpy as np

from tests.corpus import shapes as s

TURN = (0.3, 0.7, -1.1)
PLACES = {
    "at the origin": {},
    "off the origin": {"location": (3, -2, 5)},
    "turned": {"location": (0.5, 1, -2), "rotation_euler": TURN},
    "mirrored": {"location": (2, 3, -1), "rotation_euler": (0.2, -0.4, 0.9), "scale": (-1, 1, 1)},
    "scaled unevenly": {
        "location": (-4, 0, 1),
        "rotation_euler": (1.0, 0.1, 2.0),
        "scale": (2, 0.5, 3),
    },
    "sheared": {"location": (1, 2, 3), "rotation_euler": TURN, "sheared": (1, 2, 0.5)},
    "far away": {"location": (1e4, 2e4, -1.5e4), "rotation_euler": TURN},
    "tiny": {"location": (1e-5, -2e-5, 3e-5), "scale": (1e-5, 1e-5, 1e-5)},
    "huge": {"location": (1e6, 0, -2e6), "rotation_euler": TURN, "scale": (1e5, 1e5, 1e5)},
    "far in its mesh": {"baked": (1000, -500, 250), "location": (1, 1, 1)},
    "tiny in its mesh": {"size": 1e-5, "location": (0.5, 0, 0)},
    "huge in its mesh": {"size": 1e4, "baked": (1e4, 2e4, 0), "rotation_euler": TURN},
    "mirrored and sheared": {
        "location": (-3, 1, 0),
        "rotation_euler": (0.5, -0.3, 0.2),
        "scale": (1, -1, 2),
        "sheared": (0.5, 1, 3),
    },
}


def mesh(name, part, baked=(0, 0, 0), size=1.0):
    data = bpy.data.meshes.new(name)
    points = np.asarray(part[0], float) * size + baked
    data.from_pydata(points.tolist(), [], [list(map(int, face)) for face in part[1]])
    data.update()
    return data


def add(name, data=None, collection=None, sheared=None, **transform):
    """An object of this data in the scene; sheared: the scale of a parent."""
    obj = bpy.data.objects.new(name, data)
    (collection or bpy.context.scene.collection).objects.link(obj)
    for key, value in transform.items():
        setattr(obj, key, value)
    if sheared:
        parent = add("Shear of " + name, scale=sheared, rotation_euler=(0.1, 0.2, 0.3))
        obj.parent = parent
    return obj


def body(name, part, settings=None, place="off the origin", collection=None, **transform):
    """A mesh object; settings: of `body_moments`."""
    transform = {**PLACES[place], **transform}
    data = mesh(name, part, transform.pop("baked", (0, 0, 0)), transform.pop("size", 1.0))
    return given(add(name, data, collection, **transform), **(settings or {}))


def given(obj, **settings):
    for key, value in settings.items():
        setattr(obj.body_moments, key, value)
    return obj


def spread(parts, count=2, places=PLACES):
    """Each part in the next `count` places."""
    turns = cycle(places)
    for name, part in parts.items():
        for _ in range(count):
            place = next(turns)
            body("{} {}".format(name, place), part, place=place)


def made(operator, name, **options):
    """Add an object with one of Blender's operators."""
    operator(**options)
    obj = bpy.context.object
    obj.name = obj.data.name = name
    return obj


def tree_of(obj, build):
    """A geometry nodes modifier: `build(tree, source)` gives the output socket."""
    tree = bpy.data.node_groups.new("Nodes of " + obj.name, "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    source, sink = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    tree.links.new(build(tree, source.outputs[0]), sink.inputs[0])
    obj.modifiers.new("Nodes", "NODES").node_group = tree
    return obj


def node(tree, kind, inputs=None, **links):
    one = tree.nodes.new(kind)
    for key, value in (inputs or {}).items():
        one.inputs[key].default_value = value
    for key, socket in links.items():
        tree.links.new(socket, one.inputs[key])
    return one.outputs[0]


def on_grid(tree, instance, side=3, scale=(1.0, 1.0, 1.0)):
    points = node(
        tree,
        "GeometryNodeMeshGrid",
        {"Size X": 8.0, "Size Y": 6.0, "Vertices X": side, "Vertices Y": side},
    )
    inputs = {"Rotation": (0.1, 0.2, 0.3), "Scale": scale}
    return node(tree, "GeometryNodeInstanceOnPoints", inputs, Points=points, Instance=instance)


# Solids


def closed():
    ell, tube = s.prism(s.L_PLAN), s.prism(s.regular(24, 0.5), 3.0)
    hexagon = s.prism(s.regular(6), 1.5)
    twisted = np.concatenate([hexagon[0][:6], s.turned(hexagon, 2, 0.5)[0][6:]]), hexagon[1]
    spread(
        {
            "Box": s.box((0, 0, 0), (1, 2, 3)),
            "Cube": s.box((-1, -1, -1), (1, 1, 1)),
            "Plate": s.box((0, 0, 0), (2, 3, 1e-3)),
            "Rod": s.box((0, 0, 0), (1e-2, 2e-2, 5)),
            "Ball": s.ball(2),
            "Sphere": s.uv_sphere(),
            "Cone": s.cone(),
            "Pyramid": s.cone(4, 1.5, 1.0),
            "Torus": s.torus(),
            "Thin torus": s.torus(20, 6, 2.0, 0.1),
            "Cylinder": tube,
            "Frustum": s.prism(s.regular(12), 2.0, (0.3, 0.1), 0.5),
            "L beam": ell,
            "U beam": s.prism(s.U_PLAN, 4.0),
            "T beam": s.prism(s.T_PLAN, 2.0),
            "Comb": s.prism(s.COMB_PLAN, 0.7),
            "Slanted beam": s.prism(s.SLANTED_PLAN, 0.7),
            "Oblique beam": s.prism(s.SLANTED_PLAN, 1.0, (0.7, -0.2)),
            "Raised column": s.raised_column(),
            "Deeply raised column": s.raised_column(-0.6),
            "Tonon's tetrahedron": s.TONON,
            "Twisted prism": twisted,
        },
        3,
    )
    spread(
        {
            "Prism of {}".format(n): s.prism(s.regular(n, 1.0, 0.1 * n), 0.5 + 0.25 * n)
            for n in range(3, 13)
        },
        2,
    )
    spread({"Hull {}".format(i): s.random_hull(i, 6 + i) for i in range(8)}, 2)
    spread({"Polycube {}".format(i): s.polycube(i, 4 + i) for i in (1, 2, 3, 5, 7)}, 2)
    for number, cell in enumerate(s.fracture(), 1):
        body("Fragment {}".format(number), cell, place="turned")


def faulty():
    unit, cube4, cube2 = s.box(), s.box((-2, -2, -2), (2, 2, 2)), s.box((-1, -1, -1), (1, 1, 1))
    crossing = s.moved(s.turned(s.box((-0.5, -0.5, -2), (0.5, 0.5, 2)), 0, 0.8), (1, 0.5, 0))
    fin = (np.concatenate([unit[0], [[0.5, -1, 0.5], [0.5, -1, 1.5]]]), [*unit[1], [0, 8, 9]])
    two = (
        np.concatenate([unit[0], unit[0][[0, 1, 4, 5]] - (0, 1, 0)]),
        [*unit[1], [8, 9, 11, 10], [8, 10, 4, 0], [9, 1, 5, 11], [10, 11, 5, 4], [8, 0, 1, 9]],
    )
    needles = s.triangulated(
        (
            np.concatenate([unit[0], [[0.5, 1e-6, 0]]]),
            [[0, 2, 3, 1, 8], unit[1][1], [0, 8, 1, 5, 4], *unit[1][3:]],
        )
    )
    bow = s.prism([(0, 0), (1, 1), (1, 0), (0, 1)])
    spread(
        {
            "Two boxes apart": s.joined(unit, s.moved(unit, (5, 0, 0), 2)),
            "Five tetrahedra": s.random_tetrahedra(3),
            "Broken box": s.joined(*s.fracture()),
            "Cavity": s.joined(cube4, s.inverted(cube2)),
            "Two cavities": s.joined(
                cube4,
                s.inverted(s.moved(unit, (-1.5, -1, -1))),
                s.inverted(s.moved(unit, (0.5, 0, 0))),
            ),
            "Body in a cavity": s.joined(
                cube4, s.inverted(cube2), s.moved(unit, (-0.5, -0.5, -0.5))
            ),
            "Nested outward": s.joined(cube4, cube2),
            "Nested outward twice": s.joined(cube4, cube2, s.moved(cube2, scale=0.5)),
            "Overlapping boxes": s.joined(unit, s.moved(unit, (0.5, 0, 0))),
            "Crossing beams": s.joined(cube2, crossing),
            "Touching boxes": s.joined(unit, s.moved(unit, (1, 0, 0))),
            "Flipped face": s.with_flipped(unit, 1),
            "Three flipped faces": s.with_flipped(s.prism(s.L_PLAN), 0, 3, 5),
            "Inside out": s.inverted(s.prism(s.L_PLAN)),
            "One part inside out": s.joined(unit, s.inverted(s.moved(unit, (3, 0, 0)))),
            "Open box": s.without(unit, 1),
            "Open at two ends": s.without(s.prism(s.regular(9), 2.0), 0, 1),
            "Open beam": s.without(s.prism(s.L_PLAN), 1),
            "Open sphere": s.without(s.uv_sphere(), 0, 1, 2, 3, 4, 10, 11),
            "Open raised column": s.without(s.raised_column(), 1),
            "Open and flipped": s.with_flipped(s.without(s.uv_sphere(), 7, 30), 3, 12),
            "Two open boxes": s.joined(s.without(unit, 1), s.without(s.moved(unit, (2, 0, 0)), 3)),
            "T-junctions": s.t_junctions(),
            "Dense side": s.dense_side(),
            "Duplicate face": s.with_again(unit, 1),
            "All faces twice": s.with_again(unit, *range(6)),
            "Unwelded box": s.unwelded(unit),
            "Unwelded sphere": s.unwelded(s.uv_sphere()),
            "Unwelded flipped face": s.with_flipped(s.unwelded(unit), 1),
            "Needles": needles,
            "Face without area": (np.concatenate([unit[0], [[0.5, 0, 0]]]), [*unit[1], [0, 8, 1]]),
            "Loose face": (
                np.concatenate([unit[0], [[3, 0, 0], [4, 0, 0], [3, 1, 0]]]),
                [*unit[1], [8, 9, 10]],
            ),
            "Fin": fin,
            "Inner wall": two,
            "Bow tie": bow,
            "Möbius strip": s.moebius(),
            "Klein bottle": s.torus(24, 12, twist=True),
            "Sheet in space": s.sheet(4, 0.5),
            "Edge in common": s.joined(unit, s.moved(unit, (1, 1, 0))),
        },
        2,
        [place for place in PLACES if place != "tiny in its mesh"],
    )


def overlaps():
    """For --overlap union as well."""
    unit, cube4, cube2 = s.box(), s.box((-2, -2, -2), (2, 2, 2)), s.box((-1, -1, -1), (1, 1, 1))
    three = s.joined(unit, s.moved(unit, (0.5, 0.25, 0.125)), s.moved(unit, (-0.25, 0.5, 0.5)))
    parts = {
        "Halves": s.joined(unit, s.moved(unit, (0.5, 0, 0))),
        "Three boxes": three,
        "Nested": s.joined(cube4, cube2),
        "Balls": s.joined(s.ball(2), s.moved(s.ball(2), (0.7, 0.1, 0.2))),
        "Apart": s.joined(unit, s.moved(unit, (2, 0, 0))),
        "Single": unit,
    }
    places = ("at the origin", "turned", "mirrored", "sheared", "far away", "tiny")
    for (name, part), place in zip(parts.items(), places):
        body("{} {}".format(name, place), part, place=place)
        body("{} united".format(name), part, {"overlap": "UNION"}, "scaled unevenly")


def shapes():
    """With signatures, and moments of order 8."""
    parts = {
        "Box": s.box((0, 0, 0), (1, 2, 3)),
        "Cube": s.box(),
        "L beam": s.prism(s.L_PLAN),
        "Slanted beam": s.prism(s.SLANTED_PLAN, 0.7),
        "Hull": s.random_hull(4, 10),
        "Polycube": s.polycube(2, 6),
        "Torus": s.torus(),
        "Open sphere": s.without(s.uv_sphere(), 0, 5),
        "Tetrahedra": s.random_tetrahedra(2, 3),
    }
    spread(parts, 2)
    body("L beam as a shell", s.prism(s.L_PLAN), {"kind": "SHELL", "thickness": 0.01}, "turned")
    body("Hull as a shell", s.random_hull(2, 9), {"kind": "SHELL", "thickness": 0.01}, "sheared")


def shells():
    """Thin, and with walls of real thickness."""
    parts = {
        "Box": s.box((0, 0, 0), (1, 2, 3)),
        "L beam": s.prism(s.L_PLAN),
        "Ball": s.ball(2),
        "Hull": s.random_hull(3, 9),
        "Open box": s.without(s.box((0, 0, 0), (2, 2, 2)), 1),
        "Sheet": s.sheet(1),
        "Prism": s.prism(s.regular(7), 2.0),
    }
    places = cycle([place for place in PLACES if not place.startswith(("far", "tiny", "huge"))])
    for name, part in parts.items():
        for wall in ("THIN", "INWARD", "OUTWARD", "CENTERED"):
            place = next(places)
            body(
                "{} {} {}".format(name, wall.lower(), place),
                part,
                {"kind": "SHELL", "wall": wall, "thickness": 0.0625},
                place,
            )
    thin = {"kind": "SHELL", "thickness": 0.01}
    sheets = {
        "Flat sheet": s.sheet(3),
        "Hill": s.sheet(5, 0.4),
        "Möbius strip": s.moebius(),
        "Torus": s.torus(),
        "Broken box": s.joined(*s.fracture()),
    }
    for (name, part), place in zip(
        sheets.items(), ("sheared", "far away", "huge", "tiny", "mirrored and sheared")
    ):
        body("{} thin {}".format(name, place), part, thin, place)
    body(
        "Box far away inward",
        s.box((0, 0, 0), (1, 2, 3)),
        {"kind": "SHELL", "wall": "INWARD", "thickness": 0.1},
        "far away",
    )
    tiny = {"kind": "SHELL", "wall": "CENTERED", "thickness": 1e-6}
    body("Box tiny centered", s.box((0, 0, 0), (1, 2, 3)), tiny, "tiny")
    body(
        "Flipped box inward",
        s.with_flipped(s.box(), 2),
        {"kind": "SHELL", "wall": "INWARD", "thickness": 0.125},
    )
    body("Slit outward", s.prism(s.U_PLAN), {"kind": "SHELL", "wall": "OUTWARD", "thickness": 0.25})
    weighed = {
        "kind": "SHELL",
        "wall": "INWARD",
        "thickness": 0.1,
        "mass_from": "MASS",
        "mass": 3.0,
    }
    body("Weighed shell", s.box(), weighed)
    many = {"kind": "SHELL", "wall": "OUTWARD", "thickness": 0.05}
    body("Polycube outward", s.polycube(3, 6), many, "turned")
    for kind, wall in (
        ("sphere", "THIN"),
        ("torus", "THIN"),
        ("sphere", "INWARD"),
        ("torus", "OUTWARD"),
    ):
        obj = made(
            getattr(bpy.ops.surface, "primitive_nurbs_surface_{}_add".format(kind)),
            "NURBS {} {} shell".format(kind, wall.lower()),
            location=(1, 2, 3),
        )
        given(obj, kind="SHELL", wall=wall, thickness=0.05)


# Curves and surfaces


def curve(name, points, kind="POLY", cyclic=False, dimensions="3D", **options):
    data = bpy.data.curves.new(name, "CURVE")
    data.dimensions = dimensions
    outlines = points if isinstance(points, list) else [points]
    for outline in outlines:
        outline = np.asarray(outline, float)
        outline = np.column_stack([outline, np.zeros((len(outline), 3 - outline.shape[1]))])
        spline = data.splines.new(kind)
        target = spline.bezier_points if kind == "BEZIER" else spline.points
        target.add(len(outline) - 1)
        if kind == "BEZIER":
            target.foreach_set("co", outline.ravel())
            for point in target:
                point.handle_left_type = point.handle_right_type = "AUTO"
        else:
            target.foreach_set("co", np.column_stack([outline, np.ones(len(outline))]).ravel())
        spline.use_cyclic_u = cyclic
        if kind == "NURBS":
            spline.order_u, spline.use_endpoint_u = 4, not cyclic
    for key, value in options.items():
        setattr(data, key, value)
    return data


ZIGZAG = np.array([(0, 0, 0), (3, 0, 0), (3, 4, 0), (1, 4, 2), (0, 2, 1.5)])
WAVE = np.array([(0, 0, 0), (1, 2, 0.5), (2, -1, 1), (3, 1, -0.5), (4, 0, 0), (5, 1, 1)])


def curves():
    wires = {
        "Rods": curve("Rods", ZIGZAG),
        "Loop of rods": curve("Loop", ZIGZAG, cyclic=True),
        "Spline": curve("Spline", WAVE, "NURBS"),
        "Closed spline": curve("Closed", WAVE, "NURBS", True),
        "Bézier": curve("Bezier", WAVE, "BEZIER"),
        "Closed Bézier": curve("BezierLoop", WAVE, "BEZIER", True),
    }
    places = cycle(PLACES)
    for name, data in wires.items():
        for _ in range(2):
            place = dict(PLACES[next(places)])
            place.pop("baked", None), place.pop("size", None)
            given(
                add("{} wire {}".format(name, len(bpy.data.objects)), data, **place),
                kind="WIRE",
                linear_density=2.5,
            )
    given(
        add("Weighed wire", wires["Spline"], location=(1, 2, 3)),
        kind="WIRE",
        mass_from="MASS",
        mass=3.0,
    )
    sheet = {"kind": "SHELL", "thickness": 0.01}
    ell = curve("Outline", np.array(s.L_PLAN), cyclic=True, dimensions="2D", fill_mode="BOTH")
    hole = curve(
        "Holes",
        [np.array(s.L_PLAN), np.array([(0.25, 0.25), (0.75, 0.25), (0.75, 0.75), (0.25, 0.75)])],
        cyclic=True,
        dimensions="2D",
        fill_mode="BOTH",
    )
    smooth = curve("Smooth", np.array(s.L_PLAN), "NURBS", True, "2D", fill_mode="BOTH")
    given(add("Filled outline", ell, location=(1, 0, 0), rotation_euler=TURN), **sheet)
    given(add("Filled outline with a hole", hole, location=(0, 2, 0), scale=(2, 1, 1)), **sheet)
    given(add("Filled spline", smooth, location=(1e4, 0, 0)), **sheet)
    given(
        add(
            "Filled Bézier",
            curve("Round", np.array(s.L_PLAN), "BEZIER", True, "2D", fill_mode="BOTH"),
        ),
        **sheet,
    )
    given(
        add("Region of a closed curve", curve("Region", np.array(s.L_PLAN), cyclic=True)), **sheet
    )
    ell_solid = curve(
        "Extruded", np.array(s.L_PLAN), cyclic=True, dimensions="2D", fill_mode="BOTH", extrude=0.5
    )
    add("Extruded outline", ell_solid, location=(3, 2, 1), rotation_euler=TURN)
    add("Extruded outline scaled", ell_solid, location=(-3, 2, 1), scale=(1, -2, 0.5))
    add(
        "Square pipe",
        curve("Pipe", ZIGZAG, bevel_depth=0.1, bevel_resolution=0, use_fill_caps=True),
    )
    add(
        "Pipe in a loop",
        curve("Hose", WAVE, "NURBS", True, bevel_depth=0.05, bevel_resolution=2),
        location=(2, 2, 2),
    )
    given(add("Pipe as a wire", curve("Tube", ZIGZAG, bevel_depth=0.1)), kind="WIRE")
    for number, (text, extrude) in enumerate((("Body", 0.1), ("Moments", 0.05), ("B8", 0.2))):
        data = bpy.data.curves.new("Text {}".format(number), "FONT")
        data.body, data.extrude = text, extrude
        add(
            "Text {}".format(text),
            data,
            location=(number, -1, 2),
            rotation_euler=(0.1 * number, 0.3, 0),
        )
    flat = bpy.data.curves.new("Flat text", "FONT")
    flat.body = "Flat"
    given(add("Flat text", flat, rotation_euler=TURN), **sheet)
    for number, (places, radius) in enumerate(
        (
            (((0, 0, 0),), 1.0),
            (((0, 0, 0), (1.2, 0.1, 0)), 0.8),
            (((0, 0, 0), (1, 0, 0), (0, 1, 0.5)), 0.7),
        )
    ):
        data = bpy.data.metaballs.new("Drop{}".format(number))
        data.resolution = 0.3
        for place in places:
            element = data.elements.new()
            element.co, element.radius = place, radius
        add("Drop{}".format(number), data, location=(10 * number, 1, 2))


def patch(
    name,
    points,
    weights=None,
    orders=(4, 4),
    cyclic=(False, False),
    endpoint=(True, True),
    **transform,
):
    """A surface of one patch. points: (count_v, count_u, 3)."""
    points = np.asarray(points, np.float32)
    rows, columns = points.shape[:2]
    data = bpy.data.curves.new(name, "SURFACE")
    for column in range(columns):  # lofted below: only an operator makes a grid of points
        spline = data.splines.new("NURBS")
        spline.points.add(rows - 1)
        line = np.ones((rows, 4), np.float32)
        line[:, :3] = np.column_stack([np.full(rows, column), np.arange(rows), np.zeros(rows)])
        spline.points.foreach_set("co", line.ravel())
    obj = add(name, data)
    bpy.ops.object.select_all(action="DESELECT")
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.curve.select_all(action="SELECT")
    bpy.ops.curve.make_segment()
    bpy.ops.object.mode_set(mode="OBJECT")
    (spline,) = data.splines
    flat = np.ones((rows * columns, 4), np.float32)
    flat[:, :3] = points.reshape(-1, 3)
    if weights is not None:
        flat[:, 3] = np.asarray(weights, np.float32).ravel()
    spline.points.foreach_set("co", flat.ravel())
    spline.order_u, spline.order_v = orders
    spline.use_cyclic_u, spline.use_cyclic_v = cyclic
    spline.use_endpoint_u, spline.use_endpoint_v = endpoint
    spline.resolution_u = spline.resolution_v = 3
    for key, value in transform.items():
        setattr(obj, key, value)
    return obj


def nurbs():
    moves = {
        "": {},
        " turned": {"location": (5, -2, 8), "rotation_euler": TURN},
        " mirrored unevenly": {
            "location": (1, 2, 3),
            "rotation_euler": TURN,
            "scale": (1, 2, -0.5),
        },
        " far away": {"location": (1e4, -1e4, 2e4)},
        " tiny": {"scale": (1e-5, 1e-5, 1e-5)},
    }
    for kind in ("sphere", "torus", "cylinder", "surface"):
        for words, transform in moves.items():
            add_one = getattr(bpy.ops.surface, "primitive_nurbs_surface_{}_add".format(kind))
            obj = made(add_one, "NURBS {}{}".format(kind, words))
            for key, value in transform.items():
                setattr(obj, key, value)
    rng = np.random.default_rng(11)
    x, y = np.meshgrid(np.arange(5.0), np.arange(6.0))
    for number in range(3):
        hills = np.stack([x, y, np.round(rng.uniform(-0.5, 0.5, x.shape), 3)], axis=-1)
        weights = np.round(rng.uniform(0.5, 2.0, x.shape), 3) if number else None
        given(
            patch(
                "Open patch {}".format(number),
                hills,
                weights,
                (4 - number % 2, 3),
                location=(number, 0, 1),
            ),
            kind="SHELL",
            thickness=0.02,
        )
    u, v = np.meshgrid(np.arange(6) * np.pi / 3, np.arange(8) * np.pi / 4)
    ring = np.stack([(3 + np.cos(u)) * np.cos(v), (3 + np.cos(u)) * np.sin(v), np.sin(u)], axis=-1)
    patch("Cyclic patch", ring, cyclic=(True, True), endpoint=(False, False))
    patch(
        "Cyclic patch with weights",
        ring,
        np.round(rng.uniform(0.7, 1.5, u.shape), 3),
        cyclic=(True, True),
        endpoint=(False, False),
        location=(9, 1, 2),
        scale=(1, 2, 1),
    )


# Objects built by Blender


def modifier(obj, kind, **options):
    one = obj.modifiers.new(kind.title(), kind)
    for key, value in options.items():
        setattr(one, key, value)
    return obj


def built():
    ell = s.prism(s.SLANTED_PLAN, 0.7)
    modifier(
        body("Array", ell, place="turned"),
        "ARRAY",
        count=4,
        relative_offset_displace=(1.5, 0.25, 0),
    )
    modifier(body("Array that touches", s.box(), place="mirrored"), "ARRAY", count=3)
    modifier(
        body("Mirror", s.moved(ell, (1, 0, 0)), place="sheared"),
        "MIRROR",
        use_axis=(True, False, True),
    )
    modifier(body("Solidify", s.sheet(3, 0.4), place="turned"), "SOLIDIFY", thickness=0.1)
    modifier(
        body("Solidify of a box", s.box(), place="scaled unevenly"),
        "SOLIDIFY",
        thickness=0.05,
        offset=0.0,
    )
    modifier(body("Subdivision", s.box((0, 0, 0), (1, 2, 3)), place="turned"), "SUBSURF", levels=2)
    modifier(
        body("Simple subdivision", ell, place="mirrored"),
        "SUBSURF",
        levels=2,
        subdivision_type="SIMPLE",
    )
    modifier(body("Bevel", s.box((0, 0, 0), (2, 2, 1))), "BEVEL", width=0.1, segments=2)
    modifier(body("Triangulate", s.raised_column(), place="turned"), "TRIANGULATE")
    modifier(body("Decimate", s.ball(3)), "DECIMATE", ratio=0.5)
    square = np.array([(1, 0, 0), (2, 0, 0), (2, 0, 1), (1, 0, 1)]), [[0, 1, 2, 3]]
    modifier(body("Screw", square), "SCREW", steps=12)
    modifier(body("Edge split", s.box(), place="turned"), "EDGE_SPLIT")
    modifier(body("Displaced", s.ball(2)), "DISPLACE", strength=0.25, mid_level=0.0)
    modifier(body("Remesh", s.box((0, 0, 0), (2, 1, 1))), "REMESH", mode="BLOCKS", octree_depth=3)
    monkey = made(bpy.ops.mesh.primitive_monkey_add, "Suzanne", location=(1, 2, 3), rotation=TURN)
    smooth = made(
        bpy.ops.mesh.primitive_monkey_add, "Suzanne subdivided", location=(-1, 2, -3), rotation=TURN
    )
    modifier(smooth, "SUBSURF", levels=1)
    add("Suzanne mirrored", monkey.data, location=(4, 0, 0), scale=(-1, 1, 1))
    for name in ("primitive_ico_sphere_add", "primitive_torus_add", "primitive_cone_add"):
        made(
            getattr(bpy.ops.mesh, name),
            "Blender's " + name.split("_")[1],
            location=(3, 1, 2),
            rotation=TURN,
        )

    bent = made(bpy.ops.surface.primitive_nurbs_surface_sphere_add, "NURBS sphere with a modifier")
    bent.modifiers.new("Triangulate", "TRIANGULATE")

    shaped = body("Shape keys", ell, place="turned")
    shaped.shape_key_add(name="Basis")
    key = shaped.shape_key_add(name="Wide")
    for point in key.data:
        point.co.x *= 1.5
    key.value = 0.5
    data = mesh("Shared", ell)
    for number, (words, place) in enumerate(list(PLACES.items())[:8]):
        place = {
            key: value for key, value in place.items() if key not in ("baked", "size", "sheared")
        }
        add("Linked duplicate {} {}".format(number, words), data, **place)
    parent = body("Parent", s.box(), place="scaled unevenly")
    child = body("Child", ell, place="turned")
    grandchild = body("Grandchild", s.box(), place="mirrored")
    child.parent, grandchild.parent = parent, child

    tree_of(
        body("Nodes on a grid", ell, place="turned"),
        lambda tree, source: on_grid(tree, source, 3, (1.0, 2.0, 0.5)),
    )
    tree_of(
        body("Nodes beside its own", s.box(), place="mirrored"),
        lambda tree, source: joined_nodes(
            tree, on_grid(tree, node(tree, "GeometryNodeMeshCone")), source
        ),
    )
    tree_of(
        body("Nodes realized", ell, place="off the origin"),
        lambda tree, source: node(
            tree, "GeometryNodeRealizeInstances", Geometry=on_grid(tree, source)
        ),
    )
    tree_of(
        body("Nodes within nodes", s.box(), place="turned"),
        lambda tree, source: on_grid(tree, on_grid(tree, source, 2), 2, (1.0, 1.0, -1.0)),
    )
    tree_of(
        body("Nodes transformed", ell),
        lambda tree, source: node(
            tree,
            "GeometryNodeTransform",
            {"Translation": (1, 2, 3), "Rotation": TURN, "Scale": (1, -2, 1)},
            Geometry=source,
        ),
    )

    members = bpy.data.collections.new("Members")
    body("Member box", s.box(), place="turned", collection=members)
    body("Member beam", ell, place="scaled unevenly", collection=members)
    outer = bpy.data.collections.new("Outer")
    for name, collection, instanced, place in (
        ("Inner instance", outer, members, "turned"),
        ("Collection instance", None, members, "off the origin"),
        ("Collection instance mirrored", None, members, "mirrored"),
        ("Collection instance far away", None, members, "far away"),
        ("Collection instance sheared", None, members, "sheared"),
        ("Nested instance", None, outer, "scaled unevenly"),
    ):
        obj = add(name, None, collection, **PLACES[place])
        obj.instance_type, obj.instance_collection = "COLLECTION", instanced
    for kind in ("VERTS", "FACES"):
        host = body("Instances on " + kind.lower(), s.box(), place="turned")
        host.instance_type = kind
        host.use_instance_vertices_rotation = host.use_instance_faces_scale = True
        body(
            "Guest of " + kind.lower(), s.moved(ell, scale=0.2), place="at the origin"
        ).parent = host
    particles = body("Particles", s.box(), place="at the origin")
    system = particles.modifiers.new("Particles", "PARTICLE_SYSTEM").particle_system.settings
    system.type, system.count = "HAIR", 7
    system.render_type, system.instance_object = "OBJECT", child


def joined_nodes(tree, *sockets):
    one = tree.nodes.new("GeometryNodeJoinGeometry")
    for socket in sockets:
        tree.links.new(socket, one.inputs[0])
    return one.outputs[0]


# Densities


def material(name, density):
    one = bpy.data.materials.new(name)
    one.body_moments.density = density
    return one


def densities():
    steel, cork, bare = material("Steel", 7820.0), material("Cork", 240.0), material("Bare", 0.0)

    def of_materials(name, part, slots, place, **settings):
        obj = body(name, part, {"density_from": "MATERIALS", **settings}, place)
        for one in (steel, cork, bare):
            obj.data.materials.append(one)
        obj.data.polygons.foreach_set("material_index", slots)
        return obj

    unit, ell = s.box(), s.prism(s.SLANTED_PLAN, 0.7)
    pair = s.joined(unit, s.moved(unit, (4, 0, 0)))
    for place in ("at the origin", "scaled unevenly", "mirrored", "far away", "sheared", "tiny"):
        of_materials("Dumbbell " + place, pair, [0] * 6 + [1] * 6, place)
    of_materials(
        "Three materials",
        s.joined(pair, s.moved(unit, (0, 4, 0))),
        [0] * 6 + [1] * 6 + [2] * 6,
        "turned",
        density=900.0,
    )
    of_materials(
        "Materials in nested boxes",
        s.joined(s.moved(unit, (-1, -1, -1), 3), s.inverted(unit), unit),
        [0] * 12 + [1] * 6,
        "turned",
    )
    of_materials(
        "Materials of a shell", unit, [0, 1, 0, 0, 2, 1], "mirrored", kind="SHELL", thickness=0.01
    )
    of_materials(
        "Materials, weighed", pair, [0] * 6 + [1] * 6, "turned", mass_from="MASS", mass=12.5
    )
    for number, (value, place) in enumerate(
        ((0.5, "turned"), (2700.0, "sheared"), (21450.0, "huge"))
    ):
        body("One value {}".format(number), ell, {"density": value}, place)
    for number, (value, place) in enumerate(((1e-6, "tiny"), (3.5, "mirrored"), (1e9, "far away"))):
        body("Weighed {}".format(number), ell, {"mass_from": "MASS", "mass": value}, place)
    polynomials = (
        ("1000 + 20*z", "turned"),
        ("500 + x*x + 2*y*z + 100*y*y", "mirrored"),
        ("700 + 3*x - y + 0.5*z**3", "sheared"),
        ("1000, 10, 20, 30", "scaled unevenly"),
        ("800 + x**4", "off the origin"),
    )
    for number, (text, place) in enumerate(polynomials):
        for frame in ("OBJECT", "WORLD"):
            body(
                "Polynomial {} {}".format(number, frame.lower()),
                ell,
                {"density_from": "POLYNOMIAL", "density_polynomial": text, "density_frame": frame},
                place,
            )
    body(
        "Polynomial of a shell",
        unit,
        {
            "density_from": "POLYNOMIAL",
            "density_polynomial": "1000 + 50*z + x*x",
            "kind": "SHELL",
            "thickness": 0.02,
        },
        "turned",
    )
    body(
        "Polynomial of an open box",
        s.without(unit, 1),
        {"density_from": "POLYNOMIAL", "density_polynomial": "1000 + 50*z"},
        "turned",
    )
    rng = np.random.default_rng(3)
    for name, part, place in (
        ("Attribute of a hill", s.sheet(4, 0.3), "turned"),
        ("Attribute of a ball", s.ball(1), "sheared"),
        ("Attribute of a hull", s.random_hull(1, 8), "mirrored"),
    ):
        obj = body(
            name, part, {"kind": "SHELL", "density_from": "ATTRIBUTE", "thickness": 0.01}, place
        )
        values = np.round(rng.uniform(500, 3000, len(obj.data.vertices)))
        obj.data.attributes.new("density", "FLOAT", "POINT").data.foreach_set("value", values)


def openvdb():
    if hasattr(bpy.utils, "expose_bundled_modules"):
        bpy.utils.expose_bundled_modules()
    try:
        import openvdb as module
    except ImportError:
        import pyopenvdb as module
    return module


def volume(path, name, values, transform=None, offset=(0, 0, 0), **placement):
    """A Volume object of a new .vdb file. transform: (4, 4) from voxels, column vectors."""
    module = openvdb()
    grid = (module.FloatGrid if values.dtype.kind == "f" else module.Int32Grid)()
    grid.copyFromArray(np.ascontiguousarray(values), ijk=offset)
    grid.name = "density"
    if transform is not None:
        grid.transform = module.createLinearTransform(np.asarray(transform, float).T.tolist())
    return volume_of(path, name, grid, **placement)


def volume_of(path, name, grid, **placement):
    openvdb().write(str(path), [grid])
    data = bpy.data.volumes.new(name)
    data.filepath = str(path)
    return add(name, data, **placement)


def volumes(folder):
    rng = np.random.default_rng(8)
    values = np.round(rng.uniform(0, 4, (6, 9, 7)), 2)
    values = (values * (values > 1)).astype(np.float32)
    sheared = [[0.5, 0.125, 0, 3], [0, -0.25, 0.0625, -2], [0.25, 0, 1, 0.5], [0, 0, 0, 1]]
    volume(folder / "plain.vdb", "Cloud", values)
    volume(
        folder / "moved.vdb",
        "Cloud moved",
        values,
        None,
        (-5, 130, 7),
        location=(1, 2, 3),
        rotation_euler=TURN,
    )
    volume(
        folder / "sheared.vdb",
        "Cloud sheared",
        values,
        sheared,
        scale=(2, -1, 0.5),
        rotation_euler=TURN,
    )
    volume(folder / "far.vdb", "Cloud far away", values, location=(1e4, 2e4, 0))
    volume(folder / "whole.vdb", "Cloud of whole numbers", np.round(values).astype(np.int32))
    for order in (2, 3, 4):
        given(
            volume(folder / "o{}.vdb".format(order), "Cloud of order {}".format(order), values),
            spline_order=order,
        )
    given(
        volume(folder / "denser.vdb", "Cloud denser", values, scale=(0.1, 0.1, 0.1)),
        value_density=1500.0,
    )
    ct = np.round(rng.uniform(-1000, 1600, (4, 5, 6))).astype(np.float32)
    given(volume(folder / "ct.vdb", "CT numbers", ct), values_from="TABLE")
    level = openvdb().createLevelSetSphere(radius=2.0, center=(5.0, 0.0, 0.0), voxelSize=0.25)
    level.name = "distance"
    given(volume_of(folder / "level.vdb", "Level set", level), grid_as="SOLID")
    whole = rng.integers(0, 9, (6, 6, 6)).astype(np.float32)
    source = volume(folder / "source.vdb", "Source", whole, location=(0.25, 0, 0))
    for name, part, place in (
        ("Box in a cloud", s.box((1, 1, 1), (3, 4, 4)), "at the origin"),
        ("Beam in a cloud", s.moved(s.prism(s.L_PLAN), (1, 1, 1)), "at the origin"),
        ("Ball in a cloud", s.moved(s.ball(1), (2.5, 2.5, 2.5)), "at the origin"),
    ):
        given(body(name, part, place=place), density_from="VOLUME", density_volume=source)
    given(
        body(
            "Turned box in a cloud",
            s.box((-1, -1, -1), (1, 1, 1)),
            location=(2.5, 3, 2.5),
            rotation_euler=TURN,
        ),
        density_from="VOLUME",
        density_volume=source,
    )
    fog = add("Fog", bpy.data.volumes.new("Fog"))
    filler = body("Filler", s.box((0, 0, 0), (2, 1, 1)), place="at the origin")
    one = fog.modifiers.new("Fog", "MESH_TO_VOLUME")
    one.object, one.voxel_amount, one.interior_band_width = filler, 12, 100.0


# Objects requested by name


def cut(name, operation, solver="EXACT", place="turned", tool_part=None):
    base = body(name, s.box((0, 0, 0), (2, 2, 2)), place=place)
    tool = body(name + " operand", tool_part or s.box((1, 1, 1), (3, 2.5, 4)), place=place)
    tool.display_type = "WIRE"
    modifier(base, "BOOLEAN", object=tool, operation=operation, solver=solver)


def booleans():
    """The bases, not their operands, which are not asked for."""
    for operation in ("UNION", "DIFFERENCE", "INTERSECT"):
        cut("Boolean {}".format(operation.lower()), operation)
    cut(
        "Boolean of a ball",
        "DIFFERENCE",
        tool_part=s.moved(s.ball(1), (2, 2, 2), 0.75),
        place="mirrored",
    )
    cut(
        "Boolean cavity",
        "DIFFERENCE",
        tool_part=s.box((0.5, 0.5, 0.5), (1.5, 1.25, 1)),
        place="off the origin",
    )


def refused():
    """None of these can be measured, and each is asked for by its name."""
    flat = s.sheet(2)
    body("Flat sheet as a solid", flat)
    body("Faces without area", (np.zeros((3, 3)), [[0, 1, 2]]))
    add("Mesh without anything", bpy.data.meshes.new("Nothing"))
    points = bpy.data.meshes.new("Points")
    points.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1), (1, 2)], [])
    add("Vertices and edges", points)
    not_finite = mesh("Not finite", s.box())
    not_finite.vertices[0].co.x = float("nan")
    add("Not finite", not_finite)
    infinite = mesh("Infinite", s.box())
    infinite.vertices[0].co.x = float("inf")
    add("Infinite", infinite)
    body("Scaled to nothing", s.box(), scale=(1, 1, 0))
    body("No density", s.box(), {"density": 0.0})
    body("No mass", s.box(), {"mass_from": "MASS", "mass": 0.0})
    body("No thickness", s.box(), {"kind": "SHELL", "thickness": 0.0})
    body("Wire of a mesh", s.box(), {"kind": "WIRE"})
    body(
        "Wall too thick",
        s.box((0, 0, 0), (1, 2, 0.5)),
        {"kind": "SHELL", "wall": "INWARD", "thickness": 0.3},
    )
    body("Wall of a strip", s.moebius(), {"kind": "SHELL", "wall": "INWARD", "thickness": 0.01})
    body(
        "Attribute that is missing",
        s.box(),
        {"kind": "SHELL", "density_from": "ATTRIBUTE", "thickness": 0.1},
    )
    body(
        "Polynomial that is none",
        s.box(),
        {"density_from": "POLYNOMIAL", "density_polynomial": "1000 +* z"},
    )
    body(
        "Polynomial below zero",
        s.box(),
        {"density_from": "POLYNOMIAL", "density_polynomial": "-1000 - z"},
    )
    body("Volume object that is missing", s.box(), {"density_from": "VOLUME"})
    body("Disabled", s.box()).hide_viewport = True
    away = bpy.data.collections.new("Excluded")
    bpy.context.scene.collection.children.link(away)
    body("Excluded", s.box(), collection=away)
    bpy.context.view_layer.layer_collection.children["Excluded"].exclude = True
    add("Empty")
    hollow = add("Instance of nothing")
    hollow.instance_type, hollow.instance_collection = (
        "COLLECTION",
        bpy.data.collections.new("Hollow"),
    )
    add("Light", bpy.data.lights.new("Light", "SUN"))
    add("Camera", bpy.data.cameras.new("Camera"))
    add("Armature", bpy.data.armatures.new("Armature"))
    add("Lattice", bpy.data.lattices.new("Lattice"))
    add("Curve without a surface", curve("Bare", ZIGZAG))
    given(add("Open curve as a region", curve("Open", ZIGZAG)), kind="SHELL", thickness=0.1)
    blank = bpy.data.curves.new("Blank", "FONT")
    blank.body = " "
    add("Empty text", blank)
    add("Volume without a file", bpy.data.volumes.new("Volume"))
    add("Hair", bpy.data.hair_curves.new("Hair"))
    add("Points", bpy.data.pointclouds.new("Points"))
    body("Beyond all numbers", s.box(), scale=(1e30, 1e30, 1e30), size=1e30)
    body("Below all numbers", s.box(), scale=(1e-30, 1e-30, 1e-30), size=1e-35)


# Other units


def small_set():
    """One of each way, for other units."""
    spread(
        {
            "Box": s.box((0, 0, 0), (1, 2, 3)),
            "L beam": s.prism(s.L_PLAN),
            "Hull": s.random_hull(6, 9),
            "Open box": s.without(s.box(), 1),
            "Cavity": s.joined(s.box((-2, -2, -2), (2, 2, 2)), s.inverted(s.box())),
        },
        2,
    )
    body("Thin shell", s.box(), {"kind": "SHELL", "thickness": 0.125}, "turned")
    body(
        "Wall",
        s.box((0, 0, 0), (1, 2, 3)),
        {"kind": "SHELL", "wall": "INWARD", "thickness": 0.125},
        "turned",
    )
    body(
        "Polynomial",
        s.box(),
        {"density_from": "POLYNOMIAL", "density_polynomial": "1000 + 20*z"},
        "turned",
    )
    body("Weighed", s.box(), {"mass_from": "MASS", "mass": 2.5}, "mirrored")
    given(add("Wire", curve("Wire", WAVE, "NURBS")), kind="WIRE")
    made(bpy.ops.surface.primitive_nurbs_surface_torus_add, "NURBS torus", location=(1, 2, 3))


def millimeters():
    bpy.context.scene.unit_settings.scale_length = 0.001
    small_set()


def kilometers():
    bpy.context.scene.unit_settings.scale_length = 1000.0
    small_set()


# Sections


def sections():
    """Flat bodies, for the operator that measures sections."""
    outlines = {
        "L section": s.L_PLAN,
        "U section": s.U_PLAN,
        "Comb section": s.COMB_PLAN,
        "Slanted section": s.SLANTED_PLAN,
        "Hexagon": s.regular(6).tolist(),
    }
    places = ("at the origin", "turned", "sheared", "scaled unevenly", "far away")
    for (name, outline), place in zip(outlines.items(), places):
        flat = (
            np.column_stack([np.asarray(outline, float), np.zeros(len(outline))]),
            [list(range(len(outline)))],
        )
        body(name, flat, place=place)
    body("Sheet", s.sheet(4), place="tiny")
    add(
        "Outline",
        curve("Outline", np.array(s.L_PLAN), cyclic=True, dimensions="2D", fill_mode="BOTH"),
        location=(1, 2, 3),
        rotation_euler=TURN,
    )


SCENES = {
    "closed": closed,
    "faulty": faulty,
    "overlaps": overlaps,
    "shapes": shapes,
    "shells": shells,
    "curves": curves,
    "nurbs": nurbs,
    "built": built,
    "densities": densities,
    "volumes": volumes,
    "booleans": booleans,
    "refused": refused,
    "millimeters": millimeters,
    "kilometers": kilometers,
    "sections": sections,
}
EVALUATED = {
    "curves",
    "built",
    "booleans",
    "overlaps",
    "volumes/Fog",
    "volumes/Level set",
    "volumes total",
}
NAMED = {"booleans": lambda name: not name.endswith("operand"), "refused": lambda name: True}
