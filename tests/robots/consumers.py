# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Masses, centers and inertias in robot files, as the programs that read them have them.

    python consumers.py PROGRAM FILE...

prints a JSON array: for each file [mass, center, inertia about it] of each body, in the world, or
the reason why it was not read.
It imports nothing of the product, so that it runs in an environment with one program alone.
"""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np


def summed(bodies):
    """Return mass, center and inertia about it of (mass, center, inertia about it) in one frame."""
    bodies = [(m, np.asarray(c, float), np.asarray(inertia, float)) for m, c, inertia in bodies]
    mass = sum(one[0] for one in bodies)
    center = sum(m * c for m, c, _ in bodies) / mass
    arms = [c - center for _, c, _ in bodies]
    about = sum(
        inertia + m * (arm @ arm * np.eye(3) - np.outer(arm, arm))
        for (m, _, inertia), arm in zip(bodies, arms, strict=True)
    )
    return mass, center, about


def turned(moments, rotation):
    rotation = np.asarray(rotation, float).reshape(3, 3)
    return rotation @ (np.diag(moments) if np.ndim(moments) == 1 else moments) @ rotation.T


def quaternion_matrix(x, y, z, w):
    """Rotation of a quaternion, normalized first."""
    x, y, z, w = np.array([x, y, z, w]) / np.linalg.norm([x, y, z, w])
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + 2 * w * cross + 2 * cross @ cross


def mujoco(path):
    import mujoco

    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    return [
        (model.body_mass[i], data.xipos[i], turned(model.body_inertia[i], data.ximat[i]))
        for i in range(1, model.nbody)
    ]


def drake(path):
    from pydrake.multibody.parsing import Parser
    from pydrake.multibody.plant import MultibodyPlant

    plant = MultibodyPlant(0.0)
    plant.set_adjacent_bodies_collision_filters(False)
    models = Parser(plant).AddModels(str(path))
    plant.Finalize()
    context = plant.CreateDefaultContext()
    bodies = []
    for model in models:
        for index in plant.GetBodyIndices(model):
            body = plant.get_body(index)
            mass = body.default_mass()
            if mass:
                inertia = body.default_spatial_inertia().Shift(body.default_com())
                pose = body.EvalPoseInWorld(context)
                about = turned(
                    inertia.CalcRotationalInertia().CopyToFullMatrix3(), pose.rotation().matrix()
                )
                bodies.append((mass, pose @ body.default_com(), about))
    return bodies


def pinocchio(path):
    import pinocchio

    build = {".urdf": pinocchio.buildModelFromUrdf, ".xml": pinocchio.buildModelFromMJCF}
    model = build[Path(path).suffix](str(path))
    data = model.createData()
    pinocchio.forwardKinematics(model, data, pinocchio.neutral(model))
    # It misplaces the root of MJCF.
    is_free = Path(path).suffix == ".xml" and model.njoints > 1 and model.joints[1].nq == 7
    root = data.oMi[1] if is_free else pinocchio.SE3.Identity()
    placed = [root.actInv(data.oMi[i]).act(one) for i, one in enumerate(model.inertias)]
    return [(one.mass, one.lever, one.inertia) for one in placed if one.mass]


def newton(path):
    import newton

    builder = newton.ModelBuilder()
    add = {".urdf": builder.add_urdf, ".xml": builder.add_mjcf}
    add.get(Path(path).suffix, builder.add_usd)(str(path))
    model = builder.finalize(device="cpu")
    state = model.state()
    newton.eval_fk(model, model.joint_q, model.joint_qd, state)
    values = (model.body_mass, model.body_com, model.body_inertia, state.body_q)
    bodies = []
    for mass, center, inertia, pose in zip(*(one.numpy().astype(float) for one in values)):
        rotation = quaternion_matrix(*pose[3:])
        bodies.append((mass, rotation @ center + pose[:3], turned(inertia, rotation)))
    return bodies


def opensim(path):
    import opensim

    model = opensim.Model(str(path))
    state = model.initSystem()
    bodies = []
    for body in model.getBodyList():
        pose, inertia = body.getTransformInGround(state), body.getInertia()
        rotation = np.array([[pose.R().get(i, j) for j in range(3)] for i in range(3)])
        place = np.array([pose.p().get(i) for i in range(3)])
        center = np.array([body.getMassCenter().get(i) for i in range(3)])
        moments, products = inertia.getMoments(), inertia.getProducts()
        about = np.diag([moments.get(i) for i in range(3)])
        for i, j, index in ((0, 1, 0), (0, 2, 1), (1, 2, 2)):
            about[i, j] = about[j, i] = products.get(index)
        bodies.append((body.getMass(), rotation @ center + place, turned(about, rotation)))
    return [one for one in bodies if one[0]]


def genesis(path):
    import genesis

    if not genesis._initialized:
        genesis.init(backend=genesis.cpu, precision="64", logging_level="error")
    scene = genesis.Scene(show_viewer=False)
    form = {".urdf": genesis.morphs.URDF, ".xml": genesis.morphs.MJCF}[Path(path).suffix]
    more = {"merge_fixed_links": False} if Path(path).suffix == ".urdf" else {}
    entity = scene.add_entity(form(file=str(path), **more))
    bodies, poses = [], {}
    for link in entity.links:
        one = link.desc
        place, outer = poses.get(link.parent_idx, (np.zeros(3), np.eye(3)))
        place, outer = (
            place + outer @ one.pos,
            outer @ quaternion_matrix(*one.quat[1:], one.quat[0]),
        )
        poses[link.idx] = place, outer
        if one.mass:
            inner = quaternion_matrix(*one.inertial_quat[1:], one.inertial_quat[0])
            center = place + outer @ one.inertial_pos
            bodies.append((float(one.mass), center, turned(np.asarray(one.inertia), outer @ inner)))
    return bodies


def pybullet_default(path):
    return pybullet(path, 0)


def pybullet(path, flags=None):
    import pybullet

    if not pybullet.isConnected():
        pybullet.connect(pybullet.DIRECT)
    pybullet.resetSimulation()
    if Path(path).suffix == ".urdf":
        given = pybullet.URDF_USE_INERTIA_FROM_FILE if flags is None else flags
        roots = [pybullet.loadURDF(str(path), flags=given)]
    else:
        load = pybullet.loadSDF if Path(path).suffix == ".sdf" else pybullet.loadMJCF
        roots = load(str(path))
    bodies = []
    for root in roots:
        for index in range(-1, pybullet.getNumJoints(root)):
            info = pybullet.getDynamicsInfo(root, index)
            if index < 0:
                center, turn = pybullet.getBasePositionAndOrientation(root)
            else:
                center, turn = pybullet.getLinkState(root, index, computeForwardKinematics=1)[:2]
            about = turned(np.array(info[2]), quaternion_matrix(*turn))
            bodies.append((info[0], np.array(center), about))
    return [one for one in bodies if one[0]]


def libsdformat(path):
    """The program read_sdf, built from read_sdf.cc, on PATH."""
    done = subprocess.run(["read_sdf", str(path)], capture_output=True, text=True, check=True)
    words = [line.split("\t") for line in done.stdout.splitlines()]
    wrong = [one for one in words if one[0] == "error"]
    if wrong:
        raise ValueError(wrong[0][2])
    bodies = []
    for one in words:
        if one[0] == "link":
            mass, *rest = map(float, one[2:])
            rotation = quaternion_matrix(*rest[16:], rest[15])
            center = rotation @ rest[:3] + rest[12:15]
            bodies.append((mass, center, turned(np.reshape(rest[3:12], (3, 3)), rotation)))
    return [one for one in bodies if one[0]]


def main(program, *files):
    read = globals()[program]
    answers = []
    for file in files:
        try:
            answers.append(
                [
                    [float(m), np.asarray(c).tolist(), np.asarray(i).tolist()]
                    for m, c, i in read(file)
                ]
            )
        except Exception as error:
            answers.append(
                "{}: {}".format(type(error).__name__, str(error).strip().splitlines()[:1])
            )
    print("\n" + json.dumps(answers))


if __name__ == "__main__":
    main(*sys.argv[1:])
