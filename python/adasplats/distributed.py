# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Cities on many machines: the tasks of 'adasplats model --tile --plan' as Dask's futures.

    from adasplats import distributed
    distributed.make_city(["drive"], "city", tile=64, workers=4)            # processes of this machine
    distributed.make_city(["drive"], "city", tile=64, gpus=[0, 1, 2, 3])    # one a card
    client = dask.distributed.Client("tcp://head:8786")                     # SSH, Slurm, Kubernetes
    distributed.make_city(["drive"], "city", tile=64, client=client)

Which workers there are, what they are given and when is Dask's. A task is a command of its own, run
in a process that ends with its worker; what a killed one leaves does no harm. Workers of a client
need this package, the program adasplats, and the folder that the city is made in under the same path.
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
# In a process of its own, since a worker has threads, between whose fork and exec little is safe.
_LAUNCHER = """
import ctypes, os, sys
parent = int(sys.argv[1])
ctypes.CDLL(None).prctl(1, 9)
if os.getppid() != parent:
    sys.exit(1)
os.execvp(sys.argv[2], sys.argv[2:])
"""


class TaskError(RuntimeError):
    """A command that failed, with what it said."""


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
    """Models a place tile by tile, as 'adasplats model INPUTS -o OUTPUT --tile TILE' does, with the
    same bytes; gives the keys of its report. A call that was interrupted goes on when it is made again.

    options: further words of the command line, ["--halo", "12"]. What comes before the tiles, and the
    end, are done where this is called; the tiles are tasks, as run_plan() runs them, which tells
    of the other arguments.
    Raises TaskError (a command failed, with what it said), ImportError (no Dask).
    """
    _import_dask()
    if any(word.partition("=")[0] == "--report" for word in options):
        raise ValueError("options: --report: the report is what make_city() gives back")
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
    """Runs the tasks that a command prints with --plan, in the current folder, and waits for all.

    client: whose workers do it; None: `workers` processes of this machine, which are ended behind it.
    gpus: numbers of cards, each for one process of this machine in place of `workers`; workers of
    a client see those of their CUDA_VISIBLE_DEVICES, of which a task takes the first.
    threads: of each task; None: as the plan says, 0: all cores.
    retries: how often a task is run again that failed, or whose worker died more often than Dask
    itself allows for (distributed.scheduler.allowed-failures).
    resources: what a task takes of its worker, {"GPU": 1, "memory": 16e9}, as Client.submit has it;
    workers without as much that is free get none. Workers of this machine have it once.
    progress: a bar on stderr with the address of Dask's dashboard; or what is called with
    ("tasks", done, all); False: nothing.
    Raises TaskError (a task failed each time, with what it said; no other is begun), ImportError.
    """
    _import_dask()
    if client is not None and gpus is not None:
        raise ValueError("gpus are of processes that are started here: a worker of a client has the "
                         "card that its CUDA_VISIBLE_DEVICES says")
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
    """The futures of commands, one each, until all are done."""

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
        """False: its workers died, and it is to be tried again. Raises what it failed with."""
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
    """A command on a worker, in `folder`; ends when the worker does."""
    environment = dict(os.environ)
    if gpus:  # workers of a LocalCluster have numbers as names, which they keep when they start anew
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
    """Processes of this machine, one task at a time each."""
    from dask.distributed import Client, LocalCluster

    with LocalCluster(n_workers=len(gpus) if gpus else workers, threads_per_worker=1,
                      processes=True, memory_limit=0, resources=resources) as cluster:
        with Client(cluster) as client:
            yield client


def _threads(threads, client, workers, gpus) -> int | None:
    """By default the cores of this machine are shared by the processes that are started here."""
    if threads is not None or client is not None:
        return threads
    return max(1, len(os.sched_getaffinity(0)) // (len(gpus) if gpus else workers))


def _bar(client) -> Progress:
    """A line on stderr that fills up; a terminal writes it over."""
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
        raise TaskError(f"{program}: there is no such program in the PATH; `program` names it")
    return path


def _local_program(program: str) -> str:
    """A name stays one, to be found by each worker; a path must mean the same in other folders."""
    return os.path.abspath(program) if os.sep in program else program


def _text(words: Sequence[str]) -> str:
    return shlex.join(["adasplats", *words])


def _run(command: Sequence[str]) -> str:
    """A command of this process; gives what it prints. Warnings go to stderr."""
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8",
                          errors="replace", check=False)
    if done.returncode != 0:
        raise TaskError(done.stderr.strip() or f"{_text(command[1:])}: {done.returncode}")
    sys.stderr.write(done.stderr)
    return done.stdout
