# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""`model --tile --segment`: a network gives the points of a city classes, as in one piece."""
import hashlib
import json
import shlex
import unittest

from support import ProgramTest, run, tiny_place, tree_digest, write_cloud, write_network
from test_city import splats_of

REPLACED = "adasplats: warning: the labels of the points are replaced by the network's (--segment)\n"


class SegmentedCity(ProgramTest):
    """A place of 15 m in tiles of 6 m, each with all that is around it."""

    def setUp(self):
        super().setUp()
        self.network = self.folder / "height.network"
        write_network(self.network, above_m=1.13)
        self.city = self.folder / "city"
        self.unfinished = self.folder / ".city.unfinished"
        self.bare = self.folder / "bare.ply"
        write_cloud(self.bare, tiny_place(), labels=False)
        probe = run("model", self.bare, "-o", self.folder / "probe.ply", "--segment", "--network",
                    self.network)
        if probe.returncode == 69:
            self.assertIn("OpenBLAS", probe.stderr)
            self.skipTest("built without OpenBLAS")
        self.assertEqual((probe.returncode, probe.stderr), (0, ""))

    def options(self, network=None):
        return ["--segment", "--network", network or self.network, "--device", "cpu", "--threads",
                "2"]

    def command(self, *words, output=None, network=None):
        return ["model", self.bare, "-o", output or self.city, "--tile", "6", "--halo", "20",
                *self.options(network), *words]

    def assert_is_whole(self, report, whole, whole_report):
        """The splats of the city are those of a model in one piece, to the last bit."""
        columns, expected = splats_of(whole)
        self.assertIn("property ushort class", columns)
        found = []
        for tile in json.loads((self.city / "city.json").read_text())["tiles"]:
            own_columns, rows = splats_of(self.city / tile["file"])
            if rows:
                self.assertEqual(own_columns, columns)
            found += rows
        self.assertEqual(len(found), len(expected))
        self.assertEqual(set(found), expected)
        self.assertEqual(report["segmentation"], whole_report["segmentation"])
        self.assertIn("segment", report["seconds"])

    def test_is_the_model_in_one_piece(self):
        whole = self.folder / "whole.ply"
        # The second network is the program's own.
        for options in [self.options(), ["--segment", "--device", "cpu"]]:
            for remove in ["movable", "none"]:
                words = [*options, "--remove", remove]
                expected = self.report("model", self.bare, "-o", whole, "--no-refine", *words)
                report = self.report("model", self.bare, "-o", self.city, "--tile", "6", "--halo",
                                     "20", "--overwrite", *words)
                self.assert_is_whole(report, whole, expected)
        self.assertEqual({path.name for path in self.city.iterdir()},
                         {"adasplats.json", "city.json", "common.ply", "levels", "tiles"})

    def test_replaced_labels_give_a_warning(self):
        said = run("model", self.cloud, "-o", self.city, "--tile", "6", "--halo", "20",
                   *self.options())
        self.assertEqual((said.returncode, said.stderr), (0, REPLACED))
        self.assertIn("network height.network", said.stdout)
        self.assertIn("labels in the input were replaced", said.stdout)
        labelled = {path.name: path.read_bytes() for path in (self.city / "tiles").iterdir()}
        self.run_good(*self.command("--overwrite"))
        bare = {path.name: path.read_bytes() for path in (self.city / "tiles").iterdir()}
        self.assertEqual(labelled, bare)

    def test_the_network_is_on_record(self):
        self.run_good(*self.command())
        digest = hashlib.sha256(self.network.read_bytes()).hexdigest()
        files = [self.city / "common.ply", *(self.city / "tiles").iterdir()]
        for file in files:
            head = file.read_bytes()[:2000]
            self.assertIn(f"comment adasplats.network_sha256 {digest}\n".encode(), head)
            self.assertIn(b"comment adasplats.labels semantickitti\n", head)
        record = json.loads((self.city / "adasplats.json").read_text())
        self.assertEqual((record["segment"], record["network"], record["network_sha256"]),
                         (True, str(self.network), digest))
        self.assertIn(digest, self.run_good("info", self.city).stdout)

    def end_early(self, lines):
        return self.kill_behind(self.unfinished / "journal.sha256", lines, *self.command())

    def test_killed_runs_go_on(self):
        whole = self.folder / "whole"
        self.run_good(*self.command(output=whole))
        killed = [self.end_early(lines) for lines in [0, 3, 15, 18, 20, 22, 26, 30, 40]]
        self.assertTrue(any(killed))
        if not self.city.exists():
            self.run_good(*self.command())
        self.assertEqual(tree_digest(self.city), tree_digest(whole))
        self.assertFalse(self.unfinished.exists())

    def test_another_network_does_not_go_on(self):
        self.run_good(*self.command("--plan"))
        other = self.folder / "other.network"
        write_network(other, above_m=2)
        self.run_bad(73, *self.command(network=other), says=["network", "remove it"])
        before = self.network.read_bytes()
        self.network.write_bytes(other.read_bytes())
        self.run_bad(73, *self.command(), says=["network_sha256", "remove it"])
        self.network.write_bytes(before)
        # Nor does a run, or a tile, by the points' own labels.
        by_labels = ["model", self.bare, "-o", self.city, "--tile", "6", "--halo", "20"]
        self.run_bad(73, *by_labels, says=["network was", "remove it"])
        self.run_bad(73, *by_labels, "--only-tile", "x0_y0", says=["network was"])
        self.run_good(*self.command())

    def test_tiles_are_tasks(self):
        whole = self.folder / "whole"
        self.run_good(*self.command(output=whole))
        *lines, _ = self.run_good(*self.command("--plan")).stdout.splitlines()
        self.assertGreater(len(lines), 4)
        commands = [shlex.split(line) for line in lines]
        names = [words[words.index("--only-tile") + 1] for words in commands]
        # Classes were given by the plan: tasks do without the network.
        hidden = self.network.rename(self.folder / "hidden")
        classes = self.unfinished / "layers/0/points" / f"{names[0]}.classes"
        content = classes.read_bytes()
        classes.write_bytes(content[:-1] + bytes([content[-1] ^ 1]))
        self.run_bad(65, *self.command("--only-tile", names[0]), says=[classes.name])
        classes.unlink()
        self.run_bad(65, *self.command("--only-tile", names[0]), says=[classes.name])
        classes.write_bytes(content)
        journal = self.unfinished / "journal.sha256"
        lines = journal.read_text().splitlines(keepends=True)
        journal.write_text("".join(line for line in lines if "classes.json" not in line))
        self.run_bad(66, *self.command("--only-tile", names[0]), says=["classes.json", "--plan"])
        journal.write_text("".join(lines))
        for name in names:
            self.assertIn(".ply done", self.run_good(*self.command("--only-tile", name)).stdout)
        hidden.rename(self.network)
        report = self.report(*self.command())
        self.assertEqual(report["tiles_resumed"], report["tiles"])
        self.assertEqual(tree_digest(self.city), tree_digest(whole))

    def test_impossible_options_are_rejected_as_without_tiles(self):
        self.run_bad(64, *self.command("--labels", "semantickitti"),
                     says=["--labels has no effect with --segment"])
        self.run_bad(64, *self.command("--remove", "moving"),
                     says=["--remove moving", "--remove movable"])
        self.run_bad(66, *self.command(network=self.folder / "none"), says=["none"])
        self.assertFalse(self.unfinished.exists())
        self.assertFalse(self.city.exists())


if __name__ == "__main__":
    unittest.main()
