"""Reads a log of PX4 with pyulog: megabytes a second of the fastest of three runs, all topics with their values.

    read_ulog_with_pyulog.py LOG

Exit status 77 where pyulog is missing.
"""

import os
import sys
import time

try:
    from pyulog import ULog
except ImportError:
    sys.stderr.write("pyulog is missing\n")
    sys.exit(77)


def main(path):
    best = float("inf")
    for _ in range(3):
        start = time.perf_counter()
        ULog(path)
        best = min(best, time.perf_counter() - start)
    print(f"{os.path.getsize(path) * 1e-6 / best:.3f}")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
