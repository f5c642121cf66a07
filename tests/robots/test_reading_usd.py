# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Inertials of USD that Newton's schema states, and prims with a mass that are no links."""

import numpy as np
import pytest
from body_moments.core.robots import Auditor, Roots, read_description
from pxr import Gf, Usd, UsdGeom, UsdPhysics

from tests.robots.links import near, rotation
from tests.robots.stage import stage_of

HEAD = "#usda 1.0\n(\n metersPerUnit = 0.5\n kilogramsPerUnit = 3\n)\n"
BODY = """def Cube "body" (
    apiSchemas = ["PhysicsRigidBodyAPI", "PhysicsCollisionAPI", "NewtonMassAPI"]
)
{{
    float physics:mass = 6
    {}
    double3 xformOp:translate = (1, 2, 3)
    quatd xformOp:orient = (0.5, 0.5, 0.5, 0.5)
    uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:orient"]
}}
"""
CUBE = "float3 physics:diagonalInertia = (4, 4, 4)"  # a cube of side 2 and mass 6
NEWTON = "double[] newton:inertia = [{}]"


def audited(path, text):
    path.write_text(HEAD + text)
    return Auditor(Roots.for_file(path)).audit(read_description(path)).links


def codes(one):
    return [entry.finding.code for entry in one.entries]


@pytest.mark.parametrize("seed", range(5))
def test_newton_inertia_is_the_inertial_of_the_stage(tmp_path, seed):
    """Both ways of one tensor, as pxr has them, are one inertial, without a finding about it."""
    rng = np.random.default_rng(seed)
    moments, axes = rng.uniform(1.0, 1.9, 3), rotation(rng)
    entries = (axes * moments @ axes.T)[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
    turn = Gf.Matrix3d(*axes.T.ravel().tolist()).ExtractRotation().GetQuat()
    numbers = turn.GetReal(), *turn.GetImaginary()
    both = (
        NEWTON.format(", ".join(map(repr, entries.tolist()))),
        "float3 physics:diagonalInertia = {}".format(tuple(moments.tolist())),
        "quatf physics:principalAxes = {}".format(numbers),
    )
    found = []
    for lines in (both[:1], both[1:], both, (*both[1:], NEWTON.format(""))):
        text = BODY.format("\n    ".join(lines))
        (one,) = audited(tmp_path / "r.usda", text)
        assert "audit_overridden" not in codes(one)
        found.append(one.link.inertial)
    stage = stage_of(HEAD + BODY.format("\n    ".join(both)))
    xx, yy, zz, xy, xz, yz = stage.GetAttributeAtPath("/body.newton:inertia").Get()
    truth = 0.5**2 * 3 * np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    assert near(found[0].inertia, truth) and near(found[2].inertia, truth)
    assert all(near(one.inertia, truth, 1e-6) and one.mass == 18.0 for one in found)


def test_newton_inertia_is_judged_before_the_diagonal_one(tmp_path):
    wrong = "float3 physics:diagonalInertia = (4, 4, 8)"
    (one,) = audited(tmp_path / "r.usda", BODY.format(wrong + "\n" + NEWTON.format("4,4,4,0,0,0")))
    assert codes(one) == ["audit_overridden"]
    assert one.entries[0].finding.values["program"] == "Newton"
    (one,) = audited(tmp_path / "r.usda", BODY.format(CUBE + "\n" + NEWTON.format("4,4,9,0,0,0")))
    assert codes(one)[:2] == ["audit_overridden", "inertial_triangle"]
    text = BODY.replace("Newton", "Physics").format(CUBE + "\n" + NEWTON.format("4,4,9,0,0,0"))
    (one,) = audited(tmp_path / "r.usda", text)
    assert not one.entries  # Newton reads it only if the prim has its schema.


@pytest.mark.parametrize("entries", ["1, 2, 3", "4, 4, four, 0, 0, 0", "1, 1, 1, 0, 0, 0, 0"])
def test_wrong_newton_inertia_is_a_finding_at_its_line(tmp_path, entries):
    (one,) = audited(tmp_path / "r.usda", BODY.format(CUBE + "\n" + NEWTON.format(entries)))
    assert codes(one) == ["description_number"] and one.entries[0].place.line == 12


def test_prims_with_a_mass_in_a_body_are_no_links(tmp_path):
    """A collider's own mass is a part of its body's; a lone mass that is no collider is a link."""
    mass = 'def {} "{}" ( apiSchemas = ["PhysicsMassAPI"{}] ) {{ float physics:mass = 1 {} }}\n'
    collider, collides = ', "PhysicsCollisionAPI"', "float3 physics:diagonalInertia = (1, 1, 1)"
    inner = mass.format("Cube", "part", collider, "") + mass.format("Xform", "frame", "", collides)
    body = 'def Xform "body" ( apiSchemas = ["PhysicsRigidBodyAPI"] ) {{ {} }}\n'.format(inner)
    text = body + mass.format("Cube", "ground", collider, "") + mass.format("Xform", "base", "", "")
    links = audited(tmp_path / "r.usda", text)
    assert [one.link.name for one in links] == ["body", "base"]
    assert [shape.role for shape in links[0].link.shapes] == ["collision"]


MASSES = (
    ("", "", ""),
    ("", "", "physics:density = 0.0005"),
    ("physics:density = 0.0003", "", "physics:density = 0.0005"),
    ("physics:density = 0.0003", "physics:density = 0.0007", "physics:density = 0.0005"),
    ("physics:mass = 9", "physics:mass = 3", ""),
    ("physics:mass = 5|point3f physics:centerOfMass = (50, 0, 10)", "", ""),
    (
        "float3 physics:diagonalInertia = (10000, 20000, 25000)|"
        "quatf physics:principalAxes = (0.6, 0, 0, 0.8)",
        "physics:mass = 3",
        "",
    ),
    ("", "physics:mass = 3|point3f physics:centerOfMass = (10, 20, 0)", ""),
    ("", "float3 physics:diagonalInertia = (1e4, 2e4, 2.5e4)|physics:mass = 2", ""),
    ("physics:mass = 9|float3 physics:diagonalInertia = (1e4, 2e4, 2.5e4)", "", ""),
    (
        "physics:mass = 9|quatf physics:principalAxes = (0.6, 0, 0, 0.8)|"
        "float3 physics:diagonalInertia = (1e4, 2e4, 2.5e4)",
        "physics:mass = 3",
        "",
    ),
    ("quatf physics:principalAxes = (0.6, 0, 0, 0.8)", "physics:mass = 3", ""),
    ("point3f physics:centerOfMass = (0, 0, 0)", "", ""),
    ("physics:mass = 5|point3f physics:centerOfMass = (-inf, -inf, -inf)", "", ""),
)


@pytest.mark.parametrize("body, shape, material", MASSES)
def test_masses_of_colliders_are_those_of_usd(body, shape, material, tmp_path):
    def lines(text):
        named = [
            line if "f " in line or "3 " in line else "float " + line for line in text.split("|")
        ]
        return "\n".join(named) if text else ""

    path = tmp_path / "robot.usda"
    path.write_text(COLLIDERS.format(*map(lines, (body, shape, material))), encoding="utf-8")
    stage = Usd.Stage.Open(str(path))

    def volume_of(prim):
        found = UsdPhysics.RigidBodyAPI.MassInformation()
        place = UsdGeom.Xformable(prim).GetLocalTransformation()
        found.volume = 1e6
        found.inertia = Gf.Matrix3f(1e6 * 1e4 / 6.0)
        found.localPos = Gf.Vec3f(place.ExtractTranslation())
        found.localRot = Gf.Quatf(place.ExtractRotationQuat())
        return found

    prim = UsdPhysics.RigidBodyAPI(stage.GetPrimAtPath("/b"))
    mass, moments, center, axes = prim.ComputeMassProperties(volume_of)
    (link,) = Auditor(Roots.for_file(path)).audit(read_description(path)).links
    inertial = link.link.inertial
    turn = np.array(Gf.Matrix3f(axes)).T
    inertia = (turn * np.array(moments)) @ turn.T * 1e-4
    is_stated = "mass" in body and "Inertia" in body
    assert link.link.from_shapes != is_stated and abs(inertial.mass / mass - 1.0) < 1e-6
    assert near(inertial.center, np.array(center) / 100.0, 1e-6, scale=1.0)
    assert near(inertial.inertia, inertia, 1e-5)


COLLIDERS = """#usda 1.0
( metersPerUnit = 0.01 )
def Xform "b" ( apiSchemas = ["PhysicsRigidBodyAPI", "PhysicsMassAPI"] )
{{
    {}
    def Cube "c" ( apiSchemas = ["PhysicsCollisionAPI", "PhysicsMassAPI", "MaterialBindingAPI"] )
    {{
        double size = 100
        double3 xformOp:translate = (0, 30, 0)
        uniform token[] xformOpOrder = ["xformOp:translate"]
        rel material:binding:physics = </m>
        {}
    }}
    def Cube "d" ( apiSchemas = ["PhysicsCollisionAPI"] )
    {{
        double size = 100
        double3 xformOp:translate = (200, 0, 0)
        uniform token[] xformOpOrder = ["xformOp:translate"]
    }}
}}
def Material "m" ( apiSchemas = ["PhysicsMaterialAPI"] )
{{
    {}
}}
"""
