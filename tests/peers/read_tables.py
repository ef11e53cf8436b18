"""Reads the tables of a fleet as DuckDB, Polars, pandas and PyArrow do, and an MCAP as its own library does.

The argument is a folder of tables, and a second one the MCAP. Prints one JSON document. Status 77: a package is missing.
"""

import json
import sys
from pathlib import Path

try:
    import duckdb
    import pandas
    import polars
    import pyarrow.parquet
    from mcap.reader import make_reader
except ImportError as error:
    print(f"read_tables.py: {error}", file=sys.stderr)
    sys.exit(77)

out = {}
folder, mcap = Path(sys.argv[1]), sys.argv[2]
for table in sorted(entry.name for entry in folder.iterdir() if entry.is_dir() and not entry.name.startswith("_")):
    pattern = str(folder / table / "*.parquet")
    parts = sorted((folder / table).glob("*.parquet"))
    schema = pyarrow.parquet.read_schema(parts[0])
    out[table] = {
        "duckdb": duckdb.sql(f"SELECT count(*) FROM '{pattern}'").fetchall()[0][0],
        "polars": polars.read_parquet(pattern).height,
        "pandas": int(sum(len(pandas.read_parquet(part)) for part in parts)),
        "columns": {field.name: (field.metadata or {}).get(b"unit", b"").decode() for field in schema},
        "version": schema.metadata[b"mavid.schema"].decode(),
    }
legs = str(folder / "legs" / "*.parquet")
out["mean_lean_x"] = duckdb.sql(f"SELECT avg(lean[1]) FROM '{legs}'").fetchall()[0][0]
topics = {}
with open(mcap, "rb") as file:
    for schema, channel, message in make_reader(file).iter_messages():
        json.loads(message.data)
        topics.setdefault(channel.topic, [schema.name, 0])[1] += 1
out["topics"] = topics
print(json.dumps(out))
