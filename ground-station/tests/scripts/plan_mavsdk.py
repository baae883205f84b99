"""Imports a `.plan` with MAVSDK, uploads it to a vehicle, downloads it again and compares.

    pip install mavsdk==4.1.0 pymavlink==2.4.50
    python vehicles_pymavlink.py 14550 &
    python plan_mavsdk.py 14550 out/vehicle-1.plan
"""

import json
import sys

from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.mission_raw import MissionRaw


def main(port, path):
    mavsdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
    mavsdk.add_any_connection(f"udpin://127.0.0.1:{port}")
    mission = MissionRaw(mavsdk.first_autopilot(20.0))
    items = mission.import_qgroundcontrol_mission(path).mission_items
    with open(path) as file:
        ours = json.load(file)["mission"]["items"]
    print(f"imported {len(items)} items of {len(ours)} (home is put first for ArduPilot)")
    assert [item.command for item in items[-len(ours):]] == [item["command"] for item in ours]
    mission.upload_mission(items)
    back = mission.download_mission()
    assert [(i.command, i.x, i.y, i.z) for i in back] == [(i.command, i.x, i.y, i.z) for i in items]
    print(f"uploaded and read back {len(back)} items")


main(sys.argv[1], sys.argv[2])
