# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""`model --add-to`: points are added to a city that was made with --keep-points."""
import json
import shlex
import shutil
import subprocess
import unittest

from support import PROGRAM, ProgramTest, run, tiny_place, tree_digest, write_cloud, write_network

TILE, HALO = 6, 2


def moved(points, x=0.0, y=0.0, z=0.0):
    return [(px + x, py + y, pz + z, label) for px, py, pz, label in points]


def reaches(point, tile):
    """Whether a point, or its ray (as write_cloud has it), comes into a tile with its halo."""
    x, y, z, _ = point
    low_x, low_y = TILE * tile["x"] - HALO, TILE * tile["y"] - HALO
    side = TILE + 2 * HALO
    # The ray stands above (x, 0): its ways in x are none, in y from 0 to y.
    return low_x <= x <= low_x + side and low_y <= max(0, y) and min(0, y) <= low_y + side


class CityAddition(ProgramTest):
    """A street of 39 m, of which the first 15 m are a city and the rest is added, from 9 m on."""

    def setUp(self):
        super().setUp()
        self.first = self.folder / "first"
        self.both = self.folder / "both"
        self.unfinished = self.folder / ".both.unfinished"
        self.new = self.folder / "new.ply"
        self.new_points = moved(tiny_place(2), 9)
        write_cloud(self.new, self.new_points)

    def model(self, cloud, output, *words):
        return ["model", cloud, "--labels", "semantickitti", "--device", "cpu", "-o", output, *words]

    def make_first(self, *words):
        self.run_good(*self.model(self.cloud, self.first, "--tile", TILE, "--halo", HALO,
                                  "--keep-points", *words))

    def addition(self, *words, new=None, to=None, output=None):
        return self.model(new or self.new, output or self.both, "--add-to", to or self.first,
                          *words)

    def tiles(self, city):
        tiles = json.loads((city / "city.json").read_text())["tiles"]
        return {(tile["x"], tile["y"]): tile for tile in tiles}

    def test_what_is_reached_is_modelled_again(self):
        self.make_first()
        before = tree_digest(self.first)
        report = self.report(*self.addition())
        self.assertEqual(tree_digest(self.first), before)
        old, new = self.tiles(self.first), self.tiles(self.both)
        self.assertLess(set(old), set(new))
        kept = 0
        for key, tile in new.items():
            is_reached = any(reaches(point, tile) for point in self.new_points)
            kept += not is_reached
            if not is_reached:
                self.assertEqual(tile, old[key])
                file = tile["file"]
                self.assertEqual((self.both / file).read_bytes(), (self.first / file).read_bytes())
            elif key in old:
                self.assertNotEqual(tile["sha256"], old[key]["sha256"])
        self.assertEqual((report["tiles_kept"], report["tiles_resumed"]), (kept, 0))
        self.assertGreater(kept, 1)
        self.assertEqual(report["points"], 2 * len(self.new_points))
        self.assertLess(report["fit"]["tile_shift_m"], 0.02)
        self.assertEqual(self.report("info", self.both, "--verify")["files"][0]["tiles"], len(new))
        # Of both its splats lie on the ground and the wall.
        facts = self.report("info", self.both)["files"][0]
        self.assertGreater(facts["splats"], 1.3 * self.report("info", self.first)["files"][0]["splats"])

    def test_is_about_the_city_of_all_at_once(self):
        self.make_first()
        self.run_good(*self.addition())
        whole = self.folder / "whole"
        self.run_good("model", self.cloud, self.new, "--labels", "semantickitti", "--device", "cpu",
                      "-o", whole, "--tile", TILE, "--halo", HALO)
        old, new = self.tiles(whole), self.tiles(self.both)
        self.assertEqual(set(old), set(new))
        for key, tile in new.items():
            self.assertEqual(tile["points"], old[key]["points"])
            self.assertLessEqual(abs(tile["splats"] - old[key]["splats"]),
                                 0.2 * old[key]["splats"] + 20, key)

    def test_third_points_are_added_to_two(self):
        self.make_first()
        self.run_good(*self.addition())
        third = self.folder / "third.ply"
        write_cloud(third, moved(tiny_place(3), 18))
        shutil.rmtree(self.first)  # what it has in common with the second stays
        three = self.folder / "three"
        report = self.report(*self.addition(new=third, to=self.both, output=three))
        self.assertGreater(report["tiles_kept"], len(self.tiles(self.both)) // 2 - 1)
        self.assertEqual(report["points"], 3 * len(self.new_points))
        content = json.loads((three / "adasplats.json").read_text())
        inputs = [content["inputs"], content["added_to"]["made_of"]["inputs"],
                  content["added_to"]["made_of"]["added_to"]["made_of"]["inputs"]]
        self.assertEqual([[name.rpartition("/")[2] for name in names] for names in inputs],
                         [["third.ply"], ["new.ply"], ["cloud.ply"]])

    def test_killed_runs_go_on(self):
        self.make_first()
        expected = self.folder / "expected"
        self.run_good(*self.addition(output=expected))
        killed = [self.kill_behind(self.unfinished / "journal.sha256", lines, *self.addition())
                  for lines in [0, 5, 30, 60, 80, 100]]
        self.assertTrue(any(killed))
        if not self.both.exists():
            self.run_good(*self.addition("--threads", "1"))
        self.assertEqual(tree_digest(self.both), tree_digest(expected))

    def test_tiles_as_tasks(self):
        self.make_first()
        expected = self.folder / "expected"
        self.run_good(*self.addition(output=expected))
        lines = self.run_good(*self.addition("--plan")).stdout.splitlines()
        self.assertEqual(len(lines) - 1, len(self.tiles(expected)) -
                         self.report(*self.addition(output=self.folder / "x"))["tiles_kept"])
        # The city that they are added to need not be there.
        hidden = self.first.rename(self.folder / "hidden")
        for line in lines[:-1]:
            words = shlex.split(line)
            subprocess.run([PROGRAM, *words[1:]], cwd=self.folder, check=True,
                           stdout=subprocess.DEVNULL)
        hidden.rename(self.first)
        last = shlex.split(lines[-1].partition(": ")[2])
        subprocess.run([PROGRAM, *last[1:]], check=True, stdout=subprocess.DEVNULL)
        self.assertEqual(tree_digest(self.both / "tiles"), tree_digest(expected / "tiles"))

    def test_tasks_need_the_whole_plan(self):
        self.make_first()
        self.assertTrue(self.kill_behind(self.unfinished / "journal.sha256", 5,
                                         *self.addition("--plan")))
        self.run_bad(66, *self.addition("--only-tile", "x0_y0"), says=["plan"])

    def test_points_that_lie_beside_are_an_error(self):
        self.make_first()
        for name, shift in [("high", {"z": 0.3}), ("aside", {"y": -0.4})]:
            cloud = self.folder / f"{name}.ply"
            write_cloud(cloud, moved(self.new_points, **shift))
            self.run_bad(65, *self.addition(new=cloud), says=["first", "--max-shift", "0.1 m"])
            self.assertFalse(self.both.exists())
            self.assertFalse(self.unfinished.exists())
        # The same command takes what was mended, and not what it read before.
        write_cloud(self.folder / "aside.ply", self.new_points)
        self.run_good(*self.addition(new=self.folder / "aside.ply"))
        shutil.rmtree(self.both)
        high = self.folder / "high.ply"
        report = self.report(*self.addition("--max-shift", "0.5", new=high))
        self.assertAlmostEqual(report["fit"]["shift_m"][2], -0.3, delta=0.01)

    def test_distant_points_are_reported_as_disjoint(self):
        self.make_first()
        far = self.folder / "far.ply"
        write_cloud(far, moved(self.new_points, 60))
        self.run_warned("their fit cannot be checked", *self.addition(new=far))
        old, new = self.tiles(self.first), self.tiles(self.both)
        self.assertEqual([tile for key, tile in new.items() if key in old], list(old.values()))
        self.assertGreater(sum(tile["splats"] for key, tile in new.items() if key not in old), 100)

    def test_other_points_and_settings_are_errors(self):
        bare = self.folder / "bare.ply"
        write_cloud(bare, tiny_place(), labels=False)
        self.make_first()
        without = self.folder / "without"
        self.run_good(*self.model(self.cloud, without, "--tile", TILE))
        for code, words, says in [
                (64, self.addition(to=without), ["without", "--keep-points"]),
                (64, self.addition("--tile", "7"), ["first", "tile_m", "7"]),
                (64, self.addition("--tile", "0"), ["--add-to", "--tile 0"]),
                (64, self.model(self.new, self.both, "--tile", TILE, "--max-shift", "1"),
                 ["--max-shift", "--add-to"]),
                (64, self.addition("--cell", "0.07"), ["first", "cell_m", "0.07"]),
                (64, self.addition("--remove", "none"), ["first", "remove"]),
                (64, self.addition("--no-reflectance"), ["first", "reflectances"]),
                (64, self.addition(output=self.first), ["first"]),
                (64, self.addition(output=self.first / "inside"), ["first"]),
                (66, self.addition(to=self.folder / "nowhere"), ["nowhere"]),
                (66, self.addition(to=self.cloud), ["cloud.ply"]),
                (65, ["model", bare, "-o", self.both, "--add-to", self.first, "--device", "cpu"],
                 ["first", "attributes", "classes"]),
                (65, ["model", self.new, "-o", self.both, "--add-to", self.first, "--device", "cpu",
                      "--labels", "paris-carla-3d"], ["first", "semantickitti", "--labels"])]:
            result = self.run_bad(code, *words, says=says)
            self.assertNotIn("Traceback", result.stderr)
            self.assertFalse(self.both.exists(), words)
            shutil.rmtree(self.unfinished, ignore_errors=True)

    def test_damaged_points_are_errors(self):
        self.make_first()
        file = sorted(self.first.glob("layers/0/points/*.points"))[0]
        content = file.read_bytes()
        file.write_bytes(content[:-1] + bytes([content[-1] ^ 1]))
        self.run_bad(65, "info", self.first, "--verify", says=[file.name])
        self.run_bad(65, *self.addition(), says=[file.name])
        file.unlink()
        self.run_bad(66, *self.addition(), says=[file.name])
        self.run_bad(66, "info", self.first, "--verify", says=[file.name])
        file.write_bytes(content)
        self.run_good(*self.addition())

    def test_classes_by_a_network(self):
        network = self.folder / "height.network"
        write_network(network, above_m=1.13)
        options = ["--segment", "--network", network, "--device", "cpu"]
        bare, more = self.folder / "bare.ply", self.folder / "more.ply"
        write_cloud(bare, tiny_place(), labels=False)
        write_cloud(more, self.new_points, labels=False)
        probe = run("model", bare, "-o", self.folder / "probe.ply", *options)
        if probe.returncode == 69:
            self.assertIn("OpenBLAS", probe.stderr)
            self.skipTest("built without OpenBLAS")
        self.run_good("model", bare, "-o", self.first, "--tile", TILE, "--halo", HALO,
                      "--keep-points", *options)
        report = self.report("model", more, "-o", self.both, "--add-to", self.first, *options)
        counted = sum(report["segmentation"]["classes"].values())
        self.assertEqual(counted, len(self.new_points))
        write_network(network, above_m=1.2)
        self.run_bad(64, "model", more, "-o", self.folder / "x", "--add-to", self.first, *options,
                     says=["first", "--network"])


if __name__ == "__main__":
    unittest.main()
