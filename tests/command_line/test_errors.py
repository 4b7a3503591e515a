# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Faults of users: exit codes of sysexits(3), one line that helps, nothing left behind."""
import unittest

from support import ProgramTest, run, tiny_place, write_cloud


class Usage(ProgramTest):
    def test_unknown_option_names_the_nearest(self):
        self.run_bad(64, "model", self.cloud, "-o", "m.ply", "--neigbors", "20",
                     says=["--neigbors", "did you mean '--neighbors'"])
        self.run_bad(64, "simulate", "--trajektory=x", says=["did you mean '--trajectory'"])
        for command in ("render", "simulate"):  # --mount has fewer differences
            self.run_bad(64, command, "--out", "x", says=["did you mean '--output'"])

    def test_option_before_the_subcommand(self):
        self.run_bad(64, "--threads", "2", "info", self.cloud, says=["must follow the subcommand"])

    def test_unknown_subcommand_names_the_nearest(self):
        self.run_bad(64, "modle", says=["modle", "did you mean 'model'"])
        self.run_bad(64, "evaluate", "resimulat", says=["did you mean 'resimulate'"])

    def test_missing_subcommand_and_arguments(self):
        self.run_bad(64, says=["--help"])
        self.run_bad(64, "evaluate", says=["evaluate --help"])
        self.run_bad(64, "model", "-o", "m.ply", says=["INPUT"])
        self.run_bad(64, "model", self.cloud, says=["--output"])
        self.run_bad(64, "evaluate", "c2c", self.cloud, says=["ORIGINAL"])
        self.run_bad(64, "evaluate", "c2c", "a", "b", "c", says=["'c'"])

    def test_values(self):
        unlabelled = ["model", self.cloud, "-o", self.folder / "m.ply"]
        model = unlabelled + ["--labels", "semantickitti"]
        self.run_bad(64, *model, "--method", "semantik", says=["did you mean 'semantic'"])
        self.run_bad(64, *model, "--neighbors", "many", says=["--neighbors", "many"])
        self.run_bad(64, *model, "--neighbors", "0")
        self.run_bad(64, *model, "--alpha", "nan")
        self.run_bad(64, *model, "--viewpoint", "1,2", says=["1,2"])
        self.run_bad(64, *model, "--viewpoint", "1,2,inf")
        self.run_bad(64, *model, "--ground-scale", "3,3,x")
        self.run_bad(64, *model, "--scans", "0")
        self.run_bad(64, *model, "--threads", "-1", says=["--threads"])
        self.run_bad(64, *unlabelled, "--method", "semantic", says=["needs labels"])
        self.run_bad(64, "simulate", self.cloud, "--trajectory", self.poses, "-o",
                     self.folder / "s", "--sensor", "hdl-64-papr", says=["hdl-64-paper"])
        self.assertNotIn("m.ply", self.names())

    def test_render_views_exclude_each_other(self):
        model = self.model()
        self.run_bad(64, "render", model, "-o", self.folder / "p.png", "--birds-eye", "--eye",
                     "1,2,3", says=["--birds-eye"])
        self.run_bad(64, "render", model, "-o", self.folder / "p.png", "--width", "0")
        self.run_bad(64, "render", model, "-o", self.folder / "p.png", "--trajectory", self.poses,
                     "--pose", "3", says=["3 poses"])


class Input(ProgramTest):
    def test_missing_files(self):
        out = self.folder / "out"
        gone = self.folder / "gone file.ply"
        for command in (["info", gone], ["model", gone, "-o", self.folder / "out.ply"],
                        ["simulate", gone, "--trajectory", self.poses, "-o", out],
                        ["simulate", self.cloud, "--trajectory", gone, "-o", out],
                        ["render", gone, "-o", self.folder / "out.png"],
                        ["evaluate", "c2c", self.cloud, gone],
                        ["evaluate", "resimulate", gone, gone],
                        ["info", self.cloud, "--config", gone]):
            self.run_bad(66, *command, says=["gone file.ply"])
        self.assertEqual(self.names(), ["cloud.ply", "poses.csv", "tiny.toml"])

    def test_wrong_data(self):
        broken = self.folder / "broken.ply"
        broken.write_bytes(self.cloud.read_bytes()[:-7])
        for command in (["info", broken], ["model", broken, "-o", self.folder / "m.ply"]):
            self.run_bad(65, *command, says=["broken.ply"])
        self.run_bad(65, "simulate", self.cloud, "--trajectory", self.poses, "-o",
                     self.folder / "scans", says=["not a model", "adasplats model"])
        empty = self.folder / "empty.ply"
        write_cloud(empty, [])
        self.run_bad(65, "model", empty, "-o", self.folder / "m.ply", says=["no points"])
        self.assertEqual(self.names(),
                         ["broken.ply", "cloud.ply", "empty.ply", "poses.csv", "tiny.toml"])

    def test_points_that_are_not_finite_with_strict(self):
        write_cloud(self.cloud, tiny_place() + [(float("nan"), 0, 0, 40)])
        model = ["model", self.cloud, "-o", self.folder / "m.ply", "--labels", "semantickitti"]
        self.run_bad(65, *model, "--strict")
        result = run("info", self.cloud)
        self.assertEqual(result.returncode, 0)
        self.assertIn("1 of 3561 points (0.0281 %)", result.stderr)

    def test_unknown_class(self):
        write_cloud(self.cloud, [(x, y, z, 12345) for x, y, z, _ in tiny_place()])
        self.run_bad(65, "model", self.cloud, "-o", self.folder / "m.ply", "--labels",
                     "semantickitti", says=["12345"])

    def test_labels_of_another_count(self):
        scans = self.simulate(self.model())
        label = scans / "sequences" / "00" / "labels" / "000001.label"
        points = (scans / "sequences/00/velodyne/000001.bin").stat().st_size // 16
        label.write_bytes(label.read_bytes()[:-8])
        self.run_bad(65, "info", scans, says=["000001.label", str(points), str(points - 2)])
        self.run_bad(65, "model", scans / "sequences" / "00", "-o", self.folder / "m.ply",
                     says=[str(points), str(points - 2)])

    def test_config_in_place_of_cloud(self):
        self.run_bad(78, "info", self.sensor)


if __name__ == "__main__":
    unittest.main()
