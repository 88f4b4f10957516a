# SPDX-License-Identifier: GPL-3.0-or-later
import os
import sys
import threading

import pytest

from blender_addon.session import job as jobs
from blender_addon.session.errors import InputError
from blender_addon.session.job import Cancelled, Job


def _until_stopped(progress):
    """Work without end that asks at each step whether to go on."""
    while progress(1, 4, "clip.bvh"):
        pass
    raise RuntimeError("stopped")


@pytest.fixture(autouse=True)
def _no_job_is_left():
    yield
    assert jobs.current() is None


def test_run_returns_the_result_and_tells_the_listener():
    heard = []
    job = Job("Counting", lambda progress: [progress(n, 4, f"number {n}") for n in range(5)])
    assert job.run(lambda: heard.append((job.fraction, job.what))) == [True] * 5
    assert heard == [(n / 4, f"number {n}") for n in range(5)]


def test_start_works_on_another_thread():
    job = Job("Asking", lambda progress: threading.current_thread() is threading.main_thread())
    job.start()
    job.join()
    assert job.result() is False


@pytest.mark.skipif(sys.platform != "linux", reason="threads have no priority of their own")
def test_the_window_goes_before_the_work():
    own = os.getpriority(os.PRIO_PROCESS, 0)

    def work(progress):
        inherited = []
        thread = threading.Thread(target=lambda: inherited.append(os.getpriority(0, 0)))
        thread.start()
        thread.join()
        return [os.getpriority(os.PRIO_PROCESS, 0), *inherited]

    job = Job("Working", work)
    job.start()
    job.join()
    assert job.result() == [min(own + 5, 19)] * 2
    assert os.getpriority(os.PRIO_PROCESS, 0) == own


def test_cancel_ends_the_work():
    job = Job("Working", _until_stopped)
    job.start()
    assert jobs.current() is job
    job.cancel()
    job.join()
    assert not job.is_running
    with pytest.raises(Cancelled):
        job.result()


def test_work_that_was_done_before_it_was_cancelled_counts():
    job = Job("Working", lambda progress: 42)
    job.start()
    job.join()
    job.cancel()
    assert job.result() == 42


def test_errors_come_out_where_the_result_is_asked_for():
    job = Job("Failing", lambda progress: 1 // 0)
    job.start()
    job.join()
    with pytest.raises(ZeroDivisionError):
        job.result()


def test_one_job_at_a_time():
    first = Job("First", _until_stopped)
    first.start()
    for begin in (Job("Second", len).start, Job("Third", len).run):
        with pytest.raises(InputError, match="First is still running"):
            begin()
    assert jobs.current() is first
    jobs.cancel_current()
    assert not first.is_running


@pytest.mark.parametrize(("done", "total", "fraction"), [(0, 0, 0), (-1, 4, 0), (9, 4, 1)])
def test_fraction_stays_between_nothing_and_all(done, total, fraction):
    job = Job("Odd", lambda progress: progress(done, total, ""))
    job.run()
    assert job.fraction == fraction


def test_cancel_current_without_a_job_is_nothing():
    jobs.cancel_current()
