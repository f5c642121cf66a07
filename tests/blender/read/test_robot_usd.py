# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Robots as USD from numbers that are known, in all units and by all operations; and how much
descriptions may hold.
"""

import json

import numpy as np
import pytest
from body_moments.core.robots.read import descriptions
from body_moments.core.verdict import FileError

from tests.blender.robot_truth import about, check_repair, near, quaternion, random_inertial, read

SEEDS = pytest.mark.parametrize("seed", range(6))


def usd_steps(rng):
    """Operations with their values, and what they do."""
    axis, angle, vector, scales = (
        rng.normal(size=3),
        rng.uniform(-3, 3),
        rng.normal(size=3),
        rng.uniform(0.5, 2),
    )
    turn, angles = np.eye(4), rng.uniform(-3, 3, 3)
    turn[:3, :3] = about(axis, angle)
    moved, scaled = np.eye(4), np.diag([scales, scales, scales, 1])
    moved[:3, 3] = vector
    yield "translate", vector, moved
    yield "translate:pivot", vector, moved
    yield "scale", [scales] * 3, scaled
    yield "orient", quaternion(axis, angle), turn
    yield "transform", (moved @ turn @ scaled).T, moved @ turn @ scaled
    for order in ("X", "Y", "Z", "XYZ", "ZYX", "YXZ"):
        step = np.eye(4)
        for name, each in zip(order, angles):  # the first of them acts first
            step[:3, :3] = about(np.eye(3)["XYZ".index(name)], each) @ step[:3, :3]
        yield "rotate" + order, np.degrees(angles[: len(order)]), step


def usd_operations(rng, count):
    """The text of some operations, and what all of them do: the last of them acts first."""
    lines, names, matrix = [], [], np.eye(4)
    steps = list(usd_steps(rng))
    chosen = [steps[number] for number in rng.permutation(len(steps))[:count]]
    for kind, values, step in chosen:
        name = "xformOp:" + kind
        lines.append(
            "double[] {} = ({})".format(name, ", ".join(map(repr, np.ravel(values).tolist())))
        )
        names.append(name)
        matrix = matrix @ step
    if count and rng.integers(2):  # back again, as pivots do
        names.append("!invert!" + names[0])
        matrix = matrix @ np.linalg.inv(chosen[0][2])
    lines.append("uniform token[] xformOpOrder = [{}]".format(", ".join(map(json.dumps, names))))
    return "\n".join(lines), matrix


@SEEDS
def test_usd(tmp_path, seed):
    """Links in axes of their own, in meters and kilograms; shapes with all that stands above
    them.
    """
    rng = np.random.default_rng(seed)
    meters, kilograms = [(0.01, 1.0), (1.0, 0.001), (0.001, 2.0)][seed % 3]
    above, first = usd_operations(rng, 4)
    own, second = usd_operations(rng, seed)
    below, third = usd_operations(rng, 3)
    body = first @ second
    scale = np.cbrt(np.linalg.det(body[:3, :3]))
    local = np.diag([scale, scale, scale, 1.0])  # in the link's axes
    inner = local @ third
    mass, center, moments, tensor = random_inertial(rng, about((1, 2, 3), 0.7))
    radius, height = rng.uniform(0.5, 2, 2).tolist()
    corners, sizes = rng.normal(size=(6, 3)), [3, 4, 5]
    indices = rng.integers(0, 6, sum(sizes))
    values = {
        "center": center,
        "moments": moments,
        "axes": np.multiply(quaternion((1, 2, 3), 0.7), 2),
    }
    values = {
        name: "({})".format(", ".join(map(repr, value.tolist()))) for name, value in values.items()
    }
    points = ", ".join("({})".format(", ".join(map(repr, point))) for point in corners.tolist())
    mesh = "point3f[] points = [{}]\nint[] faceVertexCounts = {}\n".format(points, sizes)
    mesh += "int[] faceVertexIndices = {}\n".format(indices.tolist())
    prims = []
    for kind, statements in (
        ("Cube", "double size = {!r}".format(radius)),
        ("Cube", ""),
        ("Sphere", "double radius = {!r}".format(radius)),
        ("Sphere", ""),
        (
            "Capsule",
            'double radius = {!r}\ndouble height = {!r}\ntoken axis = "X"'.format(radius, height),
        ),
        ("Capsule", ""),
        (
            "Cylinder",
            'double radius = {!r}\ndouble height = {!r}\ntoken axis = "Y"'.format(radius, height),
        ),
        ("Cylinder", 'uniform token axis = "Z"'),
        ("Mesh", mesh),
        ("Mesh", mesh + 'uniform token orientation = "leftHanded"'),
        ("Scope", ""),
    ):
        number = len(prims)
        schemas = '(prepend apiSchemas = ["PhysicsCollisionAPI"])' if number % 2 else ""
        prims.append(
            'def {} "p{}" {}\n{{\n{}\n{}\n}}\n'.format(kind, number, schemas, below, statements)
        )
    content = """#usda 1.0
(
    metersPerUnit = {meters!r}
    kilogramsPerUnit = {kilograms!r}  # a comment = 3
    doc = \"\"\"{{ more (
    lines\"\"\"
)
def Xform "world" ( doc = "a }} b" )
{{
    {above}
    variantSet "looks" = {{
        "a" {{ def Xform "no" ( apiSchemas = ["PhysicsRigidBodyAPI"] ) {{}} }}
    }}
    rel material:binding = </m> ( a = 1 )
    custom asset file = @a.png@
    float alone
    def Xform "body" (
        prepend apiSchemas = ["PhysicsRigidBodyAPI", "PhysicsMassAPI"]
    )
    {{
        float physics:mass = {mass!r} ( doc = "kg" )
        point3f physics:centerOfMass = {center}; float3 physics:diagonalInertia = {moments}
        quatf physics:principalAxes = {axes}
        {own}
        {prims}
        def Xform "next" ( prepend apiSchemas = ["PhysicsRigidBodyAPI"] ) {{
            !reset!
            def Sphere "s" {{}}
        }}
        over "more" {{ class Sphere "s" {{}} }}
    }}
    def Sphere "only" ( prepend apiSchemas = ["PhysicsMassAPI"] ) {{ float physics:mass = 1 }}
}}
""".format(
        meters=meters,
        kilograms=kilograms,
        above=above,
        own=own,
        prims="".join(prims),
        mass=mass,
        **values,
    ).replace("!reset!", 'uniform token[] xformOpOrder = ["!resetXformStack!"]')
    description = read(tmp_path, content)
    assert (description.name, description.format) == ("world", "usd")
    link, following, only = description.links
    assert [one.name for one in description.links] == [
        "world/body",
        "world/body/next",
        "world/only",
    ]
    assert [one.inertial is None for one in description.links] == [False, True, True]
    assert link.moves and not link.findings
    assert near(link.inertial.mass, mass * kilograms, 1e-14)
    assert near(link.inertial.center, scale * center * meters, 1e-12)
    assert near(link.inertial.inertia, tensor * meters**2 * kilograms, 1e-12)
    assert near(link.local, local, 1e-12)
    inside = description.source[slice(*link.span)]
    assert inside.lstrip().startswith(b"float physics:mass") and inside.rstrip().endswith(
        b'class Sphere "s" {} }'
    )
    grown = scale * np.cbrt(np.linalg.det(third[:3, :3])) * meters
    turned = third[:3, :3] / np.cbrt(np.linalg.det(third[:3, :3]))
    orders = {"X": [1, 2, 0], "Y": [2, 0, 1], "Z": [0, 1, 2]}
    expected = [
        *(("box", np.full(3, radius)), ("box", np.full(3, 2.0))),
        *(("ellipsoid", np.full(3, radius)), ("ellipsoid", np.full(3, 1.0))),
        *(("capsule", (radius, height), "X"), ("capsule", (0.5, 1.0), "Z")),
        *(("cylinder", (radius, height), "Y"), ("cylinder", (1.0, 2.0), "Z")),
    ]
    for number, (stated, (kind, size, *axis)) in enumerate(zip(link.shapes, expected)):
        shape = stated.shape
        assert shape.kind == kind and stated.role == ("collision" if number % 2 else "visual")
        assert near(np.array(shape.size), np.array(size) * grown, 1e-12)
        assert np.abs(shape.pose.position - inner[:3, 3] * meters).max() <= 1e-12 * np.max(
            shape.size
        )
        assert near(shape.pose.rotation, turned[:, orders[axis[0] if axis else "Z"]], 1e-12)
    starts = np.cumsum(sizes) - sizes
    fans = [(s, s + i + 1, s + i + 2) for s, count in zip(starts, sizes) for i in range(count - 2)]
    placed = (corners @ inner[:3, :3].T + inner[:3, 3]) * meters
    for stated, order in zip(link.shapes[8:10], ([0, 1, 2], [2, 1, 0])):
        assert stated.shape.kind == "mesh" and near(stated.shape.surface.points, placed, 1e-12)
        assert (stated.shape.surface.triangles == indices[np.array(fans)][:, order]).all()
    # up to the next body
    assert len(link.shapes) == 11 and link.shapes[10].shape.kind == "ellipsoid"
    for other, size, place in (
        (following, meters, np.eye(4)),
        (only, meters * np.cbrt(np.linalg.det(first)), first),
    ):
        assert near(np.array(other.shapes[0].shape.size), np.full(3, size), 1e-12)
        assert near(other.local, np.diag([*[np.cbrt(np.linalg.det(place))] * 3, 1]), 1e-12)
    check_repair(tmp_path, description)


def test_damaged_meshes_in_usd_are_findings(tmp_path):
    whole = {
        "points": "[(0, 0, 0), (1, 0, 0), (0, 1, 0)]",
        "faceVertexCounts": "[3]",
        "faceVertexIndices": "[0, 1, 2]",
    }
    wrong = [
        *(
            {"points": "[0, 1]"},
            {"faceVertexCounts": "[4]"},
            {"faceVertexCounts": "[0]", "faceVertexIndices": "[]"},
        ),
        *({"faceVertexIndices": "[0, 1, 3]"}, {"faceVertexIndices": "[0, -1, 2]"}),
    ]
    cases = [{**whole, **change} for change in wrong]
    cases += [{name: value for name, value in whole.items() if name != left} for left in whole]
    # a triangle
    cases.append(
        {**whole, "faceVertexCounts": "[2, 3, 1]", "faceVertexIndices": "[2, 2, 0, 1, 2, 1]"}
    )
    meshes = ["\n".join("int[] {} = {}".format(*item) for item in case.items()) for case in cases]
    prims = "".join('def Mesh "m" {{\n{}\n}}\n'.format(mesh) for mesh in meshes)
    body = '#usda 1.0\ndef Xform "b" ( apiSchemas = ["PhysicsRigidBodyAPI"] ) {{\n{}{}}}'
    (link,) = read(tmp_path, body.format("float physics:mass = 1\n", prims)).links
    assert len(link.shapes) == 1 and link.inertial is None
    # an absent attribute may stand in another layer
    texts = [
        "[0, 1]",
        "[4]",
        "[]",
        "[0, 1, 3]",
        "[0, -1, 2]",
    ]
    assert [one.values["text"] for one in link.findings] == texts
    assert (
        link.shapes[0].shape.surface.points == [[0, 0, 0], [0.01, 0, 0], [0, 0.01, 0]]
    ).all()  # centimeters
    wrong = "float3 physics:diagonalInertia = (1, 2)\nfloat physics:mass = 1\n"
    (link,) = read(tmp_path, body.format(wrong, "")).links
    assert [(one.code, one.values["text"]) for one in link.findings] == [
        ("description_number", "(1, 2)")
    ]
    for word in ("1_0", "٣", "1.0x0"):
        wrong = 'float physics:mass = {0}\ndef Sphere "s" {{\ndouble radius = {0}x\n}}'.format(word)
        (link,) = read(tmp_path, body.format(wrong, "")).links
        found = [
            (one.values["text"], one.values["element"], one.values["line"]) for one in link.findings
        ]
        assert found == [(word, "b", 3), (word + "x", "s", 5)] and not link.shapes


@pytest.mark.parametrize(
    "content, line",
    [
        ('def Xform "a" {\n double x = (1,', 3),
        ('\ndef Xform "a" {\n double x = 1 `"\n}', 4),
        ('\n\nxform "a" {}', 4),
        ('def Xform "a"', 2),
        ('def Xform "a" {\n\n', 4),
        ('def Xform "a" {\n double x = 1\n float', 4),
        ('def Xform "a" {\n double x =', 3),
    ],
)
def test_a_layer_that_is_cut_short_says_where(tmp_path, content, line):
    with pytest.raises(FileError) as refused:
        read(tmp_path, "#usda 1.0\n" + content)
    assert (refused.value.finding.code, refused.value.finding.values["line"]) == (
        "description_invalid",
        line,
    )


def bodies(tmp_path, inside, metadata=""):
    layer = "#usda 1.0\n{}def {{}}\n{}".format(metadata, inside)
    return read(tmp_path, layer).links


BODY = 'def Xform "{}" (apiSchemas = ["PhysicsRigidBodyAPI"]) {{\n{}\n}}\n'


def test_minimal_usd_has_defaults_of_the_schemas(tmp_path):
    """Centimeters, kilograms, a center at the origin and axes along the body's; and no mass without
    both numbers.
    """
    mass, diagonal = "float physics:mass = 3\n", "float3 physics:diagonalInertia = (2, 3, 4)\n"
    zeros = "quatf physics:principalAxes = (0, 0, 0, 0)\n"
    for inside in (mass + diagonal, mass + diagonal + zeros):
        ((link),) = bodies(tmp_path, BODY.format("b", inside))
        stated = link.inertial
        assert (
            stated.mass == 3.0
            and (stated.center == 0.0).all()
            and (stated.rotation == np.eye(3)).all()
        )
        assert near(stated.tensor, np.diag([2e-4, 3e-4, 4e-4]), 1e-15) and stated.quaternion == (
            1.0,
            0.0,
            0.0,
            0.0,
        )
    for inside in (mass, diagonal, zeros):
        (link,) = bodies(tmp_path, BODY.format("b", inside))
        assert link.inertial is None and not link.findings
    with pytest.raises(FileError) as refused:
        read(tmp_path, "#usda 1.0\n")
    assert refused.value.finding.code == "file_without_objects"
    (tmp_path / "a.usda").write_bytes(b'#usda 1.0\n\ndef "\xff"')
    with pytest.raises(FileError) as refused:
        descriptions.read_description(tmp_path / "a.usda")
    assert (refused.value.finding.code, refused.value.finding.values["line"]) == (
        "description_invalid",
        1,
    )


def test_usd_statements_without_value_end_at_the_next(tmp_path):
    inside = (
        "float a\nfloat3 b (\ndoc = 1\n)\nfloat physics:mass = 3\nfloat3 physics:diagonalInertia = "
        "(2, 3, 4); "
    )
    (link,) = bodies(tmp_path, BODY.format("b", inside + 'int c; int[] d\ndef Cube "e" {}\nint f'))
    assert link.inertial.mass == 3.0 and [one.shape.kind for one in link.shapes] == ["box"]


def test_usd_shapes_are_as_large_as_each_axis_says(tmp_path):
    scale = 'float3 xformOp:scale = ({})\nuniform token[] xformOpOrder = ["xformOp:scale"]\n'
    prims = [
        *(
            'def Cube "a" {',
            'def Sphere "a" { double radius = (3, 4)',
            'def Sphere "a" { double radius = None',
        ),
        *(
            'def Cylinder "a" { uniform token axis = "{}"'.replace("{}", axis)
            for axis in ("X", "Y", "Z", "W")
        ),
        *('def Capsule "a" { token axis = "X"', 'def Capsule "a" {', 'def Cone "a" {'),
    ]
    sizes = [(4, 6, 10), (2, 3, 5), (3, 4), (5, 6), (2, 10), (2, 10), (1.5, 2), (1, 5)]
    turns = [np.eye(3)] * 2 + [
        np.eye(3)[:, order] for order in ([1, 2, 0], [2, 0, 1], [0, 1, 2], [0, 1, 2])
    ]
    turns += [np.eye(3)[:, [1, 2, 0]], np.eye(3)]
    # a mirrored one is turned
    for signs, turn in (
        ((1, 1, 1), np.eye(3)),
        ((-1, 1, 1), np.diag([1, -1, -1])),
    ):
        text = scale.format(", ".join(map(str, np.multiply(signs, (2, 3, 5)).tolist())))
        inside = "".join("{}\n{}}}\n".format(prim, text) for prim in prims)
        (link,) = bodies(tmp_path, BODY.format("b", inside), "(\nmetersPerUnit = 1\n)\n")
        # not the default in its place
        assert [one.values["text"] for one in link.findings] == [
            "(3, 4)",
            "Cone",
        ]
        for stated, size, own in zip(link.shapes, sizes, turns, strict=True):
            assert near(np.array(stated.shape.size), np.array(size, float), 1e-15)
            assert near(stated.shape.pose.rotation, turn @ own, 1e-15)


@pytest.mark.parametrize("is_mirrored", [False, True])
@pytest.mark.parametrize("is_left_handed", [False, True])
def test_usd_meshes_and_bodies_that_are_mirrored(tmp_path, is_mirrored, is_left_handed):
    """A mirror image of a left-handed mesh is a right-handed one.

    A body's own axes are never mirrored.
    """
    scale = 'float3 xformOp:scale = ({}, 2, 2)\nuniform token[] xformOpOrder = ["xformOp:scale"]\n'
    scale = scale.format(-2 if is_mirrored else 2)
    mesh = "point3f[] points = [(1, 0, 0), (0, 1, 0), (0, 0, 1)]\nint[] faceVertexCounts = [3]\n"
    mesh += "int[] faceVertexIndices = [0, 1, 2]\n"
    mesh += 'uniform token orientation = "{}Handed"\n'.format("left" if is_left_handed else "right")
    mass = "float physics:mass = 3\nfloat3 physics:diagonalInertia = (2, 3, 4)\n"
    mass += "point3f physics:centerOfMass = (10, 20, 30)\n"
    own = BODY.format("b", mass + scale + 'def Mesh "m" {{\n{}}}'.format(mesh))
    below = BODY.format("b", 'def Mesh "m" {{\n{}{}}}'.format(scale, mesh))
    side = 2.0 * np.array([-1.0, 1.0, 1.0] if is_mirrored else [1.0, 1.0, 1.0])
    for content, local in ((own, np.full(3, side[0])), (below, side)):
        (link,) = bodies(tmp_path, content)
        (made,) = (shape.shape.surface for shape in link.shapes)
        assert near(made.points, 0.01 * np.diag(local), 1e-15)
        # whether it faces away from the origin
        ahead = np.linalg.det(made.points[made.triangles[0]]) > 0.0
        assert ahead == (not is_left_handed)
        if content is own:
            assert near(link.local, np.diag([*local, 1.0]), 1e-15)
            assert near(link.inertial.center, local * (0.1, 0.2, 0.3), 1e-15)
