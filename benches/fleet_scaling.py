#!/usr/bin/env python3
"""What `mavid fleet` takes for 10, 100 and 1000 logs: processor time, memory, the exponent of growth; beside a loop over the command on one
log; and a run that is killed and started again.

    python3 benches/fleet_scaling.py [--program target/release/mavid] [--counts 10,100,1000] [--shared ../shared] [--seed 1]

The logs are flights of the embedded simulator, of the fixtures and, where they are here, of the shared recordings. Each is another: its end
is cut by some bytes. One in twenty is damaged. Processor time is that of all processes, user and system: a busy computer changes it little.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import math
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
#: simulated flights: effects that are concealed in each, as [[effect]] tables
CONCEALED = [
    "",
    'id = "weak_rotor"\nrotor = 2\nfactor = 0.9',
    'id = "linear_drag"\ndx = 0.3\ndy = 0.3\ndz = 0.0',
    'id = "motor_lag"\ntime_constant = 0.05',
    "",
]
#: recordings that are used where they are here
SHARED = ["onboard/logs/copter_47dev_sitl_quad.bin", "onboard/logs/px4_160_quad_appended.ulg", "onboard/logs/px4_190_quad_esc_status.ulg"]
#: seconds of a simulated flight that are kept: a run of 1000 logs takes minutes
KEPT = 0.45
#: of the first 64 kB of a log nothing is cut off
LEAST = 64 << 10


def bases(program: str, shared: Path, seed: int, folder: Path) -> list[tuple[str, bytes]]:
    """Name and bytes of the flights that the logs are made of."""
    found = []
    for place, effect in enumerate(CONCEALED):
        log = folder / f"simulated{place}.tlog"
        command = [program, "simulate", ROOT / "configs/x500.toml", "--trajectory", ROOT / "configs/trajectories/table2.toml"]
        command += ["--seed", seed + place, "--out", log, "--quiet"]
        if effect:
            (folder / "effect.toml").write_text(f"[[effect]]\n{effect}\n")
            command += ["--effects", folder / "effect.toml"]
        subprocess.run([str(word) for word in command], check=True, stdout=subprocess.DEVNULL)
        whole = log.read_bytes()
        found.append((f"simulated{place}.tlog", whole[: int(len(whole) * KEPT)]))
    for name in ["fixtures/p04_identify_10_22s.tlog", "fixtures/px4_flight.ulg"]:
        found.append((Path(name).name, (ROOT / name).read_bytes()))
    for name in SHARED:
        if (shared / name).is_file():
            found.append((Path(name).name, (shared / name).read_bytes()))
        else:
            print(f"skipped: {shared / name} is not here")
    return found


def damaged(log: bytes, draw: random.Random) -> bytes:
    """A log with bytes that others stand in, one that is cut short, or bytes that are none."""
    kind = draw.randrange(3)
    if kind == 0:
        broken = bytearray(log)
        for _ in range(len(log) // 200):
            broken[draw.randrange(64, len(log))] ^= 1 << draw.randrange(8)
        return bytes(broken)
    return log[: len(log) // 5] if kind == 1 else draw.randbytes(len(log))


def write_logs(found: list[tuple[str, bytes]], count: int, seed: int, at: Path) -> int:
    """So many logs, each of other bytes, with the vehicles that they are of; gives their size."""
    draw = random.Random(seed)
    total = 0
    (at / "logs").mkdir(parents=True)
    for place in range(count):
        name, log = found[place % len(found)]
        log = log[: max(LEAST, len(log) - 32 * (place // len(found)))]
        if place % 20 == 7:
            log = damaged(log, draw)
        stem, ending = name.rsplit(".", 1)
        (at / "logs" / f"{stem}_{place:05}.{ending}").write_bytes(log)
        total += len(log)
    listed = [("x500", ROOT / "configs/x500.toml", "*/simulated*"), ("p04", ROOT / "fixtures/p04_vehicle.toml", "*/p04*")]
    text = "".join(f'[[vehicle]]\nname = "{name}"\nfile = "{file}"\nlogs = "{logs}"\n' for name, file, logs in listed)
    text += '[[vehicle]]\nname = "others"\nmass = 1.5\nlogs = "*"\n'
    (at / "vehicles.toml").write_text(text)
    return total


def peak_mb(pid: int, name: str, most: dict[str, float]) -> None:
    """The largest memory that a process had so far."""
    try:
        for line in Path(f"/proc/{pid}/status").read_text().splitlines():
            if line.startswith("VmHWM:"):
                most[name] = max(most.get(name, 0.0), int(line.split()[1]) / 1024)
    except OSError:
        pass


def measured(command: list[object]) -> dict[str, float]:
    """Time on the wall, processor time of all processes, and the largest memory of the command and of the processes that it starts."""
    begun = time.monotonic()
    process = subprocess.Popen([str(word) for word in command], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    most: dict[str, float] = {}
    ended = threading.Event()

    def watch() -> None:
        while not ended.wait(0.05):
            peak_mb(process.pid, "own_mb", most)

    watcher = threading.Thread(target=watch)
    watcher.start()
    _, status, usage = os.wait4(process.pid, 0)
    ended.set()
    watcher.join()
    process.returncode = os.waitstatus_to_exitcode(status)
    assert process.returncode in (0, 3), (command, process.returncode)
    found = {"wall_s": time.monotonic() - begun, "cpu_s": usage.ru_utime + usage.ru_stime}
    return found | {"own_mb": most.get("own_mb", 0.0), "largest_mb": usage.ru_maxrss / 1024}


def fleet(program: str, at: Path, out: str, depth: str, *more: object) -> list[object]:
    command = [program, "fleet", at / "logs", "--out", at / out, "--vehicles", at / "vehicles.toml", "--depth", depth]
    return [*command, "--format", "jsonl", "--quiet", *more]


def rows(out: Path) -> list[str]:
    """All rows of all tables, sorted."""
    return sorted(f"{path.parent.name} {line}" for path in out.glob("*/part-*.jsonl") for line in path.read_text().splitlines())


def parts(out: Path) -> dict[Path, str]:
    """The files of finished parts with their hashes."""
    finished = {path.stem for path in out.glob("_parts/*.json")}
    files = [path for path in out.glob("*/part-*.jsonl") if path.stem in finished]
    return {path: hashlib.sha256(path.read_bytes()).hexdigest() for path in files}


def killed_and_resumed(program: str, at: Path, depth: str, part_logs: int) -> dict[str, object]:
    """A run is killed as soon as it has written some parts, and started again; against one that was not."""
    command = fleet(program, at, "killed", depth, "--part-logs", part_logs)
    process = subprocess.Popen([str(word) for word in command], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while len(list((at / "killed").glob("_parts/*.json"))) < 3 and process.poll() is None:
        time.sleep(0.01)
    process.send_signal(signal.SIGKILL)
    process.wait()
    before = parts(at / "killed")
    again = measured(command)
    after = parts(at / "killed")
    kept = all(after.get(path) == digest for path, digest in before.items())
    return {
        "parts_before": len({path.stem for path in before}),
        "parts": len({path.stem for path in after}),
        "kept_byte_for_byte": kept,
        "same_rows": rows(at / "killed") == rows(at / "whole"),
        "resumed_cpu_s": again["cpu_s"],
    }


def exponent(points: list[tuple[int, float]]) -> float:
    """Slope of the logarithms, least squares."""
    logs = [(math.log(count), math.log(cost)) for count, cost in points]
    mean = [sum(axis) / len(logs) for axis in zip(*logs)]
    above = sum((x - mean[0]) * (y - mean[1]) for x, y in logs)
    return above / sum((x - mean[0]) ** 2 for x, _ in logs)


def loop(program: str, at: Path, depth: str) -> dict[str, float]:
    """The same logs, one command after the other."""
    total: dict[str, float] = {}
    for log in sorted((at / "logs").iterdir()):
        command = [program, "fleet", "rows", log, "--vehicles", at / "vehicles.toml", "--depth", depth, "--json"]
        for name, value in measured(command).items():
            total[name] = max(total.get(name, 0.0), value) if name.endswith("mb") else total.get(name, 0.0) + value
    return total


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--program", default=str(ROOT / "target/release/mavid"))
    arguments.add_argument("--counts", default="10,100,1000")
    arguments.add_argument("--depth", default="explain", choices=["inspect", "balance", "explain"])
    arguments.add_argument("--shared", default=os.environ.get("MAVID_SHARED", str(ROOT.parent / "shared")))
    arguments.add_argument("--seed", type=int, default=1)
    given = arguments.parse_args()
    program = str(Path(given.program).resolve())
    folder = Path(tempfile.mkdtemp(prefix="mavid-scaling-"))
    try:
        found = bases(program, Path(given.shared), given.seed, folder)
        result: dict[str, object] = {"depth": given.depth, "cores": os.cpu_count(), "runs": {}}
        for count in map(int, given.counts.split(",")):
            at = folder / str(count)
            size = write_logs(found, count, given.seed, at)
            part_logs = max(2, count // 10)
            run = measured(fleet(program, at, "whole", given.depth, "--part-logs", part_logs))
            lines = [json.loads(line.split(" ", 1)[1]) for line in rows(at / "whole") if line.startswith("logs ")]
            states = {state: sum(log["status"] == state for log in lines) for state in ("flown", "no_flight", "error")}
            run |= {"bytes": size, "logs_per_s": count / run["wall_s"], "rows": len(rows(at / "whole")), **states}
            result["runs"][count] = run
            print(count, json.dumps(run), flush=True)
            if count == 100:
                result["loop"] = loop(program, at, given.depth)
                print("loop over 100", json.dumps(result["loop"]), flush=True)
                result["killed"] = killed_and_resumed(program, at, given.depth, part_logs)
                print("killed and resumed", json.dumps(result["killed"]), flush=True)
            shutil.rmtree(at)
        runs = result["runs"]
        for cost in ("cpu_s", "wall_s", "own_mb") if len(runs) > 1 else ():
            value = exponent([(count, run[cost]) for count, run in runs.items()])
            print(f"exponent of {cost}: {value:.3f}")
    finally:
        shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    sys.exit(main())
