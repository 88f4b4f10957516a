# SPDX-License-Identifier: GPL-3.0-or-later
"""Archives whose bytes depend on their content alone: no clock, no owner, no order of a folder."""

import gzip
import io
import tarfile
import zipfile
from collections.abc import Iterable, Mapping
from pathlib import Path

Files = Mapping[str, bytes]
"""The content of an archive: names with ``/`` and what each file holds."""

EARLIEST = (1980, 1, 1, 0, 0, 0)
"""The first moment that a zip can name."""
EARLIEST_S = 315532800
REGULAR_FILE = 0o100644


def folder_files(folder: Path, endings: Iterable[str]) -> dict[str, bytes]:
    """The files below a folder that end so, by their names in it, without what Python compiled."""
    wanted = tuple(endings)
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and path.name.endswith(wanted) and "__pycache__" not in path.parts
    }


def under(folder: str, files: Files) -> dict[str, bytes]:
    """The same files in a folder."""
    return {f"{folder}/{name}": data for name, data in files.items()}


def zipped(files: Files) -> bytes:
    """A zip of the files; a wheel among them is stored as it is, being a zip itself."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name in sorted(files, key=_metadata_last):
            entry = zipfile.ZipInfo(name, EARLIEST)
            entry.create_system = 3  # Unix, so that the permissions below count
            entry.external_attr = REGULAR_FILE << 16
            stored = name.endswith(".whl")
            entry.compress_type = zipfile.ZIP_STORED if stored else zipfile.ZIP_DEFLATED
            archive.writestr(entry, files[name])
    return buffer.getvalue()


def tarred(files: Files) -> bytes:
    """A gzipped tar of the files."""
    buffer = io.BytesIO()
    with (
        gzip.GzipFile("", "wb", compresslevel=9, fileobj=buffer, mtime=EARLIEST_S) as packed,
        tarfile.open(fileobj=packed, mode="w", format=tarfile.PAX_FORMAT) as archive,
    ):
        for name in sorted(files):
            entry = tarfile.TarInfo(name)
            entry.size, entry.mtime, entry.mode = len(files[name]), EARLIEST_S, 0o644
            archive.addfile(entry, io.BytesIO(files[name]))
    return buffer.getvalue()


def unzipped(data: bytes) -> dict[str, bytes]:
    """What a zip holds."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        return {name: archive.read(name) for name in archive.namelist() if name[-1] != "/"}


def _metadata_last(name: str) -> tuple[bool, str]:
    """The order of a wheel: what describes it comes last, as its format asks for."""
    return ".dist-info/" in name, name
