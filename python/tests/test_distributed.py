# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Cities on Dask workers. Oracle: the bytes that the program writes in one process."""
import builtins
import contextlib
import hashlib
import importlib.util
import os
import shutil
import signal
import threading
import time
from pathlib import Path

import pytest
from conftest import PROGRAM, run_program

from adasplats import distributed

needs_dask = pytest.mark.skipif(importlib.util.find_spec("distributed") is None,
                                reason="Dask's distributed is not installed")
HALO = ["--halo", "6", "--labels", "semantickitti", "--device", "cpu"]


def tree_digest(folder):
    digest = hashlib.sha256()
    for path in sorted(Path(folder).rglob("*")):
        digest.update(str(path.relative_to(folder)).encode())
        if path.is_file():
            digest.update(path.read_bytes())
    return digest.hexdigest()


@pytest.fixture(scope="module")
def whole(street):
    """The digest of the street in tiles of 12 m, by one process."""
    output = street.folder / "whole"
    run_program("model", street.cloud, "-o", output, "--tile", "12.0", *HALO)
    return tree_digest(output)


@contextlib.contextmanager
def cluster(**options):
    from dask.distributed import Client, LocalCluster

    with LocalCluster(n_workers=4, threads_per_worker=1, processes=True, dashboard_address=None,
                      **options) as workers, Client(workers) as client:
        yield workers, client


def is_running(pid):
    """Nor is it one that ended and that nobody asked for."""
    try:
        stat = Path(f"/proc/{pid}/stat").read_text()
    except (FileNotFoundError, ProcessLookupError):
        return False
    return stat.rpartition(")")[2].split()[0] not in "ZX"


class Killer(threading.Thread):
    """Kills one worker after the other (kill -9), at most one a second, while three of four are there:
    a new one takes seconds to begin."""

    MOST = 8

    def __init__(self, workers):
        super().__init__(daemon=True)
        self.workers = workers
        self.killed = 0
        self.ends = threading.Event()

    def run(self):
        # Not for ever: on a slow machine every try of the last task would be killed.
        while self.killed < self.MOST and not self.ends.wait(1):
            # Dask's thread changes its tables meanwhile, and a worker may end before it is killed.
            with contextlib.suppress(KeyError, RuntimeError, ProcessLookupError):
                self.kill_one()

    def kill_one(self):
        at_work = [worker for worker in list(self.workers.scheduler.workers.values())
                   if worker.processing]
        if len(self.workers.scheduler.workers) < 3 or not at_work:
            return
        nanny = self.workers.workers[at_work[self.killed % len(at_work)].name]
        if nanny.process is not None and nanny.process.pid:
            os.kill(nanny.process.pid, signal.SIGKILL)
            self.killed += 1


@needs_dask
def test_workers_are_killed(street, whole, tmp_path):
    # Tasks that take a second on any machine, so that workers can be killed during a task.
    program = tmp_path / "slow adasplats"
    program.write_text('#!/bin/sh\ncase "$*" in *--only-tile*) sleep 0.7;; esac\n'
                       f'exec "{shutil.which(PROGRAM)}" "$@"\n')
    program.chmod(0o755)
    counts = []
    with cluster() as (workers, client):
        killer = Killer(workers)
        killer.start()
        report = distributed.make_city([street.cloud], tmp_path / "city", tile=12.0, options=HALO,
                                       client=client, threads=1, retries=20, program=str(program),
                                       progress=lambda *step: counts.append(step))
        killer.ends.set()
        killer.join()
    assert killer.killed >= 3
    assert tree_digest(tmp_path / "city") == whole
    assert sorted(path.name for path in tmp_path.iterdir()) == ["city", program.name]
    # Tasks made all tiles but one, which make_city() makes itself to estimate the sensor.
    assert report["tiles"] == report["tiles_resumed"] > 8
    assert counts == [("tasks", done, report["tiles"] - 1) for done in range(report["tiles"])]


@needs_dask
def test_processes_of_this_machine(street, whole, tmp_path, capfd, monkeypatch):
    """Paths relative to the current folder, the program by its name, resources, a bar."""
    monkeypatch.chdir(tmp_path)
    program = Path(shutil.which(PROGRAM)).resolve()
    monkeypatch.setenv("PATH", str(program.parent), prepend=os.pathsep)
    distributed.make_city([street.cloud], "city", tile=12.0, options=HALO, workers=2,
                          resources={"memory": 1e9})
    assert tree_digest("city") == whole
    said = capfd.readouterr().err
    assert "dashboard: http://" in said
    assert "tasks [" + "#" * 40 + "]" in said
    with pytest.raises(distributed.TaskError, match=r"not empty \(--overwrite"):
        distributed.make_city([street.cloud], "city", tile=12.0, options=HALO)


@needs_dask
def test_each_card_has_one_worker(tmp_path):
    """Oracle: a fake program that prints the card that it sees."""
    program = tmp_path / "print cards"
    program.write_text('#!/bin/sh\nsleep 0.3\necho "$CUDA_VISIBLE_DEVICES" > "$2"\n')
    program.chmod(0o755)
    plan = "".join(f"adasplats of '{tmp_path}/{k}'\n" for k in range(8))
    distributed.run_plan(plan + "# when all are done: nothing\n", gpus=[5, 2],
                         resources={"GPU": 1}, program=str(program), progress=False)
    cards = [(tmp_path / str(k)).read_text().strip() for k in range(8)]
    assert set(cards) == {"5", "2"}
    with cluster() as (_, client), pytest.raises(ValueError, match="CUDA_VISIBLE_DEVICES"):
        distributed.run_plan(plan, gpus=[5], client=client)


@needs_dask
def test_tasks_that_fail(tmp_path):
    """Tasks are retried `retries` times; then their message is the error."""
    program = tmp_path / "fails at first"
    program.write_text('#!/bin/sh\necho x >> "$2"\n[ $(wc -l < "$2") -ge 3 ] && exit 0\n'
                       'echo "no luck with $2" >&2\nexit 65\n')
    program.chmod(0o755)
    with cluster() as (_, client):
        def run(name, retries):
            distributed.run_plan(f"adasplats of {tmp_path}/{name}\n", client=client,
                                 retries=retries, program=str(program), progress=False)

        run("a", 2)
        assert (tmp_path / "a").read_text() == "x\n" * 3
        with pytest.raises(distributed.TaskError, match=f"adasplats of .*: no luck with {tmp_path}/b"):
            run("b", 1)
        assert (tmp_path / "b").read_text() == "x\n" * 2
        with pytest.raises(distributed.TaskError, match="not found in PATH"):
            distributed.run_plan("adasplats of c\n", client=client, retries=0, program="no-such",
                                 progress=False)


@needs_dask
def test_a_task_ends_with_its_worker(tmp_path):
    program = tmp_path / "sleeps"
    program.write_text('#!/bin/sh\necho $$ >> "$2"\nexec sleep 60\n')
    program.chmod(0o755)
    pids = tmp_path / "pids"
    with cluster() as (workers, client):
        def run():
            with contextlib.suppress(distributed.TaskError):
                distributed.run_plan(f"adasplats of {pids}\n", client=client, retries=0,
                                     program=str(program), progress=False)

        thread = threading.Thread(target=run, daemon=True)
        thread.start()
        killed = 0
        while thread.is_alive():
            started = pids.read_text().split() if pids.exists() else []
            if len(started) == killed:
                time.sleep(0.05)
                continue
            task = int(started[-1])
            worker = int(Path(f"/proc/{task}/stat").read_text().rpartition(")")[2].split()[1])
            assert worker in [nanny.process.pid for nanny in workers.workers.values()
                              if nanny.process is not None]
            os.kill(worker, signal.SIGKILL)
            killed += 1
            for _ in range(100):
                if not is_running(task):
                    break
                time.sleep(0.05)
            assert not is_running(task)
        # Dask gives it to another worker three times.
        assert killed == 4


def test_without_dask(monkeypatch):
    found = builtins.__import__

    def missing(name, *rest):
        if name.partition(".")[0] in ("dask", "distributed"):
            raise ImportError(f"No module named '{name}'")
        return found(name, *rest)

    monkeypatch.setattr(builtins, "__import__", missing)
    for work in (lambda: distributed.make_city(["a.ply"], "b", tile=64),
                 lambda: distributed.run_plan("adasplats version\n")):
        with pytest.raises(ImportError, match=r"pip install adasplats\[distributed\]") as error:
            work()
        assert "\n" not in str(error.value)


@needs_dask
def test_arguments(tmp_path):
    with pytest.raises(ValueError, match="--report"):
        distributed.make_city(["a.ply"], tmp_path / "b", tile=64, options=["--report=c.json"])
    with pytest.raises(distributed.TaskError, match="no-such: not found in PATH"):
        distributed.make_city(["a.ply"], tmp_path / "b", tile=64, program="no-such")
    with pytest.raises(distributed.TaskError, match="a.ply"):
        distributed.make_city([tmp_path / "a.ply"], tmp_path / "b", tile=64, program=PROGRAM)
    distributed.run_plan("# when all are done: nothing\n")


def test_everything_has_a_docstring():
    assert all(getattr(distributed, name).__doc__ for name in distributed.__all__)
