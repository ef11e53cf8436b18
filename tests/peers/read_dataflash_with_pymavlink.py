"""Reads a log of ArduPilot with pymavlink: megabytes a second of the fastest of three runs, all messages with their values.

    read_dataflash_with_pymavlink.py LOG

Exit status 77 where pymavlink is missing.
"""

import os
import sys
import time

try:
    from pymavlink import DFReader
except ImportError:
    sys.stderr.write("pymavlink is missing\n")
    sys.exit(77)


def main(path):
    best = float("inf")
    for _ in range(3):
        start = time.perf_counter()
        log = DFReader.DFReader_binary(path)
        streams = {}
        while (message := log.recv_msg()) is not None:
            streams.setdefault(message.get_type(), []).append(message.to_dict())
        best = min(best, time.perf_counter() - start)
    print(f"{os.path.getsize(path) * 1e-6 / best:.3f}")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
