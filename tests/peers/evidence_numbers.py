"""Expected numbers of the tests in src/diagnose/evidence.rs and src/diagnose/harmonics.rs, by NumPy and SciPy alone.

    evidence_numbers.py [PRIOR]
        PRIOR: standard deviation of the second nuisance's coefficient about zero, where it is known beforehand
    evidence_numbers.py harmonics

The regression is one least-squares problem with all columns at once and a row for what is known beforehand; the test
partials the nuisances out first. Its series are made of integers and sines, the same in both.
"""

import sys

import numpy as np
from scipy import linalg, stats

ROWS, RUNS = 240, [(0, 150), (150, 240)]
I = np.arange(ROWS)


def chance(k, i=I):
    """Numbers without order in -0.5..0.5."""
    j = i + 1
    return (j * j * (17 * k + 23) + j * (101 * k + 59)) % 1009 / 1009 - 0.5


def noise(k):
    return chance(k) + 0.6 * np.where(I > 0, chance(k, I - 1), 0.0)


def problem():
    """Residual, tested columns, nuisances: channel 0 over its sigma 0.5, then channel 3 over its sigma 0.1."""
    def stack(force, torque):
        return np.concatenate([force * np.ones(ROWS) / 0.5, torque * np.ones(ROWS) / 0.1])

    a = stack(np.sin(0.11 * I), 0.1 * np.cos(0.05 * I))
    b = stack(np.cos(0.031 * I), 0.1 * chance(7))
    bias = stack(1.0, 0.0)
    lean = stack(np.sin(0.11 * I + 1), 0.02)
    present = stack(0.0, 0.1 * np.sin(0.02 * I))
    y = 0.3 * a - 0.4 * b + 0.2 * bias + 0.5 * lean + 0.7 * present + stack(0.4 * noise(1), 0.08 * noise(2))
    return y, np.column_stack([a, b]), np.column_stack([bias, lean, present])


def blocks(after):
    """Autocovariances of the two channels, and their matrix over all rows."""
    gammas, matrix = [], np.zeros((2 * ROWS, 2 * ROWS))
    for channel in range(2):
        x = after[channel * ROWS : (channel + 1) * ROWS]
        gamma = []
        for lag in range(120):
            products = np.concatenate([x[f : t - lag] * x[f + lag : t] for f, t in RUNS if t - lag > f])
            gamma.append(products.mean())
            if lag >= 8 and gamma[-1] < 0.05 * gamma[0]:
                break
        gammas.append(gamma)
        for f, t in RUNS:
            column = np.zeros(t - f)
            column[: min(len(gamma), t - f)] = gamma[: t - f]
            at = channel * ROWS
            matrix[at + f : at + t, at + f : at + t] = linalg.toeplitz(column)
    return gammas, matrix


def evidence(prior_std):
    y, tested, nuisances = problem()
    known = np.zeros((1, 5))
    if prior_std:
        known[0, 3] = 1 / prior_std
    every = np.vstack([np.column_stack([tested, nuisances]), known])
    target = np.append(y, 0.0)
    solution = np.linalg.lstsq(every, target, rcond=None)[0]
    theta = solution[:2]
    without = np.linalg.lstsq(every[:, 2:], target, rcond=None)[0]
    energy_with = np.sum((target - every @ solution) ** 2)
    energy_without = np.sum((target - every[:, 2:] @ without) ** 2)
    # what the nuisances cannot make of the tested columns
    part = np.linalg.lstsq(every[:, 2:], np.vstack([tested, np.zeros((1, 2))]), rcond=None)[0]
    beyond = tested - nuisances @ part
    after = y - nuisances @ without - beyond @ theta
    inverse = np.linalg.inv(every.T @ every)[:2, :2]
    gammas, matrix = blocks(after)
    from_prior = np.outer(part[1], part[1]) / prior_std**2 if prior_std else np.zeros((2, 2))
    by_residual = inverse @ (beyond.T @ matrix @ beyond + from_prior) @ inverse
    scores = (beyond * after[:, None])[:ROWS] + (beyond * after[:, None])[ROWS:]
    window = max(20, *(len(gamma) for gamma in gammas))
    meat = np.zeros((2, 2))
    for f, t in RUNS:
        for lag in range(window + 1):
            product = scores[f : t - lag].T @ scores[f + lag : t]
            meat += (1 - lag / (window + 1)) * (product if lag == 0 else product + product.T)
    by_scores = inverse @ (meat + from_prior) @ inverse
    # the larger one, in units of the information about each coefficient
    information = np.diag(np.linalg.inv(inverse))
    covariance = max(by_residual, by_scores, key=lambda covariance: np.diag(covariance) @ information)
    wald = theta @ np.linalg.solve(covariance, theta)
    sums = scores.reshape(12, 20, 2).sum(axis=1)
    spread = inverse @ (sums.T @ sums) @ inverse * 12 / 11
    f_ratio = theta @ np.linalg.solve(spread, theta) / 2 * 10 / 11
    shown = beyond @ theta
    print("theta", *theta)
    print("covariance", *covariance.ravel(), "by residual" if covariance is by_residual else "by scores")
    print("z", stats.norm.isf(stats.chi2.sf(wald, 2) / 2), "wald", wald)
    print("p_cluster", stats.f.sf(f_ratio, 2, 10))
    print("energy", energy_without - energy_with, "of", energy_without)
    print("gain", 1 - energy_with / energy_without)
    print("rms", 0.5 * np.sqrt(np.mean(shown[:ROWS] ** 2)), 0.1 * np.sqrt(np.mean(shown[ROWS:] ** 2)))
    print("nuisances", *without)

def harmonics():
    """Five periods of 4 s at 20 Hz: power of the bins, harmonics are each fifth."""
    i = np.arange(400)
    x = chance(3, i) + 0.2 * np.cos(2 * np.pi * 0.5 * 0.05 * i)
    power = np.abs(np.fft.fft(x - x.mean())) ** 2
    at = np.arange(5, 41, 5)
    beside = np.mean([power[at + shift] for shift in (-2, -1, 1, 2)], axis=0)
    ratio = power[at] / beside
    print("ratios", *ratio)
    print("p", stats.combine_pvalues(stats.f.sf(ratio, 2, 8), method="fisher").pvalue)
    print("excess", np.sum(2 * (power[at] - beside) / 400))


if __name__ == "__main__":
    if sys.argv[1:] == ["harmonics"]:
        harmonics()
    else:
        evidence(float(sys.argv[1]) if len(sys.argv) > 1 else None)
