"""The Python module of the wheel, called as a notebook calls it: {program, module, log, vehicle} in, what it gave out."""

import json
import os
import sys

given = json.load(sys.stdin)
os.environ["MAVID"] = given["program"]
sys.path.insert(0, given["module"])
try:
    import numpy
    import pandas
except ImportError as missing:
    print(missing, file=sys.stderr)
    sys.exit(77)
import mavid

found = mavid.explain(given["log"], vehicle=given["vehicle"])
table = mavid.parameters(found)
streams = mavid.streams(given["log"])
rates = next(stream for name, stream in streams.items() if name.startswith("angular_rate"))
try:
    mavid.explain("no-such-file.ulg", mass=1.0)
    refusal = None
except mavid.MavidError as error:
    refusal = [error.status, str(error)]
identified = mavid.parameters(mavid.identify(given["log"], vehicle=given["vehicle"], with_=["linear_drag", "motor_lag"]))
assert {"body", "linear_drag", "motor_lag"} == set(identified.index.get_level_values("of"))
try:
    mavid.run("completions", "bash")
    raise SystemExit("expected a refusal of what is no document")
except mavid.MavidError as error:
    assert "expected a JSON document" in str(error), error
assert isinstance(table, pandas.DataFrame) and isinstance(rates.values, numpy.ndarray)
print(
    json.dumps(
        {
            "verdict": found["verdict"],
            "mass": table.loc[("body", "mass"), "value"],
            "mass_std": table.loc[("body", "mass"), "std"],
            "rows": len(table),
            "rates": list(rates.values.shape),
            "times": len(rates.time_s),
            "columns": rates.columns,
            "effects": len(mavid.effects()),
            "refusal": refusal,
        }
    )
)
