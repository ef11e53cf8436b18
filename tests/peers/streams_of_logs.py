"""Streams of vehicles' own logs by pyulog and pymavlink: number of samples, checksums of the values and stamps, as JSON.

    streams_of_logs.py LOG...

Written from PX4's and ArduPilot's definitions of their messages, not from mavid's tables. Values are SI in body axes forward, left,
up and world axes north, west, up. Of each value of a sample: sum, sum weighted by the sample's place, sum of magnitudes. An attitude
is given by four entries of its rotation matrix, which no sign of the quaternion changes. Of modes, and of positions on the globe, number
and stamps alone are told. Exit status 77 where a package is missing.
"""

import json
import math
import os
import sys

try:
    from pymavlink import DFReader
    from pyulog import ULog
except ImportError as missing:
    sys.stderr.write(f"{missing}\n")
    sys.exit(77)

NAN = float("nan")
MOTOR_1 = 101
RAD_S = 2.0 * math.pi / 60.0
PLACES = 97
# of a sample whose values are not compared
COUNTED = [0.0]


class Stream:
    def __init__(self):
        self.times, self.samples = [], []

    def take(self, time_s, values):
        # a message that is there twice is one sample
        if self.times and time_s == self.times[-1]:
            return
        if any(math.isfinite(value) for value in values):
            self.times.append(time_s)
            self.samples.append(values)

    def told(self):
        if self.samples[0] is COUNTED:
            self.samples = [[]]
        width = max(len(sample) for sample in self.samples)
        sums = [[0.0, 0.0, 0.0] for _ in range(width)]
        for place, sample in enumerate(self.samples):
            for total, value in zip(sums, sample):
                if math.isfinite(value):
                    total[0] += value
                    total[1] += value * (1 + place % PLACES)
                    total[2] += abs(value)
        first_s = self.times[0]
        after_s = math.fsum(time_s - first_s for time_s in self.times)
        return {"count": len(self.times), "sums": sums, "first_s": first_s, "after_s": after_s}


def turned(vector):
    return [vector[0], -vector[1], -vector[2]]


def attitude(w, x, y, z):
    """Of a quaternion from forward, right, down to north, east, down."""
    size = math.sqrt(w * w + x * x + y * y + z * z)
    if not 0.0 < size < math.inf:
        return []
    w, x, y, z = w / size, x / size, -y / size, -z / size
    return [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y), 2 * (y * z + w * x)]


def euler(roll, pitch, yaw):
    if not all(map(math.isfinite, (roll, pitch, yaw))):
        return []
    (cr, sr), (cp, sp), (cy, sy) = [(math.cos(math.radians(a) / 2), math.sin(math.radians(a) / 2)) for a in (roll, pitch, yaw)]
    return attitude(
        cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy
    )


def up_to_last(values, holds):
    last = max((place for place, value in enumerate(values) if holds(value)), default=-1)
    return values[: last + 1]


def rotors(row):
    """Speeds where each motor is."""
    out = {}
    used = int(row["esc_count"])
    functions = [int(row.get(f"esc[{i}].actuator_function", 0)) for i in range(used)]
    told = any(MOTOR_1 <= function < MOTOR_1 + 12 for function in functions)
    for i in range(used):
        if told and not MOTOR_1 <= functions[i] < MOTOR_1 + 12:
            continue
        if "esc_online_flags" not in row or int(row["esc_online_flags"]) >> i & 1:
            out[functions[i] - MOTOR_1 if told else i] = row[f"esc[{i}].esc_rpm"] * RAD_S
    return [out.get(i, NAN) for i in range(max(out, default=-1) + 1)]


def picks(*names):
    return lambda row: [row[name] for name in names]


def array(name, count=3):
    return picks(*[f"{name}[{i}]" for i in range(count)])


def vector(*names):
    return lambda row: turned([row[name] for name in names])


def vector_of(name):
    return lambda row: turned(array(name)(row))


def mean_of(name):
    return lambda row: turned([value / (row[name + "_dt"] * 1e-6) for value in array(name)(row)]) if row[name + "_dt"] else []


def only(condition, of):
    return lambda row: of(row) if condition(row) else []


def set_(*names):
    return lambda row: all(row.get(name, 1) for name in names)


# topic: quantity, values of a row, seconds to be added to its stamp, whether the stamp is that of the sensor's reading
NONE, SAMPLED = (lambda row: 0.0), True
ULOG = {
    "vehicle_attitude": [("attitude", lambda row: attitude(*array("q", 4)(row)), NONE, SAMPLED)],
    "vehicle_angular_velocity": [("angular_rate", vector_of("xyz"), NONE, SAMPLED)],
    "vehicle_acceleration": [("specific_force", vector_of("xyz"), NONE, SAMPLED)],
    "sensor_combined": [
        ("angular_rate", vector_of("gyro_rad"), lambda row: -0.5e-6 * row["gyro_integral_dt"], SAMPLED),
        (
            "specific_force",
            vector_of("accelerometer_m_s2"),
            lambda row: 1e-6 * (row["accelerometer_timestamp_relative"] - 0.5 * row["accelerometer_integral_dt"]),
            SAMPLED,
        ),
    ],
    "vehicle_imu": [
        ("angular_rate", mean_of("delta_angle"), lambda row: -0.5e-6 * row["delta_angle_dt"], SAMPLED),
        ("specific_force", mean_of("delta_velocity"), lambda row: -0.5e-6 * row["delta_velocity_dt"], SAMPLED),
    ],
    "vehicle_local_position": [
        ("position", only(set_("xy_valid", "z_valid"), vector("x", "y", "z")), NONE, SAMPLED),
        ("velocity", only(set_("v_xy_valid", "v_z_valid"), vector("vx", "vy", "vz")), NONE, SAMPLED),
    ],
    "vehicle_air_data": [("barometric_height", picks("baro_alt_meter"), NONE, SAMPLED)],
    "actuator_motors": [
        ("actuator_command", lambda row: up_to_last(array("control", 12)(row), math.isfinite), NONE, False),
    ],
    "actuator_outputs": [
        (
            "actuator_command",
            lambda row: up_to_last(array("output", 16)(row)[: int(row["noutputs"])], bool) or array("output", 1)(row),
            NONE,
            False,
        ),
    ],
    "esc_status": [("rotor_speed", rotors, NONE, False)],
    "battery_status": [
        ("battery_voltage", only(lambda row: set_("connected")(row) and row["voltage_v"] > 0, picks("voltage_v")), NONE, False),
        ("battery_current", only(lambda row: set_("connected")(row) and row["current_a"] >= 0, picks("current_a")), NONE, False),
    ],
    "vehicle_torque_setpoint": [("torque_setpoint", vector_of("xyz"), NONE, False)],
    "vehicle_thrust_setpoint": [("thrust_vector", vector_of("xyz"), NONE, False)],
    "trajectory_setpoint": [
        ("position_setpoint", vector_of("position"), NONE, False),
        ("velocity_setpoint", vector_of("velocity"), NONE, False),
        ("acceleration_setpoint", vector_of("acceleration"), NONE, False),
        ("yaw_setpoint", lambda row: [-row["yaw"]], NONE, False),
        ("yaw_rate_setpoint", lambda row: [-row["yawspeed"]], NONE, False),
    ],
    "vehicle_local_position_setpoint": [
        ("position_setpoint", vector("x", "y", "z"), NONE, False),
        ("velocity_setpoint", vector("vx", "vy", "vz"), NONE, False),
        ("acceleration_setpoint", vector_of("acceleration"), NONE, False),
        ("yaw_setpoint", lambda row: [-row["yaw"]], NONE, False),
        ("yaw_rate_setpoint", lambda row: [-row["yawspeed"]], NONE, False),
    ],
    "vehicle_attitude_setpoint": [
        ("attitude_setpoint", only(set_("q_d_valid"), lambda row: attitude(*array("q_d", 4)(row))), NONE, False),
        ("thrust_setpoint", lambda row: [-row["thrust_body[2]"]], NONE, False),
    ],
    "vehicle_rates_setpoint": [
        ("angular_rate_setpoint", vector("roll", "pitch", "yaw"), NONE, False),
        ("thrust_setpoint", lambda row: [-row["thrust_body[2]"]], NONE, False),
    ],
    "vehicle_status": [
        ("armed", lambda row: [float(row["arming_state"] == 2)], NONE, False),
        ("mode", lambda row: COUNTED, NONE, False),
    ],
    "vehicle_land_detected": [("landed_state", lambda row: [1.0 if row["landed"] else 2.0], NONE, False)],
}
RECEIVER = [("gps_velocity", only(set_("vel_ned_valid"), vector("vel_n_m_s", "vel_e_m_s", "vel_d_m_s")), NONE, SAMPLED)]
ULOG.update({"sensor_gps": RECEIVER, "vehicle_gps_position": RECEIVER})


# a log begins with the state at its beginning, whenever that was entered
STATES = ("armed", "mode", "landed_state")


def ulog(path):
    streams, log = {}, ULog(path)
    for topic in log.data_list:
        columns = {name: values.tolist() for name, values in topic.data.items()}
        rows = [dict(zip(columns, row)) for row in zip(*columns.values())]
        for quantity, values, shift, sampled in ULOG.get(topic.name, []):
            stream = streams.setdefault(f"{quantity} {topic.name} {topic.multi_id}", Stream())
            for row in rows:
                stamp = row["timestamp"]
                # a reading that is long past is none
                if sampled and abs(stamp - row.get("timestamp_sample", stamp)) < 1e6:
                    stamp = row.get("timestamp_sample", stamp)
                if quantity in STATES:
                    stamp = max(stamp, log.start_timestamp)
                stream.take(stamp * 1e-6 + shift(row), values(row))
    return streams


def degrees(*names):
    return lambda row: [math.radians(row[name]) for name in names]


def outputs(row):
    return up_to_last([float(row[f"C{i}"]) for i in range(1, 15) if f"C{i}" in row], bool)


def course(row):
    if row["Status"] < 3:
        return []
    angle = math.radians(row["GCrs"])
    return turned([row["Spd"] * math.cos(angle), row["Spd"] * math.sin(angle), row["VZ"]])


DATAFLASH = {
    "IMU": [("angular_rate", vector("GyrX", "GyrY", "GyrZ")), ("specific_force", vector("AccX", "AccY", "AccZ"))],
    "ATT": [
        ("attitude", lambda row: euler(row["Roll"], row["Pitch"], row["Yaw"])),
        ("attitude_setpoint", lambda row: euler(row["DesRoll"], row["DesPitch"], row["DesYaw"])),
    ],
    "AHR2": [("attitude", lambda row: attitude(row["Q1"], row["Q2"], row["Q3"], row["Q4"]))],
    "XKF1": [
        ("attitude", lambda row: euler(row["Roll"], row["Pitch"], row["Yaw"])),
        ("velocity", vector("VN", "VE", "VD")),
        ("position", vector("PN", "PE", "PD")),
    ],
    "GPS": [("gps_velocity", course)],
    "POS": [("position", lambda row: COUNTED)],
    "BARO": [("barometric_height", picks("Alt"))],
    "CTUN": [("barometric_height", picks("BAlt"))],
    "RCOU": [("actuator_command", outputs)],
    "BAT": [("battery_voltage", picks("Volt")), ("battery_current", picks("Curr"))],
    "RATE": [
        ("angular_rate", lambda row: turned(degrees("R", "P", "Y")(row))),
        ("angular_rate_setpoint", lambda row: turned(degrees("RDes", "PDes", "YDes")(row))),
        ("torque_setpoint", vector("ROut", "POut", "YOut")),
        ("thrust_setpoint", picks("AOut")),
    ],
}
DATAFLASH["ANG"] = DATAFLASH["ATT"]
INSTANCES = ("I", "C", "Instance", "Inst")
# of the position controller, an axis a message
AXES = {"PSCN": "N", "PSCE": "E", "PSCD": "D"}
ASKED = {"position_setpoint": ("DP", "TP"), "velocity_setpoint": ("DV",), "acceleration_setpoint": ("DA",)}


class Joined:
    """Samples of which several messages hold a part each: one that has its part, or is a quarter of a second old, is whole."""

    def __init__(self, give):
        self.give, self.rows = give, {}

    def take(self, part, row):
        first = next(iter(self.rows.values()), row)
        if part in self.rows or row["TimeUS"] - first["TimeUS"] >= 250000:
            self.end()
        self.rows[part] = row

    def end(self):
        if self.rows:
            self.give(sum(row["TimeUS"] for row in self.rows.values()) * 1e-6 / len(self.rows), self.rows)
        self.rows = {}


def dataflash(path):
    streams = {}

    def stream(key):
        return streams.setdefault(key, Stream())

    def asked(time_s, rows):
        for quantity, names in ASKED.items():
            values = [
                next((rows[message][name + axis] for name in names if name + axis in rows.get(message, {})), NAN)
                for message, axis in AXES.items()
            ]
            stream(f"{quantity} PSC 0").take(time_s, turned(values))

    def speeds(time_s, rows):
        values = [rows[i]["RPM"] * RAD_S if i in rows else NAN for i in range(max(rows) + 1)]
        stream("rotor_speed ESC 0").take(time_s, values)

    axes, motors = Joined(asked), Joined(speeds)
    log = DFReader.DFReader_binary(path)
    while (message := log.recv_msg()) is not None:
        name = message.get_type()
        if name in DATAFLASH:
            row = message.to_dict()
            instance = next((int(row[field]) for field in INSTANCES if field in row), 0)
            for quantity, values in DATAFLASH[name]:
                stream(f"{quantity} {name} {instance}").take(row["TimeUS"] * 1e-6, values(row))
        elif name in AXES:
            axes.take(name, message.to_dict())
        elif name == "ESC":
            row = message.to_dict()
            motors.take(row["Instance"], row)
    axes.end()
    motors.end()
    return streams


def main(paths):
    out = {}
    for path in paths:
        read = ulog if os.path.splitext(path)[1] == ".ulg" else dataflash
        out[path] = {key: stream.told() for key, stream in read(path).items() if stream.times}
    json.dump(out, sys.stdout)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(sys.argv[1:])
