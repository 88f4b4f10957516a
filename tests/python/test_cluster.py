# SPDX-License-Identifier: GPL-3.0-or-later
"""Work on Dask: a scheduler and two workers that were started by hand, and Dask's LocalCluster."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
import sparse_mocap
from click.testing import Result
from sparse_mocap.batch import BatchSettings, Solved, outputs, solve_batch
from sparse_mocap.databases import content_hash
from sparse_mocap.evaluation import Settings, contenders, evaluate
from sparse_mocap.workers import cluster, processors

pytest.importorskip("distributed", reason="dask.distributed is not installed here")

Cli = Callable[..., Result]
NUM_TAKES = 6


class Cluster:
    """Processes of Dask that find one another by a file."""

    def __init__(self, folder: Path) -> None:
        self.file = folder / "scheduler.json"
        self.folder = folder
        self.scheduler = self._started("dask_scheduler", "--port", "0", "--no-dashboard")
        while not self.file.exists() or not self.file.stat().st_size:
            assert self.scheduler.poll() is None
            time.sleep(0.05)
        self.address = json.loads(self.file.read_text("utf-8"))["address"]
        self.workers = [self._worker(), self._worker()]

    def _worker(self) -> subprocess.Popen[bytes]:
        return self._started(
            "dask_worker", "--no-nanny", "--nthreads", "1", "--no-dashboard",
            "--local-directory", str(self.folder),
        )  # fmt: skip

    def _started(self, name: str, *options: str) -> subprocess.Popen[bytes]:
        command = [sys.executable, "-m", f"distributed.cli.{name}", *options]
        return subprocess.Popen(
            [*command, "--scheduler-file", str(self.file)],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            env=os.environ | {"PYTHONPATH": os.pathsep.join(path for path in sys.path if path)},
        )

    def wait_for_workers(self) -> None:
        from dask.distributed import Client

        with Client(self.address) as client:
            client.wait_for_workers(len(self.workers), timeout=60)

    def kill_a_worker(self) -> None:
        self.workers[0].kill()
        self.workers[0].wait()
        assert self.workers[1].poll() is None

    def stop(self) -> None:
        for process in [*self.workers, self.scheduler]:
            process.kill()
            process.wait()


class LocalWorkers:
    """Dask's own LocalCluster: the scheduler here, two workers that it starts again when lost."""

    def __init__(self, folder: Path) -> None:
        from dask.distributed import LocalCluster

        self.cluster = LocalCluster(
            n_workers=2,
            threads_per_worker=1,
            processes=True,
            dashboard_address=None,
            local_directory=str(folder),
        )
        self.address = self.cluster.scheduler_address

    def wait_for_workers(self) -> None:
        self.cluster.wait_for_workers(2, timeout=60)

    def kill_a_worker(self) -> None:
        import psutil

        first, second = (psutil.Process(nanny.pid) for nanny in self.cluster.workers.values())
        first.kill()
        first.wait(timeout=60)
        assert second.is_running()

    def stop(self) -> None:
        self.cluster.close()


KINDS = {"by_hand": Cluster, "local_cluster": LocalWorkers}
on_each_kind = pytest.mark.parametrize("dask", KINDS, indirect=True)


@pytest.fixture
def dask(tmp_path: Path, request: pytest.FixtureRequest) -> Iterator[Cluster | LocalWorkers]:
    folder = tmp_path / "dask"
    folder.mkdir()
    started = KINDS[getattr(request, "param", "by_hand")](folder)
    try:
        started.wait_for_workers()
        yield started
    finally:
        started.stop()


@pytest.fixture
def takes(tmp_path: Path, take_path: Path) -> Path:
    folder = tmp_path / "takes"
    folder.mkdir()
    for number in range(NUM_TAKES):
        shutil.copy(take_path, folder / f"take_{number}.csv")
    return folder


def made(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.glob("*.bvh")}


@on_each_kind
@pytest.mark.filterwarnings("default")
def test_solves_every_take_once_although_a_worker_is_killed(
    tmp_path: Path, takes: Path, database_path: Path, dask: Cluster | LocalWorkers
) -> None:
    settings = BatchSettings(str(database_path), content_hash(database_path))
    with processors(1) as workers:
        solve_batch(outputs([takes], tmp_path / "here"), settings, workers)

    def kill_one(one: Solved, count: int) -> None:
        if count == 1:
            dask.kill_a_worker()

    with cluster(dask.address) as workers:
        solved = solve_batch(outputs([takes], tmp_path / "there"), settings, workers, kill_one)
    assert [one.error for one in solved] == [None] * NUM_TAKES
    assert not any(one.was_there for one in solved)
    assert made(tmp_path / "there") == made(tmp_path / "here")
    assert len(made(tmp_path / "there")) == NUM_TAKES


@pytest.mark.filterwarnings("default")
def test_the_command_sends_its_work_to_the_scheduler(
    cli: Cli, tmp_path: Path, takes: Path, database_path: Path, dask: Cluster
) -> None:
    (takes / "broken.csv").write_text("no take", "utf-8")
    options = ("--database", database_path, "--scheduler", dask.address)
    result = cli("batch", takes, "-o", tmp_path / "out", *options)
    assert f"1 of {NUM_TAKES + 1} takes were not solved" in result.output
    assert len(made(tmp_path / "out")) == NUM_TAKES


@pytest.mark.filterwarnings("default")
def test_an_evaluation_finds_the_same_on_a_cluster(
    cli: Cli, tmp_path: Path, library: Path, dask: Cluster
) -> None:
    options = ("evaluate", "--database-source", library, "--scenario", 1, "--tests", "*_squat_01*")
    options = (*options, "--method", "tautges2011", "--cache", tmp_path / "cache")
    found = []
    for name, more in (("here", ()), ("there", ("--scheduler", dask.address))):
        path = tmp_path / f"{name}.json"
        result = cli(*options, "--json", path, *more)
        assert result.exit_code == 0, result.output
        found.append(json.loads(path.read_text("utf-8")))
    assert len(found[0]["tests"]) == 2
    assert found[0] == found[1]


@on_each_kind
@pytest.mark.filterwarnings("default")
def test_an_evaluation_finds_the_same_although_a_worker_is_killed(
    library: Path, database: sparse_mocap.MotionDatabase, dask: Cluster | LocalWorkers
) -> None:
    settings = Settings(1, tuple(contenders(("tautges2011",))), tests="*")
    killed = []

    def kill_one(done: int, total: int, what: str) -> None:
        if done == 1:
            dask.kill_a_worker()
            killed.append(what)

    here = evaluate(database, library, settings)
    with cluster(dask.address) as workers:
        there = evaluate(database, library, settings, kill_one, workers)
    assert len(killed) == 1
    assert len(here.tests) == 12
    assert there.as_dict() == here.as_dict()


@on_each_kind
@pytest.mark.filterwarnings("default")
def test_a_database_is_the_same_although_a_worker_is_killed(
    tmp_path: Path, library: Path, dask: Cluster | LocalWorkers
) -> None:
    sources = tmp_path / "sources"
    for copy in ("first", "second"):
        shutil.copytree(library, sources / copy)
    (sources / "broken.bvh").write_text("HIERARCHY\n", "utf-8")
    built = {"mirror": True, "keep_duplicates": True}
    here = sparse_mocap.build_database([sources], tmp_path / "here.smdb", **built)

    def kill_one(done: int, total: int, what: str) -> None:
        if done == 3:
            dask.kill_a_worker()

    with cluster(dask.address) as workers:
        there = sparse_mocap.build_database(
            [sources], tmp_path / "there.smdb", workers=workers, progress=kill_one, **built
        )
    assert (tmp_path / "there.smdb").read_bytes() == (tmp_path / "here.smdb").read_bytes()
    assert there.num_files == here.num_files == 24
    assert there.skipped == here.skipped


@pytest.mark.filterwarnings("default")
def test_the_command_builds_databases_on_the_scheduler(
    cli: Cli, tmp_path: Path, library: Path, dask: Cluster, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(library.parent)  # workers are elsewhere
    for path, more in (("here.smdb", ()), ("there.smdb", ("--scheduler", dask.address))):
        result = cli("database", "build", library.name, "-o", tmp_path / path, *more)
        assert result.exit_code == 0, result.output
    assert (tmp_path / "there.smdb").read_bytes() == (tmp_path / "here.smdb").read_bytes()


@pytest.mark.filterwarnings("default")
def test_says_what_is_wrong_with_a_scheduler(dask: Cluster) -> None:
    dask.stop()
    with (
        pytest.raises(sparse_mocap.ConfigError, match="no Dask scheduler answers"),
        cluster(dask.address, timeout_s=1.0),
    ):
        pass
