"""RotorPy's multirotor on states and commands that come as JSON on standard input.

    rotorpy_multirotor.py --accelerations   one step: [v', w'] of each state
    rotorpy_multirotor.py --trajectory      open loop: position, velocity, quaternion (i j k w), rates after each command
    rotorpy_multirotor.py --time            simulated seconds a second of the same

Exit status 77 where RotorPy is missing.
"""

import json
import sys
import time

try:
    import numpy as np
    from rotorpy.vehicles.multirotor import Multirotor
except ImportError as missing:
    sys.stderr.write(f"RotorPy is missing: {missing}\n")
    sys.exit(77)


def vehicle(params, integrator):
    params = dict(params)
    params["rotor_pos"] = {f"r{i}": np.array(r) for i, r in enumerate(params["rotor_pos"])}
    params["rotor_directions"] = np.array(params["rotor_directions"])
    return Multirotor(params, integrator_kwargs=integrator)


def state(given):
    return {name: np.array(values, dtype=float) for name, values in given.items()}


def fly(made, given):
    at, out = state(given["start"]), []
    for command in given["commands"]:
        at = made.step(at, {"cmd_motor_speeds": np.array(command)}, given["step_s"])
        out.append([*at["x"], *at["v"], *at["q"], *at["w"]])
    return out


def main(what):
    given = json.load(sys.stdin)
    if what == "--accelerations":
        made = vehicle(given["params"], None)
        out = []
        for case in given["cases"]:
            dot = made.statedot(state(case["state"]), {"cmd_motor_speeds": np.array(case["command"])}, 0.0)
            out.append([*dot["vdot"], *dot["wdot"]])
    elif what == "--trajectory":
        out = fly(vehicle(given["params"], {"method": "DOP853", "rtol": 1e-11, "atol": 1e-12}), given)
    elif what == "--time":
        # as it comes: its default integrator
        start = time.perf_counter()
        fly(vehicle(given["params"], None), given)
        out = len(given["commands"]) * given["step_s"] / (time.perf_counter() - start)
    else:
        sys.exit(__doc__)
    json.dump(out, sys.stdout)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
