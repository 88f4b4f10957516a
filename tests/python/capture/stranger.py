# SPDX-License-Identifier: GPL-3.0-or-later
"""What another user may try against a capture: ADDRESS PID PATH...; prints what succeeded."""

import json
import os
import signal
import socket
import sys
import time
from contextlib import suppress

MESSAGES = (
    b'{"do": "stop"}',
    '{"do": "attach", "token": "é"}'.encode(),
    b'{"do": "attach", "token": "\\ud800"}',
    b"[" * 60_000,
    b"POST / HTTP/1.1\r\nHost: x\r\n\r\n",
    b"\xff",
)

address, pid, *paths = sys.argv[1:]
done = {"read": [], "written": [], "listed": [], "answers": 0, "connected": 0, "killed": False}


def connected() -> socket.socket:
    kind, _, where = address.partition(":")
    if kind == "unix":
        connection = socket.socket(socket.AF_UNIX)
        connection.connect(where)
    else:
        connection = socket.create_connection(("127.0.0.1", int(where)), 3.0)
    connection.settimeout(3.0)
    done["connected"] += 1
    return connection


for message in MESSAGES:
    with suppress(OSError), connected() as connection:
        connection.sendall(message + b"\n")
        done["answers"] += bool(connection.recv(100))
crowd = []
with suppress(OSError):
    while len(crowd) < 100:
        crowd.append(connected())
for path in paths:
    with suppress(OSError), open(path, "rb") as file:
        file.read(1)
        done["read"].append(path)
    with suppress(OSError), open(path, "ab"):
        done["written"].append(path)
    with suppress(OSError):
        os.unlink(path)
        done["written"].append(path)
    with suppress(OSError):
        os.listdir(path)
        done["listed"].append(path)
with suppress(OSError):
    os.kill(int(pid), signal.SIGKILL)
    done["killed"] = True
print(json.dumps(done), flush=True)
time.sleep(30.0)
