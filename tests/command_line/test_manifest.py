# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""The manifest of simulate: all that decides the scans, and nothing else."""
import hashlib
import json
import shutil
import unittest

from support import SENSOR, ProgramTest, tree_digest, write_poses

# Options that change where results go, who computes, or what is said, but no scan.
DECIDE_NOTHING = {"--output", "--help", "--help-all", "--version", "--threads", "--report", "--config",
                  "--overwrite", "--device", "--gpus", "--gpu-memory",
                  # Who makes which of the scans.
                  "--plan", "--only-scans", "--tile-memory",
                  # They choose among poses of a recording: those that are chosen are in it.
                  "--topic", "--poses-topic"}
SCHEME = """\
name = "mine"
[[class]]
id = 40
name = "way"
group = "ground"
"""
DROP = """\
usual_reflectance = 0.3
weights = [-3, 0.1, 0, 0, 0, 0, 0, 0]
"""


class Manifest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.place = self.model("model.ply", "--no-refine")
        self.count = 0

    def file(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return path

    def manifest(self, *words, model=None, trajectory=None):
        """The text of the manifest of a simulation, but for what came out, and its folder."""
        self.count += 1
        folder = self.folder / f"scans {self.count}"
        places = {"--trajectory", "--at", "--path"}
        defaults = [] if places & set(words) else ["--trajectory", trajectory or self.poses]
        if "--sensor" not in words and "--rig" not in words:
            defaults += ["--sensor", self.sensor]
        self.run_good("simulate", model or self.place, *defaults, "-o", folder, *words)
        text = (folder / "adasplats.json").read_text(encoding="utf-8")
        self.assertNotIn(str(self.folder), text, "a path of this machine")
        manifest = json.loads(text)
        for name, digest in manifest.pop("outputs").items():
            self.assertEqual(hashlib.sha256((folder / name).read_bytes()).hexdigest(), digest)
        return json.dumps(manifest), folder

    def changes(self):
        """By option: words without it, and with it, which must make another manifest."""
        more = self.folder / "more.csv"
        write_poses(more, 5)
        sensor = self.file("other.toml", SENSOR.replace("16", "15"))
        unit = self.file("unit.toml", SENSOR + f"range_offsets_m = {[0.01 * k for k in range(16)]}\n")
        rig = '[[sensors]]\nname = "a"\nsensor = "velodyne-vlp-16"\n'
        rigs = [self.file("rig.toml", rig), self.file("moved.toml", rig + "mount = [0, 0, 0.1]\n")]
        return {
            "--sensor": ([], ["--sensor", sensor]),
            "--rig": (["--rig", rigs[0]], ["--rig", rigs[1]]),
            "--labels": ([], ["--labels", self.file("scheme.toml", SCHEME)]),
            "--trajectory": ([], ["--trajectory", more]),
            "--at": (["--at", "5,0"], ["--at", "5,0", "--at", "6,0,2,90"]),
            "--path": (["--path", "4,0;8,0"], ["--path", "4,0;8,0.5"]),
            "--speed": (["--path", "4,0;8,0"], ["--path", "4,0;8,0", "--speed", "5"]),
            "--height": (["--at", "5,0"], ["--at", "5,0", "--height", "2"]),
            "--offset": ([], ["--offset", "0.5,0,0"]),
            "--mount": ([], ["--mount", "0,0,0.1"]),
            "--mount-rotation": ([], ["--mount-rotation", "0,1,0"]),
            "--every": ([], ["--every", "2"]),
            "--rate": ([], ["--rate", "20"]),
            "--spacing": ([], ["--spacing", "1"]),
            "--rolling-shutter": ([], ["--rolling-shutter"]),
            "--motion": (["--rolling-shutter"], ["--rolling-shutter", "--motion", more]),
            "--points": (["--rolling-shutter"], ["--rolling-shutter", "--points", "deskewed"]),
            "--noise": ([], ["--no-noise"]),
            "--sensor-offsets": (["--sensor", unit], ["--sensor", unit, "--sensor-offsets"]),
            "--range-noise": ([], ["--range-noise", "0.02"]),
            "--min-range": ([], ["--min-range", "3"]),
            "--max-range": ([], ["--max-range", "20"]),
            "--rotation-rate": ([], ["--rotation-rate", "20"]),
            "--depth": ([], ["--depth", "5"]),
            "--depth-gap": (["--depth", "5"], ["--depth", "5", "--depth-gap", "0.001"]),
            "--sub-rays": ([], ["--sub-rays", "7"]),
            "--separation": ([], ["--separation", "0.1"]),
            "--returns": ([], ["--returns", "2"]),
            "--return-mode": ([], ["--return-mode", "last"]),
            "--ray-drop": ([], ["--ray-drop", self.file("drop.toml", DROP)]),
            "--vehicle-body": ([], ["--no-vehicle-body"]),
            "--rain": ([], ["--rain", "20"]),
            "--fog": ([], ["--fog", "40"]),
            "--snow": ([], ["--snow", "1"]),
            "--white-intensity": (["--rain", "20"],
                                  ["--rain", "20", "--white-intensity", "100"]),
            "--format": ([], ["--format", "npy"]),
            "--point-order": (["--format", "semantickitti"],
                              ["--format", "semantickitti", "--point-order", "firing"]),
            "--driver": (["--format", "mcap"], ["--format", "mcap", "--driver", "hesai"]),
            "--velocities": (["--format", "ply"], ["--format", "ply", "--velocities"]),
            "--seed": ([], ["--seed", "9"]),
        }

    def options_of_help(self):
        """The first long name of every option of the command."""
        names = set()
        for line in self.run_good("simulate", "--help-all").stdout.splitlines():
            words = [word.strip(",") for word in line.split()]
            if line.startswith(("  -", "    -")):
                names.add(next(word for word in words if word.startswith("--")))
        return names

    def test_every_setting_changes_it(self):
        self.sensor.write_text(SENSOR + 'divergence_deg = [0.5, 0.5]\ndivergence_kind = "1/e2"\n')
        changes = self.changes()
        self.assertEqual(self.options_of_help() - DECIDE_NOTHING, set(changes),
                         "an option without an entry in the manifest, or in this test")
        before = {}
        for option, (without, with_it) in changes.items():
            key = tuple(without)
            if key not in before:
                before[key] = self.manifest(*without)[0]
            self.assertNotEqual(self.manifest(*with_it)[0], before[key], option)

    def test_every_input_changes_it(self):
        before = self.manifest()[0]
        # Files that have other content under the same name.
        copy = self.folder / "copy" / self.sensor.name
        copy.parent.mkdir()
        model = self.model(f"copy/{self.place.name}", "--method", "basic")
        self.assertNotEqual(self.manifest(model=model)[0], before)
        copy.write_text(SENSOR.replace("-25.0", "-24.0"))
        self.assertNotEqual(self.manifest("--sensor", copy)[0], before)
        poses = copy.with_name("poses.csv")
        poses.write_text(self.poses.read_text().replace("4,0,2", "4,0.001,2"))
        self.assertNotEqual(self.manifest(trajectory=poses)[0], before)
        drop = self.file("drop.toml", DROP)
        dropped = self.manifest("--ray-drop", drop)[0]
        drop.write_text(DROP.replace("-3", "-2"))
        self.assertNotEqual(self.manifest("--ray-drop", drop)[0], dropped)

    def test_objects_of_a_world_change_it(self):
        box = self.file("box.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        way = self.folder / "way.csv"
        write_poses(way)
        world = self.file("world.toml", f'model = "{self.place.name}"\n[[object]]\n'
                          'geometry = "box.obj"\ntrajectory = "way.csv"\n')
        seen = [self.manifest(model=world)[0]]
        box.write_text(box.read_text().replace("1 0 0", "2 0 0"))
        seen.append(self.manifest(model=world)[0])
        write_poses(way, 2)
        seen.append(self.manifest(model=world)[0])
        self.model(self.place.name, "--method", "basic")
        seen.append(self.manifest(model=world)[0])
        self.assertEqual(len(set(seen)), 4)

    def test_the_same_run_gives_the_same_bytes(self):
        first, folder = self.manifest("--rain", "5")
        again, other = self.manifest("--rain", "5", "--threads", "1")
        self.assertEqual(first, again)
        self.assertEqual(tree_digest(folder), tree_digest(other))
        # The same in another folder: the manifest contains only file names.
        moved = self.folder / "moved"
        moved.mkdir()
        for path in [self.place, self.poses, self.sensor]:
            shutil.copy(path, moved)
        there, _ = self.manifest("--rain", "5", "--sensor", moved / self.sensor.name,
                                 model=moved / self.place.name,
                                 trajectory=moved / self.poses.name)
        self.assertEqual(first, there)
        for key in ["date", "time", "host", "device", "threads"]:
            self.assertNotIn(key, json.loads(first))


if __name__ == "__main__":
    unittest.main()
