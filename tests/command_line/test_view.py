# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""The viewer's command: what it shows, what it refuses, how it ends. Attacks: tests/server."""
import json
import signal
import subprocess
import unittest
import urllib.error
import urllib.request

from support import PROGRAM, ProgramTest


class ViewTest(ProgramTest):
    def setUp(self):
        super().setUp()
        found = subprocess.run([PROGRAM, "view", self.folder / "none.ply"], stderr=subprocess.PIPE,
                               encoding="utf-8")
        if "without the viewer" in found.stderr:
            self.assertEqual(found.returncode, 69)
            self.skipTest("built without the viewer's page")

    def serve(self, *arguments):
        """Starts the program; gives back the process and the page's address."""
        process = subprocess.Popen([PROGRAM, "view", *map(str, arguments), "--no-browser"],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        url = process.stdout.readline().strip()
        self.assertTrue(url.startswith("http://127.0.0.1:"), (url, process.poll()))
        return process, url

    def scene(self, *arguments):
        process, url = self.serve(*arguments)
        with urllib.request.urlopen(url + "scene.json", timeout=20) as answer:
            scene = json.load(answer)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=20), 130)
        return scene

    def test_a_model(self):
        scene = self.scene(self.model(), "--sensor", "velodyne-vlp-16", "--poses", self.poses)
        self.assertEqual([layer["kind"] for layer in scene["layers"]], ["splats"])
        self.assertTrue(scene["can_simulate"])
        self.assertEqual(scene["sensor"], "velodyne-vlp-16")
        self.assertEqual(scene["start_pose"][:3], [4, 0, 2])
        self.assertEqual(len(scene["trajectories"][0]["poses"]), 3)

    def test_layers_beside_the_model(self):
        model = self.model()
        scans = self.simulate(model)
        errors = self.folder / "errors.ply"
        self.run_good("evaluate", "c2c", scans, self.cloud, "--errors", errors)
        scene = self.scene(model, "--cloud", self.cloud, "--errors", errors, "--sequence", scans)
        self.assertEqual([layer["kind"] for layer in scene["layers"]],
                         ["splats", "points", "points"])
        self.assertEqual([layer["has_errors"] for layer in scene["layers"]], [False, False, True])
        self.assertEqual(len(scene["scans"]), 3)

    def test_errors_of_the_splats_that_beams_hit(self):
        model, errors = self.model(), self.folder / "errors.ply"
        scans = self.simulate(model)
        self.run_good("evaluate", "resimulate", model, scans / "sequences" / "00", "--errors",
                      errors)
        scene = self.scene(model, "--errors", errors)
        self.assertEqual([layer["has_errors"] for layer in scene["layers"]][:2], [True, True])
        # Another model's: an error, as of `render`; as points they are shown without a model.
        other = self.model("other.ply", "--method", "basic")
        self.run_bad(65, "view", other, "--errors", errors, "--no-browser",
                     says=["errors.ply", "another model"])
        self.assertTrue(self.scene(errors)["layers"][0]["has_errors"])

    def test_errors_that_name_no_splats(self):
        model, errors = self.model(), self.folder / "errors.ply"
        self.run_good("evaluate", "c2c", self.cloud, self.cloud, "--errors", errors)
        process, url = self.serve(model, "--errors", errors)
        with urllib.request.urlopen(url + "scene.json", timeout=20) as answer:
            layers = json.load(answer)["layers"]
        self.assertEqual([layer["has_errors"] for layer in layers], [False, True])
        process.send_signal(signal.SIGINT)
        said = process.communicate(timeout=20)[1]
        self.assertRegex(said, "warning: .*errors.ply: has no column 'splat'")

    def test_errors_with_a_sign_have_parts(self):
        model = self.model()
        errors = self.folder / "errors.ply"
        rows = ["0 0 0 0.02", "1 0 0 -0.2", "2 0 0 0.3", "3 0 0 -2", "4 0 0 nan", "5 0 0 nan"]
        errors.write_text("ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\n"
                          "property float y\nproperty float z\nproperty float error_m\n"
                          "end_header\n" + "\n".join(rows) + "\n")
        scene = self.scene(model, "--errors", errors)
        self.assertEqual([(layer["part"], layer["count"]) for layer in scene["layers"][1:]],
                         [("", 6), ("early", 1), ("late", 1), ("ghosts", 1), ("holes", 2)])
        low, high = scene["layers"][1]["error_range_m"]
        self.assertAlmostEqual(high, 0.3, places=6)
        self.assertEqual(low, -high)

    def mesh(self):
        mesh = self.folder / "mesh.obj"
        mesh.write_text("v 0 0 0\nv 9 0 0\nv 0 9 0\nv 9 9 0\nf 1 2 3\nf 2 4 3\n")
        return mesh

    def test_a_mesh(self):
        scene = self.scene(self.mesh())
        self.assertEqual([(layer["kind"], layer["count"]) for layer in scene["layers"]],
                         [("mesh", 2)])
        self.assertTrue(scene["can_simulate"])

    def test_layers_of_any_kind(self):
        scene = self.scene(self.model(), "--layer", self.mesh(), "--layer", self.cloud, "--layer",
                           self.model("other.ply"))
        self.assertEqual(sorted(layer["kind"] for layer in scene["layers"]),
                         ["mesh", "points", "splats", "splats"])

    def test_a_world(self):
        self.model("model.ply")
        self.mesh()
        (self.folder / "drive.csv").write_text(
            "time,x,y,z,qw,qx,qy,qz\n3,0,0,0,1,0,0,0\n4,5,0,0,1,0,0,0\n")
        (self.folder / "world.toml").write_text(
            "model = 'model.ply'\n"
            "[[object]]\nname = 'stands'\ngeometry = 'mesh.obj'\nposition = [1, 2, 0]\n"
            "[[object]]\nname = 'drives'\ngeometry = 'mesh.obj'\ntrajectory = 'drive.csv'\n"
            "class = 7\npresent = 'during'\n")
        scene = self.scene(self.folder / "world.toml")
        self.assertEqual([layer["kind"] for layer in scene["layers"]], ["splats"])
        stands, drives = scene["objects"]
        origin = scene["origin_m"]
        self.assertEqual([p + o for p, o in zip(stands["poses"][0], origin)], [1, 2, 0])
        self.assertEqual((drives["times_s"], drives["class_id"], drives["only_during"]),
                         ([3, 4], 7, True))
        self.assertEqual(stands["geometry"]["id"], drives["geometry"]["id"])
        self.assertEqual(stands["geometry"]["kind"], "mesh")

    def test_points_alone(self):
        scene = self.scene(self.cloud)
        self.assertFalse(scene["can_simulate"])
        self.assertEqual(scene["layers"][0]["count"], self.points_of(self.cloud))

    def points_of(self, cloud):
        return self.report("info", cloud)["files"][0]["points"]

    def test_a_folder(self):
        (self.folder / "place").mkdir()
        self.model("place/model.ply")
        scene = self.scene(self.folder / "place")
        self.assertEqual(scene["layers"][0]["name"], "model.ply")
        self.model("place/other.ply")
        self.run_bad(64, "view", self.folder / "place", says=["model.ply", "other.ply"])
        (self.folder / "empty").mkdir()
        self.run_bad(66, "view", self.folder / "empty", says=["neither"])

    def test_rejected_requests(self):
        model = self.model()
        self.run_bad(66, "view", self.folder / "none.ply", says=["none.ply"])
        self.run_bad(64, "view", model, "--sensor", "velodyne-vlp-17", says=["velodyne-vlp-17"])
        self.run_bad(64, "view", model, "--sensor", self.sensor, says=["sensor"])
        self.run_bad(64, "view", model, "--port", "66000", says=["--port"])
        self.run_bad(64, "view", model, "--address", "nowhere", "--no-browser", says=["nowhere"])
        world = self.folder / "world.toml"
        world.write_text("model = 'model.ply'\n")
        self.run_bad(64, "view", model, "--layer", world, says=["world.toml", "layer"])
        self.run_bad(66, "view", model, "--layer", self.folder / "none.ply", says=["none.ply"])

    def test_a_port_that_is_taken(self):
        model = self.model()
        _, url = self.serve(model)
        port = url.split(":")[2].split("/")[0]
        self.run_bad(69, "view", model, "--port", port, "--no-browser", says=[port])

    def test_the_address_can_be_chosen(self):
        process, url = self.serve(self.model(), "--token", "mine")
        self.assertTrue(url.endswith("/mine/"))
        with self.assertRaises(urllib.error.HTTPError) as refused:
            urllib.request.urlopen(url.replace("mine", "yours") + "scene.json", timeout=20)
        self.assertEqual(refused.exception.code, 404)
        refused.exception.close()
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(timeout=20), 143)


if __name__ == "__main__":
    unittest.main()
