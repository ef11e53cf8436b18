#!/usr/bin/env python3
"""Writes the inputs from which the fuzzers begin, into work/TARGET: pieces of the project's own fixtures and
configuration files, and short scripts. The same files in every run; what the fuzzers made of them is in corpus/."""
import random
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
LOGS = sorted((ROOT / "fixtures").glob("*.tlog"))


def records(log, most):
    """The first records of a log: stamp and frame."""
    data, at, found = log.read_bytes(), 0, []
    while at + 10 < len(data) and len(found) < most:
        length = data[at + 9]
        size = length + (12 if data[at + 8] == 0xFD else 8) + (13 if data[at + 8] == 0xFD and data[at + 10] & 1 else 0)
        found.append((data[at:at + 8], data[at + 8:at + 8 + size]))
        at += 8 + size
    return found


def splitter():
    for log in LOGS:
        frames = b"".join(frame for _, frame in records(log, 25))
        yield bytes([0, 7]) + frames
        yield bytes([2, 255, 40]) + frames[:40]
    yield from scripts(5, [1, 2], 6, 150)
    # mavlink#2555, alone and before a whole frame
    short = bytes([0xFD, 0, 0, 0, 0, 1, 1, 0x83, 0, 0, 0])
    yield bytes([0, 3]) + short
    yield bytes([0, 3]) + short + frames


def tlog():
    for log in LOGS:
        some = records(log, 30)
        yield bytes([0, 5]) + b"".join(stamp + frame for stamp, frame in some)
        yield bytes([0, 5]) + b"".join(stamp[::-1] + frame for stamp, frame in some)
        yield bytes([0, 5]) + b"".join([some[0][0]] + [frame for _, frame in some])
    yield from scripts(6, [1], 8, 200)


def ulog():
    log = (ROOT / "fixtures/px4_flight.ulg").read_bytes()
    kept, at = {}, 16
    while at + 3 <= len(log):
        body = log[at + 3:at + 3 + int.from_bytes(log[at:at + 2], "little")]
        kept.setdefault(chr(log[at + 2]), []).append(log[at:at + 3] + body)
        at += 3 + len(body)
    for topics in (b"vehicle_attitude", b"esc_status", b"vehicle_status"), (b"vehicle_local_position", b"actuator_motors"):
        formats = [m for m in kept["F"] if m[3:].split(b":")[0] in topics + (b"esc_report",)]
        added = [m for m in kept["A"] if m[6:] in topics]
        data = [m for m in kept["D"] if m[3:5] in [a[4:6] for a in added]][:12]
        yield bytes([0, 7]) + log[8:16] + b"".join(kept["B"] + kept["I"][:3] + formats + kept["P"][:3] + added + data)
    yield from scripts(8, [1], 8, 200)


def dataflash():
    yield from scripts(7, [1, 3], 8, 300)
    yield b"\x01\x09" + b"".join(bytes([0xA3, 0x95, 135]) + bytes([64, 0, 0, 3, 0, 0, 0, 0, event]) for event in (10, 28, 18, 11))
    yield (b"\x02IMU, 1000, 0, 0.1, 0.2, 0.3, 1, 2, -9.8\nATT, 2000, 1, 2, 3, 4, 5, 6\nMSG, 3000, ArduCopter V4.5.7, again\n"
           b"PARM, 3000, FRAME_CLASS, 1\nMODE, 4000, GUIDED, GUIDED, 1\nEV, 1e3\nnothing\nESC, 5000, 3, nan\nFMT, 135, 12, EV")


def csv():
    yield b"\x00\x00time_s,velocity_x_m_s,velocity_y_m_s,velocity_z_m_s\n0,1,2,3\n0.1,1,,3\n\n0.2,nan,2,3\n"
    yield b"\x01\x000,1,2,3,0.5,0.5\n0.01,1,2,3,0.5,0.5\n0.01,1,2,3,0.5\n-5,1,2,3,0.5,0.5\n1e9,1,2,3,0.5,0.5\n"
    yield b"\x02\x010;1;0;0;0;1;2;3\n100;0.7;0.7;0;0;1;2;3\n200;\"0\";0;0;0;1;2;3\n"
    yield b"\x03\x000\t0.1\t0.2\t12.1\t1\tx\n1\t0.1\t0.2\t12.0\t1\ty\n"


def toml():
    kinds = {0: ["configs/*.toml", "fixtures/*.toml"], 1: ["configs/trajectories/*.toml"], 2: ["configs/demo/concealed.toml"],
             3: ["configs/csv/*.toml"], 4: ["configs/demo/limits.toml"]}
    for kind, patterns in kinds.items():
        for pattern in patterns:
            for path in sorted(ROOT.glob(pattern)):
                lines = path.read_text().splitlines()
                # comments teach a fuzzer nothing
                yield bytes([kind]) + "\n".join(line for line in lines if line and not line.startswith("#")).encode()
    yield b'\x05autopilot = "px4"\nunanswered = ["A"]\nabsent = []\n[values]\nTHR_MDL_FAC = 0.3\nPWM_MAIN_MIN1 = 1000.0\n'
    model = (ROOT / "fixtures/p04_vehicle.toml").read_text()
    yield b"\x06" + (model + '\n[[effect]]\nid = "motor_lag"\ntime_constant_s = 0.05\n').encode()


def scripts(seed, first, count, most):
    """Short scripts of random bytes, behind each of the first bytes."""
    draw = random.Random(seed)
    for head in first:
        for _ in range(count):
            yield bytes([head]) + draw.randbytes(draw.randrange(1, most))


def signing():
    yield from scripts(1, [1, 2], 6, 200)
    yield b"\x00\x01\x20" + bytes(range(32)) + b"mavid signing times 1\nown 400000\nstream 1 1 1 400000\n"
    yield b"\x00\x01\x06secret" + b"mavid signing times 1\nown 18446744073709551615\n"


def flight():
    yield from scripts(2, range(16), 2, 60)


def identify():
    yield from scripts(3, [0, 1, 2], 8, 40)


def explain():
    yield b""
    yield from scripts(4, [0, 1, 4, 5, 6], 2, 20)


for make in [splitter, tlog, ulog, dataflash, csv, toml, signing, flight, identify, explain]:
    folder = HERE / "work" / make.__name__
    folder.mkdir(parents=True, exist_ok=True)
    for index, data in enumerate(make()):
        (folder / f"seed-{index:02}").write_bytes(data)
