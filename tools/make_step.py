# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Write tests/core/cad/kernel/step.tar.xz with OpenCascade (`pip install cadquery-ocp==8.0.1.1.0`):
44 parts as STEP files, and their volumes and centers by its GProp in `volumes.json`, in mm.
"""

import json
import math
import tarfile
from pathlib import Path

from OCP import BRepAlgoAPI, BRepBuilderAPI, BRepFilletAPI, BRepOffsetAPI, BRepPrimAPI, gp
from OCP.BRepGProp import BRepGProp
from OCP.collections import Array1_gp_Pnt, HArray1_gp_Pnt, List_TopoDS_Shape
from OCP.GeomAPI import GeomAPI_Interpolate, GeomAPI_PointsToBSpline
from OCP.GProp import GProp_GProps
from OCP.Interface import Interface_Static
from OCP.Quantity import Quantity_Color, Quantity_TOC_RGB
from OCP.STEPCAFControl import STEPCAFControl_Writer
from OCP.STEPControl import STEPControl_AsIs, STEPControl_Writer
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE
from OCP.TopExp import TopExp_Explorer
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS
from OCP.XCAFDoc import XCAFDoc_ColorSurf, XCAFDoc_DocumentTool

FOLDER = Path(__file__).parents[1] / "tests/core/cad/kernel"


def point(*place):
    return gp.gp_Pnt(*map(float, place))


def made(kind, *sizes):
    return getattr(BRepPrimAPI, "BRepPrimAPI_Make" + kind)(*sizes).Shape()


def box(x, y, z, place=(0, 0, 0)):
    return made("Box", point(*place), float(x), float(y), float(z))


def rod(radius, height, place=(0, 0, 0), along=(0, 0, 1)):
    axis = gp.gp_Ax2(point(*place), gp.gp_Dir(*map(float, along)))
    return made("Cylinder", axis, float(radius), float(height))


def combine(kind, *shapes):
    first, *others = shapes
    for other in others:
        first = getattr(BRepAlgoAPI, "BRepAlgoAPI_" + kind)(first, other).Shape()
    return first


def pieces(shape, kind):
    found, explorer = [], TopExp_Explorer(shape, kind)
    while explorer.More():
        if not any(explorer.Current().IsSame(one) for one in found):
            found.append(explorer.Current())
        explorer.Next()
    return found


def rounded(kind, shape, size, which=slice(None)):
    maker = getattr(BRepFilletAPI, "BRepFilletAPI_Make" + kind)(shape)
    for edge in pieces(shape, TopAbs_EDGE)[which]:
        maker.Add(size, TopoDS.Edge(edge))
    return maker.Shape()


def hollow(shape, open_face):
    faces = List_TopoDS_Shape()
    faces.Append(pieces(shape, TopAbs_FACE)[open_face])
    maker = BRepOffsetAPI.BRepOffsetAPI_MakeThickSolid()
    maker.MakeThickSolidByJoin(shape, faces, -1.0, 1e-6)
    return maker.Shape()


def wire(curve):
    edge = BRepBuilderAPI.BRepBuilderAPI_MakeEdge(curve).Edge()
    return BRepBuilderAPI.BRepBuilderAPI_MakeWire(edge).Wire()


def circle(radius, height=0.0):
    return wire(gp.gp_Circ(gp.gp_Ax2(point(0, 0, height), gp.gp_Dir(0, 0, 1)), radius))


def polygon(*corners):
    maker = BRepBuilderAPI.BRepBuilderAPI_MakePolygon()
    for corner in corners:
        maker.Add(point(*corner))
    maker.Close()
    return maker.Wire()


def smooth(*places):
    points = HArray1_gp_Pnt(1, len(places))
    for k, place in enumerate(places, 1):
        points.SetValue(k, point(*place))
    fit = GeomAPI_Interpolate(points, True, 1e-7)
    fit.Perform()
    return wire(fit.Curve())


def swept(section, *motion):
    kind = "Prism" if isinstance(motion[0], gp.gp_Vec) else "Revol"
    return made(kind, BRepBuilderAPI.BRepBuilderAPI_MakeFace(section).Face(), *motion)


def loft(*sections, ruled=False):
    maker = BRepOffsetAPI.BRepOffsetAPI_ThruSections(True, ruled, 1e-6)
    for section in sections:
        maker.AddWire(section)
    maker.Build()
    return maker.Shape()


def pipe(*places):
    points = Array1_gp_Pnt(1, len(places))
    for k, place in enumerate(places, 1):
        points.SetValue(k, point(*place))
    spine = wire(GeomAPI_PointsToBSpline(points).Curve())
    section = BRepBuilderAPI.BRepBuilderAPI_MakeFace(circle(2.0)).Face()
    return BRepOffsetAPI.BRepOffsetAPI_MakePipe(spine, section).Shape()


def place(x, y, z, angle=0.0):
    turn, shift = gp.gp_Trsf(), gp.gp_Trsf()
    turn.SetRotation(gp.gp_Ax1(point(0, 0, 0), gp.gp_Dir(1, 2, 3)), angle)
    shift.SetTranslation(gp.gp_Vec(x, y, z))
    return shift.Multiplied(turn)


def assembly(unit, schema, path):
    """Write a plate with two pairs of bolts; return it."""
    document = TDocStd_Document(TCollection_ExtendedString("parts"))
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    colors = XCAFDoc_DocumentTool.ColorTool_s(document.Main())
    labels = [shapes.AddShape(one, False) for one in (parts["bolt"], box(30, 20, 4))]
    labels += [shapes.NewShape(), shapes.NewShape()]
    for label, name in zip(labels, ("Bolt", "Pl\u00e4tte", "Pair", "Top")):
        TDataStd_Name.Set_s(label, TCollection_ExtendedString(name, True))
    bolt, plate, pair, top = labels
    colors.SetColor(bolt, Quantity_Color(0.8, 0.1, 0.2, Quantity_TOC_RGB), XCAFDoc_ColorSurf)
    for whole, part, *where in (
        (pair, bolt, 5, 5, 4),
        (pair, bolt, 25, 15, 4, 0.4),
        (top, plate, 0, 0, 0),
        (top, pair, 0, 0, 0),
        (top, pair, 100, 0, 0, 1.0),
    ):
        shapes.AddComponent(whole, part, TopLoc_Location(place(*where)))
    shapes.UpdateAssemblies()
    writer = STEPCAFControl_Writer()
    Interface_Static.SetCVal_s("write.step.unit", unit)
    Interface_Static.SetCVal_s("write.step.schema", schema)
    writer.Transfer(document, STEPControl_AsIs)
    writer.Write(str(path))
    return shapes.GetShape_s(top)


def without_owner(member):
    return member.replace(mtime=0, uid=0, gid=0, uname="", gname="", deep=False)


tube = combine("Cut", rod(10, 48), rod(5, 48))
ball = made("Sphere", 5.0)
outline = smooth((10, 0, 0), (4, 5, 0), (0, 9, 0), (-7, 4, 0), (-8, -3, 0), (0, -6, 0))
wall = smooth((10, 0, 0), (13, 0, 2), (12, 0, 8), (9, 0, 12), (8, 0, 5))
axis = gp.gp_Ax1(point(0, 0, 0), gp.gp_Dir(0, 0, 1))
square = [(-5, -5, 0), (5, -5, 0), (5, 5, 0), (-5, 5, 0)]
prism = swept(outline, gp.gp_Vec(0, 0, 12))
vase = swept(wall, axis)
skew = [(3, 0, 0), (5, 0, 0), (5, 4, 6), (3, 4, 6)]
hexagon = [(8 * math.cos(k * math.pi / 3), 8 * math.sin(k * math.pi / 3), 0) for k in range(6)]
holes = [rod(2, 20, (10 + 15 * i, 10 + 15 * j, -5)) for i in range(4) for j in range(3)]
parts = {
    "cylinder": rod(5, 20),
    "cone": made("Cone", 6.0, 2.0, 10.0),
    "apex": made("Cone", 6.0, 0.0, 10.0),
    "sphere": ball,
    "torus": made("Torus", 10.0, 3.0),
    "tube": tube,
    "wedge": made("Cylinder", 5.0, 20.0, 1.3),
    "drilled": combine("Cut", box(20, 20, 20), rod(4, 40, (10, 10, -5))),
    "cross": combine("Cut", tube, rod(3, 60, (-30, 0, 24), (1, 0, 0))),
    "fillets": rounded("Fillet", box(10, 20, 30), 2.0),
    "chamfers": rounded("Chamfer", box(10, 20, 30), 2.0),
    "rim": rounded("Fillet", rod(5, 20), 1.0, slice(1)),
    "bead": combine("Cut", ball, rod(2, 20, (0, 0, -10))),
    "cap": combine("Cut", ball, box(9, 20, 20, (1, -10, -10))),
    "half_torus": combine("Cut", made("Torus", 10.0, 3.0), box(40, 40, 10, (-20, -20, 0))),
    "slant": combine("Cut", rod(5, 20), swept(polygon(*square), gp.gp_Vec(10, 0, 20))),
    "steinmetz": combine("Common", rod(5, 30, (0, 0, -15)), rod(5, 30, (-15, 0, 0), (1, 0, 0))),
    "tee": combine("Fuse", rod(5, 30, (0, 0, -15)), rod(3, 20, (0, 0, 0), (1, 0, 0))),
    "loft": loft(*(circle(5.0 + 2.0 * (37 * k % 5) / 5.0, 5.0 * k) for k in range(6))),
    "frustum": loft(polygon(*square), polygon(*((x, 2 * y, 9) for x, y, _ in square)), ruled=True),
    "twisted": loft(
        polygon(*square), polygon((0, -4, 9), (4, 0, 9), (0, 4, 9), (-4, 0, 9)), ruled=True
    ),
    "open_box": hollow(box(20, 30, 10), 5),
    "open_fillets": hollow(rounded("Fillet", box(20, 30, 10), 3.0, slice(0, 7, 2)), 5),
    "cup": hollow(rod(8, 20), 1),
    "prism": prism,
    "leaning": swept(outline, gp.gp_Vec(3, 2, 12)),
    "drilled_prism": combine("Cut", prism, rod(2, 40, (0, 0, -5))),
    "vase": vase,
    "cut_vase": combine("Cut", vase, box(50, 50, 50, (0, 0, -20))),
    "turned": swept(polygon((4, 0, 0), (9, 0, 0), (7, 0, 6), (4, 0, 9)), axis, 1.2),
    "hyperboloid": swept(polygon(*skew), axis, 1.0),
    "hyperboloid_back": swept(polygon(*skew[::-1]), axis, 1.0),
    "pipe": pipe((0, 0, 0), (0, 0, 10), (5, 0, 20), (15, 5, 25)),
    "drilled_ball": combine("Cut", made("Sphere", 10.0), rod(3, 40, (2, 1, -20))),
    "drilled_cone": combine(
        "Cut", made("Cone", 8.0, 4.0, 12.0), rod(1.5, 40, (-20, 0, 5), (1, 0, 0))
    ),
    "cut_cone": combine("Cut", made("Cone", 8.0, 2.0, 12.0), box(20, 40, 40, (3, -20, -5))),
    "lune": made("Sphere", 10.0, 0.05),
    "broad_lune": made("Sphere", 10.0, 6.25),
    "cavity": combine("Cut", box(20, 20, 20), made("Sphere", point(10, 10, 10), 6.0)),
    "plate": combine("Cut", box(65, 50, 6), *holes),
    "bolt": combine("Fuse", swept(polygon(*hexagon), gp.gp_Vec(0, 0, 5)), rod(4, 25)),
}
found = {}
writers = {
    "assembly_mm": ("MM", "AP214IS"),
    "assembly_inch": ("INCH", "AP203"),
    "assembly_m": ("M", "AP242DIS"),
}
with tarfile.open(FOLDER / "step.tar.xz", "w:xz", preset=9) as archive:
    for name in sorted([*parts, *writers]):
        path = FOLDER / (name + ".step")
        if name in writers:
            shape = assembly(*writers[name], path)
        else:
            shape, writer = parts[name], STEPControl_Writer()
            writer.Transfer(shape, STEPControl_AsIs)
            writer.Write(str(path))
        inside = GProp_GProps()
        BRepGProp.VolumeProperties_s(shape, inside, 1e-12, True, False)
        center = inside.CentreOfMass()
        found[name] = inside.Mass(), [center.X(), center.Y(), center.Z()]
        archive.add(path, path.name, filter=without_owner)
        path.unlink()
    path = FOLDER / "volumes.json"
    path.write_text(json.dumps(found) + "\n")
    archive.add(path, path.name, filter=without_owner)
    path.unlink()
