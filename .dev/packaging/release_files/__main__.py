# SPDX-License-Identifier: GPL-3.0-or-later
"""``python -m release_files``: what `./dev package` runs when the modules are compiled."""

import argparse
import sys
from pathlib import Path

from .errors import PackagingError
from .release import header_versions, make_release, table, write_release


def main() -> int:
    """Make the release and print the table; 1 when something must not be handed out."""
    parser = argparse.ArgumentParser(prog="release_files", description=__doc__)
    parser.add_argument("root", type=Path, help="the folder of the sources")
    parser.add_argument(
        "--modules", type=Path, nargs="+", required=True, help="folders of compiled modules"
    )
    parser.add_argument("--pyserial", type=Path, required=True, help="folder of pyserial's wheel")
    parser.add_argument("--headers", type=Path, help="folder of CPython's headers, by target")
    parser.add_argument("--output", type=Path, required=True)
    options = parser.parse_args()
    modules = {
        path.name: path.read_bytes()
        for folder in options.modules
        for path in sorted(folder.glob("_core*"))
    }
    try:
        pyserial = _only_wheel(options.pyserial)
        release = make_release(options.root.resolve(), modules, pyserial)
    except PackagingError as error:
        print(f"{error}\nNothing was written.", file=sys.stderr)
        return 1
    if options.headers is not None:
        release.headers |= header_versions(options.headers)
    write_release(release, options.output)
    print("\n".join(table(release)))
    return 0


def _only_wheel(folder: Path) -> tuple[str, bytes]:
    wheels = sorted(folder.glob("pyserial-*.whl"))
    if len(wheels) != 1:
        raise PackagingError(f"{folder} must hold one wheel of pyserial and holds {len(wheels)}")
    return wheels[0].name, wheels[0].read_bytes()


if __name__ == "__main__":
    sys.exit(main())
