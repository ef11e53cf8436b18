"""Plays a PX4 vehicle that keeps one log and serves it by log messages with pymavlink.

    logs_with_pymavlink.py CONNECTION FILE LOSS

Loses a share LOSS of what comes and of what goes, by a seed. Ends once nobody has been heard for a while after the log was
asked for, and writes {"requests": of data, "sent": messages with data} as JSON. Exit status 77 where pymavlink is missing.
"""

import json
import random
import sys
import time

from messages import mavutil

PATIENCE_S = 120.0
SILENT_S = 4.0
PIECE = 90


def main():
    connection, file, loss = sys.argv[1:]
    with open(file, "rb") as read:
        log = read.read()
    lost = random.Random(7)
    loss = float(loss)
    link = mavutil.mavlink_connection(connection, source_system=1, source_component=1)
    start = heard = time.monotonic()
    beat, requests, sent, at, end = 0.0, 0, 0, 0, 0

    def send(message):
        if lost.random() >= loss:
            link.mav.send(message)

    mav = mavutil.mavlink
    while time.monotonic() - start < PATIENCE_S:
        now = time.monotonic()
        if now > beat:
            beat = now + 0.3
            send(mav.MAVLink_heartbeat_message(2, 12, 1, 4 << 16 | 3 << 24, 3, 3))
        if requests and now - heard > SILENT_S:
            break
        message = link.recv_match(blocking=at >= end, timeout=0.02)
        if message is not None and lost.random() >= loss:
            heard = now
            kind = message.get_type()
            if kind == "COMMAND_LONG" and message.command in (512, 520):
                # neither a file transfer nor anything else that is optional
                send(mav.MAVLink_autopilot_version_message(0, 1 << 24, 0, 0, 0, [0] * 8, [0] * 8, [0] * 8, 0, 0, 99))
            elif kind == "LOG_REQUEST_LIST":
                send(mav.MAVLink_log_entry_message(3, 1, 3, 1700000000, len(log)))
            elif kind == "LOG_REQUEST_DATA" and message.id == 3:
                requests += 1
                at, end = message.ofs, min(message.ofs + message.count, len(log))
            elif kind == "LOG_REQUEST_END":
                at = end
        if at < end:
            piece = log[at:min(at + PIECE, end)]
            send(mav.MAVLink_log_data_message(3, at, len(piece), list(piece) + [0] * (PIECE - len(piece))))
            sent += 1
            at += len(piece)
            time.sleep(0.0005)
    json.dump({"requests": requests, "sent": sent}, sys.stdout)


main()
