"""Checks signed frames with pymavlink, and signs some.

Reads {"key": hex, "time": t, "frames": [hex, ...]} on standard input: 32 bytes of key, the time to begin signing
with in units of 10 microseconds since 2015, frames to check in their order. Writes {"accepted": [bool, ...],
"frames": [hex, ...]}: what it thinks of each, and five frames that it signed.

Exit status 77 where pymavlink is missing.
"""

import json
import os
import sys

os.environ["MAVLINK20"] = "1"
try:
    from pymavlink.dialects.v20 import ardupilotmega as dialect
except ImportError:
    sys.stderr.write("pymavlink is missing\n")
    sys.exit(77)


def mav(key, time):
    mav = dialect.MAVLink(None, srcSystem=255, srcComponent=190)
    mav.signing.secret_key = key
    mav.signing.timestamp = time
    mav.signing.sign_outgoing = True
    return mav


def accepts(checker, frame):
    try:
        return checker.decode(bytearray(frame)).get_type() == "HEARTBEAT"
    except dialect.MAVError:
        return False


def main():
    given = json.load(sys.stdin)
    key = bytes.fromhex(given["key"])
    checker, signer = mav(key, given["time"]), mav(key, given["time"])
    accepted = [accepts(checker, bytes.fromhex(frame)) for frame in given["frames"]]
    frames = []
    for _ in range(5):
        message = dialect.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3)
        frames.append(bytes(message.pack(signer)).hex())
        signer.seq = (signer.seq + 1) % 256
    json.dump({"accepted": accepted, "frames": frames}, sys.stdout)


if __name__ == "__main__":
    main()
