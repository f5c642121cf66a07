# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Write the bodies of tests/core/cad/kernel with OpenCascade (`pip install cadquery-ocp`), and
their properties by its GProp.

The faces are converted to B-splines; NAME.igs has trimmed surfaces (144), NAME_solid.igs a manifold
solid (186).
"""

import gzip
import json
from pathlib import Path

from OCP import BRepAlgoAPI, BRepBuilderAPI, BRepPrimAPI, TopAbs, gp
from OCP.BRepFilletAPI import BRepFilletAPI_MakeFillet
from OCP.BRepGProp import BRepGProp
from OCP.BRepOffsetAPI import BRepOffsetAPI_ThruSections
from OCP.GProp import GProp_GProps
from OCP.IGESControl import IGESControl_Controller, IGESControl_Writer
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS

FOLDER = Path(__file__).parents[1] / "tests/core/cad/kernel"


def axis(x, y, z):
    return gp.gp_Ax2(gp.gp_Pnt(x, y, z), gp.gp_Dir(0, 0, 1))


def made(kind, *sizes):
    return getattr(BRepPrimAPI, "BRepPrimAPI_Make" + kind)(*sizes).Shape()


block = made("Box", 40, 20, 10)
fillet, edges = BRepFilletAPI_MakeFillet(block), TopExp_Explorer(block, TopAbs.TopAbs_EDGE)
while edges.More():
    fillet.Add(2.0, TopoDS.Edge(edges.Current()))
    edges.Next()
loft = BRepOffsetAPI_ThruSections(True, False, 1e-6)
for k in range(8):
    edge = BRepBuilderAPI.BRepBuilderAPI_MakeEdge(
        gp.gp_Circ(axis(0, 0, 5 * k), 5.0 + 2.0 * (37 * k % 5) / 5.0)
    ).Edge()
    loft.AddWire(BRepBuilderAPI.BRepBuilderAPI_MakeWire(edge).Wire())
loft.SetMaxDegree(14)
loft.Build()
drilled = BRepAlgoAPI.BRepAlgoAPI_Cut(block, made("Cylinder", axis(15, 8, -1), 4, 12)).Shape()
bodies = {
    "box": block,
    "drilled": drilled,
    "fillet": fillet.Shape(),
    "loft": loft.Shape(),
    "sphere": made("Sphere", 10),
}
bodies |= {
    "torus": made("Torus", 20, 5),
    "cylinder": made("Cylinder", 10, 30),
    "cone": made("Cone", 10, 4, 30),
}
bodies |= {name + "_solid": bodies[name] for name in ("sphere", "drilled", "fillet")}
bodies["apex_solid"] = made("Cone", 10, 0, 30)
found = {}
IGESControl_Controller.Init_s()
for name, body in bodies.items():
    shape = BRepBuilderAPI.BRepBuilderAPI_NurbsConvert(body, True).Shape()
    inside, skin = GProp_GProps(), GProp_GProps()
    BRepGProp.VolumeProperties_s(shape, inside, 1e-12, True, False)
    BRepGProp.SurfaceProperties_s(shape, skin, 1e-12, False)
    center, inertia = inside.CentreOfMass(), inside.MatrixOfInertia()
    rows = [[inertia.Value(i, j) for j in (1, 2, 3)] for i in (1, 2, 3)]
    found[name] = inside.Mass(), skin.Mass(), [center.X(), center.Y(), center.Z()], rows
    writer, path = IGESControl_Writer("MM", int(name.endswith("_solid"))), FOLDER / (name + ".igs")
    writer.AddShape(shape)
    writer.ComputeModel()
    writer.Write(str(path))
    path.with_name(path.name + ".gz").write_bytes(gzip.compress(path.read_bytes(), 9, mtime=0))
    path.unlink()
(FOLDER / "gprop.json").write_text(json.dumps(found) + "\n")
