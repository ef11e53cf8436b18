"""The tables of a fleet, made by Spark: the function of `fleet_ray.py` under `mapInPandas`.

    spark-submit examples/fleet_spark.py s3a://flights/2026 --out s3a://tables --depth balance

Spark gives each log to `mavid.texts`, a pure function of its bytes and address, and writes the tables as Parquet. Every computer needs
the wheel, and Java.
"""

from __future__ import annotations

from typing import Any, Iterator

import fleet_command
import mavid
import pandas as pd
from pyspark.sql import DataFrame, SparkSession
from pyspark.sql import functions as f
from pyspark.sql.pandas.types import from_arrow_schema


def empty_logs(spark: SparkSession, sources: list[str]) -> DataFrame:
    """Logs without a byte. Spark leaves empty files out of what it reads, and they are rows as well."""
    context = spark.sparkContext
    found = []
    for source in sources:
        path = context._jvm.org.apache.hadoop.fs.Path(source)
        system = path.getFileSystem(context._jsc.hadoopConfiguration())
        for status in system.globStatus(path) or []:
            files = system.listFiles(status.getPath(), True)
            while files.hasNext():
                file = files.next()
                name = file.getPath().toString()
                if file.getLen() == 0 and name.rsplit(".", 1)[-1] in fleet_command.ENDINGS:
                    found.append((name, bytearray()))
    return spark.createDataFrame(found, "path string, content binary")


def make(spark: SparkSession, sources: list[str], out: str, **options: Any) -> int:
    """Writes the tables of all logs below the sources into `out`; gives the number of logs."""

    def study(batches: Iterator[pd.DataFrame]) -> Iterator[pd.DataFrame]:
        for batch in batches:
            for path, log in zip(batch["path"], batch["content"]):
                # as paths of a computer are called elsewhere
                uri = path.removeprefix("file:")
                yield pd.DataFrame(mavid.texts(bytes(log), uri, **options))

    endings = ",".join(fleet_command.ENDINGS)
    files = spark.read.format("binaryFile").option("pathGlobFilter", f"*.{{{endings}}}")
    logs = files.option("recursiveFileLookup", "true").load(sources).select("path", "content")
    logs = logs.unionAll(empty_logs(spark, sources))
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
    given = fleet_command.given("Spark")
    spark = SparkSession.builder.appName("mavid fleet").getOrCreate()
    print(make(spark, given.sources, given.out, depth=given.depth, vehicles=given.vehicles), "logs")


if __name__ == "__main__":
    main()
