# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Make cities on many machines: the tasks of 'adasplats model --tile --plan' as Dask futures.

    from adasplats import distributed
    distributed.make_city(["drive"], "city", tile=64, workers=4)            # local processes
    distributed.make_city(["drive"], "city", tile=64, gpus=[0, 1, 2, 3])    # one per GPU
    client = dask.distributed.Client("tcp://head:8786")                     # SSH, Slurm, Kubernetes
    distributed.make_city(["drive"], "city", tile=64, client=client)

Dask manages and schedules the workers. A task is a command in its own process, which ends with its
worker; the files of a killed task do no harm. Workers of a client need this package, the program
adasplats, and the folder of the city under the same path.
Needs Dask: pip install adasplats[distributed], or apt-get install python3-distributed.
"""
from __future__ import annotations

import contextlib
import json
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable, Iterator, Mapping, Sequence, Union

if TYPE_CHECKING:
    import dask.distributed

__all__ = ["TaskError", "make_city", "run_plan"]

Progress = Callable[[str, int, int], object]

# Starts a command that ends when the worker does, also by kill -9: prctl(PR_SET_PDEATHSIG, SIGKILL).
# It is a separate process because few calls are safe between fork and exec in a threaded worker.
_LAUNCHER = """
import ctypes, os, sys
parent = int(sys.argv[1])
ctypes.CDLL(None).prctl(1, 9)
if os.getppid() != parent:
    sys.exit(1)
os.execvp(sys.argv[2], sys.argv[2:])
"""


class TaskError(RuntimeError):
    """A command failed; the message contains its error output."""


def make_city(
    inputs: Sequence[Union[str, os.PathLike]],
    output: Union[str, os.PathLike],
    *,
    tile: float,
    options: Sequence[str] = (),
    client: dask.distributed.Client | None = None,
    workers: int = 4,
    gpus: Sequence[int] | None = None,
    threads: int | None = None,
    retries: int = 3,
    resources: Mapping[str, float] | None = None,
    program: str = "adasplats",
    progress: Progress | bool = True,
) -> dict[str, Any]:
    """Make a city tile by tile, with the bytes of 'adasplats model INPUTS -o OUTPUT --tile TILE'.

    Return its report as a dict. The same call resumes interrupted work.

    tile: side of the square tiles, m. options: further words of the command line, ["--halo", "12"].
    The steps before and after the tiles run in this process; the tiles are tasks of run_plan(),
    which documents the other arguments.
    Raises TaskError (a command failed), ValueError, ImportError (no Dask).
    """
    _import_dask()
    if any(word.partition("=")[0] == "--report" for word in options):
        raise ValueError("options: --report is not allowed; make_city() returns the report")
    has_threads = any(word.partition("=")[0] == "--threads" for word in options)
    command = [_found(program), "model", *map(os.fspath, inputs), "-o", os.fspath(output), "--tile",
               str(tile), *options]
    run_plan(_run([*command, "--plan"]), client=client, workers=workers, gpus=gpus,
             threads=threads if has_threads else _threads(threads, client, workers, gpus),
             retries=retries, resources=resources, program=program, progress=progress)
    with tempfile.TemporaryDirectory(prefix="adasplats-") as folder:
        report = Path(folder) / "report.json"
        _run([*command, "--report", str(report)])
        return json.loads(report.read_text(encoding="utf-8"))


def run_plan(
    plan: str,
    *,
    client: dask.distributed.Client | None = None,
    workers: int = 4,
    gpus: Sequence[int] | None = None,
    threads: int | None = None,
    retries: int = 3,
    resources: Mapping[str, float] | None = None,
    program: str = "adasplats",
    progress: Progress | bool = True,
) -> None:
    """Run the tasks that a command prints with --plan, in the current folder, and wait for all.

    client: Dask client of the workers; None: start `workers` local processes for this call.
    gpus: GPU indices; one local process per GPU in place of `workers`. On a worker of a client, a
    task uses the first GPU of the worker's CUDA_VISIBLE_DEVICES.
    threads: per task; None: as in the plan, 0: all cores.
    retries: maximum number of repetitions of a task that failed or lost its worker more often than
    Dask allows (distributed.scheduler.allowed-failures).
    resources: of the worker, per task, {"GPU": 1, "memory": 16e9}, as in Client.submit(); a worker
    runs only tasks that its free resources allow. Local workers have these resources once.
    progress: True: a bar on stderr with the address of Dask's dashboard; False: nothing; or a
    function of ("tasks", done, total).
    Raises TaskError (a task failed every time; no other task is started), ValueError, ImportError.
    """
    _import_dask()
    if client is not None and gpus is not None:
        raise ValueError("gpus is for local processes; for the workers of a client set their "
                         "CUDA_VISIBLE_DEVICES")
    commands = [shlex.split(line)[1:] for line in plan.splitlines()
                if line.strip() and not line.startswith("#")]
    if threads is not None:
        commands = [[*words[:1], "--threads", str(threads), *words[1:]] for words in commands]
    if not commands:
        return
    with contextlib.ExitStack() as stack:
        if client is None:
            client = stack.enter_context(_local_client(workers, gpus, resources))
        _Run(client, commands, gpus, retries, resources, program, progress).wait()


class _Run:
    """Runs one future per command until all are done."""

    def __init__(self, client, commands, gpus, retries, resources, program, progress):
        self.client = client
        self.commands = commands
        self.retries = retries
        self.resources = dict(resources) if resources else None
        self.arguments = (_local_program(program), os.getcwd(), list(gpus) if gpus else None)
        self.progress = _bar(client) if progress is True else progress or (lambda *_: None)
        self.deaths = [0] * len(commands)

    def submit(self, number):
        return self.client.submit(_run_task, self.commands[number], *self.arguments, pure=False,
                                  retries=self.retries, resources=self.resources,
                                  key=f"task {number + 1}, try {self.deaths[number] + 1}, "
                                      f"{os.getpid()}-{id(self)}")

    def wait(self):
        from dask.distributed import as_completed

        numbers = {self.submit(number): number for number in range(len(self.commands))}
        waiting = as_completed(list(numbers))
        done = 0
        self.progress("tasks", done, len(self.commands))
        try:
            for future in waiting:
                number = numbers.pop(future)
                if self.is_done(future, number):
                    done += 1
                    self.progress("tasks", done, len(self.commands))
                else:
                    again = self.submit(number)
                    numbers[again] = number
                    waiting.add(again)
        finally:
            self.client.cancel(list(numbers), force=True)

    def is_done(self, future, number):
        """False: its workers died, and it will be retried. Raises TaskError if it failed."""
        from dask.distributed import KilledWorker

        if future.status == "finished":
            return True
        error = (future.exception() if future.status == "error"
                 else TaskError(f"a task was {future.status}"))
        lost = isinstance(error, KilledWorker) or future.status == "lost"
        if lost and self.deaths[number] < self.retries:
            self.deaths[number] += 1
            return False
        if isinstance(error, TaskError):
            raise error
        raise TaskError(f"{_text(self.commands[number])}: {error}") from error


def _run_task(words, program, folder, gpus):
    """Run a command on a worker, in `folder`; it ends with the worker."""
    environment = dict(os.environ)
    if gpus:  # names of LocalCluster workers are numbers, which restarts keep
        from dask.distributed import get_worker

        environment["CUDA_VISIBLE_DEVICES"] = str(gpus[int(get_worker().name) % len(gpus)])
    command = [sys.executable, "-c", _LAUNCHER, str(os.getpid()), _found(program), *words]
    try:
        done = subprocess.run(command, cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, encoding="utf-8",
                              errors="replace", check=False)
    except OSError as error:
        raise TaskError(f"{_text(words)}: {error}") from error
    if done.returncode != 0:
        raise TaskError(f"{_text(words)}: {done.stderr.strip() or done.returncode}")


@contextlib.contextmanager
def _local_client(workers, gpus, resources) -> Iterator[Any]:
    """A client of local processes, each of which runs one task at a time."""
    from dask.distributed import Client, LocalCluster

    with LocalCluster(n_workers=len(gpus) if gpus else workers, threads_per_worker=1,
                      processes=True, memory_limit=0, resources=resources) as cluster:
        with Client(cluster) as client:
            yield client


def _threads(threads, client, workers, gpus) -> int | None:
    """By default, local processes share the cores of this machine."""
    if threads is not None or client is not None:
        return threads
    return max(1, len(os.sched_getaffinity(0)) // (len(gpus) if gpus else workers))


def _bar(client) -> Progress:
    """A progress bar on stderr; a terminal overwrites it in place."""
    print(f"adasplats: Dask's dashboard: {client.dashboard_link}", file=sys.stderr)
    is_terminal = sys.stderr.isatty()

    def show(step, done, total):
        if not is_terminal and done not in (0, total):
            return
        begin = "\r" if is_terminal else ""
        end = "\n" if done == total or not is_terminal else ""
        print(f"{begin}{step} [{'#' * (40 * done // total):40}] {done} of {total}", end=end,
              file=sys.stderr, flush=True)

    return show


def _import_dask() -> None:
    try:
        import dask.distributed  # noqa: F401
    except ImportError as error:
        raise ImportError("adasplats.distributed needs Dask: pip install adasplats[distributed], or "
                          "apt-get install python3-distributed") from error


def _found(program: str) -> str:
    path = shutil.which(program)
    if path is None:
        raise TaskError(f"{program}: not found in PATH (set `program` to its path)")
    return path


def _local_program(program: str) -> str:
    """Each worker looks up a name in its PATH; a path becomes absolute."""
    return os.path.abspath(program) if os.sep in program else program


def _text(words: Sequence[str]) -> str:
    return shlex.join(["adasplats", *words])


def _run(command: Sequence[str]) -> str:
    """Run a command; return its output. Its warnings go to stderr."""
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8",
                          errors="replace", check=False)
    if done.returncode != 0:
        raise TaskError(done.stderr.strip() or f"{_text(command[1:])}: {done.returncode}")
    sys.stderr.write(done.stderr)
    return done.stdout
