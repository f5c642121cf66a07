# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Record a jump of a figure of boxes in MuJoCo as jump.bvh: servos crouch, push off, tuck, and
land.

Run it in the robots' environment: `python tests/operators/rig/simulate_jump.py`. test_motion.py
builds the same boxes around the imported bones, so that the parts have the masses of the simulated
ones.
"""

from pathlib import Path

import numpy as np

DENSITY, RATE, SECONDS = 1000.0, 60, 1.5
# name, the part above, the joint in the world, the box's half extents, and its center from the
# joint
TRUNK = (
    ("hips", "", (0, 0, 0.95), (0.16, 0.10, 0.10), (0, 0, 0.03)),
    ("spine", "hips", (0, 0, 1.08), (0.17, 0.11, 0.20), (0, 0, 0.22)),
    ("head", "spine", (0, 0, 1.52), (0.08, 0.09, 0.12), (0, 0, 0.13)),
)
LIMBS = (
    ("arm", "spine", (0.23, 0, 1.44), (0.05, 0.05, 0.15), (0, 0, -0.15)),
    ("forearm", "arm", (0.23, 0, 1.13), (0.04, 0.04, 0.15), (0, 0, -0.15)),
    ("thigh", "hips", (0.10, 0, 0.90), (0.07, 0.07, 0.20), (0, 0, -0.20)),
    ("shin", "thigh", (0.10, 0, 0.48), (0.055, 0.055, 0.19), (0, 0, -0.19)),
    ("foot", "shin", (0.10, 0, 0.08), (0.05, 0.13, 0.03), (0, -0.05, -0.05)),
)
POSES = (  # seconds, and the servos' angles at that time
    (0.00, {"thigh": 0.0, "shin": 0.0, "foot": 0.0, "arm.L": 0.0, "arm.R": 0.0, "spine": 0.0}),
    (0.45, {"thigh": 1.1, "shin": -1.7, "foot": 0.75, "arm.L": 0.9, "arm.R": 0.4, "spine": 0.35}),
    (0.60, {"thigh": 1.1, "shin": -1.7, "foot": 0.75, "arm.L": 0.9, "arm.R": 0.4, "spine": 0.35}),
    (0.72, {"thigh": 0.0, "shin": 0.0, "foot": -0.5, "arm.L": -1.5, "arm.R": -0.5, "spine": 0.0}),
    (0.95, {"thigh": 1.2, "shin": -1.6, "foot": 0.0, "arm.L": -0.8, "arm.R": -0.8, "spine": 0.2}),
    (1.20, {"thigh": 0.3, "shin": -0.5, "foot": 0.2, "arm.L": 0.0, "arm.R": 0.0, "spine": 0.1}),
    (1.40, {"thigh": 0.9, "shin": -1.5, "foot": 0.65, "arm.L": 0.0, "arm.R": 0.0, "spine": 0.3}),
)


def parts():
    """Return (name, the part above, joint, half extents, center from the joint) of all parts, those
    above first.
    """
    pairs = {limb[0] for limb in LIMBS}
    both = [
        (name + side, above + side if above in pairs else above, (sign * x, y, z), half, center)
        for side, sign in ((".L", 1), (".R", -1))
        for name, above, (x, y, z), half, center in LIMBS
    ]
    return [*TRUNK, *both]


def servo(name):
    """Return the times and angles of a part's servo, None for a part that is welded."""
    key = name if name in POSES[0][1] else name.partition(".")[0]
    return [(time, pose[key]) for time, pose in POSES] if key in POSES[0][1] else None


def simulate():
    """Return the (f, c) values of the recording's channels: the hips' place and turn, and the angle
    of each joint.
    """
    import mujoco

    spec = mujoco.MjSpec()
    spec.option.timestep, spec.option.integrator = 5e-4, mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    spec.worldbody.add_geom(
        type=mujoco.mjtGeom.mjGEOM_PLANE, size=(9, 9, 1), friction=(1.2, 0.1, 0.1)
    )
    bodies, places = {"": spec.worldbody}, {"": np.zeros(3)}
    for name, above, place, half, center in parts():
        bodies[name] = bodies[above].add_body(name=name, pos=place - places[above])
        places[name] = np.array(place)
        box = mujoco.mjtGeom.mjGEOM_BOX
        bodies[name].add_geom(
            type=box, size=half, pos=center, density=DENSITY, contype=0, conaffinity=1
        )
        if not above:
            bodies[name].add_freejoint()
        elif servo(name):
            gain = (
                150.0 if name.startswith("arm") else 1000.0 if name.startswith("foot") else 2000.0
            )
            bodies[name].add_joint(name=name, axis=(-1, 0, 0), damping=3.0)
            actuator = spec.add_actuator(name=name, target=name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
            actuator.set_to_position(kp=gain, kv=0.03 * gain)
    model = spec.compile()
    data, frames = mujoco.MjData(model), []
    for frame in range(round(RATE * SECONDS) + 1):
        while data.time < frame / RATE - 1e-9:
            for index in range(model.nu):
                data.ctrl[index] = np.interp(data.time, *zip(*servo(model.actuator(index).name)))
            mujoco.mj_step(model, data)
        mujoco.mj_kinematics(model, data)
        turn = data.body("hips").xmat.reshape(3, 3)  # about z, then x, then y
        angles = (
            np.arctan2(-turn[0, 1], turn[1, 1]),
            np.arcsin(turn[2, 1]),
            np.arctan2(-turn[2, 0], turn[2, 2]),
        )
        joints = [
            -data.joint(name).qpos[0] if servo(name) else 0.0
            for name, above, *_ in parts()
            if above
        ]
        frames.append([*data.body("hips").xpos, *np.degrees([*angles, *joints])])
    return np.array(frames)


def hierarchy():
    """Return the head of the recording and the order of the parts' channels."""
    known = {
        name: (np.array(place), half, np.array(center)) for name, _, place, half, center in parts()
    }
    lines, order, turns = ["HIERARCHY"], [], "Zrotation Xrotation Yrotation"

    def add(name, above, kind):
        place, half, center = known[name]
        order.append(name)
        channels = "3 " + turns if above else "6 Xposition Yposition Zposition " + turns
        offset = place - known[above][0] if above else place
        lines.extend(
            [
                kind + " " + name,
                "{",
                "OFFSET {:g} {:g} {:g}".format(*offset),
                "CHANNELS " + channels,
            ]
        )
        below = [part for part, over, *_ in parts() if over == name]
        for part in below:
            add(part, name, "JOINT")
        if not below:
            lines.extend(["End Site", "{", "OFFSET {:g} {:g} {:g}".format(*(2.0 * center)), "}"])
        lines.append("}")

    add("hips", "", "ROOT")
    return lines, order


if __name__ == "__main__":
    lines, order = hierarchy()
    values, names = simulate(), [name for name, *_ in parts()]
    lines += ["MOTION", "Frames: {:d}".format(len(values)), "Frame Time: {:.9f}".format(1.0 / RATE)]
    for row in values:
        joints = " ".join("0 {:.4f} 0".format(row[5 + names.index(name)]) for name in order[1:])
        lines.append(" ".join(map("{:.5f}".format, row[:6])) + " " + joints)
    Path(__file__).with_name("jump.bvh").write_text("\n".join(lines) + "\n")
