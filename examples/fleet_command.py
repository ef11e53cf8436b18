"""The command line of `fleet_ray.py` and `fleet_spark.py`, and which files are logs."""

from __future__ import annotations

import argparse

#: files that are logs end so
ENDINGS = ["tlog", "ulg", "bin", "log", "csv", "BIN", "LOG", "ULG", "TLOG", "CSV"]


def given(engine: str) -> argparse.Namespace:
    """What was asked for: `sources`, `out`, `depth`, `vehicles`."""
    arguments = argparse.ArgumentParser(description=f"The tables of a fleet, made by {engine}.")
    arguments.add_argument("sources", nargs="+", help=f"folders or files, as {engine} reads them")
    arguments.add_argument("--out", required=True)
    arguments.add_argument("--depth", choices=["inspect", "balance", "explain"], default="explain")
    arguments.add_argument("--vehicles", help="as of mavid fleet; every computer reads it at this path")
    return arguments.parse_args()
