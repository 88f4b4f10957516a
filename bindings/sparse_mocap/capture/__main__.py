# SPDX-License-Identifier: GPL-3.0-or-later
"""``python -m sparse_mocap.capture FOLDER``: the capture process.

FOLDER holds ``config.json`` and receives the logs. The process is started by a client, is detached
from the terminal and keeps running while it records, even if the client ends.
"""

from __future__ import annotations

import json
import os
import signal
import sys
from pathlib import Path
from types import FrameType

from ..files import remove_folder
from .config import CONFIG_NAME, CaptureConfig
from .recorder import Recorder
from .server import Server


def main(folder: Path) -> int:
    """Captures until no client is attached and nothing is recorded."""
    os.umask(0o077)  # what sensors measured is nobody else's
    config = CaptureConfig.from_json(json.loads((folder / CONFIG_NAME).read_text("utf-8")))
    recorder = Recorder(folder, config)
    server = Server(recorder)

    def end(_number: int, _frame: FrameType | None) -> None:
        server.must_end = True

    signal.signal(signal.SIGTERM, end)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # a terminal's Ctrl-C is for the client
    if hasattr(signal, "SIGHUP"):
        signal.signal(signal.SIGHUP, signal.SIG_IGN)
    recorder.start()
    try:
        server.run()
    finally:
        recorder.stop()
        if recorder.may_be_removed:
            _release_output()
            remove_folder(folder)
    return 0


def _release_output() -> None:
    """Closes the file in the folder that this process prints to, which Windows would not remove."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    for output in (1, 2):
        os.dup2(nowhere, output)
    os.close(nowhere)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
