"""Integrates a rigid body under constant thrust and torque with SciPy: a rotation matrix in place of a quaternion.

Standard input: {"mass", "gravity", "inertia", "force", "torque", "position", "velocity", "matrix", "rates", "end_s"}; body
force and torque, matrix body to world, row by row. Standard output: position, velocity, matrix, rates at the end.
Exit status 77 where SciPy is missing.
"""

import json
import sys

try:
    import numpy as np
    from scipy.integrate import solve_ivp
except ImportError as missing:
    sys.stderr.write(f"SciPy is missing: {missing}\n")
    sys.exit(77)


def main():
    given = json.load(sys.stdin)
    inertia = np.array(given["inertia"]).reshape(3, 3)
    force, torque = np.array(given["force"]), np.array(given["torque"])

    def slope(_, y):
        matrix, w = y[6:15].reshape(3, 3), y[15:]
        acceleration = matrix @ force / given["mass"] - np.array([0.0, 0.0, given["gravity"]])
        # R' = R [w]x, column by column: each row of R crossed with w
        turning = np.cross(matrix, w)
        spin = np.linalg.solve(inertia, torque - np.cross(w, inertia @ w))
        return np.concatenate([y[3:6], acceleration, turning.ravel(), spin])

    start = np.concatenate([given["position"], given["velocity"], given["matrix"], given["rates"]])
    end = solve_ivp(slope, (0.0, given["end_s"]), start, method="DOP853", rtol=1e-12, atol=1e-13)
    json.dump(list(end.y[:, -1]), sys.stdout)


if __name__ == "__main__":
    main()
