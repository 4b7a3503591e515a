# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Meshes: made from points, and taken wherever splat models are."""
import json
import os
import signal
import struct
import subprocess
import time
import unittest
from pathlib import Path

from support import BUILDING, PROGRAM, ROAD, ProgramTest, run, tree_digest

# A stand-in for PoissonRecon: notes its arguments and gives one large triangle at the road's height.
FAKE_RECON = """\
#!/bin/sh
echo "$@" > "$NOTES/recon"
while [ "$1" != --out ]; do shift; done
cat > "$2" <<'MESH'
ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
property float value
element face 1
property list uchar int vertex_indices
end_header
-50 -50 0 9
60 -50 0 9
0 80 0 9
3 0 1 2
MESH
"""
FAKE_TRIMMER = """\
#!/bin/sh
echo "$@" > "$NOTES/trimmer"
cp "$2" "$4"
"""


def write_wall(path, with_classes=True):
    """A wall of two triangles at x = 8, 20 m wide and 8 m high, classes as 32-bit numbers."""
    declaration = "property int category\n" if with_classes else ""
    classes = [f" {BUILDING}", f" {ROAD}"] if with_classes else ["", ""]
    path.write_text(
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
        "property float z\nelement face 2\nproperty list uchar int vertex_indices\n"
        f"{declaration}end_header\n8 -10 -4\n8 10 -4\n8 10 4\n8 -10 4\n"
        f"3 0 1 2{classes[0]}\n3 0 2 3{classes[1]}\n")


def labels_of(scans):
    """The set of classes in the scans that simulate wrote."""
    found = set()
    for path in (scans / "sequences" / "00" / "labels").iterdir():
        data = path.read_bytes()
        found |= {n & 0xffff for n in struct.unpack(f"<{len(data) // 4}I", data)}
    return found


class MeshesAsScenes(ProgramTest):
    def setUp(self):
        super().setUp()
        self.wall = self.folder / "wall.ply"
        write_wall(self.wall)

    # Oracle: the wall's distance, and its two classes.
    def test_simulate(self):
        scans = self.simulate(self.wall, "scans", "--no-noise", "--labels", "semantickitti")
        self.assertEqual(labels_of(scans), {BUILDING, ROAD})
        points = (scans / "sequences" / "00" / "velodyne" / "000000.bin").read_bytes()
        values = struct.unpack(f"<{len(points) // 4}f", points)
        self.assertGreater(len(values), 400)
        for x in values[::4]:
            self.assertAlmostEqual(x, 4, delta=1e-4)  # the first pose is at x = 4
        content = json.loads((scans / "adasplats.json").read_text())
        self.assertEqual(content["labels"]["name"], "semantickitti")

    def test_obj_is_the_same_scene(self):
        obj = self.folder / "wall.obj"
        obj.write_text("# wall\nv 8 -10 -4\nv 8 10 -4\nv 8 10 4\nv 8 -10 4\nf -4 -3/1 -2//1 -1\n")
        write_wall(self.wall, with_classes=False)
        scans = [self.simulate(mesh, f"scans {mesh.suffix}") / "sequences"
                 for mesh in [self.wall, obj]]
        self.assertEqual(tree_digest(scans[0]), tree_digest(scans[1]))

    def test_render(self):
        picture = self.folder / "wall.png"
        report = self.report("render", self.wall, self.model(), "-o", picture, "--width", "64",
                             "--height", "48", "--eye", "0,0,1", "--labels", "semantickitti",
                             "--repeat", "3")
        self.assertGreater(report["seconds_rendered"], 0)
        self.assertAlmostEqual(report["images_per_second"] * report["seconds_rendered"], 2)
        self.run_bad(64, "render", self.wall, "-o", picture, "--repeat", "0", says=["--repeat"])
        self.run_bad(66, "render", self.wall, "-o", picture, "--labels", "none.toml",
                     says=["none.toml"])

    # Oracle: beams of scans simulated in the mesh hit it again where they were.
    def test_resimulate(self):
        scans = self.simulate(self.wall, "scans", "--no-noise") / "sequences" / "00"
        report = self.report("evaluate", "resimulate", self.wall, scans)
        self.assertGreater(report["rays"], 100)
        self.assertEqual(report["no_hit"], 0)
        self.assertLess(report["range_error_m"]["mae"], 1e-3)

    def test_info(self):
        facts = self.report("info", self.wall)["files"][0]
        self.assertEqual((facts["kind"], facts["triangles"]), ("mesh", 2))
        self.assertAlmostEqual(facts["area_m2"], 160)
        self.assertEqual(facts["classes"], {str(ROAD): 1, str(BUILDING): 1})

    # The true surface of a street, whose face property is `class`.
    def test_true_surface_of_a_street(self):
        street = self.folder / "street"
        self.run_good("synth", "street", "-o", street, "--points", "20000")
        scans = street / "sequences" / "00"
        report = self.report("evaluate", "resimulate", street / "mesh.ply", scans)
        self.assertGreater(report["within"]["0.10"], 0.9)
        self.assertIn("classes", self.report("info", street / "mesh.ply")["files"][0])

    def test_broken_meshes(self):
        simulate = ["--trajectory", self.poses, "--sensor", self.sensor, "-o", self.folder / "s"]
        broken = self.folder / "broken.obj"
        broken.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n")
        self.run_bad(65, "simulate", broken, *simulate, says=["broken.obj:4:", "vertex 4"])
        broken.write_text("v 0 0 0\n")
        self.run_bad(65, "render", broken, "-o", self.folder / "p.png", says=["no triangles"])
        self.wall.write_text(self.wall.read_text().replace(f" {ROAD}\n", " -1\n"))
        self.run_bad(65, "evaluate", "resimulate", self.wall, self.folder, says=[])
        self.run_bad(65, "info", self.wall, says=["wall.ply", "category"])


class Meshing(ProgramTest):
    def mesh(self, method, *arguments, **options):
        path = self.folder / f"{method}.ply"
        report = self.folder / "report.json"
        result = run("mesh", self.cloud, "-o", path, "--method", method, "--report", report,
                     *arguments, **options)
        if result.returncode == 69:
            self.skipTest(result.stderr)
        self.assertEqual(result.returncode, 0, result.stderr)
        return path, json.loads(report.read_text(encoding="utf-8"))

    def test_imls(self):
        mesh, report = self.mesh("imls", "--labels", "semantickitti", "--voxel", "0.15")
        self.assertEqual(report["points_in"], 60 * 40 + 60 * 16 + 200)
        self.assertEqual(report["points_used"], report["points_in"])
        self.assertGreater(report["primitives"], 1000)
        self.assertEqual(report["normals_oriented_by"], "sensor positions")
        self.assertGreater(report["seconds"]["imls"], 0)
        facts = self.report("info", mesh)["files"][0]
        self.assertEqual(facts["triangles"], report["primitives"])
        self.assertEqual(set(facts["classes"]), {"40", "50", "80"})
        # Oracle: the place, at most 3 voxels larger.
        self.assertGreater(facts["extent_m"]["x"][0], -0.6)
        self.assertLess(facts["extent_m"]["x"][1], 15.4)
        scans = self.simulate(mesh)
        self.assertEqual(labels_of(scans), {40, 50, 80})
        for threads in ["1", "3"]:
            before = mesh.read_bytes()
            self.mesh("imls", "--labels", "semantickitti", "--voxel", "0.15", "--threads", threads)
            self.assertEqual(mesh.read_bytes(), before)

    def test_bad_options(self):
        out = ["-o", self.folder / "m.ply"]
        self.run_bad(64, "mesh", self.cloud, *out, "--method", "impls", says=["imls"])
        self.run_bad(73, "mesh", self.cloud, "-o", self.folder)
        self.run_bad(66, "mesh", self.folder / "none.ply", *out, says=["none.ply"])
        mesh = ["mesh", self.cloud, *out, "--labels", "semantickitti"]
        if run(*mesh).returncode != 69:
            self.run_bad(64, *mesh, "--voxel", "0", says=["voxel"])
            self.run_bad(64, *mesh, "--truncation", "9", says=["truncation"])
            self.run_bad(64, *mesh, "--neighbors", "2", says=["neighbors"])


class Poisson(ProgramTest):
    """With stand-ins for the programs, which record their arguments."""

    def setUp(self):
        super().setUp()
        self.programs = self.folder / "programs"
        self.programs.mkdir()
        self.notes = self.folder / "notes"
        self.notes.mkdir()
        self.outputs = self.folder / "outputs"
        self.outputs.mkdir()
        self.environment = dict(os.environ, NOTES=str(self.notes),
                                PATH=f"{self.programs}:/usr/bin:/bin")
        self.command = ["mesh", self.cloud, "-o", self.outputs / "m.ply", "--method", "poisson",
                        "--poisson-program", "poissonrecon", "--labels", "semantickitti"]

    def provide(self, recon=FAKE_RECON, trimmer=FAKE_TRIMMER):
        for name, text in [("PoissonRecon", recon), ("SurfaceTrimmer", trimmer)]:
            (self.programs / name).write_text(text)
            (self.programs / name).chmod(0o755)

    def test_programs_are_missing(self):
        self.run_bad(69, *self.command, env=self.environment,
                     says=["PoissonRecon", "SurfaceTrimmer", "PATH", "libopen3d-dev"])
        self.assertEqual(list(self.outputs.iterdir()), [])

    def test_flags_and_result(self):
        self.provide()
        self.run_good(*self.command, env=self.environment)
        arguments = (self.notes / "recon").read_text()
        for flag in ["--depth 13 ", "--bType 3 ", "--samplesPerNode 2.0", "--density", "--tempDir "]:
            self.assertIn(flag, arguments)
        self.assertIn("--trim 10.0", (self.notes / "trimmer").read_text())
        self.assertEqual([p.name for p in self.outputs.iterdir()], ["m.ply"])
        facts = self.report("info", self.outputs / "m.ply")["files"][0]
        self.assertEqual((facts["triangles"], facts["classes"]), (1, {"40": 1}))
        report = self.folder / "report.json"
        self.run_good(*self.command, "--depth", "9", "--report", report, env=self.environment)
        self.assertIn("--depth 9 ", (self.notes / "recon").read_text())
        self.assertIn("--trim 6.0", (self.notes / "trimmer").read_text())
        result = json.loads(report.read_text())
        self.assertEqual((result["program"], result["primitives"]), ("PoissonRecon", 1))
        self.assertGreater(result["program_peak_memory_bytes"], 0)

    def test_failure_leaves_nothing(self):
        self.provide(recon="#!/bin/sh\necho bad luck >&2\nexit 5\n")
        self.run_bad(69, *self.command, env=self.environment, says=["code 5", "bad luck"])
        self.provide(trimmer="#!/bin/sh\nkill -11 $$\n")
        self.run_bad(69, *self.command, env=self.environment, says=["signal 11"])
        self.provide(trimmer="#!/bin/sh\nexit 0\n")
        self.run_bad(66, *self.command, env=self.environment, says=["trimmed.ply"])
        self.assertEqual(list(self.outputs.iterdir()), [])

    def test_interrupt_ends_the_program(self):
        self.provide(recon='#!/bin/sh\necho $$ > "$NOTES/n"; mv "$NOTES/n" "$NOTES/pid"\n'
                     "exec sleep 600\n")
        for sent, code in [(signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGKILL, -9)]:
            process = subprocess.Popen([PROGRAM, *map(str, self.command)], env=self.environment,
                                       stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            try:
                while process.poll() is None and not (self.notes / "pid").exists():
                    time.sleep(0.02)
                process.send_signal(sent)
                process.communicate(timeout=100)
            finally:
                process.kill()
            self.assertEqual(process.returncode, code)
            child = int((self.notes / "pid").read_text())
            self.assertTrue(self.has_ended(child), sent)
            (self.notes / "pid").unlink()
            if sent != signal.SIGKILL:
                self.assertEqual(list(self.outputs.iterdir()), [])

    @staticmethod
    def has_ended(child):
        """Whether a process is gone or a zombie, at the latest after ten seconds."""
        for _ in range(500):
            try:
                state = Path(f"/proc/{child}/stat").read_text().rpartition(")")[2].split()[0]
            except FileNotFoundError:
                return True
            if state == "Z":
                return True
            time.sleep(0.02)
        return False


if __name__ == "__main__":
    unittest.main()
