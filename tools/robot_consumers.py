# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Load exported robots in every program that reads them, and write docs/robots-consumers.md.

    python3 tests/project.py consumers

Each program gets an environment of its own in --folder: together 12 GB, and an hour. Those that
are there already are used again; with --python NAME=PATH another one is used. libsdformat is that
of the system, built with g++ and pkg-config.
"""

import argparse
import json
import os
import shlex
import subprocess
import sys
import venv
from pathlib import Path

import numpy as np
from loading import ROOT, load_checkout

load_checkout()

from body_moments.core.robots import FORMATS
from body_moments.core.robots.model import Robot
from body_moments.core.robots.write.joints import merge_fixed
from body_moments.core.robots.write.stl import write_meshes
from body_moments.core.robots.write.texts import robot_text

from tests.robots.consumers import summed
from tests.robots.links import assembly, total

READERS = ROOT / "tests" / "robots" / "consumers.py"
# program -> its reader, what pip installs, and the formats that it reads, with what is to be said
CONSUMERS = {
    "MuJoCo 4.0.0": ("mujoco", ["mujoco==4.0.0"], {"urdf": "", "mjcf": ""}),
    "Drake 1.58.0": (
        "drake",
        ["drake==1.58.0"],
        {
            "urdf": "",
            "sdf": "",
            "mjcf": "Drake reads only OBJ meshes",
            "mjcf, OBJ": "`--mesh-format obj`",
        },
    ),
    "Pinocchio 4.1.0": (
        "pinocchio",
        ["pin==4.1.0"],
        {
            "urdf": "",
            "mjcf": "compared as if the root link were at the origin",
        },
    ),
    "Newton 1.8.0": (
        "newton",
        ["newton[importers]==1.8.0"],
        {"urdf": "", "mjcf": "", "usd": "Newton ignores `metersPerUnit`"},
    ),
    "OpenSim 4.6": ("opensim", ["opensim==4.6"], {"osim": ""}),
    "Genesis 1.4.5": (
        "genesis",
        ["genesis-world==1.4.5", "torch"],
        {
            "urdf": "only every fifth file, because Genesis takes long to cut meshes into pieces",
            "mjcf": "only every fifth file",
        },
    ),
    "PyBullet 3.2.7": (
        "pybullet",
        ["pybullet==3.2.7"],
        {
            "urdf": "with the flag `URDF_USE_INERTIA_FROM_FILE`",
            "mjcf": "PyBullet uses the inertia of the geoms. Some masses and places are wrong",
            "sdf": "PyBullet ignores the places and the inertia of the file",
        },
    ),
    "PyBullet 3.2.7, no flag": (
        "pybullet_default",
        ["pybullet==3.2.7"],
        {"urdf": "PyBullet uses the inertia of the collider's bounding box"},
    ),
    "libsdformat 12.3": ("libsdformat", [], {"sdf": ""}),
}
BODY = '<inertial><mass value="1"/>{}</inertial>'
TENSOR = '<inertia ixx="{}" iyy="{}" izz="{}" ixy="0" ixz="0" iyz="0"/>'
ROBOT = """<robot name="r"><link name="a"><inertial><mass value="5"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link><link name="b">{}
<collision><geometry><box size="1 1 1"/></geometry></collision></link><joint name="j"
type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/><limit lower="-1" upper="1"
effort="1" velocity="1"/></joint></robot>"""
PROBES = {
    "none": "",
    "short": BODY.format(TENSOR.format(1, 2, 3.0 * (1.0 + 1e-12))),
    "impossible": BODY.format(TENSOR.format(1, 1, 9)),
}
HEAD = """# Robots in the Programs That Read Them

This page tests exported robots in the programs that read them. The command
`python3 tests/project.py consumers` makes {count} random robots. Each robot has 12 links, joints of
all kinds, and a mesh for each link. The command exports each robot twice: with and without *Merge
Fixed Links*. All other options have their default values. Each program then reads the files, and
the command writes this page.

## Robots with Right Numbers

In each program, we read the total mass, center and inertia of each robot, and compare these numbers
with the exact numbers. Each row of the first table shows the largest relative differences of all
files in one format. The difference of the centers is a distance. To make this distance relative, we
divide it by the larger of two lengths: the radius of gyration, and the distance of the center from
the origin.

Two programs have differences above 1e-12 although they use the numbers of the file:

- Newton computes in single precision. Along a chain of joints, the rounding errors add up. The
  errors are largest with Newton's MJCF importer.
- PyBullet computes the principal axes of an inertia by iteration, and ends the iteration too soon.
  The directions of the axes are therefore wrong by up to 6e-7 radians.

| program | format | files read | mass | center | inertia | remark |
|---|---|---|---|---|---|---|
{rows}
## Links with Missing or Impossible Numbers

The inertial of a link is its mass, center and inertia. The second table shows how programs read a
link of a URDF file if the inertial of the link is missing or impossible. The collider of this link
is a cube of 1 m. A cell of the table gives the mass of the link in the program, and the three
principal moments in kg·m². There are three tests:

- *no inertial*: the file states no inertial for the link.
- *A + B < C by 1e-12*: the file states a mass of 1 kg, and the principal moments A, B and C: 1, 2
  and 3 · (1 + 1e-12) kg·m². C is too large by 1e-12 of its value. Such a small error can come from
  rounding.
- *1, 1, 9*: the file states a mass of 1 kg, and the principal moments 1, 1 and 9 kg·m². No body can
  have these moments.

| program | no inertial | A + B < C by 1e-12 | 1, 1, 9 |
|---|---|---|---|
{probes}
"""


def write_robots(folder: Path, count: int) -> list[tuple[Path, str, Robot]]:
    """Write the random robots; return each file, its format and the robot."""
    files = []
    for kind in ("urdf", "sdf", "mjcf", "mjcf, OBJ", "usd", "osim"):
        form, _, mesh_format = kind.lower().partition(", ")
        for seed in range(count):
            robot = assembly(seed)
            for name in ("", "_merged"):
                path = folder / (form + mesh_format + str(seed) + name + FORMATS[form].suffix)
                named = robot
                if not FORMATS[form].holds_meshes:
                    named = write_meshes(robot, path, None, True, mesh_format or "stl")
                text, _ = robot_text(merge_fixed(named) if name else named, form)
                path.write_text(text, encoding="utf-8")
                files.append((path, kind, robot))
    return files


def read(python: str, reader: str, files: list[Path], search: Path) -> list:
    """Return the bodies of each file, or the reason why it was not read, as an earlier run had
    them if there was one.
    """
    known = search / "{}_{}_{}.json".format(reader, files[0].stem, len(files))
    if known.is_file():
        return json.loads(known.read_text(encoding="utf-8"))
    paths = str(search) + os.pathsep + os.environ["PATH"]
    done = subprocess.run(
        [python, READERS, reader, *files],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        check=True,
        env=os.environ | {"PATH": paths},
        cwd=search,
    )
    answer = done.stdout.strip().splitlines()[-1]
    known.write_text(answer, encoding="utf-8")
    return json.loads(answer)


def environment(folder: Path, reader: str, packages: list[str]) -> str:
    """Return the Python that has a program, installed if it is missing."""
    if not packages:
        flags = ["pkg-config", "--cflags", "--libs", "sdformat12"]
        flags = shlex.split(subprocess.run(flags, capture_output=True, text=True).stdout)
        source = READERS.with_name("read_sdf.cc")
        subprocess.run(["g++", "-std=c++17", source, "-o", folder / "read_sdf", *flags], check=True)
        return sys.executable
    home = folder / reader.removesuffix("_default")
    python = home / "bin" / "python"
    if not python.exists():
        venv.create(home, with_pip=True)
        subprocess.run([python, "-m", "pip", "install", "--quiet", *packages, "numpy"], check=True)
    return str(python)


def row_of(program: str, form: str, remark: str, found: list, robots: list[Robot]) -> str:
    """Return the row of a program and a format."""
    errors = []
    for bodies, robot in zip(found, robots, strict=True):
        if isinstance(bodies, str):
            continue
        is_at_origin = form == "urdf" and not robot.roots[0].is_fixed or "origin" in remark
        truth = total(robot, is_at_origin)
        mass, center, inertia = summed(bodies)
        far = max(np.sqrt(np.trace(truth.inertia) / truth.mass), np.linalg.norm(truth.center))
        errors.append(
            (
                abs(mass / truth.mass - 1.0),
                np.abs(center - truth.center).max() / far,
                np.abs(inertia - truth.inertia).max() / np.abs(truth.inertia).max(),
            )
        )
    largest = ["{:.0e}".format(one) for one in np.max(errors, axis=0)] if errors else ["–"] * 3
    if reasons := [one for one in found if isinstance(one, str)]:
        print(program, form, reasons[0], file=sys.stderr)
    count = "{} of {}".format(len(errors), len(found))
    return "| {} |\n".format(" | ".join([program, form, count, *largest, remark]))


def words_of(bodies: list | str) -> str:
    """Return what a program makes of the second link of a probe."""
    if isinstance(bodies, str):
        return "refused"
    probes = [one for one in bodies if abs(one[0] - 5.0) > 1e-6]
    if not probes:
        return "mass 0"
    ((mass, _, inertia),) = probes
    moments = ", ".join("{:.7g}".format(one) for one in np.linalg.eigvalsh(inertia))
    return "{:.6g} kg; {}".format(mass, moments)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--count", type=int, default=60)
    parser.add_argument("--folder", type=Path, default=ROOT / ".envs" / "consumers")
    parser.add_argument("--python", action="append", default=[], metavar="NAME=PATH")
    options = parser.parse_args()
    given = dict(one.split("=", 1) for one in options.python)
    folder = options.folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    files = write_robots(folder, options.count)
    probes = []
    for name, inertial in PROBES.items():
        probes.append(folder / (name + ".urdf"))
        probes[-1].write_text(ROBOT.format(inertial), encoding="utf-8")
    rows, answers = "", ""
    for program, (reader, packages, forms) in CONSUMERS.items():
        home = reader.removesuffix("_default")
        python = given.get(home) or environment(folder, reader, packages)
        for form, remark in forms.items():
            several = [(path, robot) for path, own, robot in files if own == form]
            several = several[:: 5 if "fifth" in remark else 1]
            found = read(python, reader, [path for path, _ in several], folder)
            rows += row_of(program, form, remark, found, [robot for _, robot in several])
        if "urdf" in forms:
            words = map(words_of, read(python, reader, probes, folder))
            answers += "| {} |\n".format(" | ".join([program, *words]))
        print(rows.splitlines()[-1], answers.splitlines()[-1:], flush=True)
    text = HEAD.format(count=options.count, rows=rows, probes=answers.rstrip("\n"))
    (ROOT / "docs" / "robots-consumers.md").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
