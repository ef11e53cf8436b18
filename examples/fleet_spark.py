"""The tables of a fleet, made by Spark: the function of `fleet_ray.py` under `mapInPandas`.

    spark-submit examples/fleet_spark.py s3a://flights/2026 --out s3a://tables --depth balance

Spark gives each log to `mavid.texts`, a pure function of its bytes and address, and writes the tables as Parquet. Every computer needs
the wheel, and Java.
"""

from __future__ import annotations

import argparse
from typing import Any, Iterator

import mavid
import pandas as pd
from pyspark.sql import DataFrame, SparkSession
from pyspark.sql import functions as f
from pyspark.sql.pandas.types import from_arrow_schema

#: files that are logs
ENDINGS = "*.{tlog,ulg,bin,log,csv,BIN,LOG,ULG,TLOG,CSV}"


def make(spark: SparkSession, sources: list[str], out: str, **options: Any) -> int:
    """Writes the tables of all logs below the sources into `out`; gives the number of logs."""

    def study(batches: Iterator[pd.DataFrame]) -> Iterator[pd.DataFrame]:
        for batch in batches:
            for path, log in zip(batch["path"], batch["content"]):
                # as paths of a computer are called elsewhere
                uri = path.removeprefix("file:")
                yield pd.DataFrame(mavid.texts(bytes(log), uri, **options))

    files = spark.read.format("binaryFile").option("pathGlobFilter", ENDINGS).option("recursiveFileLookup", "true")
    logs = files.load(sources).select("path", "content")
    found: DataFrame = logs.mapInPandas(study, "uri string, log string, table string, row string").persist()
    # of logs with the same bytes, the rows of one
    first = found.where("table = 'logs'").groupBy("log").agg(f.min("uri").alias("uri"))
    own = found.join(f.broadcast(first), ["log", "uri"])
    for table, schema in mavid.schema().items():
        rows = own.where(f.col("table") == table).select(f.from_json("row", from_arrow_schema(schema)).alias("row"))
        rows.select("row.*").write.mode("overwrite").parquet(f"{out}/{table}")
    count: int = first.count()
    found.unpersist()
    return count


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("sources", nargs="+", help="folders or files, as Spark reads them")
    arguments.add_argument("--out", required=True)
    arguments.add_argument("--depth", choices=["inspect", "balance", "explain"], default="explain")
    arguments.add_argument("--vehicles", help="as of mavid fleet; every computer reads it at this path")
    given = arguments.parse_args()
    spark = SparkSession.builder.appName("mavid fleet").getOrCreate()
    print(make(spark, given.sources, given.out, depth=given.depth, vehicles=given.vehicles), "logs")


if __name__ == "__main__":
    main()
