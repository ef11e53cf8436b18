"""Commands a vehicle with MAVSDK, as a program on a companion computer does.

    fly_with_mavsdk.py CONNECTION

Waits until the vehicle is healthy, sets parameters, stores a fence and reads it again, tries to store a mission, arms,
takes off in OFFBOARD by position setpoints, goes on by velocity and attitude setpoints, holds and lands.
Writes what it saw as JSON. Exit status 77 where MAVSDK is missing.
"""

import json
import os
import sys
import time

try:
    import mavsdk
    from mavsdk.plugins.action import Action
    from mavsdk.plugins.geofence import Circle, FenceType, Geofence, GeofenceData, Point, Polygon
    from mavsdk.plugins.info import Info
    from mavsdk.plugins.mission_raw import MissionItem, MissionRaw, MissionRawError
    from mavsdk.plugins.offboard import (
        Attitude, Offboard, OffboardError, PositionNedYaw, VelocityNedYaw)
    from mavsdk.plugins.param import Param
    from mavsdk.plugins.telemetry import FlightMode, LandedState, Telemetry
except (ImportError, OSError):
    sys.stderr.write("mavsdk is missing\n")
    sys.exit(77)

PATIENCE_S = 90.0
HEIGHT_M = 3.0


class Pilot:
    def __init__(self, connection):
        configuration = mavsdk.Configuration.create_with_component_type(mavsdk.ComponentType.GROUND_STATION)
        self.library = mavsdk.Mavsdk(configuration)
        result = self.library.add_any_connection(connection)
        if result != mavsdk.ConnectionResult.SUCCESS:
            raise SystemExit(f"{connection}: {result!r}")
        self.system = self.library.first_autopilot(20.0)
        if self.system is None:
            raise SystemExit("no vehicle came")
        self.telemetry = Telemetry(self.system)
        self.end = time.monotonic() + PATIENCE_S
        self.texts = []
        self.telemetry.subscribe_status_text(lambda text, _: self.texts.append(text.text))

    def until(self, condition, what):
        while not condition():
            if time.monotonic() > self.end:
                raise SystemExit(f"no progress, expected {what}: {self.telemetry.health()}, {self.texts}, "
                                 f"{self.telemetry.flight_mode()!r}, {self.place()}")
            time.sleep(0.05)

    def place(self):
        at = self.telemetry.position_velocity_ned().position
        return [at.north_m, at.east_m, at.down_m]

    def near(self, wanted):
        return all(abs(got - want) < 0.25 for got, want in zip(self.place(), wanted))


def main():
    # the library writes to standard output: that is for the answer alone
    answer = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    pilot = Pilot(sys.argv[1])
    telemetry, action = pilot.telemetry, Action(pilot.system)
    pilot.until(telemetry.health_all_ok, "a healthy vehicle")
    health = telemetry.health()
    info = Info(pilot.system)
    version = info.get_version()
    param = Param(pilot.system)
    param.set_param_float("MIS_TAKEOFF_ALT", HEIGHT_M)
    param.set_param_int("COM_OBL_RC_ACT", 4)
    every = param.get_all_params()
    hover = param.get_param_float("MPC_THR_HOVER")

    geofence = Geofence(pilot.system)
    home = telemetry.home()
    corners = [Point(home.latitude_deg + north, home.longitude_deg + east)
               for north, east in ((1e-3, 1e-3), (1e-3, -1e-3), (-1e-3, -1e-3), (-1e-3, 1e-3))]
    fence = GeofenceData([Polygon(corners, FenceType.INCLUSION)],
                         [Circle(Point(home.latitude_deg, home.longitude_deg), 60.0, FenceType.INCLUSION)])
    geofence.upload_geofence(fence)
    stored = geofence.download_geofence()
    try:
        waypoint = MissionItem(0, 6, 16, 1, 1, 0.0, 1.0, 0.0, 0.0, 474000000, 85000000, 5.0, 0)
        MissionRaw(pilot.system).upload_mission([waypoint])
        mission = "accepted"
    except MissionRawError as error:
        mission = error.result.name

    offboard = Offboard(pilot.system)
    try:
        offboard.start()
        early = "accepted"
    except OffboardError as error:
        early = error.result.name
    offboard.set_position_ned(PositionNedYaw(0.0, 0.0, -HEIGHT_M, 0.0))
    time.sleep(1.0)
    action.arm()
    offboard.start()
    pilot.until(lambda: telemetry.flight_mode() == FlightMode.OFFBOARD, "OFFBOARD")
    pilot.until(lambda: pilot.near([0.0, 0.0, -HEIGHT_M]), "the height")
    in_air = [telemetry.in_air(), telemetry.landed_state().name]
    offboard.set_position_ned(PositionNedYaw(1.5, 1.0, -HEIGHT_M, 90.0))
    pilot.until(lambda: pilot.near([1.5, 1.0, -HEIGHT_M]), "the place")
    pilot.until(lambda: abs(telemetry.attitude_euler().yaw_deg - 90.0) < 5.0, "the heading")
    there = pilot.place()
    offboard.set_velocity_ned(VelocityNedYaw(0.0, 1.0, 0.0, 90.0))
    pilot.until(lambda: pilot.place()[1] > 3.0, "a way to the east")
    # level with the thrust that carries the weight: it goes on, at its height
    offboard.set_attitude(Attitude(0.0, 0.0, 90.0, hover))
    time.sleep(1.0)
    drifted = pilot.place()
    offboard.stop()
    pilot.until(lambda: telemetry.flight_mode() == FlightMode.HOLD, "HOLD")
    action.land()
    pilot.until(lambda: not telemetry.armed() and telemetry.landed_state() == LandedState.ON_GROUND, "to stand")
    json.dump({
        "autopilot": pilot.system.autopilot_type().name,
        "version": [version.flight_sw_major, version.flight_sw_minor],
        "health": vars(health),
        "parameters": len(every.int_params) + len(every.float_params),
        "fence": [len(stored.polygons[0].points), stored.circles[0].radius],
        "mission": mission,
        "early": early,
        "in_air": in_air,
        "there": there,
        "drifted": drifted,
        "landed_at": pilot.place(),
        "texts": pilot.texts,
    }, answer)
    answer.close()
    pilot.library.destroy()


main()
