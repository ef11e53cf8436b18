"""The tables of a fleet, made by Ray Data on as many computers as a cluster has.

    python examples/fleet_ray.py s3://flights/2026 --out s3://tables --depth balance

`mavid.texts` is a pure function of a log's bytes and address. Ray reads the logs, gives each to it, does a part again whose computer is
lost, and writes the tables as Parquet: `mavid fleet report` and whatever reads Parquet read them. Every computer needs the wheel.
"""

from __future__ import annotations

import json
from typing import Any

import fleet_command
import mavid
import numpy as np
import pyarrow as pa
import pyarrow.fs
import pyarrow.parquet
import ray

COLUMNS = ("uri", "log", "table", "row")


def study(batch: dict[str, np.ndarray], options: dict[str, Any]) -> dict[str, np.ndarray]:
    """The rows of some logs: one row a row of any table, as JSON."""
    logs = zip(batch["path"], batch["bytes"])
    found = [row for uri, log in logs for row in mavid.texts(bytes(log), str(uri), **options)]
    return {name: np.array([row[name] for row in found], dtype=object) for name in COLUMNS}


def typed(batch: pa.Table, schema: pa.Schema) -> pa.Table:
    """The JSON of one table with the types of its columns."""
    return pa.Table.from_pylist([json.loads(row) for row in batch["row"].to_pylist()], schema)


def of_first(batch: pa.Table, table: str, first: dict[str, str]) -> pa.Table:
    """The rows of one table; of logs with the same bytes those of one."""
    each = zip(batch["table"].to_pylist(), batch["log"].to_pylist(), batch["uri"].to_pylist())
    return batch.filter(pa.array([own == table and first[log] == uri for own, log, uri in each], pa.bool_()))


def heads(batch: pa.Table) -> pa.Table:
    """Which logs have rows in which tables."""
    return batch.select(["table", "log", "uri"]).group_by(["table", "log", "uri"]).aggregate([])


def make(sources: list[str], out: str, parallel: int = 200, **options: Any) -> int:
    """Writes the tables of all logs below the sources into `out`; gives the number of logs."""
    logs = ray.data.read_binary_files(
        sources, include_paths=True, file_extensions=fleet_command.ENDINGS, override_num_blocks=parallel
    )
    # the dear part, done once: it stays in the cluster's memory, and on its disks
    found = logs.map_batches(study, batch_size=1, fn_kwargs={"options": options}, num_cpus=1).materialize()
    first: dict[str, str] = {}
    filled = set()
    for row in found.map_batches(heads, batch_format="pyarrow").iter_rows():
        first[row["log"]] = min(row["uri"], first.get(row["log"], row["uri"]))
        filled.add(row["table"])
    for table, schema in mavid.schema().items():
        if table in filled:
            own = found.map_batches(of_first, batch_format="pyarrow", fn_kwargs={"table": table, "first": first})
            own.map_batches(typed, batch_format="pyarrow", fn_kwargs={"schema": schema}).write_parquet(f"{out}/{table}")
        else:
            # a reader then knows the columns of a table without rows
            system, path = pyarrow.fs.FileSystem.from_uri(out) if "://" in out else (pyarrow.fs.LocalFileSystem(), out)
            system.create_dir(f"{path}/{table}")
            pa.parquet.write_table(schema.empty_table(), f"{path}/{table}/empty.parquet", filesystem=system)
    return len(first)


def main() -> None:
    given = fleet_command.given("Ray")
    ray.init()
    print(make(given.sources, given.out, depth=given.depth, vehicles=given.vehicles), "logs")


if __name__ == "__main__":
    main()
