"""pymavlink with MAVLink 2 and the dialect of all scripts here. Ends with exit status 77 where it is missing."""

import os
import sys

os.environ["MAVLINK20"] = "1"
os.environ.setdefault("MAVLINK_DIALECT", "ardupilotmega")
try:
    from pymavlink import mavutil
except ImportError:
    sys.stderr.write("pymavlink is missing\n")
    sys.exit(77)

__all__ = ["mavutil"]
