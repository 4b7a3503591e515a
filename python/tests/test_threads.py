# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""The GIL, several threads, Ctrl-C, progress."""
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time

import numpy as np
import pytest
from conftest import unit_rays

import adasplats


def count_while(work):
    """How often another Python thread runs during `work`, and the duration of `work` in s."""
    done = threading.Event()
    counted = []

    def count():
        ticks = 0
        while not done.is_set():
            time.sleep(0.001)
            ticks += 1
        counted.append(ticks)

    thread = threading.Thread(target=count)
    thread.start()
    start = time.monotonic()
    work()
    seconds = time.monotonic() - start
    done.set()
    thread.join()
    return counted[0], seconds


def test_long_calls_release_the_gil(street, scene, poses):
    rays = unit_rays(3_000_000)
    many = np.repeat(poses.poses[:1], 100, axis=0)
    for work in (lambda: scene.cast([0.0, 0, 2], rays),
                 lambda: scene.simulate("hdl-64-paper", many),
                 lambda: adasplats.model(street.cloud, labels="semantickitti"),
                 lambda: scene.render(width=1280, height=720),
                 lambda: adasplats.evaluate.c2c(street.sequence, street.sequence)):
        ticks, seconds = count_while(work)
        # A held GIL would give one tick or two; a busy machine gives fewer than one a millisecond.
        assert ticks > 5 * seconds, (ticks, seconds)


def test_one_scene_in_several_threads(scene, poses):
    rays = unit_rays(100_000)
    expected = scene.cast([0.0, 0, 2], rays).ranges
    scans = scene.simulate("hdl-32-paper", poses)
    wrong = []

    def work(number):
        for _ in range(3):
            if number % 2:
                same = np.array_equal(scene.cast([0.0, 0, 2], rays).ranges, expected)
            else:
                again = scene.simulate("hdl-32-paper", poses)
                same = all(np.array_equal(a.positions, b.positions) for a, b in zip(again, scans))
            if not same:
                wrong.append(number)

    threads = [threading.Thread(target=work, args=(k,)) for k in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong


def test_one_iterator_in_several_threads(scene, poses):
    many = np.repeat(poses.poses[:1], 40, axis=0)
    iterator = scene.iter_scans("hdl-32-paper", many)
    taken = []

    def work():
        for scan in iterator:
            taken.append(scan.time)

    threads = [threading.Thread(target=work) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    np.testing.assert_allclose(sorted(taken), 0.1 * np.arange(40))


def test_threads_do_not_change_results(street, poses):
    scans = [adasplats.Scene(street.model, device="cpu", threads=n).simulate("hdl-32-paper", poses)
             for n in (1, 2, 3)]
    for other in scans[1:]:
        for a, b in zip(scans[0], other):
            np.testing.assert_array_equal(a.positions, b.positions)


def test_breaking_out_of_an_iterator_leaves_nothing(scene, poses):
    before = threading.active_count(), len(os.listdir("/proc/self/task"))
    for scan in scene.iter_scans("hdl-32-paper", np.repeat(poses.poses[:1], 10_000, axis=0)):
        assert len(scan) > 0
        break
    assert threading.active_count() == before[0]
    # The system lists a thread that was joined for a moment longer.
    deadline = time.monotonic() + 10
    while len(os.listdir("/proc/self/task")) > before[1] and time.monotonic() < deadline:
        time.sleep(0.01)
    assert len(os.listdir("/proc/self/task")) <= before[1]


def test_progress_is_reported(street, scene, poses):
    heard = []
    adasplats.model(street.cloud, labels="semantickitti",
                    progress=lambda step, done, total: heard.append((step, done, total)))
    assert len({step for step, _, _ in heard}) > 5
    assert all(list(map(type, call)) == [str, int, int] for call in heard)
    heard.clear()
    scene.simulate("hdl-32-paper", poses, progress=lambda *call: heard.append(call))
    assert heard[0] == ("simulate", 0, len(poses))
    assert heard[-1] == ("simulate", len(poses), len(poses))


def test_an_error_in_progress_ends_the_work(street, scene, poses):
    def fail(step, done, total):
        raise KeyError(step)

    with pytest.raises(KeyError):
        adasplats.model(street.cloud, labels="semantickitti", progress=fail)
    with pytest.raises(KeyError, match="simulate"):
        scene.simulate("hdl-32-paper", poses, progress=fail)


LONG_WORK = {
    "simulate": """
        scene = adasplats.Scene(MODEL, device="cpu")
        poses = np.repeat(np.eye(4)[None], 100_000, axis=0)
        ready()
        scene.simulate("hdl-64-paper", poses)
    """,
    "iter_scans": """
        scene = adasplats.Scene(MODEL, device="cpu")
        ready()
        for scan in scene.iter_scans("hdl-64-paper", np.repeat(np.eye(4)[None], 100_000, axis=0)):
            pass
    """,
    "cast": """
        scene = adasplats.Scene(MODEL, device="cpu")
        rays = np.broadcast_to(np.array([1, 0.1, -0.05], np.float32), (40_000_000, 3))
        ready()
        while True:
            scene.cast([0, 0, 2], rays)
    """,
    "model": """
        cloud = adasplats.read(CLOUD)
        ready()
        while True:
            adasplats.model(cloud, labels="semantickitti")
    """,
    "synth": """
        ready()
        adasplats.synth_street(FOLDER, points=5_000_000, length=50)
    """,
}


@pytest.mark.parametrize("name", LONG_WORK)
def test_interrupt(street, tmp_path, name):
    head = textwrap.dedent(f"""
        import sys
        import numpy as np
        import adasplats
        MODEL, CLOUD, FOLDER = {str(street.model)!r}, {str(street.cloud)!r}, {str(tmp_path)!r}
        def ready():
            print("ready", flush=True)
        try:
    """)
    work = textwrap.indent(textwrap.dedent(LONG_WORK[name]), "    ")
    script = head + work + "\nexcept KeyboardInterrupt:\n    sys.exit(42)\n"
    process = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE)
    try:
        assert process.stdout.readline() == b"ready\n", process.stderr.read()
        time.sleep(0.5)
        assert process.poll() is None
        process.send_signal(signal.SIGINT)
        process.wait(timeout=30)  # every work here lasts longer
        assert process.returncode == 42, process.stderr.read()
    finally:
        process.kill()
        process.communicate()


def test_forked_workers_get_an_error(street, scene, poses):
    """A fork has no threads and must not wait for them."""
    origins, directions = np.zeros(3), unit_rays(10)
    calls = [lambda: scene.cast(origins, directions), lambda: scene.simulate(street.sensor, poses),
             lambda: scene.iter_scans(street.sensor, poses),
             lambda: scene.scan_batches(street.sensor, poses), lambda: scene.render(width=8, height=8)]
    child = os.fork()
    if child == 0:
        errors = 0
        for call in calls:
            try:
                call()
            except RuntimeError as error:
                errors += "'spawn'" in str(error)
        os._exit(errors)
    deadline = time.time() + 60
    while (ended := os.waitpid(child, os.WNOHANG)) == (0, 0):
        if time.time() > deadline:
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)
            pytest.fail("the fork hangs")
        time.sleep(0.01)
    assert os.waitstatus_to_exitcode(ended[1]) == len(calls)
    assert len(scene.cast(origins, directions)) == 10
