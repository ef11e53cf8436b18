"""Plays a PX4 vehicle with pymavlink, for a ground station that flies it in OFFBOARD.

    vehicle_with_pymavlink.py CONNECTION RATE_HZ   until it has flown, landed and disarmed
    vehicle_with_pymavlink.py --check              only whether pymavlink is there

A point that follows setpoints: position, velocity and acceleration together, leaning as its acceleration asks. Modes
need what PX4's need: OFFBOARD a second of setpoints before, arming OFFBOARD or Hold. Writes what it saw as JSON; of the
setpoints, in which of the RATE_HZ slots of the ground station's clock each was made, and how old it was beside the
youngest. Exit status 77 where pymavlink is missing.
"""

import json
import math
import struct
import sys
import time

from messages import mavutil

m = mavutil.mavlink
PATIENCE_S = 150.0
STEP_S = 0.01
G = 9.81
HOLD, LAND, OFFBOARD = 4 << 16 | 3 << 24, 4 << 16 | 6 << 24, 6 << 16
NAMES = {HOLD: "HOLD", LAND: "LAND", OFFBOARD: "OFFBOARD"}
ACCEPTED, TEMPORARILY_REJECTED, UNSUPPORTED, FAILED = 0, 1, 3, 4
SENSORS = 0x1 | 0x2 | 0x4 | 0x8 | 0x20 | 0x400 | 0x800 | 0x1000 | 0x2000 | 0x4000 | 0x8000 | 0x200000 | 0x2000000
HEALTHY = 1 << 28
ESTIMATE_GOOD = 831

# whole numbers go out as bytes, as PX4 sends them
PARAMETERS = {
    "COM_OF_LOSS_T": 1.0, "COM_OBL_RC_ACT": 4, "COM_RC_IN_MODE": 4, "COM_RCL_EXCEPT": 4, "NAV_DLL_ACT": 0,
    "NAV_RCL_ACT": 2, "COM_RC_OVERRIDE": 1, "COM_LOW_BAT_ACT": 0, "GF_ACTION": 0, "COM_DISARM_LAND": 1.0,
    "MPC_XY_VEL_MAX": 12.0, "MPC_Z_VEL_MAX_UP": 4.0, "MPC_Z_VEL_MAX_DN": 4.0, "MPC_TILTMAX_AIR": 45.0,
    "MPC_THR_HOVER": 0.5, "THR_MDL_FAC": 0.0, "CA_ROTOR_COUNT": 4, "MAV_SYS_ID": 1,
} | {f"PWM_MAIN_{kind}{output}": value for output in range(1, 5)
     for kind, value in (("FUNC", 100 + output), ("MIN", 1000), ("MAX", 2000), ("DIS", 900))}


def unit(v):
    size = math.sqrt(sum(x * x for x in v))
    return [x / size for x in v]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def quaternion(acceleration, yaw):
    """The attitude, NED from FRD, whose thrust gives the acceleration, the nose to yaw."""
    down = unit([-acceleration[0], -acceleration[1], G - acceleration[2]])
    right = unit(cross(down, [math.cos(yaw), math.sin(yaw), 0.0]))
    ahead = cross(right, down)
    trace = ahead[0] + right[1] + down[2]
    # far from upside down: w is never small
    w = 0.5 * math.sqrt(1.0 + trace)
    return [w, (right[2] - down[1]) / (4 * w), (down[0] - ahead[2]) / (4 * w), (ahead[1] - right[0]) / (4 * w)]


def turn_rates(before, after):
    """Body rates from one attitude to the next."""
    w, x, y, z = before
    a, b, c, d = after
    turn = [w * b - x * a - y * d + z * c, w * c + x * d - y * a - z * b, w * d - x * c + y * b - z * a]
    return [2.0 * part / STEP_S for part in turn]


class Vehicle:
    def __init__(self, connection, rate_hz):
        self.link = mavutil.mavlink_connection(connection, source_system=1, source_component=1)
        self.slot_ms = 1000 / rate_hz
        self.start = time.monotonic()
        self.mode, self.armed, self.landed = HOLD, False, True
        self.p, self.v, self.a, self.q, self.w = [0.0] * 3, [0.0] * 3, [0.0] * 3, [1.0, 0.0, 0.0, 0.0], [0.0] * 3
        self.setpoint, self.came, self.first = None, None, None
        self.intervals, self.sent = {}, {}
        self.still = None
        self.highest = 0.0
        self.modes, self.refused, self.losses = [NAMES[HOLD]], [], 0
        self.made, self.ages, self.fields = [], [], []
        self.over = None

    def now(self):
        return time.monotonic() - self.start

    def ms(self):
        return int(1e3 * self.now())

    def enter(self, mode):
        if mode != self.mode:
            self.modes.append(NAMES[mode])
        self.mode = mode

    # what comes in

    def hear(self, message):
        kind = message.get_type()
        if kind == "COMMAND_LONG":
            result = self.obey(message)
            if result != ACCEPTED:
                self.refused.append([message.command, int(message.param1), result])
            self.link.mav.command_ack_send(
                message.command, result, 0, 0, message.get_srcSystem(), message.get_srcComponent())
        elif kind == "SET_POSITION_TARGET_LOCAL_NED":
            self.take(message)
        elif kind == "TIMESYNC" and message.tc1 == 0:
            self.link.mav.timesync_send(int(1e9 * self.now()) + 1, message.ts1)
        elif kind == "PARAM_REQUEST_READ":
            name = message.param_id
            if name in PARAMETERS:
                value = PARAMETERS[name]
                whole = isinstance(value, int)
                value = struct.unpack("<f", struct.pack("<i", value))[0] if whole else value
                self.link.mav.param_value_send(
                    name.encode(), value, 6 if whole else 9, len(PARAMETERS), list(PARAMETERS).index(name))
        elif kind == "MISSION_REQUEST_LIST":
            self.link.mav.mission_count_send(
                message.get_srcSystem(), message.get_srcComponent(), 0, message.mission_type)

    def take(self, message):
        now = self.now()
        if self.came is None or now - self.came > 1.0:
            self.first = now
        self.came = now
        self.setpoint = message
        self.made.append(message.time_boot_ms)
        self.ages.append(1e3 * now - message.time_boot_ms)
        self.fields.append((message.x, message.y, message.z, message.vx, message.vy, message.vz))

    def has_stream(self):
        now = self.now()
        return self.came is not None and now - self.came < 0.5 and now - self.first >= 1.0

    def obey(self, command):
        number = command.command
        if number == m.MAV_CMD_DO_SET_MODE:
            mode = int(command.param2) << 16 | int(command.param3) << 24
            if mode not in NAMES or (mode == OFFBOARD and not self.has_stream()):
                return TEMPORARILY_REJECTED
            self.enter(mode)
            return ACCEPTED
        if number == m.MAV_CMD_NAV_LAND:
            self.enter(LAND)
            return ACCEPTED
        if number == m.MAV_CMD_COMPONENT_ARM_DISARM:
            if command.param1 < 0.5 and not self.landed:
                return TEMPORARILY_REJECTED
            if command.param1 >= 0.5 and self.mode == OFFBOARD and not self.has_stream():
                return TEMPORARILY_REJECTED
            self.armed = command.param1 >= 0.5
            return ACCEPTED
        if number == m.MAV_CMD_SET_MESSAGE_INTERVAL:
            if int(command.param1) not in STREAMS:
                return FAILED
            self.intervals[int(command.param1)] = 1e-6 * command.param2
            return ACCEPTED
        if number == m.MAV_CMD_REQUEST_MESSAGE:
            if int(command.param1) not in STREAMS:
                return UNSUPPORTED
            STREAMS[int(command.param1)](self)
            return ACCEPTED
        return UNSUPPORTED

    # flight

    def step(self):
        now = self.now()
        if self.armed and self.mode == OFFBOARD and now - self.came > PARAMETERS["COM_OF_LOSS_T"]:
            self.losses += 1
            self.enter(LAND)
        if not self.armed:
            return
        wanted, velocity, acceleration, yaw = list(self.p), [0.0] * 3, [0.0] * 3, 0.0
        if self.mode == OFFBOARD:
            s = self.setpoint
            wanted, velocity, acceleration = [s.x, s.y, s.z], [s.vx, s.vy, s.vz], [s.afx, s.afy, s.afz]
            yaw = s.yaw
        elif self.mode == LAND:
            velocity[2] = 0.7
        if self.landed and (self.mode != OFFBOARD or wanted[2] > self.p[2] - 0.2):
            return self.rest(now)
        self.landed = False
        for axis in range(3):
            speed = velocity[axis] + 1.2 * max(-2.0, min(2.0, wanted[axis] - self.p[axis]))
            ask = acceleration[axis] + 3.0 * (speed - self.v[axis])
            self.a[axis] += (max(-6.0, min(6.0, ask)) - self.a[axis]) * STEP_S / 0.1
            self.v[axis] += self.a[axis] * STEP_S
            self.p[axis] += self.v[axis] * STEP_S
        before, self.q = self.q, quaternion(self.a, yaw)
        self.w = turn_rates(before, self.q)
        self.highest = max(self.highest, -self.p[2])
        if self.p[2] >= 0.0 and self.mode == LAND:
            self.p[2], self.v, self.a, self.w = 0.0, [0.0] * 3, [0.0] * 3, [0.0] * 3
            self.q = quaternion(self.a, yaw)
            self.landed, self.still = True, now

    def rest(self, now):
        if self.still is not None and now - self.still > PARAMETERS["COM_DISARM_LAND"]:
            self.armed, self.over = False, now
            self.enter(HOLD)

    # what goes out

    def heartbeat(self):
        armed = m.MAV_MODE_FLAG_SAFETY_ARMED if self.armed else 0
        self.link.mav.heartbeat_send(2, 12, 1 | 4 | 8 | 16 | armed, self.mode, 4 if self.armed else 3)

    def speak(self):
        now = self.now()
        for message_id, interval in self.intervals.items():
            # on a grid, so that a late step does not slow the stream
            slot = int(now / interval) if interval > 0 else None
            if slot is not None and slot != self.sent.get(message_id):
                self.sent[message_id] = slot
                STREAMS[message_id](self)

    def share(self):
        lift = math.sqrt(self.a[0] ** 2 + self.a[1] ** 2 + (G - self.a[2]) ** 2) / G
        return min(1.0, 0.5 * lift) if self.armed and not self.landed else 0.0

    def send_status(self):
        self.link.mav.sys_status_send(SENSORS, SENSORS, SENSORS | HEALTHY, 100, 16200, -1, 95, 0, 0, 0, 0, 0, 0)

    def send_servos(self):
        pulse = int(1000 + 1000 * self.share()) if self.armed else 900
        self.link.mav.servo_output_raw_send(int(1e6 * self.now()), 0, *[pulse] * 4, 0, 0, 0, 0)

    def send_imu(self):
        # body: nothing but thrust and weight act, so that only z is felt
        felt = -math.sqrt(self.a[0] ** 2 + self.a[1] ** 2 + (G - self.a[2]) ** 2)
        self.link.mav.highres_imu_send(
            int(1e6 * self.now()), 0.0, 0.0, felt, *self.w, 0.2, 0.0, 0.4, 950.0, 0.0, 500.0, 25.0, 0x3F)

    def send_home(self):
        self.link.mav.home_position_send(
            473977420, 85455940, 488000, 0, 0, 0, [1, 0, 0, 0], 0, 0, 0, int(1e6 * self.now()))

    def send_version(self):
        self.link.mav.autopilot_version_send(
            4 | 8 | 16 | 128 | 8192, 1 << 24 | 16 << 16 | 255, 0, 0, 0, [0] * 8, [0] * 8, [0] * 8, 0, 0, 7)


STREAMS = {
    1: Vehicle.send_status,
    31: lambda v: v.link.mav.attitude_quaternion_send(v.ms(), *v.q, *v.w),
    32: lambda v: v.link.mav.local_position_ned_send(v.ms(), *v.p, *v.v),
    36: Vehicle.send_servos,
    105: Vehicle.send_imu,
    147: lambda v: v.link.mav.battery_status_send(0, 1, 3, 2500, [16200] + [65535] * 9, -1, -1, -1, 95),
    148: Vehicle.send_version,
    230: lambda v: v.link.mav.estimator_status_send(
        int(1e6 * v.now()), ESTIMATE_GOOD, 0.1, 0.1, 0.1, 0.05, 0.0, 0.0, 0.3, 0.4),
    242: Vehicle.send_home,
    245: lambda v: v.link.mav.extended_sys_state_send(0, 1 if v.landed else 2),
}


def main():
    if sys.argv[1] == "--check":
        print("null")
        return
    vehicle = Vehicle(sys.argv[1], float(sys.argv[2]))
    beat, following = -1.0, 0.0
    while vehicle.over is None or vehicle.now() < vehicle.over + 3.0:
        now = vehicle.now()
        if now > PATIENCE_S:
            raise SystemExit(f"no end: {vehicle.modes}, {vehicle.refused}, armed {vehicle.armed}, at {vehicle.p}")
        if now >= beat + 1.0:
            beat = now
            vehicle.heartbeat()
        # as many steps as time has passed
        while following < now:
            following += STEP_S
            vehicle.step()
        vehicle.speak()
        message = vehicle.link.recv_match(blocking=True, timeout=max(0.0005, following - vehicle.now()))
        while message is not None:
            vehicle.hear(message)
            message = vehicle.link.recv_match(blocking=False)
    youngest = min(vehicle.ages)
    ages = sorted(age - youngest for age in vehicle.ages)
    slots = [int(made // vehicle.slot_ms) for made in vehicle.made]
    print(json.dumps({
        "modes": vehicle.modes,
        "refused": vehicle.refused,
        "losses": vehicle.losses,
        "highest_m": vehicle.highest,
        "landed_at": vehicle.p,
        "setpoints": len(vehicle.made),
        "slots": max(slots) - min(slots) + 1,
        "slots_filled": len(set(slots)),
        "newer_each": all(b > a for a, b in zip(vehicle.made, vehicle.made[1:])),
        "moving": len(set(vehicle.fields)),
        "age_ms": {"median": ages[len(ages) // 2], "99": ages[int(0.99 * (len(ages) - 1))], "greatest": ages[-1]},
    }))


main()
