# SPDX-License-Identifier: GPL-3.0-or-later
"""The compiled core: motion databases."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path as _Path
from typing import TypedDict, Unpack

import numpy as np
from numpy.typing import NDArray

from ._core_model import Model
from ._core_motion import Motion, ReadOptions, Skeleton
from ._core_readings import SensorInput
from ._core_reconstruction import SensorRecording
from ._core_types import Path, ProgressCallback

class ClipTake:
    """What real sensors measured while a clip was performed.

    The clip's rows hold it in place of what virtual sensors read.
    """

    name: str
    hash: str
    begin_s: float
    correlation: float
    coverage: float
    channels: dict[str, list[str]]

class Clip:
    """A stretch of a database's rows.

    source is the file, relative to the folder built from; hashes are XXH3 of it and of the .asf
    that was read with it; skeleton is the id of its SourceSkeleton; origin and license are notes;
    warnings are kinds of warnings about the file and how often (empty for copies).
    """

    name: str
    actor: str
    motion_class: str
    source: str
    source_hash: str
    skeleton_hash: str
    skeleton: str
    origin: str
    license: str
    source_frames: int
    source_rate_hz: float
    warnings: dict[str, int]
    is_mirrored: bool
    is_reversed: bool
    tempo: float
    take: ClipTake | None
    begin: int
    end: int

class SourceSkeleton:
    """One kind of skeleton among a database's sources.

    joints are the source's that move the standard ones; unit_scale times its lengths are metres.
    """

    id: str
    num_joints: int
    joints: dict[str, str]
    unit_scale: float

class MotionDatabase:
    """An opened .smdb, read-only and thread-safe."""

    def __init__(self, path: Path) -> None:
        """Checks the whole file. Raises FormatError."""
    path: str
    num_frames: int
    rate_hz: float
    skeleton: Skeleton
    clips: list[Clip]
    skeletons: list[SourceSkeleton]
    skipped: list[tuple[str, str]]
    duplicates: list[tuple[str, str]]
    site_names: list[str]
    @property
    def build_info(self) -> str:
        """JSON: options and counts of the build."""
    def array(self, name: str) -> NDArray[np.float32]:
        """A read-only copy of the rows as float32.

        Names: angles, positions, extremities, root_motion, contacts, specific_force_pivot,
        specific_force_end, angular_velocity, up.
        """
    def clip_motion(self, index: int, *, extremities: bool = False) -> Motion:
        """The clip as a motion on the standard skeleton, starting at the origin.

        extremities: with feet, toes and hands, which are relaxed in clips whose files have none.
        """
    model_names: list[str]
    def model(self, method: str) -> Model:
        """What a method learned and keeps here, see store_model. Raises FormatError."""
    def section(self, name: str, version: int) -> dict[str, str] | None:
        """The texts of an optional part, None where it is missing or was made from other rows."""
    @property
    def sections(self) -> list[str]:
        """The names of the optional parts that it holds."""
    @property
    def rows_hash(self) -> str:
        """Tells these rows from all others: XXH3, 16 hexadecimal digits."""
    @property
    def array_bytes(self) -> dict[str, int]:
        """What its rows take in the file, by the names of array()."""
    @property
    def other_tensors(self) -> list[tuple[str, str, tuple[int, ...], int]]:
        """Tensors that other programs put into the file: name, element type, shape, bytes."""

def store_section(
    database: Path, name: str, texts: Mapping[str, str], *, version: int, rows: str = ""
) -> None:
    """Puts an optional part of texts into a motion database, in place of one of its name.

    rows: the rows_hash of the rows that it was made from, empty when it belongs to any. The file
    is replaced atomically. Raises FormatError, OSError and ValueError.
    """

def find_motion_files(
    sources: Sequence[Path], exclude: Sequence[str] = (), read: ReadOptions = ...
) -> list[_Path]:
    """The motion files that the sources are or hold, without those excluded, sorted.

    Raises FormatError when a source does not exist or nothing is left.
    """

def named_motion_files(
    sources: Sequence[Path], exclude: Sequence[str] = (), read: ReadOptions = ...
) -> list[tuple[_Path, str]]:
    """As find_motion_files, each with the name that its clips have as their source."""

class ProgressReport:
    """How far an import is: done of total steps.

    files of num_files are through in this pass over them (there are two) and hold so many frames;
    bytes of num_bytes are read, over all passes.
    """

    done: int
    total: int
    what: str
    files: int
    num_files: int
    frames: int
    bytes: int
    num_bytes: int

class TakeAlignment:
    """Where in a take a motion was performed, and how well both agree.

    Correlations are 1 at most, however the sensors are mounted; unrelated movements have about 0.5.
    """

    begin_s: float
    correlation: float
    runner_up: float
    coverage: float
    sensor_correlations: list[float]

def align_take(
    motion: Motion,
    recordings: Sequence[SensorRecording],
    sensors: Sequence[SensorInput],
    *,
    event: tuple[float, float] | None = None,
    progress: ProgressCallback | None = None,
) -> TakeAlignment:
    """Returns where in a take a motion of the standard skeleton was performed.

    recordings: a SensorRecording for each of the sensors (SensorInput), all on one clock. event:
    when on that clock a clap or a jump happened that the motion has too, from and to; it then
    decides the time. Raises ConfigError for what is too short to be compared, ValueError for unlike
    numbers of recordings and sensors, and Cancelled.
    """

class PairedTake:
    """What sensors recorded while a motion was performed."""

    def __init__(
        self,
        name: str,
        hash: str,
        sensors: Sequence[SensorInput],
        recordings: Sequence[SensorRecording],
        *,
        begin_s: float,
        correlation: float,
    ) -> None:
        """Takes the name and hash of the take file.

        begin_s: when the motion begins on its clock; correlation: how well the readings agree with
        it, see align_take. Raises ValueError for unlike numbers of sensors and recordings.
        """
    name: str
    hash: str

class BuildReport:
    """What an import did.

    num_files, source_frames and source_bytes are what it took in, num_clips and num_frames what
    the database holds; num_known files were in already, num_replaced of num_files took the place
    of what they held before. skipped (unusable), duplicates and doubtful are (path, reason).
    """

    num_files: int
    num_known: int
    num_replaced: int
    num_clips: int
    num_frames: int
    source_frames: int
    source_bytes: int
    elapsed_s: float
    skipped: list[tuple[str, str]]
    duplicates: list[tuple[str, str]]
    doubtful: list[tuple[str, str]]
    warnings: list[str]

class _ImportOptions(TypedDict, total=False):
    """Of sparse_mocap.build_database and add_to_database, which say what they mean.

    No class at run time.
    """

    strict: bool
    keep_duplicates: bool
    num_threads: int
    by_hand: dict[str, str]
    mappings: Path | None
    read: ReadOptions
    progress: ProgressCallback | None
    details: Callable[[ProgressReport], object] | None

_RemoteWork = Callable[[list[bytes]], Iterable[bytes | None]]

def build_database(
    sources: Sequence[Path],
    output: Path,
    *,
    rate_hz: float = 25.0,
    mirror: bool = False,
    reverse: bool = False,
    tempo_copies: Sequence[float] = (0.8, 1.25),
    own_proportions: bool = False,
    exclude: Sequence[str] = (),
    labels: Mapping[str, tuple[str, str, str, str, float]] = ...,
    label_warnings: Sequence[str] = (),
    remote: _RemoteWork | None = None,
    **options: Unpack[_ImportOptions],
) -> BuildReport:
    """Builds a database from motion files, or folders of them, and writes it to output.

    rate_hz is the database's frame rate; mirror, reverse and tempo_copies (factors) add copies of
    each clip; own_proportions: readings are of each body's own, not the averaged ones; exclude:
    glob patterns of files to leave out; labels: actor, class, origin, license and the rate (Hz, 0:
    not said) by a motion file's path. strict: the first file that cannot be used or is doubtful
    ends it, otherwise it is skipped or taken with a warning; keep_duplicates: files with the same
    motion are all taken; num_threads 0: one for each processor; by_hand: the source's joint by
    standard joint; mappings: the file of remembered mappings; read: what the files do not say;
    remote(requests): does the work on files in place of this process, and gives an iterator over
    what answer_request says of each request, None while the next is not there yet.
    Raises FormatError, and Cancelled if progress returns False; the output is then left as it was.
    """

def answer_request(request: bytes, read: ReadOptions) -> bytes:
    """Does the work on a motion file that an import asks for, as bytes.

    read: readers of further formats; all else is in the request. Raises ValueError for what is no
    request of this version.
    """

def add_to_database(
    database: Path,
    sources: Sequence[Path],
    output: Path | None = None,
    *,
    exclude: Sequence[str] = (),
    labels: Mapping[str, tuple[str, str, str, str, float]] = ...,
    label_warnings: Sequence[str] = (),
    rebuild: bool = False,
    takes: Mapping[Path, PairedTake] = ...,
    remote: _RemoteWork | None = None,
    **options: Unpack[_ImportOptions],
) -> BuildReport:
    """Adds motion files to a database, with the copies that it was built with.

    output: where the result goes, None: in its place. rebuild: the sources hold the database's own
    files too, and everything is built anew, so that its skeleton is averaged over all bodies.
    takes: what sensors recorded while files were performed, by the files' paths. The rest is as in
    build_database().
    """

def drop_from_database(database: Path, clips: Sequence[str], output: Path | None = None) -> int:
    """Drops the clips whose name or source matches a glob pattern, and returns how many.

    output: where the result goes, None: in its place. Raises FormatError.
    """
