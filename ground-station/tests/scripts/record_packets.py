"""Prints packets as pymavlink writes them: name, then hexadecimal. Made tests/data/pymavlink_packets.txt.

Needs: pip install pymavlink==2.4.50
"""

from pymavlink.dialects.v20 import common as mavlink


def main():
    class Sink:
        def write(self, _):
            pass

    for component in (1, 190):
        link = mavlink.MAVLink(Sink(), srcSystem=7, srcComponent=component)
        messages = [
            link.heartbeat_encode(2, 3, 129, 4, 4),
            link.sys_status_encode(0x10000000, 0, 0x10000000, 0, 12000, -1, 87, 0, 0, 0, 0, 0, 0),
            link.local_position_ned_encode(1234, 1.5, -2.5, -3.25, 0.5, 0.25, -0.125),
            link.global_position_int_encode(1234, 420308000, -936319000, 290000, 2000, 10, -20, 30, 9000),
            link.mission_request_encode(255, 190, 3),
            link.mission_current_encode(4),
            link.mission_request_list_encode(7, 1),
            link.mission_count_encode(7, 1, 12),
            link.mission_ack_encode(255, 190, 0),
            link.mission_request_int_encode(255, 190, 5),
            link.mission_item_int_encode(7, 1, 5, 6, 18, 0, 1, 1.0, 0.0, -3.0, 0.5, 420308123, -936319456, 2.0),
            link.command_long_encode(7, 1, 400, 0, 1, 0, 0, 0, 0, 0, 0),
            link.command_ack_encode(400, 0),
            link.set_position_target_local_ned_encode(
                99, 7, 1, 1, 2048, 1.0, 2.0, -3.0, 0.1, 0.2, -0.3, 1.1, 1.2, -1.3, 0.75, 0.0
            ),
            link.home_position_encode(420308000, -936319000, 290000, 0, 0, 0, [1, 0, 0, 0], 0, 0, 0),
            link.statustext_encode(4, b"PreArm: check"),
        ]
        for message in messages:
            print(message.get_type(), message.pack(link).hex())


main()
