"""The excitation problem of `mavid plan --criterion cond`, solved with SciPy's SLSQP: an oracle and a rival.

    plan_with_slsqp.py assess TRAJECTORY.toml
        JSON: condition number and extremes of roll, pitch (degrees) over one period at 2 ms
    plan_with_slsqp.py plan SECONDS LIMITS.json
        JSON: one entry a start, until the time is up. LIMITS: roll, pitch (rad), x, y (m), z_min, z_max (m),
        speed (m/s), yaw_rate (rad/s), period (s), harmonics.

Exit status 77 where SciPy is missing. Written from the paper's equations (12), (18), (26), (27) with numeric gradients; shares nothing with the program.
"""

import json
import sys
import time
import tomllib

try:
    import numpy as np
    from scipy.linalg import null_space
    from scipy.optimize import minimize
except ImportError as missing:
    sys.stderr.write(f"SciPy is missing: {missing}\n")
    sys.exit(77)

GRAVITY = 9.81


def series_rows(t, period, harmonics):
    """d^k q / d[a, b, c], k = 0..4."""
    w = 2 * np.pi / period * np.arange(1, harmonics + 1)
    s, c = np.sin(np.outer(t, w)), np.cos(np.outer(t, w))
    one, zero = np.ones((len(t), 1)), np.zeros((len(t), 1))
    return [
        np.hstack([s / w, -c / w, one]),
        np.hstack([c, s, zero]),
        np.hstack([-w * s, w * c, zero]),
        np.hstack([-w**2 * c, -(w**2) * s, zero]),
        np.hstack([w**3 * s, -(w**3) * c, zero]),
    ]


def motion(x, y, z, yaw):
    """Each argument: value and four derivatives. Specific force, rates, angular accelerations, roll, pitch."""
    f = [np.array([x[2 + k], y[2 + k], z[2 + k] + (GRAVITY if k == 0 else 0)]) for k in range(3)]
    size = np.linalg.norm(f[0], axis=0)
    up = f[0] / size
    size1 = np.sum(up * f[1], axis=0)
    up1 = (f[1] - up * size1) / size
    size2 = np.sum(up1 * f[1] + up * f[2], axis=0)
    up2 = (f[2] - 2 * up1 * size1 - up * size2) / size
    cy, sy = np.cos(yaw[0]), np.sin(yaw[0])
    pitch = np.arctan((cy * f[0][0] + sy * f[0][1]) / f[0][2])
    roll = np.arctan(np.cos(pitch) * (sy * f[0][0] - cy * f[0][1]) / f[0][2])
    cp, sp, cr, sr = np.cos(pitch), np.sin(pitch), np.cos(roll), np.sin(roll)
    zero = np.zeros_like(cp)
    bx = np.array([cp * cy, cp * sy, -sp])
    by = np.array([sr * sp * cy - cr * sy, sr * sp * sy + cr * cy, sr * cp])
    dot = lambda a, b: np.sum(a * b, axis=0)
    p, q = -dot(up1, by), dot(up1, bx)
    # yaw rate = (q sin roll + r cos roll) / cos pitch, third row of (4)
    r = (yaw[1] * cp - q * sr) / cr
    bx1, by1 = by * r - up * q, up * p - bx * r
    dp, dq = -dot(up2, by) - dot(up1, by1), dot(up2, bx) + dot(up1, bx1)
    roll1, pitch1 = p + np.tan(pitch) * (q * sr + r * cr), q * cr - r * sr
    dr = (yaw[2] * cp - yaw[1] * sp * pitch1 - dq * sr - q * cr * roll1 + r * sr * roll1) / cr
    return size, (p, q, r), (dp, dq, dr), roll, pitch, zero


def condition(force, rates, accelerations, zero):
    (p, q, r), (dp, dq, dr) = rates, accelerations
    rows = [
        [force, zero, zero, zero, zero, zero, zero],
        [zero, dp, dq - p * r, dr + p * q, -q * r, q * q - r * r, q * r],
        [zero, p * r, dp + q * r, r * r - p * p, dq, dr - p * q, -p * r],
        [zero, -p * q, p * p - q * q, dp - q * r, p * q, dq + p * r, dr],
    ]
    w = np.concatenate([np.array(row).T for row in rows])
    singular = np.linalg.svd(w, compute_uv=False)
    return singular[0] / singular[-1]


def assess(path):
    with open(path, "rb") as file:
        stored = tomllib.load(file)
    t = np.arange(0, stored["period_s"] - 1e-9, 0.002)
    rows = series_rows(t, stored["period_s"], stored["harmonics"])
    axes = [np.array(stored[k]["a"] + stored[k]["b"] + [stored[k]["c"]]) for k in ("x_m", "y_m", "z_m", "yaw_rad")]
    paths = [[row @ axis for row in rows] for axis in axes]
    force, rates, accelerations, roll, pitch, zero = motion(*paths)
    return {
        "condition_number": condition(force, rates, accelerations, zero),
        "roll_deg": float(np.degrees(np.abs(roll).max())),
        "pitch_deg": float(np.degrees(np.abs(pitch).max())),
        "speed_m_s": float(max(np.abs(paths[k][1]).max() for k in range(3))),
        "yaw_rate_deg_s": float(np.degrees(np.abs(paths[3][1]).max())),
        "z_m": [float(paths[2][0].min()), float(paths[2][0].max())],
    }


def plan(seconds, limits):
    period, harmonics = limits["period"], limits["harmonics"]
    at_rest = series_rows(np.zeros(1), period, harmonics)
    place = [at_rest[0], at_rest[1], at_rest[2]]
    bases = [null_space(np.vstack(place if k != 2 else place[1:])) for k in range(4)]
    cuts = np.cumsum([0] + [b.shape[1] for b in bases])
    offset = np.zeros(2 * harmonics + 1)
    offset[-1] = 0.5 * (limits["z_min"] + limits["z_max"])

    def evaluator(count):
        rows = series_rows(np.arange(count) * period / count, period, harmonics)

        def paths(x):
            out = []
            for k in range(4):
                axis = bases[k] @ x[cuts[k] : cuts[k + 1]] + (offset if k == 2 else 0)
                out.append([row @ axis for row in rows])
            return out

        def cost(x):
            force, rates, accelerations, _, _, zero = motion(*paths(x))
            return np.log(condition(force, rates, accelerations, zero))

        def spare(x):
            p = paths(x)
            _, _, _, roll, pitch, _ = motion(*p)
            sizes = [(roll, limits["roll"]), (pitch, limits["pitch"]), (p[3][1], limits["yaw_rate"])]
            sizes += [(p[0][0], limits["x"]), (p[1][0], limits["y"])]
            sizes += [(p[k][1], limits["speed"]) for k in range(3)]
            parts = [side for value, bound in sizes for side in (1 - value / bound, 1 + value / bound)]
            parts += [p[2][0] - limits["z_min"], limits["z_max"] - p[2][0]]
            return np.concatenate(parts)

        return cost, spare

    # a peak of the fifth harmonic rises 0.3 % between 200 samples: what is left keeps the bounds in between
    cost, spare = evaluator(200)
    fine_cost, fine_spare = evaluator(round(period / 0.002))
    random = np.random.default_rng(1)
    began, found = time.time(), []
    while time.time() - began < seconds:
        x = random.uniform(-0.1, 0.1, cuts[-1])
        constraint = {"type": "ineq", "fun": lambda x: spare(x) - 0.004}
        result = minimize(cost, x, method="SLSQP", constraints=constraint, options={"maxiter": 300, "ftol": 1e-7})
        entry = {"condition_number": float(np.exp(fine_cost(result.x))), "violation": float(-fine_spare(result.x).min())}
        found.append(entry | {"after_s": time.time() - began})
    return found


if __name__ == "__main__":
    if sys.argv[1] == "assess":
        print(json.dumps(assess(sys.argv[2])))
    else:
        print(json.dumps(plan(float(sys.argv[2]), json.loads(sys.argv[3]))))
