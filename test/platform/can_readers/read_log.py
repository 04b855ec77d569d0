"""What python-can reads in a log, a line a frame as our parser would say it: STAMP ID FD BRS DATA.

read_log.py can.log | can.asc
"""
import sys

import can

reader = can.ASCReader if sys.argv[1].endswith(".asc") else can.CanutilsLogReader
for message in reader(sys.argv[1]):
    print(
        f"{message.timestamp:.6f} {message.arbitration_id:X} {message.is_fd:d} "
        f"{message.bitrate_switch:d} {bytes(message.data).hex().upper()}"
    )
