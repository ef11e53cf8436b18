"""Commands a vehicle with pymavlink: mode, arming, takeoff, a setpoint, landing.

    fly_with_pymavlink.py CONNECTION px4|ardupilot

PX4 is flown in OFFBOARD with one setpoint for every ATTITUDE that comes, ArduPilot in GUIDED. Writes what it saw
as JSON. Exit status 77 where pymavlink is missing.
"""

import json
import sys
import time

from messages import mavutil

mavlink = mavutil.mavlink
PATIENCE_S = 90.0
HEIGHT_M = 3.0
PX4_OFFBOARD = 6 << 16


class Pilot:
    def __init__(self, connection):
        self.link = mavutil.mavlink_connection(connection, source_system=255, source_component=190)
        self.end = time.monotonic() + PATIENCE_S
        self.beat = 0.0
        self.position = None
        self.mode = None
        self.armed = False
        self.landed = None
        self.acks = {}
        self.texts = []
        self.counts = {}
        self.setpoint = None

    def step(self):
        """Takes one message; sends what is due."""
        if time.monotonic() > self.end:
            raise SystemExit(f"no progress: mode {self.mode}, armed {self.armed}, at {self.position}, {self.texts}")
        if time.monotonic() > self.beat:
            self.beat = time.monotonic() + 0.5
            self.link.mav.heartbeat_send(6, 8, 0, 0, 4)
        message = self.link.recv_match(blocking=True, timeout=0.05)
        if message is None:
            return
        kind = message.get_type()
        self.counts[kind] = self.counts.get(kind, 0) + 1
        if kind == "HEARTBEAT" and message.get_srcComponent() == 1:
            self.mode = message.custom_mode
            self.armed = bool(message.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED)
            self.autopilot = message.autopilot
        elif kind == "LOCAL_POSITION_NED":
            self.position = [message.x, message.y, message.z]
        elif kind == "EXTENDED_SYS_STATE":
            self.landed = message.landed_state
        elif kind == "COMMAND_ACK":
            self.acks[message.command] = message.result
        elif kind == "STATUSTEXT":
            self.texts.append(message.text)
        elif kind == "PARAM_VALUE":
            self.parameter = message
        elif kind == "ATTITUDE" and self.setpoint is not None:
            x, y, z = self.setpoint
            self.link.mav.set_position_target_local_ned_send(
                0, 1, 1, mavlink.MAV_FRAME_LOCAL_NED, 0, x, y, z, 0, 0, 0, 0, 0, 0, 0, 0)

    def until(self, condition):
        while not condition():
            self.step()

    def command(self, number, *params):
        """Asks until it is accepted."""
        self.acks.pop(number, None)
        params = list(params) + [0] * (7 - len(params))
        while True:
            self.link.mav.command_long_send(1, 1, number, 0, *params)
            again = time.monotonic() + 0.5
            self.until(lambda: number in self.acks or time.monotonic() > again)
            if self.acks.get(number) == 0:
                return
            self.acks.pop(number, None)

    def interval(self, message_id, rate_hz):
        self.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, message_id, 1e6 / rate_hz)


def main():
    connection, autopilot = sys.argv[1:]
    pilot = Pilot(connection)
    pilot.until(lambda: pilot.mode is not None)
    for message_id, rate_hz in ((30, 50), (32, 20), (245, 5)):
        pilot.interval(message_id, rate_hz)
    pilot.parameter = None
    name = b"COM_OF_LOSS_T" if autopilot == "px4" else b"GUID_TIMEOUT"
    pilot.link.mav.param_request_read_send(1, 1, name, -1)
    pilot.until(lambda: pilot.parameter is not None)
    pilot.until(lambda: pilot.position is not None)
    if autopilot == "px4":
        pilot.setpoint = [0.0, 0.0, -HEIGHT_M]
        seen = pilot.counts["ATTITUDE"]
        pilot.until(lambda: pilot.counts["ATTITUDE"] > seen + 75)
        pilot.command(mavlink.MAV_CMD_DO_SET_MODE, 1, 6)
        pilot.until(lambda: pilot.mode == PX4_OFFBOARD)
        pilot.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
    else:
        pilot.command(mavlink.MAV_CMD_DO_SET_MODE, 1, 4)
        pilot.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
        pilot.command(mavlink.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, 0, 0, 0, HEIGHT_M)
    pilot.until(lambda: pilot.position[2] < 0.2 - HEIGHT_M)
    pilot.setpoint = [1.5, 1.0, -HEIGHT_M]
    pilot.until(lambda: abs(pilot.position[0] - 1.5) < 0.3 and abs(pilot.position[1] - 1.0) < 0.3)
    there = list(pilot.position)
    pilot.setpoint = None
    pilot.command(mavlink.MAV_CMD_NAV_LAND)
    pilot.until(lambda: not pilot.armed and pilot.landed == mavlink.MAV_LANDED_STATE_ON_GROUND)
    print(json.dumps({
        "autopilot": pilot.autopilot,
        "parameter": pilot.parameter.param_value,
        "parameters": pilot.parameter.param_count,
        "there": there,
        "landed_at": pilot.position,
        "texts": pilot.texts,
        "bad": pilot.counts.get("BAD_DATA", 0),
    }))


main()
