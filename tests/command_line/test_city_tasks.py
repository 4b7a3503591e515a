# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""`model --tile --plan`: the tiles of a place as commands of their own, for many processes."""
import json
import os
import random
import shlex
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

from support import PROGRAM, ProgramTest, tiny_place, tree_digest, write_cloud


def has_gnu_parallel():
    if shutil.which("parallel") is None:  # there is another program of that name
        return False
    return b"GNU parallel" in subprocess.run(["parallel", "--version"], stdout=subprocess.PIPE,
                                             stderr=subprocess.DEVNULL, check=False).stdout


class CityTasks(ProgramTest):
    """A place of 15 m in tiles of 6 m, each with all that is around it."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.digest = None
        cls.place = Path(tempfile.mkdtemp(prefix="adasplats test ä "))
        cls.addClassCleanup(shutil.rmtree, cls.place, ignore_errors=True)
        write_cloud(cls.place / "cloud.ply", tiny_place())

    def setUp(self):
        super().setUp()
        self.cloud = self.place / "cloud.ply"  # the city holds its path
        self.city = self.folder / "it's a city"
        self.unfinished = self.folder / ".it's a city.unfinished"

    def command(self, *words, output=None):
        return ["model", self.cloud, "--labels", "semantickitti", "--tile", "6", "--halo", "20",
                "--device", "cpu", "--threads", "1", "-o", output or self.city, *words]

    def whole(self):
        """The digest of the city that one command makes; it is made once for all tests."""
        if CityTasks.digest is None:
            output = self.folder / "whole"
            self.run_good(*self.command(output=output))
            CityTasks.digest = tree_digest(output)
        return CityTasks.digest

    def plan(self):
        """The lines of the tasks; the last line is the command that finishes, as a comment."""
        lines = self.run_good(*self.command("--plan")).stdout.splitlines()
        self.assertTrue(lines[-1].startswith("# when all are done: adasplats model "), lines[-1])
        self.assertEqual(shlex.split(lines[-1].partition(": ")[2])[1:],
                         [str(word) for word in self.command()])
        return lines[:-1]

    def task(self, tile):
        return self.command("--only-tile", tile)

    def tiles(self):
        """The tiles of the plan."""
        return [words[words.index("--only-tile") + 1] for words in map(shlex.split, self.plan())]

    def in_shell(self, command, text=""):
        """Runs words with the program in the PATH."""
        path = os.pathsep.join([str(Path(shutil.which(PROGRAM)).resolve().parent),
                                os.environ["PATH"]])
        result = subprocess.run(command, input=text, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, encoding="utf-8", timeout=120,
                                env=dict(os.environ, PATH=path), check=False)
        self.assertEqual((result.returncode, result.stderr), (0, ""), command)
        return result.stdout

    def finish(self):
        """The last command finds all tiles done; the folder is that of one command."""
        report = self.report(*self.command())
        self.assertEqual(report["tiles_resumed"], report["tiles"])
        self.assertEqual(tree_digest(self.city), self.whole())
        self.assertFalse(self.unfinished.exists())

    def start(self, words):
        process = subprocess.Popen([PROGRAM, *map(str, words)], stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def test_lines_run_by_a_shell_one_by_one(self):
        """In any order, by their number as in an array of jobs."""
        lines = self.plan()
        self.assertGreater(len(lines), 4)
        file = self.folder / "tasks"
        file.write_text("\n".join(lines) + "\n", encoding="utf-8")
        order = list(range(1, len(lines) + 1))
        random.Random(3).shuffle(order)
        for number in order:
            said = self.in_shell(["sh", "-c", f'sed -n {number}p "$1" | sh', "sh", str(file)])
            self.assertRegex(said, r"^.*: tiles/x-?\d+_y-?\d+\.ply done\n$")
        self.finish()

    def test_whole_plan_at_once(self):
        """With the comment at its end, by xargs, four at a time."""
        plan = self.run_good(*self.command("--plan")).stdout
        said = self.in_shell(["xargs", "-d", "\\n", "-P", "4", "-I{}", "sh", "-c", "{}"], plan)
        self.assertEqual(said.count(".ply done\n"), plan.count("--only-tile"))
        self.finish()

    @unittest.skipUnless(has_gnu_parallel(), "GNU parallel is not installed")
    def test_gnu_parallel(self):
        plan = self.run_good(*self.command("--plan")).stdout
        said = self.in_shell(["parallel", "--will-cite", "-j", "4"], plan)
        self.assertEqual(said.count(".ply done\n"), plan.count("--only-tile"))
        self.finish()

    def test_what_is_done_is_not_done_again(self):
        first, *others = self.tiles()
        self.assertIn(".ply done", self.run_good(*self.task(first)).stdout)
        tile = self.unfinished / "tiles" / f"{first}.ply"
        before = tile.stat().st_mtime_ns
        self.assertIn("already done", self.run_good(*self.task(first)).stdout)
        self.assertEqual(tile.stat().st_mtime_ns, before)
        # What coreutils make of the note.
        self.in_shell(["sh", "-c", 'cd "$1" && sha256sum --quiet -c *.sha256', "sh",
                       str(tile.parent)])
        # Nor is it planned again.
        self.assertEqual(self.tiles(), others)
        self.assertIn("already done", self.run_good(*self.task(first)).stdout)
        for name in others:
            self.run_good(*self.task(name))
        self.assertEqual(self.tiles(), [])
        self.finish()
        # A line that is run late.
        self.assertIn("already done", self.run_good(*self.task(first)).stdout)
        self.assertEqual(tree_digest(self.city), self.whole())

    def test_killed_tasks(self):
        killed = 0
        for k, name in enumerate(self.tiles()):
            process = self.start(self.task(name))
            time.sleep(0.004 * (k + 1))
            process.kill()
            killed += process.wait() == -signal.SIGKILL
        self.assertGreater(killed, 0)
        # What a task that is killed while it writes leaves.
        (self.unfinished / "tiles" / ".adasplats-7-0.tmp").write_bytes(b"half a tile")
        for name in self.tiles():
            self.run_good(*self.task(name))
        self.finish()

    def test_one_tile_by_several_at_once(self):
        tiles = self.tiles()
        processes = [self.start(self.task(tiles[0])) for _ in range(4)]
        for process in processes:
            out, errors = process.communicate(timeout=100)
            self.assertEqual((process.returncode, errors), (0, b""))
        for name in tiles[1:]:
            self.run_good(*self.task(name))
        self.finish()

    def test_a_run_without_a_plan_makes_what_tasks_did_not(self):
        first = self.tiles()[0]
        self.run_good(*self.task(first))
        report = self.report(*self.command())
        self.assertEqual(report["tiles_resumed"], 2)  # the pilot tile, too
        self.assertEqual(tree_digest(self.city), self.whole())

    def test_inputs_need_not_be_where_tasks_run(self):
        self.whole()
        tiles = self.tiles()
        away = self.folder / "away.ply"
        self.cloud.rename(away)
        for name in tiles:
            self.run_good(*self.task(name))
        away.rename(self.cloud)
        self.finish()

    def test_damaged_tiles_are_made_again(self):
        tiles = self.tiles()
        for name in tiles:
            self.run_good(*self.task(name))
        damaged = [self.unfinished / "tiles" / f"{name}.ply" for name in tiles[:3]]
        content = [path.read_bytes() for path in damaged]
        for path, was in zip(damaged, content):
            path.write_bytes(was[:-1] + bytes([was[-1] ^ 1]))
        self.assertIn(".ply done", self.run_good(*self.task(tiles[0])).stdout)
        self.assertEqual(damaged[0].read_bytes(), content[0])
        note = Path(f"{damaged[1]}.sha256")
        note.write_text("what?\n")
        damaged[1].write_bytes(content[1])
        self.assertIn(".ply done", self.run_good(*self.task(tiles[1])).stdout)
        # The third one by the run that finishes.
        report = self.report(*self.command())
        self.assertEqual(report["tiles_resumed"], report["tiles"] - 1)
        self.assertEqual(tree_digest(self.city), self.whole())

    def test_damage_of_what_tiles_are_made_of(self):
        name = self.tiles()[0]
        for file in ["layers/0/points/points.json", "layers/0/points/spacing.json",
                     "layers/0/points/response.ply", "layers/layers.json",
                     f"layers/0/points/{name}", f"layers/0/rays/{name}.passing"]:
            found = [path for path in self.unfinished.glob(file + "*") if path.is_file()]
            self.assertEqual(len(found), 1, file)
            content = found[0].read_bytes()
            found[0].write_bytes(content + b" ")
            self.run_bad(65, *self.task(name), says=[found[0].name])
            found[0].unlink()
            self.run_bad(65, *self.task(name), says=[found[0].name])
            found[0].write_bytes(content)
        self.assertIn(".ply done", self.run_good(*self.task(name)).stdout)
        tile = self.unfinished / "tiles" / f"{name}.ply"
        self.run_good(*self.command())
        tile = self.city / "tiles" / f"{name}.ply"
        tile.write_bytes(tile.read_bytes() + b" ")
        self.run_bad(65, *self.task(name), says=[tile.name, "--overwrite"])

    def test_points_that_a_stopped_run_removed_are_read_again(self):
        self.plan()
        layer = self.unfinished / "layers" / "0" / "points"
        for name in ["common.ply", "points.json", next(layer.glob("x*")).name]:
            (layer / name).unlink()
            self.plan()
            self.assertTrue((layer / name).exists())
        self.run_good(*self.command())
        self.assertEqual(tree_digest(self.city), self.whole())

    def test_other_settings_and_versions(self):
        name = self.tiles()[0]
        self.run_bad(73, *self.command("--only-tile", name, "--cell", "0.07"),
                     says=["cell", "run --plan again"])
        self.run_bad(73, *self.command("--only-tile", name, "--own-body", "1"), says=["load"])
        self.run_bad(64, *self.command("--only-tile", "x77_y3"), says=["--only-tile x77_y3"])
        content = self.unfinished / "adasplats.json"
        text = content.read_text(encoding="utf-8")
        facts = json.loads(text)
        content.write_text(json.dumps({**facts, "version": "0.0.7"}), encoding="utf-8")
        self.run_bad(73, *self.task(name), says=["version was", "0.0.7", "run --plan again"])
        content.write_text("{", encoding="utf-8")
        self.run_bad(73, *self.task(name), says=["adasplats.json", "damaged"])
        content.write_text(text, encoding="utf-8")
        self.run_bad(66, *self.command("--only-tile", name, output=self.folder / "other"),
                     says=["other", "--plan"])
        # Nothing was done to the folder.
        self.assertIn(".ply done", self.run_good(*self.task(name)).stdout)

    def test_a_plan_that_was_not_finished(self):
        name = self.tiles()[0]
        journal = self.unfinished / "journal.sha256"
        lines = journal.read_text(encoding="utf-8").splitlines(keepends=True)
        journal.write_text("".join(line for line in lines if "spacing" not in line),
                           encoding="utf-8")
        self.run_bad(66, *self.task(name), says=["spacing.json", "--plan"])

    def test_tasks_and_runs_keep_out_of_each_others_way(self):
        first, second, *_ = self.tiles()
        task = self.start(self.task(first))
        self.stop_with_lock(task)
        self.run_bad(73, *self.command(), says=["another process"])
        self.run_good(*self.task(second))  # tasks do not
        task.send_signal(signal.SIGCONT)
        self.assertEqual(task.wait(100), 0)
        run = self.start(self.command())
        self.stop_with_lock(run)
        self.run_bad(73, *self.task(first), says=["another process"])
        run.send_signal(signal.SIGCONT)
        self.assertEqual(run.wait(100), 0)
        self.assertEqual(tree_digest(self.city), self.whole())

    def test_reports(self):
        tasks = self.report(*self.command("--plan"))["tasks"]
        self.assertEqual(tasks, self.tiles())
        report = self.report(*self.task(tasks[0]))
        self.assertEqual((report["tile"], report["was_done"]), (tasks[0], False))
        # Tasks would all write the plan's.
        self.assertNotIn("--report", self.run_good(
            *self.command("--report", self.folder / "r.json", "--plan")).stdout.splitlines()[0])

    def test_options(self):
        for words in [["--plan"], ["--only-tile", "x0_y0"]]:
            self.run_bad(64, "model", self.cloud, "-o", self.folder / "m.ply", *words,
                         says=[words[0], "without --tile"])
        self.run_bad(64, *self.command("--only-tile", "x0_y0", "--plan"), says=["--plan"])
        for name in ["", "x0", "x0_y", "x01_y2", "x1_y2 ", "x1_y99999999999", "../x0_y0"]:
            self.run_bad(64, *self.command("--only-tile", name), says=["--only-tile", "x3_y-2"])
        config = self.folder / "config.toml"
        config.write_text("plan = true\n")
        self.run_bad(64, *self.command("--config", config), says=["--plan", "configuration"])


if __name__ == "__main__":
    unittest.main()
