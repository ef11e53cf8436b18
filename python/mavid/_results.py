"""The verbs that notebooks need, and their documents as arrays and tables."""

from __future__ import annotations

import csv
import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, Union

from ._program import Word, run

if TYPE_CHECKING:
    import numpy as np
    import pandas as pd

Log = Union[str, "os.PathLike[str]"]


def _given(options: dict[str, Any]) -> list[Word]:
    """`mass=2.0, set_logging=True` is `--mass 2.0 --set-logging`, `with_=["inflow", "tether"]` is `--with inflow --with tether`; None is nothing."""
    words: list[Word] = []
    for name, value in options.items():
        if value is None or value is False:
            continue
        # a word that Python keeps for itself ends with an underscore
        option = "--" + name.rstrip("_").replace("_", "-")
        if isinstance(value, (list, tuple)):
            words.extend(word for one in value for word in (option, one))
        else:
            words.extend([option] if value is True else [option, value])
    return words


def explain(*logs: Log, mass: float | None = None, vehicle: Log | None = None, **options: Any) -> dict[str, Any]:
    """What `mavid explain LOG...` finds: mass in kg, or a vehicle file; other options as keywords (`size=0.5`, `out="folder"`)."""
    return run("explain", *logs, *_given({"mass": mass, "vehicle": vehicle, **options}))


def identify(*logs: Log, mass: float | None = None, vehicle: Log | None = None, **options: Any) -> dict[str, Any]:
    """What `mavid identify LOG...` estimates; arguments as of `explain`, and effects by `with_=["linear_drag", "motor_lag"]`."""
    return run("identify", *logs, *_given({"mass": mass, "vehicle": vehicle, **options}))


def inspect(log: Log, **options: Any) -> dict[str, Any]:
    """What is in a log and what can be identified from it."""
    return run("inspect", log, *_given(options))


def effects(name: str | None = None, **options: Any) -> list[dict[str, Any]]:
    """What the program knows of its effects, or of one."""
    found: list[dict[str, Any]] = run("effects", *([name] if name else []), *_given(options))["effects"]
    return found


def parameters(found: dict[str, Any]) -> pd.DataFrame:
    """Mass, inertia and the effects of what `explain` or `identify` found (of its best method), one row a parameter: of, value, std, unit."""
    import pandas as pd

    if found.get("best"):
        of_body, effects = found["best"]["parameters"], found.get("with", {}).get("effects", [])
    elif "effects" in found:
        of_body, effects = found["parameters"], found["effects"]
    else:
        raise ValueError(f"expected what explain or identify found, got a document of {', '.join(map(repr, found)) or 'nothing'}")
    body = [{"of": "body", "name": name, **row} for name, row in of_body.items()]
    named = [{"of": effect["id"], **row} for effect in effects for row in effect["parameters"]]
    return pd.DataFrame(body + named, columns=["of", "name", "value", "std", "unit"]).set_index(["of", "name"])


class Stream(NamedTuple):
    """Samples of one quantity on the vehicle's clock, SI, body forward-left-up, world north-west-up."""

    time_s: np.ndarray
    #: one row a sample, one column a value
    values: np.ndarray
    columns: tuple[str, ...]


def streams(log: Log, **options: Any) -> dict[str, Stream]:
    """The streams of a log by their names, as `mavid convert --to csv` writes them. NaN is an unknown value."""
    import numpy as np

    found: dict[str, Stream] = {}
    with tempfile.TemporaryDirectory(prefix="mavid-") as folder:
        document = run("convert", log, "--to", "csv", "--out", folder, *_given(options))
        for name in document["files"]:
            path = Path(folder) / name
            if path.suffix != ".csv":
                continue
            with path.open(newline="") as table:
                head = next(csv.reader(table))
                rows = np.genfromtxt(table, delimiter=",", ndmin=2)
            found[path.stem] = Stream(rows[:, 0], rows[:, 1:], tuple(head[1:]))
    return found
