# SPDX-License-Identifier: GPL-3.0-or-later
"""The core of a capture: bytes to the raw log, then decoded, then samples to the sample log."""

from __future__ import annotations

import threading
import time
from collections import defaultdict, deque
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .config import CaptureConfig
from .decoder import Decoder
from .diagnosis import why_odd_values
from .errors import LogError, recover_command
from .link import Arrived, Link, State
from .raw_log import Kind, Record, sent_by
from .rolling_log import RollingLog
from .sample_log import SampleLogWriter, Samples

__all__ = ["Recorder", "Recording"]

SILENT_S = 0.1
"""A sensor without a sample for longer than this is reported as silent."""
_RATE_WINDOW = 5  # ticks
_ENOUGH_SAMPLES = 200
_NEWEST_PART = 0.03  # of the average that tells a wrong unit
_USUAL_SIZE_MPS2 = 9.81
_SHARED_ID = 0.2  # if this part of the frames is repeated or out of order, two sensors share an id


@dataclass
class Recording:
    """A part of the capture that becomes a take."""

    number: int
    begin_ns: int
    until_ns: int | None = None
    """When it stops by itself."""
    first_sample: int = 0


class Recorder:
    """Receives data from the links' threads, stores and counts it."""

    def __init__(self, folder: Path, config: CaptureConfig) -> None:
        self.folder, self.config = folder, config
        self._raw = RollingLog(
            folder, {"event": "capture", "config": config.as_json(), "unix_s": time.time()}
        )
        self._log = SampleLogWriter(folder)
        self._lock = threading.Lock()
        self._decoder = Decoder(config)
        self._num_logged_sensors = 0
        self._last: dict[int, Any] = {}
        self._num_of: dict[int, int] = {}
        self._sizes: defaultdict[int, float] = defaultdict(lambda: _USUAL_SIZE_MPS2)
        self._with_gyroscope: set[int] = set()
        self._with_orientation: set[int] = set()
        self._rates: deque[tuple[float, dict[int, int]]] = deque(maxlen=_RATE_WINDOW)
        self.recording: Recording | None = None
        self.num_recordings = 0
        self._unsaved: set[int] = set()
        self.links = [Link(index, link, self) for index, link in enumerate(config.links)]

    def start(self) -> None:
        """Opens the links."""
        if self.config.must_record:
            self.start_recording(None)
        for link in self.links:
            link.start()

    def stop(self) -> None:
        """Stops the links and the recording, and closes the logs."""
        for link in self.links:
            link.stop()
        with self._lock:
            self._stop_recording()
            self._raw.close()
            self._log.close()

    def connected(self, link: int, port: str, device: str = "") -> tuple[bytes, ...]:
        """A link's port was opened."""
        with self._lock:
            now_ns = self._event(link, {"event": "connected", "port": port, "device": device})
            return self._decoder.connected(link, now_ns, device)

    def set_sites(self, site_of: Mapping[str, str]) -> None:
        """Says where sensors are worn, by their identities. Raises LogError."""
        with self._lock:
            self.config = self._decoder.set_sites(site_of)
            self._raw.about["config"] = self.config.as_json()
            self._event(0, {"event": "sites", "site_of": dict(site_of)})

    def keep_alive(self, link: int) -> tuple[bytes, ...]:
        """What must be sent to the link's device every second."""
        return self._decoder.keep_alive(link)

    def changed(self, link: int, state: State, message: str) -> None:
        """A link's state changed; logged, because it explains gaps."""
        with self._lock:
            try:
                self._event(link, {"event": "state", "state": state, "message": message})
            except (LogError, ValueError):
                return  # a full disk is reported by arrived()

    def arrived(self, link: int, arrival_ns: int, data: bytes, sender: str = "") -> Arrived:
        """Bytes arrived: they are written to the raw log before they are decoded."""
        kind = Kind.DATAGRAM if sender else Kind.BYTES
        record = Record(kind, link, arrival_ns, sent_by(sender, data) if sender else data)
        with self._lock:
            try:
                self._raw.append(record)
                decoded = self._decoder.arrived(link, arrival_ns, data, sender)
                self._log.append(decoded.samples)
                has_samples = len(decoded.samples) > 0
                self._raw.decoded(
                    record, sender, has_samples=has_samples, has_news=decoded.has_news
                )
            except OSError as error:
                raise self._log_error(error) from error
            self._count(decoded.samples)
            self._log_new_sensors()
        return Arrived(len(decoded.samples), decoded.replies)

    def tick(self) -> None:
        """Called about twice a second.

        Syncs the disk, stops recordings, counts rates, deletes old files.
        """
        full = None
        with self._lock:
            recording = self.recording
            if recording and recording.until_ns and time.perf_counter_ns() >= recording.until_ns:
                self._stop_recording()
            self._rates.append((time.perf_counter(), dict(self._num_of)))
            if self.recording is None:
                with suppress(OSError):  # a full disk is reported by arrived()
                    full = self._raw.roll_over()
                self._log.remove_old()
        # Outside the lock: a slow disk must not block the links.
        with suppress(OSError, ValueError):
            self._raw.sync()
        if full is not None:
            with suppress(OSError):
                full.close()

    def start_recording(self, seconds: float | None) -> dict[str, Any]:
        """Records for this long from now, or until stopped; a running recording continues."""
        with self._lock:
            now = time.perf_counter_ns()
            if self.recording is None:
                self.recording = Recording(self.num_recordings, now, None, self._log.num_samples)
                self._raw.begin_recording()
                self._event(0, {"event": "recording", "number": self.num_recordings})
                self._unsaved.add(self.num_recordings)
                self.num_recordings += 1
            self.recording.until_ns = None if seconds is None else now + int(seconds * 1e9)
            return self._recording_json()

    def stop_recording(self) -> None:
        """Stops the recording, if there is one."""
        with self._lock:
            self._stop_recording()

    def tell_saved(self, number: int) -> None:
        """A recording was saved as a take."""
        with self._lock:
            self._unsaved.discard(number)

    @property
    def may_be_removed(self) -> bool:
        """Whether the folder is not needed at the end: whatever was recorded was saved."""
        return not self._unsaved and (self.config.is_temporary or self.num_recordings > 0)

    def status(self) -> dict[str, Any]:
        """The status of the capture, as a JSON object."""
        with self._lock:
            now_ns = time.perf_counter_ns()
            return {
                "now_ns": now_ns,
                "folder": str(self.folder),
                "samples": self._log.num_samples,
                "recordings": self.num_recordings,
                "recording": self._recording_json() if self.recording else None,
                "notes": list(self._decoder.sites.conflicts),
                "links": [self._link_json(link) for link in self.links],
                "sensors": [
                    self._sensor_json(i, now_ns) for i in range(len(self._decoder.sensors))
                ],
            }

    def _event(self, link: int, event: dict[str, Any]) -> int:
        try:
            return self._raw.append_event(link, event)
        except OSError as error:
            raise self._log_error(error) from error

    def _log_error(self, error: OSError) -> LogError:
        return LogError(
            f"{self.folder}: {error.strerror or error}; free some disk space, then save what was "
            f"received with: {recover_command(self.folder)}"
        )

    def _stop_recording(self) -> None:
        if self.recording is not None:
            number, self.recording = self.recording.number, None
            with suppress(LogError):  # a full disk is reported by arrived(); the log ends here
                self._event(0, {"event": "recording_end", "number": number})
            self._raw.end_recording()

    def _recording_json(self) -> dict[str, Any]:
        assert self.recording is not None
        recording = self.recording
        return {
            "number": recording.number,
            "seconds": (time.perf_counter_ns() - recording.begin_ns) * 1e-9,
            "samples": self._log.num_samples - recording.first_sample,
            "first_sample": recording.first_sample,
        }

    def _count(self, samples: Samples) -> None:
        for sensor in np.unique(samples["sensor"]).tolist():
            own = samples[samples["sensor"] == sensor]
            self._num_of[sensor] = self._num_of.get(sensor, 0) + len(own)
            self._last[sensor] = own[-1]
            size = float(np.median(np.linalg.norm(own["specific_force"], axis=1)))
            self._sizes[sensor] += _NEWEST_PART * (size - self._sizes[sensor])
            rate = own["angular_velocity"]
            if (np.isfinite(rate) & (rate != 0.0)).any():
                self._with_gyroscope.add(sensor)
            if np.isfinite(own["orientation"]).any():
                self._with_orientation.add(sensor)

    def _log_new_sensors(self) -> None:
        sensors = self._decoder.sensors
        for index in range(self._num_logged_sensors, len(sensors)):
            sensor = sensors[index]
            self._event(sensor.link, {"event": "sensor", "index": index, "name": sensor.name})
        self._num_logged_sensors = len(sensors)

    def _link_json(self, link: Link) -> dict[str, Any]:
        counters = self._decoder.counters(link.index)
        frames = counters.get("samples", 0)
        suspect = counters.get("repeated", 0) + counters.get("out_of_order", 0)
        message = link.message
        odd = self._why_odd(link)
        if not message and odd:
            message = f"{link.opened_as}: {odd}"
        if not message and frames > 100 and suspect > _SHARED_ID * (frames + suspect):
            message = f"{link.opened_as}: two sensors seem to have the same id; change one of them"
        return {
            "port": link.config.port, "opened_as": link.opened_as, "driver": link.config.driver,
            "state": str(link.state), "message": message,
            "device_message": self._decoder.message(link.index),
            "bytes": link.num_bytes, "reconnects": link.num_reconnects, "counters": counters,
        }  # fmt: skip

    def _why_odd(self, link: Link) -> str:
        """What is odd about the values of one of the link's sensors."""
        for index, sensor in enumerate(self._decoder.sensors):
            if sensor.link == link.index and self._num_of.get(index, 0) > _ENOUGH_SAMPLES:
                why = why_odd_values(link.config, sensor.identity, self._sizes[index])
                if why:
                    return why
        return ""

    def _sensor_json(self, index: int, now_ns: int) -> dict[str, Any]:
        sensor, last = self._decoder.sensors[index], self._last.get(index)
        status: dict[str, Any] = {
            "name": sensor.name, "identity": sensor.identity, "is_shared": sensor.is_shared,
            "site": self._decoder.sites.sites[index], "link": sensor.link,
            "is_replaced": sensor.replaced_by is not None, "battery": self._decoder.battery(index),
            "samples": self._num_of.get(index, 0), "missing": sensor.num_missing,
            "rate_hz": self._rate(index), "age_s": None, "specific_force": None,
            "state": "silent", "flags": 0, "has_gyroscope": index in self._with_gyroscope,
            "has_orientation": index in self._with_orientation,
        }  # fmt: skip
        if last is not None:
            age_s = (now_ns - int(last["arrival_ns"])) * 1e-9
            status["age_s"], status["flags"] = age_s, int(last["flags"])
            status["specific_force"] = np.round(last["specific_force"], 3).tolist()
            status["state"] = "silent" if age_s > SILENT_S else "live"
        return status

    def _rate(self, index: int) -> float:
        if not self._rates:
            return 0.0
        begin_s, then = self._rates[0]
        return (self._num_of.get(index, 0) - then.get(index, 0)) / max(
            time.perf_counter() - begin_s, 0.1
        )
