# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""`model --tile`: a place in tiles, as a folder that other commands take for a model."""
import json
import resource
import signal
import subprocess
import unittest

from support import PROGRAM, ProgramTest, tiny_place, tree_digest, write_cloud


def splats_of(path):
    """The lines of a model's header that say its columns, and its rows as a set of bytes."""
    header, body = path.read_bytes().split(b"end_header\n", 1)
    lines = header.decode().splitlines()
    count = next(int(line.split()[-1]) for line in lines if line.startswith("element vertex"))
    columns = [line for line in lines if line.startswith("property")]
    if count == 0:
        return columns, set()
    size = len(body) // count
    return columns, {body[i * size:(i + 1) * size] for i in range(count)}


class City(ProgramTest):
    """A place of 15 m in tiles of 6 m, each with all that is around it."""

    def setUp(self):
        super().setUp()
        self.city = self.folder / "city"
        self.unfinished = self.folder / ".city.unfinished"

    def command(self, *words, output=None):
        return ["model", self.cloud, "--labels", "semantickitti", "--tile", "6", "--halo", "20",
                "--device", "cpu", "-o", output or self.city, *words]

    def tiles(self, city=None):
        return json.loads(((city or self.city) / "city.json").read_text())["tiles"]

    def test_tiles_together_are_the_model_in_one_piece(self):
        report = self.report(*self.command())
        whole = self.folder / "whole.ply"
        self.run_good("model", self.cloud, "--labels", "semantickitti", "--device", "cpu", "-o",
                      whole, "--no-refine")
        columns, expected = splats_of(whole)
        found = []
        for tile in self.tiles():
            own_columns, rows = splats_of(self.city / tile["file"])
            self.assertEqual(len(rows), tile["splats"])
            if rows:
                self.assertEqual(own_columns, columns)
            found += rows
        self.assertGreater(len(self.tiles()), 4)
        self.assertEqual(len(found), len(expected))
        self.assertEqual(set(found), expected)
        self.assertEqual(report["primitives"], len(expected))
        self.assertEqual(report["points"], sum(tile["points"] for tile in self.tiles()))
        # No more is left than the model.
        self.assertEqual({path.name for path in self.city.iterdir()},
                         {"adasplats.json", "city.json", "common.ply", "levels", "tiles"})

    def test_tiles_come_and_go_along_a_drive(self):
        self.run_good(*self.command())
        whole = self.folder / "whole.ply"
        self.run_good("model", self.cloud, "--labels", "semantickitti", "--device", "cpu", "-o",
                      whole, "--no-refine")
        scans = {}
        for name, model, words in [("whole", whole, []), ("tiles", self.city, []),
                                   ("few", self.city, ["--tile-memory", "1e-9"])]:
            output = self.folder / name
            report = self.report("simulate", model, "--trajectory", self.poses, "--sensor",
                                 self.sensor, "--max-range", "6", "-o", output, "--device", "cpu",
                                 *words)
            self.assertEqual("tiles" in report, name != "whole")
            scans[name] = [path.read_bytes() for path in sorted(output.rglob("*.bin"))]
            if name != "whole":
                self.assertGreater(report["tiles"]["loaded"], 0)
                self.assertGreater(report["tiles"]["max_bytes"], 0)
        self.assertEqual(len(scans["whole"]), 3)
        self.assertGreater(len(scans["whole"][0]), 0)
        self.assertEqual(scans["tiles"], scans["whole"])
        self.assertEqual(scans["few"], scans["whole"])

    def test_other_commands_take_it_for_a_model(self):
        self.run_good(*self.command())
        splats = sum(tile["splats"] for tile in self.tiles())
        facts = self.report("info", self.city)["files"][0]
        self.assertEqual((facts["kind"], facts["tiles"]), ("city of splats", len(self.tiles())))
        whole = self.folder / "whole.ply"
        self.run_good("model", self.cloud, "--labels", "semantickitti", "--device", "cpu", "-o",
                      whole, "--no-refine")
        scans = []
        for model in [self.city, whole]:
            output = self.folder / f"scans of {model.name}"
            self.run_good("simulate", model, "--trajectory", self.poses, "--sensor", self.sensor,
                          "--no-noise", "-o", output)
            scans.append([path.read_bytes() for path in sorted(output.rglob("*.bin"))])
        self.assertEqual(len(scans[0]), 3)
        self.assertEqual(scans[0], scans[1])
        picture = self.folder / "city.png"
        self.run_good("render", self.city, "-o", picture, "--width", "64", "--height", "48")
        self.assertTrue(picture.exists())
        gaussians = self.folder / "one.ply"
        self.run_good("export", self.city, "-o", gaussians, "--format", "gaussian-3d")
        self.assertIn(b"element vertex %d\n" % splats, gaussians.read_bytes()[:400])

    def end_early(self, lines):
        return self.kill_behind(self.unfinished / "journal.sha256", lines, *self.command())

    def test_killed_runs_go_on(self):
        whole = self.folder / "whole"
        self.run_good(*self.command(output=whole))
        killed = [self.end_early(lines) for lines in [0, 3, 12, 20, 30, 33]]
        self.assertTrue(any(killed))
        if not self.city.exists():
            report = self.report(*self.command("--threads", "1"))
            self.assertGreater(report["tiles_resumed"], 0)
        self.assertEqual(tree_digest(self.city), tree_digest(whole))
        self.assertFalse(self.unfinished.exists())

    def test_full_disks_lose_nothing(self):
        whole = self.folder / "whole"
        self.run_good(*self.command(output=whole))
        sizes = sorted({path.stat().st_size for path in whole.rglob("*") if path.is_file()})
        # No file can be larger, of the points, of a tile, of the largest: each time something else
        # has no room.
        for size in [300, sizes[0] + 1, sizes[len(sizes) // 2], sizes[-1] - 1]:
            limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
            self.run_bad(74, *self.command(), preexec_fn=limit)
            self.assertFalse(self.city.exists())
        self.run_good(*self.command())
        self.assertEqual(tree_digest(self.city), tree_digest(whole))

    def test_another_run_does_not_go_on_with_it(self):
        self.assertTrue(self.end_early(3))
        self.run_bad(73, *self.command("--cell", "0.07"), says=["cell", "remove it"])
        self.run_bad(73, *self.command("--own-body", "1"), says=["load", "remove it"])
        # Two runs into one folder.
        process = subprocess.Popen([PROGRAM, *map(str, self.command())], stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE)
        try:
            self.stop_with_lock(process)
            self.run_bad(73, *self.command(), says=["city"])
            process.send_signal(signal.SIGCONT)
            process.communicate(timeout=100)
        finally:
            process.kill()
        self.assertEqual(process.returncode, 0)
        # And what is there is not written over.
        self.run_bad(73, *self.command(), says=["city"])

    def test_damage_is_an_error(self):
        self.run_good(*self.command())
        tile = self.city / max(self.tiles(), key=lambda tile: tile["splats"])["file"]
        content = tile.read_bytes()
        self.run_good("info", self.city, "--verify")
        # Another radius, say: as many splats as before.
        tile.write_bytes(content[:-1] + bytes([content[-1] ^ 1]))
        self.run_good("info", self.city)
        self.run_bad(65, "info", self.city, "--verify", says=[tile.name, "SHA-256"])
        tile.write_bytes(content[:-20])
        self.run_bad(65, "info", self.city, says=[tile.name])
        tile.unlink()
        self.run_bad(66, "info", self.city, says=[tile.name])
        tile.write_bytes(content)
        manifest = self.city / "city.json"
        manifest.write_text(manifest.read_text().replace('"version": 1', '"version": 7'))
        self.run_bad(65, "info", self.city, says=["city.json", "version 7"])

    def test_removal_without_labels_is_an_error_as_in_one_piece(self):
        bare = self.folder / "bare.ply"
        write_cloud(bare, tiny_place(), labels=False)
        self.run_bad(64, "model", bare, "--remove", "moving", "--tile", "6", "-o", self.city,
                     says=["--remove moving"])
        self.assertFalse(self.unfinished.exists())

    def test_tiles_are_chosen_by_the_memory(self):
        place = tiny_place()
        street = self.folder / "street.ply"
        write_cloud(street, [(x + shift, y, z, label) for shift in range(0, 400, 40)
                             for x, y, z, label in place])
        command = ["model", street, "--labels", "semantickitti", "--device", "cpu", "--threads", "2"]
        needed_gb = 10 * len(place) * 340e-9  # kModelBytesAPoint
        # It fits.
        self.run_good(*command, "--memory", f"{2.5 * needed_gb:.6f}", "-o", self.folder / "whole.ply",
                      "--no-refine")
        self.run_bad(64, *command, "--memory", "1", "-o", self.city,
                     says=["fit", "city.ply", "--tile 64"])
        self.run_bad(66, "model", self.folder / "none.las", "--memory", "1", "-o", self.city,
                     says=["none.las"])
        # It does not.
        for text in ["8X", "G", "8 G", "8GiB", ""]:
            self.run_bad(64, *command, f"--memory={text}", "-o", self.city,
                         says=["--memory", "8, 8G or 500M"])
        self.run_bad(64, *command, "--memory", "-1G", "-o", self.city,
                     says=["--memory", "-1G"])
        memory = ["--memory", f"{600 * needed_gb:.3f}MB"]
        self.run_bad(64, *command, *memory, "-o", self.folder / "city.ply",
                     says=["of --memory", "name a folder", "--tile 0"])
        self.run_warned("modelling in tiles of 64 m", *command, *memory, "-o", self.city)
        facts = json.loads((self.city / "city.json").read_text())
        self.assertEqual(facts["tile_m"], 64)
        self.assertGreater(len(facts["tiles"]), 6)
        whole = self.folder / "whole.ply"
        columns, expected = splats_of(whole)
        found = [row for tile in facts["tiles"] for row in splats_of(self.city / tile["file"])[1]]
        self.assertEqual(set(found), expected)
        # One piece was asked for; the tasks say the tiles that were chosen.
        self.run_good(*command, *memory, "--tile", "0", "-o", self.folder / "one.ply")
        plan = self.run_warned("modelling in tiles", *command, *memory, "-o",
                               self.folder / "other", "--plan").stdout
        self.assertTrue(all("--tile 64" in line for line in plan.splitlines()), plan)
        self.run_bad(65, *command, "--memory", "0.0001", "-o", self.folder / "none",
                     says=["street.ply", "tiles of 16 m"])
        self.run_bad(64, *command, *memory, "--method", "basic", "-o", self.folder / "basic.ply",
                     says=["consistent"])

    def test_options(self):
        self.run_bad(64, *self.command("--method", "basic"), says=["consistent"])
        self.run_bad(64, *self.command("--refine"), says=["--refine", "tiles"])
        self.run_bad(64, "model", self.cloud, "-o", self.folder / "m.ply", "--halo", "3",
                     says=["--halo has no effect without --tile"])
        self.run_bad(64, "model", self.cloud, "-o", self.folder / "m.txt", says=[".ply"])
        self.run_bad(64, "info", self.cloud, "--verify", says=["--verify has no effect"])


if __name__ == "__main__":
    unittest.main()
