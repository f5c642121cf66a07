# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Write the parts of tests/core/cad/kernel/swept with OpenCascade's default writer (`pip install
cadquery-ocp==8.0.1.1.0`): NAME_faces.igs with trimmed surfaces (144), NAME_solid.igs a manifold
solid (186).
"""

import gzip
from pathlib import Path

from OCP import BRepPrimAPI, gp
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
from OCP.BRepFilletAPI import BRepFilletAPI_MakeFillet
from OCP.IGESControl import IGESControl_Controller, IGESControl_Writer
from OCP.TopAbs import TopAbs_EDGE
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS

FOLDER = Path(__file__).parents[1] / "tests/core/cad/kernel/swept"


def made(kind, *sizes):
    return getattr(BRepPrimAPI, "BRepPrimAPI_Make" + kind)(*sizes).Shape()


def rod(radius, height, place, along):
    axis = gp.gp_Ax2(gp.gp_Pnt(*place), gp.gp_Dir(*along))
    return made("Cylinder", axis, radius, height)


def cut(shape, tool):
    return BRepAlgoAPI_Cut(shape, tool).Shape()


def beside(normal):
    axis = gp.gp_Ax2(gp.gp_Pnt(2.0, 0.0, 0.0), gp.gp_Dir(*normal), gp.gp_Dir(0.0, 1.0, 0.0))
    place = gp.gp_Pnt(2.0, 0.0, 0.0).Translated(gp.gp_Vec(axis.XDirection()) * -25.0)
    axis.SetLocation(place.Translated(gp.gp_Vec(axis.YDirection()) * -25.0))
    return made("Box", axis, 50.0, 50.0, 50.0)


box = made("Box", 10.0, 20.0, 30.0)
fillet = BRepFilletAPI_MakeFillet(box)
fillet.Add(2.0, TopoDS.Edge(TopExp_Explorer(box, TopAbs_EDGE).Current()))
tube = cut(made("Cylinder", 10.0, 48.0), made("Cylinder", 5.0, 48.0))
parts = {
    "cylinder": made("Cylinder", 5.0, 20.0),
    "cone": made("Cone", 6.0, 2.0, 10.0),
    "apex": made("Cone", 6.0, 0.0, 10.0),
    "sphere": made("Sphere", 5.0),
    "torus": made("Torus", 10.0, 3.0),
    "tube": tube,
    "wedge": made("Cylinder", 5.0, 20.0, 1.3),
    "nearly_round": made("Cylinder", 5.0, 20.0, 6.1),
    "drilled": cut(made("Box", 20.0, 20.0, 20.0), rod(4.0, 40.0, (10, 10, -5), (0, 0, 1))),
    "fillet": fillet.Shape(),
    "cap": cut(
        made("Sphere", 5.0),
        made("Box", gp.gp_Pnt(1.0, -10.0, -10.0), gp.gp_Pnt(10.0, 10.0, 10.0)),
    ),
    "cross": cut(tube, rod(3.0, 60.0, (-30, 0, 24), (1, 0, 0))),
    "touching": cut(
        rod(10.0, 60.0, (0, 0, -30), (0, 0, 1)), rod(10.0, 60.0, (-30, 0, 0), (1, 0, 0))
    ),
    "viviani": cut(made("Sphere", 6.0), rod(3.0, 30.0, (3, 0, -15), (0, 0, 1))),
    "hyperbola": cut(made("Cone", 6.0, 0.0, 12.0), beside((1.0, 0.0, 0.0))),
    "parabola": cut(made("Cone", 6.0, 0.0, 12.0), beside((2.0, 0.0, 1.0))),
}
FOLDER.mkdir(exist_ok=True)
IGESControl_Controller.Init_s()
for name, part in parts.items():
    for mode, kind in enumerate(("faces", "solid")):
        writer = IGESControl_Writer("MM", mode)
        writer.AddShape(part)
        writer.ComputeModel()
        path = FOLDER / "{}_{}.igs".format(name, kind)
        writer.Write(str(path))
        path.with_name(path.name + ".gz").write_bytes(gzip.compress(path.read_bytes(), 9, mtime=0))
        path.unlink()
