"""The tables of a fleet by Ray and by Spark, against those of `mavid fleet`, row by row: `fleet_on_engines.py PROGRAM FOLDER`.

Ray runs on a cluster of two nodes on this computer, of which one is killed on the way. FOLDER is for what is written. Exit status 77:
an engine is not here.
"""

from __future__ import annotations

import json
import os
import shutil
import stat
import subprocess
import sys
import threading
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SKIPPED = 77
#: as many logs as make two nodes work for a while
COPIES = 12
OPTIONS = {"depth": "balance", "mass": 2.06, "size": 0.5, "frame": "quadrotor-x"}


def logs(folder: Path) -> Path:
    """Logs of the fixtures: some cut, so that each is another, some damaged, and twins."""
    at = folder / "logs"
    (at / "deep").mkdir(parents=True)
    fixtures = ROOT / "fixtures"
    for copy in range(COPIES):
        whole = (fixtures / "px4_flight.ulg").read_bytes()
        (at / f"a{copy:02}.ulg").write_bytes(whole[: len(whole) - 512 * copy])
        whole = (fixtures / "p01_identify_0_25s.tlog").read_bytes()
        (at / "deep" / f"b{copy:02}.tlog").write_bytes(whole[: len(whole) - 64 * copy])
    (at / "words.bin").write_bytes(b"this is no log at all\n" * 50)
    (at / "empty.tlog").write_bytes(b"")
    (at / "twin.ulg").write_bytes((at / "a01.ulg").read_bytes())
    return at


def rows(folder: Path) -> dict[str, list[str]]:
    """All rows of all tables, sorted: numbers to the last bit."""
    import pyarrow.parquet as pq

    found = {}
    for table in sorted(path.name for path in folder.iterdir() if path.is_dir() and not path.name.startswith("_")):
        own = []
        for part in sorted((folder / table).glob("*.parquet")):
            own += pq.ParquetFile(part).read().to_pylist()
        for part in sorted((folder / table).glob("*.jsonl")):
            own += [json.loads(line) for line in part.read_text().splitlines()]
        found[table] = sorted(json.dumps(row, sort_keys=True) for row in own)
    return found


def same(expected: dict[str, list[str]], found: dict[str, list[str]], engine: str) -> None:
    assert expected.keys() == found.keys(), (engine, expected.keys(), found.keys())
    for table, own in expected.items():
        for one, other in zip(own, found[table]):
            assert one == other, f"{engine}, {table}:\n{one}\n{other}"
        assert len(own) == len(found[table]), (engine, table, len(own), len(found[table]))
    print(f"{engine}: {sum(map(len, found.values()))} rows of {len(found['logs'])} logs, equal to those of mavid fleet")


def counted(program: str, folder: Path) -> Path:
    """A program that is called like the other, and leaves a line for each call: so it shows how far the work is."""
    script = folder / "mavid"
    script.write_text(f'#!/bin/sh\n[ "$2" = rows ] && echo "$3" >>"{folder}/calls"\nexec "{program}" "$@"\n')
    script.chmod(script.stat().st_mode | stat.S_IXUSR)
    (folder / "calls").touch()
    return script


def calls(folder: Path) -> int:
    return len((folder / "calls").read_text().splitlines())


def on_ray(at: Path, folder: Path) -> dict[str, list[str]]:
    import ray
    import ray.data
    from ray.cluster_utils import Cluster

    import fleet_ray

    # each reads and studies at once
    node = {"num_cpus": 2, "object_store_memory": 400 << 20}
    cluster = Cluster(initialize_head=True, head_node_args=node)
    second = cluster.add_node(**node)
    cluster.wait_for_nodes()
    ray.init(address=cluster.address, log_to_driver=False, logging_level="ERROR")
    ray.data.DataContext.get_current().enable_progress_bars = False
    total = len([path for path in at.rglob("*") if path.is_file()])

    def kill() -> None:
        while calls(folder) < total // 2:
            time.sleep(0.02)
        cluster.remove_node(second, allow_graceful=False)
        print(f"ray: a node was killed after {calls(folder)} of {total} logs")

    killer = threading.Thread(target=kill)
    killer.start()
    try:
        out = folder / "ray"
        fleet_ray.make([str(at)], str(out), parallel=total, **OPTIONS)
        killer.join()
        assert len([node for node in ray.nodes() if node["Alive"]]) == 1
        print(f"ray: {calls(folder)} logs were studied, of {total}: some again, as their node was lost")
        return rows(out)
    finally:
        ray.shutdown()
        cluster.shutdown()


def on_spark(at: Path, folder: Path) -> dict[str, list[str]]:
    from pyspark.sql import SparkSession

    import fleet_spark

    builder = SparkSession.builder.master("local[2]").config("spark.ui.enabled", "false")
    spark = builder.config("spark.sql.shuffle.partitions", "2").getOrCreate()
    spark.sparkContext.setLogLevel("ERROR")
    try:
        out = folder / "spark"
        fleet_spark.make(spark, [str(at)], str(out), **OPTIONS)
        return rows(out)
    finally:
        spark.stop()


def main() -> int:
    program, folder = sys.argv[1], Path(sys.argv[2]).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    at = logs(folder)
    local = folder / "local"
    options = [word for name, value in OPTIONS.items() for word in (f"--{name}", str(value))]
    command = [program, "fleet", str(at), "--out", str(local), *options, "--quiet"]
    assert subprocess.run(command, check=False).returncode == 3, "expected logs that cannot be read among the others"
    expected = rows(local)
    assert len(expected["logs"]) == 2 * COPIES + 2, len(expected["logs"])
    os.environ["MAVID"] = str(counted(program, folder))
    paths = [str(ROOT / "python"), str(ROOT / "examples")]
    sys.path[:0] = paths
    os.environ["PYTHONPATH"] = os.pathsep.join(paths)
    os.environ["PYSPARK_PYTHON"] = sys.executable
    skipped = []
    for engine, make, needed in [("ray", on_ray, "ray"), ("spark", on_spark, "pyspark")]:
        try:
            __import__(needed)
        except ImportError as error:
            skipped.append(f"{engine}: skipped, {error}")
            continue
        if engine == "spark" and shutil.which("java") is None and not os.environ.get("JAVA_HOME"):
            skipped.append("spark: skipped, there is no Java (on Debian: apt install default-jre-headless)")
            continue
        same(expected, make(at, folder), engine)
    print("\n".join(skipped))
    return SKIPPED if skipped else 0


if __name__ == "__main__":
    sys.exit(main())
