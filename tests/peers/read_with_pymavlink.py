"""Reads a telemetry log with pymavlink.

    read_with_pymavlink.py --time LOG      frames a second of its two log readers
    read_with_pymavlink.py --records LOG   one line a frame: stamp in microseconds, frame in hexadecimal
    read_with_pymavlink.py --counts LOG    one line a message: id, frames (unknown ids as well)

Exit status 77 where pymavlink is missing.
"""

import collections
import struct
import sys
import time

from messages import mavutil


def plain(path):
    return mavutil.mavlogfile(path, write=False)


def mapped(path):
    return mavutil.mavlink_connection(path)


def messages(log):
    while (message := log.recv_msg()) is not None:
        yield message


def message_id(message):
    name = message.get_type()
    return int(name[len("UNKNOWN_"):]) if name.startswith("UNKNOWN_") else message.get_msgId()


def main(what, path):
    if what == "--time":
        for name, opened in (("mavlogfile", plain), ("mavlink_connection", mapped)):
            best = 0.0
            for _ in range(3):
                start = time.perf_counter()
                count = sum(1 for _ in messages(opened(path)))
                best = max(best, count / (time.perf_counter() - start))
            print(name, f"{best:.0f}")
    elif what == "--records":
        # the stamp as pymavlink keeps it is a float of seconds; its bytes are taken from where it stood
        log = plain(path)
        with open(path, "rb") as raw:
            end = 0
            for message in messages(log):
                frame = bytes(message.get_msgbuf())
                raw.seek(end)
                (stamp,) = struct.unpack(">Q", raw.read(8))
                end += 8 + len(frame)
                assert abs(stamp * 1.0e-6 - message._timestamp) < 1e-3, (stamp, message._timestamp)
                print(stamp, frame.hex())
    elif what == "--counts":
        for number, count in sorted(collections.Counter(map(message_id, messages(plain(path)))).items()):
            print(number, count)
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2])
