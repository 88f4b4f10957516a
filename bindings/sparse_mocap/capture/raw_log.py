# SPDX-License-Identifier: GPL-3.0-or-later
"""The raw log: every received byte with its arrival time, written to disk before decoding.

The 8 bytes ``SMRAWLG1``, whose last is the version, then records. All numbers are
little-endian::

    2 bytes  F5 4C          start of a record
    u8       kind           1 bytes of a link, 2 a datagram of a link, 3 an event
    u8       link           number of the capture's link (0, 1, ...)
    u32      length         of the payload
    i64      arrival        monotonic clock of the machine, nanoseconds
    payload                 bytes | u8 length of the sender's name, name, datagram | JSON, UTF-8
    u32      CRC-32         of everything after the first two bytes

A log may continue in further files (``raw.1.log``, ...), so that the oldest can be deleted while
nothing is recorded. Each starts with what is needed to read it on its own: the capture's event and,
for every link, how its connection began; an event ``begun`` ends that part.

A record is passed to the operating system in one write, so that a killed capture loses nothing that
it had received; the disk is synced about once a second, in case of a power failure. An incomplete
record at the end (its length or checksum is wrong) is ignored. Damage in the middle is skipped up
to the next record with a valid checksum.
"""

from __future__ import annotations

import io
import json
import os
import re
import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from enum import IntEnum
from pathlib import Path
from typing import Any, BinaryIO

__all__ = [
    "Kind",
    "LogFormatError",
    "RawLogWriter",
    "Record",
    "check_magic",
    "log_path",
    "read_log",
    "read_records",
    "sent_by",
]

MAGIC = b"SMRAWLG1"
FILE_NAME = "raw.log"
BEGUN = "begun"
"""The event after the part that a later file repeats from the earlier ones."""

_BEGIN = b"\xf5\x4c"
_HEAD = struct.Struct("<BBIq")
_CHECK = struct.Struct("<I")
_LONGEST_PAYLOAD = 1 << 20
_MOST_DAMAGED = 1 << 30
"""Bytes with a wrong checksum, counted again for each record that they may be part of; a log with
more of them was not damaged but made up."""


class LogFormatError(ValueError):
    """A file is not a log of this version; str() names the file."""


class Kind(IntEnum):
    """The kind of a record."""

    BYTES = 1
    DATAGRAM = 2
    EVENT = 3


@dataclass(frozen=True)
class Record:
    """One record."""

    kind: Kind
    link: int
    arrival_ns: int
    payload: bytes

    @property
    def event(self) -> dict[str, Any]:
        """The payload of an event."""
        value = json.loads(self.payload)
        return value if isinstance(value, dict) else {}

    def is_event(self, name: str) -> bool:
        """Whether it is an event of this name."""
        return self.kind is Kind.EVENT and self.event.get("event") == name

    @property
    def datagram(self) -> tuple[str, bytes]:
        """Sender and content of a datagram."""
        end = 1 + self.payload[0]
        return self.payload[1:end].decode("utf-8", "replace"), self.payload[end:]


def sent_by(sender: str, datagram: bytes) -> bytes:
    """The payload of a datagram's record."""
    name = sender.encode()[:255]
    return bytes([len(name)]) + name + datagram


def log_path(folder: Path, number: int) -> Path:
    """A log's file; they are numbered from 0."""
    return folder / (f"raw.{number}.log" if number else FILE_NAME)


class RawLogWriter:
    """Appends records to a new file of a log; each is one write to the operating system."""

    def __init__(self, folder: Path, number: int = 0) -> None:
        self.number = number
        self._file = open(log_path(folder, number), "xb", buffering=0)  # noqa: SIM115
        self._file.write(MAGIC)
        self.num_bytes = len(MAGIC)

    def append(self, record: Record) -> None:
        """Appends a record. Raises OSError, for example when the disk is full."""
        head = _HEAD.pack(record.kind, record.link, len(record.payload), record.arrival_ns)
        body = head + record.payload
        rest = memoryview(_BEGIN + body + _CHECK.pack(zlib.crc32(body)))
        while len(rest):
            written = self._file.write(rest)
            self.num_bytes += written
            rest = rest[written:]

    def append_bytes(self, link: int, arrival_ns: int, data: bytes) -> None:
        """Appends bytes of a link."""
        self.append(Record(Kind.BYTES, link, arrival_ns, data))

    def append_event(self, link: int, arrival_ns: int, event: dict[str, Any]) -> None:
        """Appends an event."""
        self.append(Record(Kind.EVENT, link, arrival_ns, json.dumps(event).encode()))

    def append_datagram(self, link: int, arrival_ns: int, sender: str, datagram: bytes) -> None:
        """Appends a datagram with its sender."""
        self.append(Record(Kind.DATAGRAM, link, arrival_ns, sent_by(sender, datagram)))

    def sync(self) -> None:
        """Waits until everything is on disk."""
        os.fsync(self._file.fileno())

    def close(self) -> None:
        """Syncs and closes."""
        if not self._file.closed:
            self.sync()
            self._file.close()


def read_log(folder: Path) -> Iterator[Record]:
    """Yields the records of all remaining files of a log, in order.

    Repeated records are skipped if the file before was read. Raises as read_records does.
    """
    found = [re.fullmatch(r"raw\.(\d+)\.log", path.name) for path in folder.glob("raw.*.log")]
    numbers = sorted(int(match[1]) for match in found if match)
    last = -2
    for number in (0, *numbers):
        path = log_path(folder, number)
        is_repeated = number == last + 1
        try:
            if number and path.stat().st_size < len(MAGIC):  # its start is incomplete
                continue
            for record in read_records(path):
                last = number
                if not is_repeated:
                    yield record
                is_repeated = is_repeated and not record.is_event(BEGUN)
        except FileNotFoundError:  # deleted, perhaps just now
            if not numbers:
                raise


def check_magic(path: Path, begin: bytes, magic: bytes, what: str) -> None:
    """Raises LogFormatError unless a file begins with these bytes; the last is the version."""
    if begin == magic:
        return
    if len(begin) == len(magic) and begin[:-1] == magic[:-1]:
        version = begin[-1:].decode("ascii", "replace")
        raise LogFormatError(
            f"{path}: is a {what} of format version {version!r}, and this program reads version"
            f" {magic[-1:].decode()!r}; use the Sparse Mocap that recorded it"
        )
    raise LogFormatError(f"{path}: is not a {what} of a capture")


def read_records(path: Path) -> Iterator[Record]:
    """Yields the records of a log, even one that is being written or is incomplete.

    Raises LogFormatError when the file is not a raw log, and OSError.
    """
    with open(path, "rb") as file:
        check_magic(path, file.read(len(MAGIC)), MAGIC, "raw log")
        yield from _records(file, _Damage(path))


class _Damage:
    """Counts what was checked in vain."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._num_bytes = 0

    def add(self, num_bytes: int) -> None:
        """Raises LogFormatError when it is too much."""
        self._num_bytes += num_bytes
        if self._num_bytes > _MOST_DAMAGED:
            raise LogFormatError(f"{self._path}: is too damaged to be read; use a copy of the log")


def _records(file: BinaryIO, damage: _Damage) -> Iterator[Record]:
    pending = b""
    while block := file.read(1 << 16):
        pending += block
        at = 0
        while True:
            record, end = _record_at(pending, at, damage)
            if record is not None:
                yield record
            elif end == at:
                break
            at = end
        pending = pending[at:]
    # The length of an incomplete record may span complete records after it.
    for at in _begins(pending, 1):
        record, _ = _record_at(pending, at, damage)
        if record is not None:
            yield from _records(io.BytesIO(pending[at:]), damage)
            return


def _record_at(data: bytes, at: int, damage: _Damage) -> tuple[Record | None, int]:
    """Returns the record at ``at`` and its end, or None and where to continue the search.

    The latter is ``at`` itself while more bytes are needed.
    """
    if not data.startswith(_BEGIN, at):
        begin = data.find(_BEGIN, at)
        return None, begin if begin >= 0 else max(at, len(data) - 1)
    body = at + len(_BEGIN)
    if len(data) < body + _HEAD.size:
        return None, at
    kind, link, length, arrival_ns = _HEAD.unpack_from(data, body)
    payload = body + _HEAD.size
    end = payload + length
    if kind not in tuple(Kind) or length > _LONGEST_PAYLOAD:
        return None, at + 1
    if len(data) < end + _CHECK.size:
        return None, at
    if _CHECK.unpack_from(data, end)[0] != zlib.crc32(data[body:end]):
        damage.add(length)
        return None, at + 1
    return Record(Kind(kind), link, arrival_ns, data[payload:end]), end + _CHECK.size


def _begins(data: bytes, at: int) -> Iterator[int]:
    while (at := data.find(_BEGIN, at)) >= 0:
        yield at
        at += 1
