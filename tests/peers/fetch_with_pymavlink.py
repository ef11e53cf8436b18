"""Flies a simulated vehicle up and down with pymavlink, and fetches the log of the flight with its file transfer.

    fetch_with_pymavlink.py CONNECTION px4|ardupilot

Lists the logs with pymavlink's MAVFTP, downloads the last one with bursts, and writes
{"path": ..., "listed": bytes, "log": hex of its first bytes, "sum": its checksum as zlib has it, "bytes": bytes} as
JSON. Exit status 77 where pymavlink is missing.
"""

import json
import os
import sys
import time
import zlib

os.environ["MAVLINK20"] = "1"
os.environ.setdefault("MAVLINK_DIALECT", "ardupilotmega")
try:
    from pymavlink import mavftp, mavutil
except ImportError:
    sys.stderr.write("pymavlink with its file transfer is missing\n")
    sys.exit(77)

mavlink = mavutil.mavlink
PATIENCE_S = 90.0
HEIGHT_M = 3.0
SEA_M = 488.0


class Station:
    def __init__(self, connection):
        self.link = mavutil.mavlink_connection(connection, source_system=255, source_component=190)
        self.end = time.monotonic() + PATIENCE_S
        self.beat = 0.0
        self.armed = False

    def until(self, condition, again=lambda: None):
        asked = 0.0
        while not condition():
            if time.monotonic() > self.end:
                raise SystemExit("no progress")
            if time.monotonic() > self.beat:
                self.beat = time.monotonic() + 0.5
                self.link.mav.heartbeat_send(6, 8, 0, 0, 4)
            if time.monotonic() > asked:
                asked = time.monotonic() + 1.0
                again()
            message = self.link.recv_match(type=["HEARTBEAT"], blocking=True, timeout=0.05)
            if message is not None and message.get_srcComponent() == 1:
                self.armed = bool(message.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED)

    def command(self, number, *params):
        params = list(params) + [0] * (7 - len(params))
        self.link.mav.command_long_send(1, 1, number, 0, *params)


def fly(station, autopilot):
    station.until(lambda: station.link.target_system != 0)

    def up():
        if autopilot == "px4":
            station.command(mavlink.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, 0, 0, 0, SEA_M + HEIGHT_M)
        else:
            station.command(mavlink.MAV_CMD_DO_SET_MODE, 1, 4)
        station.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
        if autopilot != "px4":
            station.command(mavlink.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, 0, 0, 0, HEIGHT_M)

    station.until(lambda: station.armed, up)
    began = time.monotonic()
    station.until(lambda: time.monotonic() > began + 1.0)
    station.until(lambda: not station.armed, lambda: station.command(mavlink.MAV_CMD_NAV_LAND))


def last(ftp, path):
    """Path and size of the last log below a folder."""
    answer = ftp.cmd_list([path])
    if answer.error_code != mavftp.FtpError.Success:
        raise SystemExit(f"{path} cannot be listed: {answer.error_code}")
    entry = sorted((entry for entry in ftp.list_result if entry.name not in (".", "..")), key=lambda entry: entry.name)[-1]
    below = f"{path}/{entry.name}"
    return last(ftp, below) if entry.is_dir else (below, entry.size_b)


def main():
    connection, autopilot = sys.argv[1:]
    station = Station(connection)
    fly(station, autopilot)
    ftp = mavftp.MAVFTP(station.link, 1, 1)
    # whole messages: a busy computer loses fewer of them
    ftp.ftp_settings.burst_read_size = 239
    path, listed = last(ftp, "/fs/microsd/log" if autopilot == "px4" else "/APM/LOGS")
    got = []
    ftp.cmd_get([path, "-"], callback=lambda file: got.append(file.read() if file else None))
    answer = ftp.process_ftp_reply("OpenFileRO", timeout=120)
    if not got or got[0] is None:
        raise SystemExit(f"{path} does not come: {answer.error_code}")
    log = got[0]
    # the same polynomial, begun with nought and not inverted at the end
    total = zlib.crc32(log, 0xFFFFFFFF) ^ 0xFFFFFFFF
    json.dump({"path": path, "listed": listed, "log": log.hex(), "sum": total, "bytes": len(log)}, sys.stdout)


if __name__ == "__main__":
    main()
