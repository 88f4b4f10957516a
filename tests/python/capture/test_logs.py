# SPDX-License-Identifier: GPL-3.0-or-later
"""The logs on disk: what was written is read, whatever a crash or a bad disk did to the file."""

from __future__ import annotations

import os
import random
import struct
import sys
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest
from sparse_mocap.capture import RecordingError, recording_to_take, sample_log
from sparse_mocap.capture.raw_log import MAGIC, Kind, RawLogWriter, Record, read_records
from sparse_mocap.capture.sample_log import SAMPLE, SampleLogReader, SampleLogWriter


def written(folder: Path, count: int = 40) -> list[Record]:
    source = random.Random(1)
    log = RawLogWriter(folder)
    records = []
    for number in range(count):
        kind = source.choice(list(Kind))
        payload = source.randbytes(source.choice([0, 1, 7, 60]))
        if kind is Kind.BYTES:  # what looks like the begin of a record is no reason to stumble
            payload += b"\xf5\x4c\x01"
        records.append(Record(kind, number % 3, number * 1000, payload))
        log.append(records[-1])
    log.close()
    return records


def test_the_log_gives_back_what_was_appended(tmp_path: Path) -> None:
    records = written(tmp_path)
    assert list(read_records(tmp_path / "raw.log")) == records


def test_a_log_torn_anywhere_gives_every_whole_record(tmp_path: Path) -> None:
    records = written(tmp_path, 12)
    data = (tmp_path / "raw.log").read_bytes()
    ends, at = [], len(MAGIC)
    for record in records:
        at += 2 + 14 + len(record.payload) + 4
        ends.append(at)
    assert ends[-1] == len(data)
    torn = tmp_path / "torn.log"
    for length in range(len(MAGIC), len(data) + 1):
        torn.write_bytes(data[:length])
        whole = sum(end <= length for end in ends)
        assert list(read_records(torn)) == records[:whole]


def test_a_flipped_bit_costs_one_record(tmp_path: Path) -> None:
    records = written(tmp_path, 12)
    data = bytearray((tmp_path / "raw.log").read_bytes())
    bad = tmp_path / "bad.log"
    for at in range(len(MAGIC), len(data)):
        data[at] ^= 0x10
        bad.write_bytes(data)
        data[at] ^= 0x10
        found = list(read_records(bad))
        assert len(found) == len(records) - 1
        assert all(record in records for record in found)


def test_records_longer_than_a_block_are_whole(tmp_path: Path) -> None:
    log = RawLogWriter(tmp_path)
    payload = os.urandom(200_000)
    log.append_bytes(0, 5, payload)
    log.append_event(1, 6, {"event": "state", "message": "ü"})
    log.append_datagram(2, 7, "10.0.0.7:6969", b"\x00\x01")
    log.close()
    first, second, third = read_records(tmp_path / "raw.log")
    assert first.payload == payload
    assert second.event == {"event": "state", "message": "ü"}
    assert third.datagram == ("10.0.0.7:6969", b"\x00\x01")


def test_another_file_is_no_log(tmp_path: Path) -> None:
    other = tmp_path / "other"
    other.write_bytes(b"time_s,sensor,ax,ay,az\n")
    with pytest.raises(ValueError, match="is not a raw log"):
        list(read_records(other))


def test_a_log_of_another_version_says_so(tmp_path: Path) -> None:
    newer = tmp_path / "raw.log"
    newer.write_bytes(MAGIC[:-1] + b"2")
    with pytest.raises(ValueError, match=r"raw log of format version '2', .* reads version '1'"):
        list(read_records(newer))
    (tmp_path / sample_log.FILE_NAME).write_bytes(sample_log.MAGIC[:-1] + b"0")
    with pytest.raises(ValueError, match=r"sample log of format version '0', .* version '1'"):
        SampleLogReader(tmp_path)


def test_a_log_is_never_overwritten(tmp_path: Path) -> None:
    written(tmp_path, 3)
    with pytest.raises(FileExistsError):
        RawLogWriter(tmp_path)


def some_samples(begin: int, count: int) -> np.ndarray:
    samples = np.zeros(count, SAMPLE)
    samples["counter"] = np.arange(begin, begin + count)
    samples["specific_force"] = np.arange(begin, begin + count)[:, None]
    return samples


def test_a_reader_that_was_stalled_misses_nothing(tmp_path: Path) -> None:
    log = SampleLogWriter(tmp_path)
    reader, late = SampleLogReader(tmp_path), SampleLogReader(tmp_path, 30)
    with closing(log), closing(reader), closing(late):
        _check_both(log, reader, late)


def _check_both(log: SampleLogWriter, reader: SampleLogReader, late: SampleLogReader) -> None:
    counters: list[int] = []
    for begin in range(0, 100, 10):
        log.append(some_samples(begin, 10))
        if begin % 30 == 0:
            counters += reader.read()["counter"].tolist()
    counters += reader.read(5)["counter"].tolist() + reader.read()["counter"].tolist()
    assert counters == list(range(100))
    assert late.read()["counter"].tolist() == list(range(30, 100))
    assert len(reader.read()) == 0


def test_a_torn_sample_is_not_read(tmp_path: Path) -> None:
    log = SampleLogWriter(tmp_path)
    log.append(some_samples(0, 3))
    log.close()
    path = tmp_path / "samples.bin"
    data = path.read_bytes()
    path.write_bytes(data[:-1])
    with closing(SampleLogReader(tmp_path)) as reader:
        assert reader.num_samples == len(reader.read()) == 2
        path.write_bytes(data)
        assert reader.read()["counter"].tolist() == [2]


def test_a_log_in_many_files_is_read_as_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sample_log, "PER_FILE", 16)
    log = SampleLogWriter(tmp_path)
    with closing(log), closing(SampleLogReader(tmp_path)) as reader:
        log.append(some_samples(0, 16))
        assert len(reader.read(10)) == 10
        log.append(some_samples(16, 84))
        assert reader.num_samples == 100
        assert reader.read()["counter"].tolist() == list(range(10, 100))
        log.append(some_samples(100, 5))
        assert reader.read()["counter"].tolist() == list(range(100, 105))


def test_who_was_stalled_too_long_goes_on_with_the_oldest_left(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sample_log, "PER_FILE", 16)
    log = SampleLogWriter(tmp_path)
    with (
        closing(log), closing(SampleLogReader(tmp_path)) as stalled,
        closing(SampleLogReader(tmp_path, 40)) as late,
    ):  # fmt: skip
        for begin in range(0, 100, 10):
            log.append(some_samples(begin, 10))
            log.remove_old()
        is_kept = sys.platform == "win32"  # a file that is being read cannot be deleted there
        assert len(list(tmp_path.iterdir())) == (4 if is_kept else 3)
        assert late.read()["counter"].tolist() == list(range(64, 100))
        # What it has open is there for it still.
        assert stalled.read()["counter"].tolist() == [*range(16), *range(64, 100)]
        assert stalled.position == log.num_samples == 100
        log.remove_old()
        assert len(list(tmp_path.iterdir())) == 3


def test_a_file_that_cannot_be_deleted_yet_is_deleted_later(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As on Windows while somebody reads it."""
    unlink, read_by = Path.unlink, {"samples.bin", "samples.3.bin"}

    def unlink_unread(path: Path, missing_ok: bool = False) -> None:
        if path.name in read_by:
            raise PermissionError(13, "used by another process", str(path))
        unlink(path, missing_ok=missing_ok)

    monkeypatch.setattr(sample_log, "PER_FILE", 16)
    monkeypatch.setattr(Path, "unlink", unlink_unread)
    with closing(SampleLogWriter(tmp_path)) as log, closing(SampleLogReader(tmp_path)) as stalled:
        for begin in range(0, 100, 10):
            log.append(some_samples(begin, 10))
            log.remove_old()
        assert {path.name for path in tmp_path.iterdir()} > read_by
        kept = [*range(16), *range(48, 100)]
        assert stalled.read()["counter"].tolist() == kept
        read_by.clear()
        log.remove_old()
        assert len(list(tmp_path.iterdir())) == 3


def test_a_made_up_log_gives_one_line_soon(tmp_path: Path) -> None:
    """Every byte pair claims a record of a megabyte, whose checksum is wrong."""
    head = b"\xf5\x4c" + struct.pack("<BBIq", 1, 0, (1 << 20) - 1, 0)
    (tmp_path / "raw.log").write_bytes(b"SMRAWLG1" + head * (12_000_000 // len(head)))
    with pytest.raises(RecordingError, match="too damaged"):
        recording_to_take(tmp_path)


@pytest.mark.parametrize(
    "event",
    [
        b"[" * 100_000, b"[]", b"\xff", b'{"event": "capture"}',
        b'{"event": "capture", "config": {"links": 5, "sites": []}}',
        b'{"event": "capture", "config": {"links": [{"port": "p", "driver": "x"}], "sites": []}}',
        b'{"event": "capture", "config": {"links": [], "sites": [], "surprise": 1}}',
    ],
)  # fmt: skip
def test_a_log_with_other_content_gives_one_line(tmp_path: Path, event: bytes) -> None:
    writer = RawLogWriter(tmp_path)
    writer.append(Record(Kind.EVENT, 0, 1, event))
    writer.append_bytes(7, 2, b"data of a link that is not there")
    writer.close()
    with pytest.raises(RecordingError) as caught:
        recording_to_take(tmp_path)
    assert str(tmp_path) in str(caught.value)
    assert "\n" not in str(caught.value)
