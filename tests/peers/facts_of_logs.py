"""What logs say of their vehicles, by pymavlink and pyulog: kind, seconds armed, seconds in the air, one line of JSON a file.

    facts_of_logs.py LOG...

Armed is what the autopilot says: HEARTBEAT, vehicle_status, EV, ARM or STAT. In the air is what it says of landing where it
does, and else height above half a metre while armed. Times are the vehicle's. `null`: the log does not say, or has no clock.
Exit status 77 where a package is missing.
"""

import json
import os
import sys

try:
    from pymavlink import DFReader, mavutil
    from pyulog import ULog
except ImportError as missing:
    sys.stderr.write(f"{missing}\n")
    sys.exit(77)

SAFETY_ARMED = 128
ARMING_STATE_ARMED = 2
AUTOPILOTS = (3, 12)
# numbers of EV
ARMED, DISARMED, LANDED, NOT_LANDED = 10, 11, 18, 28


class Spans:
    """Seconds during which a state holds; before its first word the contrary held if the word is of a change."""

    def __init__(self):
        self.total, self.since, self.said = 0.0, None, False

    def say(self, time, holds, began=None):
        if not self.said and not holds and began is not None:
            self.total += time - began
        self.said = True
        if holds and self.since is None:
            self.since = time
        if not holds and self.since is not None:
            self.total += time - self.since
            self.since = None

    def seconds(self, end):
        if not self.said:
            return None
        return round(self.total + (end - self.since if self.since is not None else 0.0), 1)


def ulog(path):
    log = ULog(path)

    def spans(topic, field, holds):
        found = [d.data for d in log.data_list if d.name == topic and d.multi_id == 0 and field in d.data]
        if not found:
            return None
        out, end = Spans(), log.last_timestamp * 1e-6
        for time, value in zip(found[0]["timestamp"], found[0][field]):
            out.say(time * 1e-6, holds(value))
        return out.seconds(end)

    words = log.msg_info_dict
    return {
        "software": f"{words.get('sys_name')} on {words.get('ver_hw')}",
        "mav_type": log.initial_parameters.get("MAV_TYPE"),
        "armed_s": spans("vehicle_status", "arming_state", lambda state: state == ARMING_STATE_ARMED),
        "airborne_s": spans("vehicle_land_detected", "landed", lambda landed: not landed),
    }


def dataflash(path):
    reader = DFReader.DFReader_text if path.endswith(".log") else DFReader.DFReader_binary
    log = reader(path)
    armed, airborne, high = Spans(), Spans(), Spans()
    now = began = None
    software, parameters = None, {}
    while (message := log.recv_msg()) is not None:
        name, fields = message.get_type(), message.to_dict()
        stamp = fields["TimeUS"] * 1e-6 if "TimeUS" in fields else fields.get("TimeMS", 0) * 1e-3
        if name == "GPS" and "TimeMS" in fields:
            stamp = fields.get("T", 0) * 1e-3
        now = stamp or now
        if name not in ("PARM", "FMT", "MSG", "UNIT", "MULT", "FMTU") and now is not None:
            began = now if began is None else began
        if name == "MSG" and software is None and fields["Message"].startswith(("Ardu", "APM")):
            software = fields["Message"]
        elif name == "PARM":
            parameters[fields["Name"]] = fields["Value"]
        elif now is None:
            continue
        elif name == "EV" and fields["Id"] in (ARMED, DISARMED):
            armed.say(now, fields["Id"] == ARMED, began)
        elif name == "ARM":
            armed.say(now, bool(fields["ArmState"]), began)
        elif name == "STAT" and "Armed" in fields:
            armed.say(now, bool(fields["Armed"]))
            airborne.say(now, bool(fields["isFlying"]))
        elif name == "EV" and fields["Id"] in (LANDED, NOT_LANDED):
            airborne.say(now, fields["Id"] == NOT_LANDED, began)
        if name == "CTUN" and "BAlt" in fields and now is not None:
            high.say(now, fields["BAlt"] > 0.5 and (armed.since is not None))
    wanted = ("FRAME", "FRAME_CLASS", "H_SV_MAN", "Q_ENABLE")
    return {
        "software": software,
        "parameters": {name: parameters[name] for name in wanted if name in parameters},
        "armed_s": armed.seconds(now) if now is not None else None,
        "airborne_s": (airborne.seconds(now) or (high.seconds(now) if not airborne.said else 0.0)) if now is not None else None,
    }


def tlog(path):
    link = mavutil.mavlink_connection(path, dialect="ardupilotmega")
    systems = {}
    while (message := link.recv_match()) is not None:
        if message.get_type() == "BAD_DATA":
            continue
        one = systems.setdefault(
            (message.get_srcSystem(), message.get_srcComponent()),
            {"armed": Spans(), "airborne": Spans(), "boot": None, "beats": 0, "mav_type": None, "software": None},
        )
        name, fields = message.get_type(), message.to_dict()
        if fields.get("time_boot_ms"):
            one["boot"] = fields["time_boot_ms"] * 1e-3
        now = one["boot"]
        if name == "HEARTBEAT" and fields["autopilot"] in AUTOPILOTS:
            one["beats"] += 1
            one["mav_type"] = fields["type"]
            if now is not None:
                one["armed"].say(now, bool(fields["base_mode"] & SAFETY_ARMED))
        elif name == "STATUSTEXT" and fields["text"].startswith("Ardu") and one["software"] is None:
            one["software"] = fields["text"]
        elif name == "GLOBAL_POSITION_INT":
            one["airborne"].say(now, fields["relative_alt"] > 500 and one["armed"].since is not None)
    return {
        f"{system}/{component}": {
            "software": one["software"],
            "mav_type": one["mav_type"],
            "armed_s": one["armed"].seconds(one["boot"]),
            "airborne_s": one["airborne"].seconds(one["boot"]),
        }
        for (system, component), one in systems.items()
        if one["beats"]
    }


def main(paths):
    for path in paths:
        read = {".ulg": ulog, ".tlog": tlog}.get(os.path.splitext(path)[1], dataflash)
        try:
            facts = read(path)
        except Exception as refusal:  # what a reader cannot open is a fact of that file, too
            facts = {"refused": f"{type(refusal).__name__}: {refusal}"}
        print(json.dumps({"file": os.path.basename(path), **facts}))


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(sys.argv[1:])
