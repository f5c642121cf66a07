# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Descriptions of several files: stages that usd-core wrote, in text and binary, and files for
xacro.
"""

import sys

import pytest
from body_moments.core.robots import Auditor, Roots, read_description
from body_moments.core.verdict import MeasureError
from pxr import Gf, Usd, UsdGeom, UsdPhysics, UsdUtils

RIGHT = 8000.0 * 4.0 / 6.0  # of a cube with sides of 2 m
MACRO = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:macro name="cube"
params="name i">
<link name="${name}"><inertial><mass value="8000"/><inertia ixx="${i}" iyy="${i}" izz="${i}"
ixy="0" ixz="0" iyz="0"/>
</inertial><collision><geometry><box size="2 2 2"/></geometry></collision></link>
</xacro:macro></robot>"""
ROBOT = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:include filename="FILE"/>
<xacro:cube name="a" i="${8000*4/6}"/><xacro:cube name="b" i="${8000*4/6*1000}"/></robot>"""


def stage_of(path):
    stage = Usd.Stage.CreateNew(str(path))
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    return stage


def write_part(path, moment):
    stage = stage_of(path)
    prim = UsdGeom.Xform.Define(stage, "/part").GetPrim()
    UsdPhysics.RigidBodyAPI.Apply(prim)
    mass = UsdPhysics.MassAPI.Apply(prim)
    mass.CreateMassAttr(8000.0)
    mass.CreateDiagonalInertiaAttr(Gf.Vec3f(moment))
    mass.CreatePrincipalAxesAttr(Gf.Quatf(1.0))
    UsdPhysics.CollisionAPI.Apply(UsdGeom.Cube.Define(stage, "/part/shape").GetPrim())
    stage.SetDefaultPrim(prim)
    stage.Save()


def codes(path):
    """The findings of each link, by its name."""
    audit = Auditor(Roots.for_file(path)).audit(read_description(path))
    assert all(one.link.span is None for one in audit.links) and not audit.repairs()
    return {
        one.link.name: [str(entry.finding.code) for entry in one.entries] for one in audit.links
    }


def refusal(path):
    with pytest.raises(MeasureError) as refused:
        read_description(path, Roots.for_file(path))
    return refused.value.finding


@pytest.mark.parametrize("end", ["usda", "usdc", "usdz"])
def test_parts_of_other_usd_files_are_audited(tmp_path, end, monkeypatch):
    """Also of instances, whose content is a prototype's."""
    inner = "usdc" if end == "usdz" else end
    write_part(tmp_path / "good.{}".format(inner), RIGHT)
    write_part(tmp_path / "bad.{}".format(inner), 1000.0 * RIGHT)
    path = tmp_path / "robot.{}".format(inner)
    stage = stage_of(path)
    for name in ("good", "bad"):
        prim = stage.DefinePrim("/robot/" + name)
        prim.GetReferences().AddReference("./{}.{}".format(name, inner))
        prim.SetInstanceable(True)
    stage.Save()
    if end == "usdz":
        assert UsdUtils.CreateNewUsdzPackage(str(path), str(tmp_path / "robot.usdz"))
        path = tmp_path / "robot.usdz"
    assert codes(path) == {"robot/good": [], "robot/bad": ["audit_unit"]}
    monkeypatch.setitem(sys.modules, "pxr.Sdf", None)
    assert refusal(path).code == "usd_not_text"


def test_usd_files_outside_and_missing_ones_are_refused(tmp_path):
    (tmp_path / "a" / "b").mkdir(parents=True)
    write_part(tmp_path / "part.usda", RIGHT)
    for name, cause in (("../../part.usda", "mesh_outside"), ("./none.usda", "mesh_missing")):
        path = tmp_path / "a" / "b" / "robot.usda"
        path.unlink(missing_ok=True)
        path.write_text('#usda 1.0\ndef Xform "a" (payload = @{}@)\n{{\n}}\n'.format(name))
        found = refusal(path)
        assert found.code == "include_unreadable" and found.values["cause"]["code"] == cause
        path.unlink()
        layers = '#usda 1.0\n(\n subLayers = [\n  @{}@\n ]\n)\ndef "x"\n{{\n}}\n'.format(name)
        (tmp_path / "a" / "b" / cause).with_suffix(".usda").write_text(layers)
        assert (
            refusal((tmp_path / "a" / "b" / cause).with_suffix(".usda")).values["cause"]["code"]
            == cause
        )


def test_damaged_binary_usd_is_refused(tmp_path):
    write_part(tmp_path / "part.usdc", RIGHT)
    data = (tmp_path / "part.usdc").read_bytes()
    for index, part in enumerate((data[:100], data[: len(data) // 2], b"PK\3\4" + data)):
        path = tmp_path / "cut{}.{}".format(index, "usdz" if part.startswith(b"PK") else "usdc")
        path.write_bytes(part)
        assert refusal(path).code in ("file_unreadable", "file_without_objects")


def test_xacro_is_expanded_within_the_roots(tmp_path, monkeypatch):
    pytest.importorskip("xacro")
    package = tmp_path / "package"
    (package / "urdf").mkdir(parents=True)
    path = package / "urdf" / "r.urdf.xacro"
    for name in ("m.xacro", "../m.xacro", "../../m.xacro"):
        (package / "urdf" / name).write_text(MACRO)
        path.write_text(ROBOT.replace("FILE", name))
        if name.count("..") < 2:
            assert codes(path) == {"a": [], "b": ["audit_unit"]}
            continue
        found = refusal(path)
        assert (
            found.code == "include_unreadable" and found.values["cause"]["code"] == "mesh_outside"
        )
    for wrong in ("FILE", "r.urdf.xacro"):  # missing, and itself
        path.write_text(ROBOT.replace("FILE", wrong))
        assert refusal(path).code in ("include_unreadable", "xacro_not_expanded")
    path.write_text(ROBOT.replace("FILE", "m.xacro").replace("8000*4/6*1000", "nope"))
    assert "nope" in refusal(path).values["error"]


def test_faults_of_xacro_have_the_places_of_their_elements(tmp_path):
    """In the file that was named, and in the macro of another one; each at the element that was
    expanded.
    """
    pytest.importorskip("xacro")
    (tmp_path / "urdf").mkdir()
    inner = MACRO.replace("<inertial>", "\n <inertial>").replace(
        "<collision>", "\n\n  <collision>\n"
    )
    inner = inner.replace(
        "<box", '<mesh filename="${name}.stl"/></geometry></collision><visual><geometry><box'
    )
    inner = inner.replace("</collision></link>", "</visual></link>")
    (tmp_path / "urdf" / "m.xacro").write_text(inner)
    (tmp_path / "b.stl").write_text("")  # It is beside the file that is named.
    path = tmp_path / "r.urdf.xacro"
    own = (
        '\n<link name="own">\n <inertial><mass value="nope"/></inertial></link>\n<xacro:if '
        'value="1">'
    )
    own += '<link name="mass"><inertial>\n<mass value="-1"/></inertial></link></xacro:if></robot>'
    path.write_text(ROBOT.replace("FILE", "urdf/m.xacro").replace("</robot>", own))
    links = {
        one.link.name: one
        for one in Auditor(Roots.for_file(path)).audit(read_description(path)).links
    }
    macro = str(tmp_path / "urdf" / "m.xacro")
    places = {
        name: [(str(entry.finding.code), *entry.place) for entry in one.entries]
        for name, one in links.items()
    }
    assert places == {
        "a": [("mesh_missing", 8, 3, macro)],
        "b": [("mesh_unreadable", 8, 3, macro)],
        "own": [("description_number", 5, 12, "")],
        "mass": [("inertial_not_positive", 6, 39, "")] * 2,
    }
    assert {name: one.link.place for name, one in links.items()} == {
        **{"a": (3, 1, macro), "b": (3, 1, macro)},
        **{"own": (4, 1, ""), "mass": (6, 21, "")},
    }


def test_xacro_without_its_module_names_the_command(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "xacro", None)
    path = tmp_path / "r.xacro"
    path.write_text(ROBOT)
    found = refusal(path)
    assert found.code == "xacro_not_expanded" and "xacro r.xacro > robot.urdf" in str(found)
