"""Three ArduCopters as pymavlink speaks: a whole session against `ground-station fly`.

    pip install pymavlink==2.4.50
    python vehicles_pymavlink.py 14550 &
    ground-station fly --connect udpin:127.0.0.1:14550 --way loiter-items

Prints what each vehicle holds when the ground station has read it back, and ends.
"""

import sys
import time

from pymavlink import mavutil

HOME = (42.0308, -93.6319)


class Vehicle:
    def __init__(self, system, port):
        self.link = mavutil.mavlink_connection(f"udpout:127.0.0.1:{port}", source_system=system, source_component=1)
        self.system, self.items, self.count, self.read = system, {}, None, False
        self.next = 0.0

    def step(self):
        now, mav = time.time(), self.link.mav
        if now > self.next:
            self.next = now + 0.2
            mav.heartbeat_send(2, 3, 1, 0, 3)
            mav.sys_status_send(0x10000000, 0, 0x10000000, 0, 12000, -1, 90, 0, 0, 0, 0, 0, 0)
            mav.local_position_ned_send(0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
            mav.global_position_int_send(0, int(HOME[0] * 1e7), int(HOME[1] * 1e7), 290000, 0, 0, 0, 0, 0)
        while True:
            message = self.link.recv_match(blocking=False)
            if message is None:
                return
            self.take(message)

    def take(self, message):
        mav, kind = self.link.mav, message.get_type()
        # A ground station may send everything to everyone.
        if getattr(message, "target_system", self.system) not in (0, self.system):
            return
        self.station = (message.get_srcSystem(), message.get_srcComponent())
        if kind == "COMMAND_LONG":
            mav.command_ack_send(message.command, 0)
            if message.command == 512:
                mav.home_position_send(0, 0, 0, 0, 0, 0, [1, 0, 0, 0], 0, 0, 0)
        elif kind == "MISSION_COUNT":
            self.count, self.items = message.count, {}
            mav.mission_request_int_send(*self.station, 0)
        elif kind == "MISSION_ITEM_INT" and self.count is not None:
            self.items[message.seq] = message
            if len(self.items) < self.count:
                mav.mission_request_int_send(*self.station, len(self.items))
            else:
                mav.mission_ack_send(*self.station, 0)
        elif kind == "MISSION_REQUEST_LIST":
            mav.mission_count_send(*self.station, len(self.items))
        elif kind == "MISSION_REQUEST_INT":
            i = self.items[message.seq]
            radius = float(int(i.param3)) if i.command == 18 else i.param3
            mav.mission_item_int_send(*self.station, i.seq, i.frame, i.command, 0, 1, i.param1, i.param2, radius, i.param4, i.x, i.y, i.z)
        elif kind == "MISSION_ACK":
            self.read = True


def main():
    vehicles = [Vehicle(system, int(sys.argv[1])) for system in (1, 2, 3)]
    end, linger = time.time() + 60, time.time() + 60
    # Whoever has read a mission back may ask again, so the vehicles stay for another second.
    while time.time() < min(end, linger):
        for vehicle in vehicles:
            vehicle.step()
        if all(vehicle.read for vehicle in vehicles):
            linger = min(linger, time.time() + 1.0)
        time.sleep(0.01)
    for vehicle in vehicles:
        commands = [vehicle.items[number].command for number in sorted(vehicle.items)]
        print(f"vehicle {vehicle.system}: {len(commands)} items, commands {commands}, read back: {vehicle.read}")
    sys.exit(0 if all(vehicle.read for vehicle in vehicles) else 1)


main()
