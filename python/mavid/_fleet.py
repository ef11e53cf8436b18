"""Rows of the tables of a fleet, one log at a time: what engines that spread logs over computers call for each."""

from __future__ import annotations

import json
import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any, Union

from ._program import run
from ._results import Log, _given

if TYPE_CHECKING:
    import pyarrow as pa

Rows = dict[str, list[dict[str, Any]]]


def rows(log: Union[Log, bytes], uri: str | None = None, **options: Any) -> Rows:
    """The rows of a log by the names of their tables: a pure function of its bytes, its `uri` and the options.

    `log` is a path, or the bytes themselves; these need a `uri`. The options are those of `mavid fleet` for one log: `depth="balance"`,
    `vehicles="vehicles.toml"`, `log_time=60`. A log that cannot be read is a row in `logs` with the reason, and no exception.
    """
    if not isinstance(log, bytes):
        return run("fleet", "rows", log, *_given({"uri": uri, **options}))
    if uri is None:
        raise ValueError("expected a uri: bytes have no name")
    # a drafted vehicle is called as its log is
    name = uri.rsplit("/", 1)[-1].replace("\0", "")[-200:]
    if name in ("", ".", ".."):
        name = "log"
    with tempfile.TemporaryDirectory(prefix="mavid-") as folder:
        path = Path(folder) / name
        path.write_bytes(log)
        return run("fleet", "rows", path, *_given({"uri": uri, **options}))


def texts(log: Union[Log, bytes], uri: str, **options: Any) -> list[dict[str, str]]:
    """The rows of a log as rows of one table of texts: `uri`, `log` (its hash), `table` and `row` (JSON).

    One function can then give all tables at once, under Ray, Spark and their like; `schema` says how to read `row`.
    """
    found = rows(log, uri, **options)
    name = found["logs"][0]["log"]
    return [
        {"uri": uri, "log": name, "table": table, "row": json.dumps(row)}
        for table, own in found.items()
        for row in own
    ]


_KINDS = {
    "text": lambda pa: pa.string(),
    "number": lambda pa: pa.float64(),
    "whole": lambda pa: pa.int64(),
    "truth": lambda pa: pa.bool_(),
    "numbers": lambda pa: pa.list_(pa.field("item", pa.float64())),
}


def schema(**options: Any) -> dict[str, pa.Schema]:
    """The tables with the types of their columns, for pyarrow; unit and meaning are in the metadata of each field."""
    import pyarrow as pa

    document = run("fleet", "schema", *_given(options))
    version = {"mavid.schema": str(document["schema"])}

    def field(column: dict[str, Any]) -> pa.Field:
        words = {"unit": column["unit"], "meaning": column["words"]}
        return pa.field(column["name"], _KINDS[column["kind"]](pa), column["may_be_empty"], words)

    return {
        table["name"]: pa.schema([field(column) for column in table["columns"]], version)
        for table in document["tables"]
    }
