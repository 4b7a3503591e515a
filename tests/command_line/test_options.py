# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""No option is taken and ignored: each does something or is refused."""
import json
import unittest

from support import ProgramTest, run, tiny_place, write_cloud


class OptionsTest(ProgramTest):
    def refuse(self, text, *arguments):
        """The program must not do it, name the option, and leave nothing behind."""
        before = self.names()
        self.run_bad(64, *arguments, says=[text])
        self.assertEqual(self.names(), before, arguments)

    def test_model(self):
        run = ["model", self.cloud, "-o", self.folder / "m.ply"]
        for option, value in [("--alpha", "0.2"), ("--neighbors", "40"), ("--radius", "0.1"),
                              ("--denoise-sigmas", "3"), ("--planar-scale", "2,2,2"),
                              ("--selection", "curve")]:
            self.refuse(option, *run, option, value)
        self.refuse("--resample", *run, "--resample")
        for method, option, value in [
                ("basic", "--cell", "0.05"), ("basic", "--smoothness", "0.5"),
                ("basic", "--ground-scale", "1,1,1"), ("basic", "--resample-density", "1"),
                ("descriptors", "--ground-scale", "1,1,1"), ("descriptors", "--settle-rounds", "1"),
                ("semantic", "--planar-scale", "1,1,1")]:
            self.refuse(option, *run, "--labels", "semantickitti", "--method", method, option, value)
        self.refuse("--denoise-votes", *run, "--method", "basic", "--no-denoise", "--denoise-votes",
                    "0.4")
        self.refuse("--strict-rounds", *run, "--balance-rounds", "0", "--strict-rounds", "2")
        config = self.folder / "settings.toml"
        config.write_text("alpha = 0.3\n")
        self.refuse("--alpha", *run, "--config", config)
        # What is turned off and would not have been done is as wished.
        self.model("basic.ply", "--method", "basic", "--no-resample")

    def test_a_draft_is_of_a_quarter(self):
        draft = ["model", self.cloud, "-o", self.folder / "m.ply", "--labels", "semantickitti",
                 "--draft"]
        for option, value in [("--cell", "0.05"), ("--method", "basic"), ("--settle-rounds", "1"),
                              ("--tile", "64"), ("--memory", "1")]:
            self.refuse(option, *draft, option, value)
        of_all = self.report("model", self.cloud, "-o", self.folder / "all.ply", "--labels",
                             "semantickitti")
        of_some = self.report(*draft)
        self.assertNotIn("draft_of", of_all)
        self.assertEqual((of_some["draft_of"], of_some["draft_every"]), ("points", 4))
        self.assertEqual(of_some["points_read"], of_all["points_read"])
        self.assertLess(0.15 * of_all["points_in"], of_some["points_in"])
        self.assertLess(of_some["points_in"], 0.35 * of_all["points_in"])
        self.assertEqual(of_some["cell_m"], 0.1)

    def test_a_draft_of_a_drive_keeps_eight_scans(self):
        self.model()
        poses = self.folder / "slow.csv"
        poses.write_text("time,x,y,z,qw,qx,qy,qz\n" +
                         "".join(f"{0.1 * k:.1f},{4 + 0.3 * k},0,2,1,0,0,0\n" for k in range(25)))
        run("simulate", self.folder / "model.ply", "--trajectory", poses, "--sensor", self.sensor,
            "-o", self.folder / "scans", check=True)
        for scans, every in [("0:5", 1), ("0:15", 1), ("0:16", 2), ("0:25", 3)]:
            report = self.folder / "draft.json"
            run("model", self.folder / "scans" / "sequences" / "00", "-o", self.folder / "m.ply",
                "--draft", "--scans", scans, "--report", report, check=True)
            draft = json.loads(report.read_text(encoding="utf-8"))
            self.assertEqual((draft["draft_of"], draft["draft_every"]), ("scans", every), scans)

    def test_labels_and_removal(self):
        bare, paris = self.folder / "bare.ply", self.folder / "paris.ply"
        write_cloud(bare, tiny_place(), labels=False)
        write_cloud(paris, [(x, y, z, 1) for x, y, z, _ in tiny_place()])
        for command in ["model", "mesh"]:
            made = [command, "-o", self.folder / "out.ply"]
            self.refuse("--labels", *made, bare, "--labels", "semantickitti")
            self.refuse("--remove moving", *made, bare, "--remove", "moving")
            self.refuse("--remove movable", *made, paris, "--remove", "movable")
            self.refuse("--remove moving", *made, paris, "--remove", "moving", "--labels",
                        "paris-carla-3d")
        still = self.folder / "still.toml"
        still.write_text('name = "still"\n[[class]]\nid = 1\nname = "wall"\ngroup = "surface"\n')
        model = self.folder / "out.ply"
        said = run("model", paris, "-o", model, "--labels", still)
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertIn("'still' has no class that is movable; nothing is removed", said.stderr)
        report = self.report("model", self.cloud, "-o", model, "--labels", "semantickitti")
        self.assertEqual(report["points_removed"], {})

    def test_default_method_prints_its_own_figures(self):
        path = self.folder / "m.ply"
        text = self.run_good("model", self.cloud, "-o", path, "--labels", "semantickitti").stdout
        for word in [" cells, ", " seeds; removed ", " measured rays"]:
            self.assertIn(word, text)
        for word in ["R 0", "E 0", "noisy", "resampled"]:
            self.assertNotIn(word, text)
        report = self.report("model", self.cloud, "-o", path, "--labels", "semantickitti")
        self.assertNotIn("radius_m", report)
        self.assertGreaterEqual(report["cells"], report["seeds"])
        self.assertGreaterEqual(report["seeds"] - report["seeds_removed"], 1)
        self.assertGreater(report["rays"], 0)
        text = self.run_good("model", self.cloud, "-o", path, "--method", "basic", "--labels",
                             "semantickitti").stdout
        for word in ["noisy points removed", "R ", "E "]:
            self.assertIn(word, text)

    def test_mesh(self):
        run = ["mesh", self.cloud, "-o", self.folder / "mesh.ply"]
        for option, value in [("--depth", "9"), ("--trim", "5"), ("--poisson-program", "open3d")]:
            self.refuse(option, *run, option, value)
        for option in ["--voxel", "--sigma", "--truncation"]:
            self.refuse(option, *run, "--method", "poisson", option, "0.5")

    def test_info_of_a_sequence(self):
        sequence = self.simulate(self.model()) / "sequences" / "00"
        whole = self.report("info", sequence)["files"][0]
        part = self.report("info", sequence, "--scans", "1:2")["files"][0]
        self.assertEqual((whole["scans"], part["scans"], part["scans_in_all"]), (3, 2, 3))
        self.assertLess(part["points"], whole["points"])
        self.assertAlmostEqual(part["driven_m"], 2, places=3)
        self.assertIn("2 of 3", self.run_good("info", sequence, "--scans", "1:2").stdout)
        self.refuse("3 scans", "info", sequence, "--scans", "5:2")
        self.refuse("--viewpoint", "info", sequence, "--viewpoint", "0,0,0")

    def test_info_of_a_model(self):
        model = self.model()
        self.refuse("--scans", "info", model, "--scans", "0:1")
        self.refuse("--salvage", "info", model, "--salvage")
        self.refuse("--labels", "info", "--labels", "semantickitti")
        self.assertIn("40 road", self.run_good("info", model, "--labels", "semantickitti").stdout)
        self.assertIn("40", self.run_good("info", model, "--labels", "paris-carla-3d").stdout)
        self.assertNotIn("road", self.run_good("info", model, "--labels", "paris-carla-3d").stdout)

    def test_pictures(self):
        model, out = self.model(), self.folder / "out.png"
        self.refuse("--pose", "render", model, "-o", out, "--pose", "1")
        self.refuse("--fov", "render", model, "-o", out, "--birds-eye", "--fov", "60")
        self.refuse("--samples", "render", self.cloud, "-o", out, "--samples", "2")
        for option, value in [("--picture-width", "64"), ("--eye", "0,0,1"), ("--target", "0,0,1")]:
            self.refuse(option, "evaluate", "c2c", self.cloud, self.cloud, option, value)
        self.refuse("--labels", "evaluate", "c2c", self.cloud, self.cloud, "--labels",
                    "semantickitti")
        self.refuse("--nearest-classes", "evaluate", "c2c", self.cloud, self.cloud,
                    "--nearest-classes")

    def test_scans(self):
        model = self.model()
        run = ["simulate", model, "--trajectory", self.poses, "--sensor", self.sensor, "-o",
               self.folder / "new"]
        self.refuse("--range-noise", *run, "--no-noise", "--range-noise", "0.1")
        self.refuse("--points", *run, "--points", "deskewed")
        for option in ["--rate", "--spacing", "--fog"]:
            self.refuse(option, *run, option, "0")
        scans = self.simulate(model)
        sequence = scans / "sequences" / "00"
        self.refuse("--fog", "simkitti32", sequence, "-o", self.folder / "new", "--fog", "0")
        self.refuse("--picture-width", "evaluate", "resimulate", model, sequence, "--picture-width",
                    "64")
        self.refuse("--keep-moving", "evaluate", "resimulate", model, sequence, "--keep-moving",
                    "--drop-movable")
        self.refuse("--sensor", "evaluate", "echoes", model, sequence, "--sensor",
                    "velodyne-hdl-64e-kitti")
        self.refuse("--scans", "evaluate", "segmentation", self.cloud, self.cloud, "--scans", "0:1")
        self.refuse("--labels", "evaluate", "presence", model, self.unlabelled(), "--labels",
                    "semantickitti")
        self.refuse("--viewpoint", "export", model, "-o", self.folder / "out.glb", "--viewpoint",
                    "0,0,0")
        self.refuse("labels have no effect", "export", sequence, "-o", self.folder / "out.mcap", "--labels",
                    "semantickitti")
        self.refuse("--label-field", "export", sequence, "-o", self.folder / "out.mcap",
                    "--label-field", "label")
        self.refuse("--moving-radius", "simkitti32", sequence, "-o", self.folder / "out",
                    "--no-moving", "--moving-radius", "0.2")
        self.refuse("--model-every", "simkitti32", sequence, "-o", self.folder / "out", "--model",
                    model, "--model-every", "2")
        self.refuse("--max-driving-scans", "synth", "street", "-o", self.folder / "out",
                    "--driving-spacing", "0", "--max-driving-scans", "3")

    def unlabelled(self):
        path = self.folder / "unlabelled.ply"
        write_cloud(path, tiny_place(), labels=False)
        return path


if __name__ == "__main__":
    unittest.main()
