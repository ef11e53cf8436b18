"""Flies a model as `mavid export` wrote it in the simulator that it was written for.

On standard input, as JSON: `format` ("rotorpy" or "mjcf"), `text` (the exported file), `callback` (the program beside it, or null), `believed` (mass, gravity,
inertia and hubs from the centre of mass as the controller has them, reaction torque over thrust, spins), `period_s`
of the controller, `reference` (position, velocity, acceleration, yaw, yaw rate a period), `thrust_coefficient`,
`noise` (standard deviations of the velocity in m/s and the rates in rad/s that the controller sees) and `seed`.

Answers a row a period: position, velocity, quaternion (w x y z), rates, specific force (body), and the thrust that
each rotor is told to have until the next row. Axes: world z up, body x forward, y left, z up; SI.

Exit status 77 where the simulator is missing.
"""

import json
import os
import sys

os.environ["MUJOCO_GL"] = "disable"


def missing(why):
    sys.stderr.write(f"a simulator is missing: {why}\n")
    sys.exit(77)


try:
    import numpy as np
    from scipy.spatial.transform import Rotation
except ImportError as why:
    missing(why)


class RotorPy:
    """Commands are rotor speeds."""

    def __init__(self, given, start):
        from rotorpy.vehicles.multirotor import Multirotor

        names = {}
        exec(given["text"], names)  # the file is Python, written by the program under test
        params = names["quad_params"]
        self.coefficient, self.mass = given["thrust_coefficient"], params["mass"]
        self.vehicle = Multirotor(params)
        hover = np.sqrt(self.mass * self.vehicle.g / len(params["rotor_pos"]) / self.coefficient)
        self.state = {
            "x": start[0:3],
            "v": np.zeros(3),
            "q": Rotation.from_rotvec([0.0, 0.0, start[9]]).as_quat(),
            "w": np.zeros(3),
            "wind": np.zeros(3),
            "rotor_speeds": np.full(len(params["rotor_pos"]), hover),
        }

    def body(self):
        s = self.state
        turned = Rotation.from_quat(s["q"])
        airspeed = turned.inv().apply(s["v"] - s["wind"])
        force, _ = self.vehicle.compute_body_wrench(s["w"], s["rotor_speeds"], airspeed)
        return s["x"], s["v"], turned, s["w"], force / self.mass

    def step(self, thrusts, period_s):
        self.state = self.vehicle.step(self.state, {"cmd_motor_speeds": np.sqrt(thrusts / self.coefficient)}, period_s)


class MuJoCo:
    """Commands are thrusts."""

    def __init__(self, given, start):
        import mujoco

        self.mujoco = mujoco
        self.model = mujoco.MjModel.from_xml_string(given["text"])
        if given.get("callback"):
            names = {}
            exec(given["callback"], names)  # the file is Python, written by the program under test
            names["install"](self.model)
        self.data = mujoco.MjData(self.model)
        self.rotors = len(given["believed"]["hubs"])
        self.body_id = self.model.body("vehicle").id
        self.center = self.model.body_ipos[self.body_id].copy()
        turned = Rotation.from_rotvec([0.0, 0.0, start[9]])
        self.data.qpos[:3] = start[0:3] - turned.apply(self.center)
        self.data.qpos[3:7] = np.roll(turned.as_quat(), 1)
        hover = self.model.body_mass[self.body_id] * -self.model.opt.gravity[2] / self.rotors
        self.data.ctrl[: self.rotors] = hover
        self.data.act[:] = hover
        mujoco.mj_forward(self.model, self.data)

    def body(self):
        q, v = self.data.qpos, self.data.qvel
        turned = Rotation.from_quat(np.roll(q[3:7], -1))
        velocity = v[:3] + turned.apply(np.cross(v[3:], self.center))
        force = turned.inv().apply(self.acceleration() - self.model.opt.gravity)
        return q[:3] + turned.apply(self.center), velocity, turned, v[3:].copy(), force

    def acceleration(self):
        """Of the centre of mass, world; the simulator's is that of the body's origin."""
        a, w, turned = self.data.qacc, self.data.qvel[3:], Rotation.from_quat(np.roll(self.data.qpos[3:7], -1))
        return a[:3] + turned.apply(np.cross(a[3:], self.center) + np.cross(w, np.cross(w, self.center)))

    def step(self, thrusts, period_s):
        self.data.ctrl[: self.rotors] = thrusts
        for _ in range(round(period_s / self.model.opt.timestep)):
            self.mujoco.mj_step(self.model, self.data)
        self.mujoco.mj_forward(self.model, self.data)


class Controller:
    """Position and attitude, with the vehicle as it is believed to be (Lee, Leok and McClamroch 2010)."""

    POSITION, VELOCITY, ATTITUDE, RATES = 6.0, 4.5, 110.0, 20.0

    def __init__(self, believed):
        self.mass, self.gravity = believed["mass"], np.array([0.0, 0.0, believed["gravity"]])
        self.inertia = np.array(believed["inertia"]).reshape(3, 3)
        hubs = np.array(believed["hubs"])
        yaw = believed["torque_per_thrust"] * np.array(believed["yaw_signs"])
        self.mix = np.linalg.pinv(np.vstack([np.ones(len(hubs)), hubs[:, 1], -hubs[:, 0], yaw]))
        self.thrust_max, self.sum = believed["thrust_max"], np.zeros(3)

    def thrusts(self, wanted, x, v, turned, w, period_s):
        self.sum += (wanted[0:3] - x) * period_s
        push = wanted[6:9] + self.POSITION * (wanted[0:3] - x) + self.VELOCITY * (wanted[3:6] - v) + self.sum + self.gravity
        up = push / np.linalg.norm(push)
        left = np.cross(up, [np.cos(wanted[9]), np.sin(wanted[9]), 0.0])
        left /= np.linalg.norm(left)
        target = Rotation.from_matrix(np.column_stack([np.cross(left, up), left, up]))
        turn = (target.inv() * turned).as_rotvec()
        turning = turned.inv().apply([0.0, 0.0, wanted[10]])
        angular = -self.ATTITUDE * turn - self.RATES * (w - turning)
        torque = self.inertia @ angular + np.cross(w, self.inertia @ w)
        force = self.mass * push @ turned.apply([0.0, 0.0, 1.0])
        return np.clip(self.mix @ np.concatenate([[force], torque]), 0.01 * self.thrust_max, self.thrust_max)


def main():
    given = json.load(sys.stdin)
    reference, period_s = np.array(given["reference"]), given["period_s"]
    try:
        simulator = {"rotorpy": RotorPy, "mjcf": MuJoCo}[given["format"]](given, reference[0])
    except ImportError as why:
        missing(why)
    controller, random = Controller(given["believed"]), np.random.default_rng(given["seed"])
    rows = []
    for wanted in reference:
        x, v, turned, w, force = simulator.body()
        seen_v, seen_w = v + given["noise"][0] * random.normal(size=3), w + given["noise"][1] * random.normal(size=3)
        thrusts = controller.thrusts(wanted, x, seen_v, turned, seen_w, period_s)
        rows.append([*x, *v, *np.roll(turned.as_quat(), 1), *w, *force, *thrusts])
        simulator.step(thrusts, period_s)
    json.dump(rows, sys.stdout)


if __name__ == "__main__":
    main()
