"""Holds explanations by the vehicle's own log against those by telemetry, on the flights of ../shared/onboard/sitl, of which both are there.

    log_against_tlog.py MAVID

`../shared/score.py` judges both (MAVID_SHARED names another folder). Fails where a flight that is right by telemetry is wrong by
the vehicle's own log, and where the median error of the sizes that both state is larger by the own logs with an identification
profile: by more than two standard errors of the difference, by bootstrap over flights. Exit status 77 where the flights are
missing.
"""

import json
import os
import random
import re
import statistics
import subprocess
import sys

SHARED = os.environ.get("MAVID_SHARED") or os.path.join(os.path.dirname(__file__), "..", "..", "..", "shared")
SIZE = re.compile(r"(\w+\.\w+) (-?[\d.e+-]+) \+- [\d.e+-]+ \((-?[\d.e+-]+)")
DRAWS = 2000


def score(mavid, kind):
    """Of each flight whether it is right, and the relative error of each size."""
    command = [sys.executable, os.path.join(SHARED, "score.py"), "sitl", kind, "--mavid", mavid]
    said = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    print(said, flush=True)
    flights = {}
    for line in said.splitlines()[:-1]:
        flight, is_right, rest = line.split(maxsplit=2)
        sizes = {name: abs(float(value) / float(truth) - 1.0) for name, value, truth in SIZE.findall(rest)}
        flights[flight] = (is_right == "right", sizes)
    return flights


def logs_for_identification():
    found = []
    for name in ("answers-px4.json", "answers-ap.json"):
        with open(os.path.join(SHARED, "onboard", "sitl", name), encoding="utf-8") as read:
            flights = json.load(read)
        for flight, facts in flights.items():
            told = facts.get("logging") if isinstance(facts, dict) else None
            profile = json.dumps(told or facts)
            if '"ident' in profile or "SDLOG_PROFILE 9" in profile:
                found.append(flight)
    return found


def difference(pairs):
    """Median error by own log less that by telemetry, of pairs of both, flight by flight."""
    both = [pair for flight in pairs for pair in flight]
    return statistics.median(own for own, _ in both) - statistics.median(other for _, other in both)


def main(mavid):
    if not os.path.isdir(os.path.join(SHARED, "onboard", "sitl")):
        sys.stderr.write(f"expected flights in {SHARED}, got none\n")
        sys.exit(77)
    by_telemetry, by_log = score(mavid, "tlog"), score(mavid, "log")
    worse = [flight for flight, (right, _) in by_telemetry.items() if right and not by_log[flight][0]]
    pairs = []
    for flight in logs_for_identification():
        (_, own), (_, other) = by_log.get(flight, (0, {})), by_telemetry.get(flight, (0, {}))
        both = [(own[name], other[name]) for name in own if name in other]
        if both:
            pairs.append(both)
    lot = random.Random(1)
    draws = [difference(lot.choices(pairs, k=len(pairs))) for _ in range(DRAWS)]
    larger, error = difference(pairs), statistics.pstdev(draws)
    own = statistics.median(own for flight in pairs for own, _ in flight)
    count = sum(map(len, pairs))
    print(f"{len(by_log)} flights; right by telemetry and wrong by the own log: {worse or 'none'}")
    print(
        f"{count} sizes of {len(pairs)} flights with an identification profile: median error {own:.4f} by the own log,"
        f" {own - larger:.4f} by telemetry, difference {larger:.4f} +- {error:.4f}"
    )
    sys.exit(1 if worse or larger > 2.0 * error else 0)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
