# SPDX-License-Identifier: GPL-3.0-or-later
"""``python -m release_files.tested``: notes in the report which modules the test suites ran on."""

import argparse
import json
import re
import sys
from pathlib import Path
from typing import Any

from .errors import PackagingError

LOADED = re.compile(r"^Compiled module: (\S+) ([0-9a-f]{64})$", re.MULTILINE)


def note_tests(report: dict[str, Any], logs: dict[str, str]) -> None:
    """Add to each module of the report the suites that had loaded just it.

    ``logs`` are the outputs of suites that passed, by the suites' names. PackagingError when one
    had loaded a module that is not in the report.
    """
    modules = {(module["name"], module["sha256"]): module for module in report["modules"]}
    for module in report["modules"]:
        module.setdefault("tested_by", [])
    for suite, log in logs.items():
        found = LOADED.findall(log)
        if not found:
            raise PackagingError(f"{suite} does not say which compiled module it had loaded")
        for name, sha256 in found:
            if (name, sha256) not in modules:
                raise PackagingError(f"{suite} ran on another {name} than is handed out")
            suites = modules[name, sha256]["tested_by"]
            suites += [suite] if suite not in suites else []


def main() -> int:
    """Note the suites in report.json; 1 when one ran on another module."""
    parser = argparse.ArgumentParser(prog="release_files.tested", description=__doc__)
    parser.add_argument("report", type=Path)
    parser.add_argument("logs", nargs="*", metavar="SUITE=LOG")
    options = parser.parse_args()
    report = json.loads(options.report.read_text("utf-8"))
    logs = dict(log.rsplit("=", 1) for log in options.logs)
    try:
        note_tests(
            report, {suite: Path(log).read_text("utf-8", "replace") for suite, log in logs.items()}
        )
    except PackagingError as error:
        print(error, file=sys.stderr)
        return 1
    options.report.write_text(json.dumps(report, indent=2) + "\n", encoding="utf-8")
    for module in report["modules"]:
        print(f"{module['name']}: {', '.join(module['tested_by']) or 'not tested here'}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
