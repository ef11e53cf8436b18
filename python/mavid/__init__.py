"""mavid from Python: runs the program and gives its JSON documents as dictionaries, arrays and tables.

    import mavid

    found = mavid.explain("flight.ulg", mass=2.0)
    print(found["answer"])
    mavid.parameters(found)          # a pandas table with standard errors
    mavid.streams("flight.ulg")      # NumPy arrays

Units are SI; the keys of a document are those of the book's chapter "JSON outputs".
"""

from ._fleet import rows, schema, texts
from ._program import MavidError, program, run
from ._results import Stream, effects, explain, identify, inspect, parameters, streams

__all__ = [
    "MavidError",
    "Stream",
    "effects",
    "explain",
    "identify",
    "inspect",
    "parameters",
    "program",
    "rows",
    "run",
    "schema",
    "streams",
    "texts",
]
