# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""The comparison of methods: complete, resumable, and not stopped by what fails in it."""
import fcntl
import json
import os
import shutil
import signal
import struct
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

from pictures import png_size
from support import PROGRAM, run, tiny_place, write_cloud, write_network

# The tests work with relative paths in folders of their own.
ABSOLUTE_PROGRAM = str(Path(shutil.which(PROGRAM) or PROGRAM).resolve())

FEW_BEAMS = ["--picture-width", "64", "--sensor", "velodyne-vlp-16"]
COARSE = [*FEW_BEAMS, "--every", "40"]
CHILD_STEPS = ["generate", "render", "picture", "simulate", "c2c", "resimulate", "truth"]

# Of every competitor that is done, by parts of its entry.
KEYS = {
    "generate": {"command", "seconds", "peak_memory_bytes", "primitives", "points_used"},
    "render": {"images_per_second", "picture"},
    "simulate": {"scans", "rays", "hits", "scans_per_second", "sensor"},
    "c2c": {"c2c_m", "completeness_m", "chamfer_m", "chamfer_m2", "f_score", "by_class", "picture"},
    "resimulate": {"rays", "no_hit", "early_50cm", "late_50cm", "within", "range_error_m",
                   "by_range", "by_incidence", "by_class", "picture"},
    "truth": {"rays", "hole_share", "ghost_share", "bleeding_share", "surface_distance_m", "range",
              "by_class"},
}


def compare(*arguments, folder, **options):
    """Runs `adasplats compare` in a folder."""
    options.setdefault("program", ABSOLUTE_PROGRAM)
    program = options.pop("program")
    return subprocess.run([program, "compare", *map(str, arguments)], cwd=folder, timeout=120,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8",
                          **options)


def states(folder):
    """When each step of a comparison was done last, by "competitor/step"."""
    return {f"{path.parent.name}/{path.stem}": path.stat().st_mtime_ns
            for path in (folder / "work").glob("*/*.json") if not path.stem.endswith("-report")}


def results_of(folder):
    return json.loads((folder / "compare.json").read_text(encoding="utf-8"))


def rows_of(folder):
    return {entry["name"]: entry for entry in results_of(folder)["competitors"]}


def processes_in(folder):
    """Numbers of the living processes that work in a folder."""
    found = []
    for process in Path("/proc").glob("[0-9]*"):
        try:
            state = (process / "stat").read_text().rpartition(")")[2].split()[0]
            if state != "Z" and Path(os.readlink(process / "cwd")) == folder:
                found.append(process.name)
        except OSError:  # ended meanwhile, or of somebody else
            pass
    return found


class CompareTest(unittest.TestCase):
    """A test in a folder of its own."""

    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="adasplats test ä ")).resolve()
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.output = self.folder / "out"

    def compare(self, *arguments, **options):
        """Compares in the test's folder, which must succeed."""
        result = compare(*arguments, folder=self.folder, **options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def refuse(self, code, *arguments, says=()):
        result = compare(*arguments, folder=self.folder)
        self.assertEqual(result.returncode, code, (arguments, result.stderr))
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        for text in says:
            self.assertIn(text, result.stderr)

    def run_again(self, before):
        """The steps that were done since `before`."""
        now = states(self.output)
        return {step for step in now if now[step] != before.get(step)}


class Street(CompareTest):
    """On a synthetic street: out/ holds basic and imls at the start of every test."""
    RUN = ["street", "-o", "out", *COARSE]
    BOTH = [*RUN, "--methods", "basic,imls"]
    # One thread: its steps take long enough to be interrupted on a large machine as well.
    NEW = ["street", "-o", "new", *COARSE, "--methods", "basic", "--threads", "1"]

    @classmethod
    def setUpClass(cls):
        cls.made = Path(tempfile.mkdtemp(prefix="adasplats test "))
        cls.addClassCleanup(shutil.rmtree, cls.made, ignore_errors=True)
        run("synth", "street", "-o", cls.made / "street", "--points", "4000", "--driving-spacing",
            "25", "--seed", "3", check=True)
        cls.first = compare(*cls.BOTH, folder=cls.made)

    def setUp(self):
        super().setUp()
        self.assertEqual((self.first.returncode, self.first.stderr), (0, ""))
        # With the times of all files: the copy is the same comparison.
        shutil.copytree(self.made, self.folder, dirs_exist_ok=True)

    def test_everything_is_measured(self):
        results = results_of(self.output)
        self.assertEqual((results["program"], results["schema"], results["title"]),
                         ("adasplats", 1, "street"))
        self.assertEqual(results["command"], "adasplats compare " + " ".join(self.BOTH))
        data = results["data"]
        self.assertEqual(data["inputs"], ["street/mapping.ply"])
        self.assertEqual((data["labels"], data["held_out"], data["truth"], data["trajectory"]),
                         ("semantickitti", "street/sequences/00", "street/mesh.ply",
                          "street/mapping_trajectory.csv"))
        self.assertEqual((data["offset_m"], data["every"], data["preset"]), ([1, 1, -1], 40, ""))
        self.assertAlmostEqual(data["points"], 4000, delta=1000)
        self.assertGreater(results["machine"]["memory_bytes"], 0)
        provenance = results["provenance"]
        self.assertEqual(provenance["command"], results["command"])
        for entry in results["competitors"]:
            own = entry["provenance"]
            self.assertEqual(set(entry["made_by"]), set(CHILD_STEPS))
            for made_by in entry["made_by"].values():
                self.assertEqual((made_by["version"], made_by["commit"], made_by["dirty"]),
                                 (provenance["version"], provenance["commit"], provenance["dirty"]))
            self.assertEqual((own["commit"], own["dirty"]), (provenance["commit"], provenance["dirty"]))
            self.assertTrue(provenance["date"] <= own["first_date"] <= own["last_date"], own)
        removed = data["removed"]
        self.assertEqual((removed["rule"], removed["paper"]), ("movable", "movable"))
        self.assertEqual(sum(removed["by_class"].values()), removed["points"])
        self.assertIn("car", removed["by_class"])
        self.assertEqual(results["limits"]["seconds"], 3600)
        self.assertGreater(results["limits"]["memory_bytes"], 0)
        self.assertEqual(results["paper"]["table"], "PC3D-Paris")
        self.assertEqual([(entry["name"], entry["kind"], entry["state"])
                          for entry in results["competitors"]],
                         [("basic", "splats", "done"), ("imls", "mesh", "done")])
        for entry in results["competitors"]:
            for part, keys in KEYS.items():
                self.assertLessEqual(keys, set(entry[part]), (entry["name"], part))
            self.assertGreater(entry["generate"]["primitives"], 100)
            self.assertGreater(entry["render"]["images_per_second"], 0)
            self.assertEqual(set(entry["simulate"]["scans_per_second"]),
                             {"traced", "assembled", "written"})
            self.assertEqual(set(entry["c2c"]["f_score"]), {"0.05", "0.10", "0.224"})
            self.assertIn("road", entry["c2c"]["by_class"])

    def test_device(self):
        device = results_of(self.output)["device"]
        basic = rows_of(self.output)["basic"]
        for part in ["generate", "render", "simulate", "resimulate", "truth"]:
            self.assertEqual(basic[part]["device"], device["kind"])
            if "command" in basic[part]:
                self.assertNotIn("--device", basic[part]["command"])
        # Only what has a choice is done again on another device; and what is made from that.
        before = states(self.output)
        self.compare(*self.BOTH, "--device", "cpu")
        chosen = set(CHILD_STEPS) - {"c2c"}
        again = {step for step in self.run_again(before) if not step.endswith("/c2c")}
        self.assertEqual(again, {f"basic/{step}" for step in chosen} |
                         {f"imls/{step}" for step in chosen - {"generate"}})
        self.assertEqual(results_of(self.output)["device"]["kind"], "cpu")
        rows = rows_of(self.output)
        for part in ["generate", "simulate", "resimulate", "truth"]:
            self.assertIn("--device cpu", rows["basic"][part]["command"])
        self.assertNotIn("--device", rows["imls"]["generate"]["command"])
        self.refuse(64, *self.BOTH, "--device", "cpus", says=["did you mean 'cpu'"])

    def test_files(self):
        self.assertEqual(sorted(p.name for p in self.output.iterdir()),
                         ["adasplats.json", "compare.json", "pictures", "report.html", "report.md",
                          "work"])
        pictures = {results_of(self.output)["original"]["picture"]}
        for entry in results_of(self.output)["competitors"]:
            pictures |= {entry[part]["picture"] for part in ["render", "c2c", "resimulate"]}
        self.assertEqual(pictures,
                         {f"pictures/{p.name}" for p in (self.output / "pictures").iterdir()})
        self.assertEqual(len(pictures), 1 + 2 * 3)
        for picture in pictures:
            self.assertGreater(png_size(self.output / picture)[0], 0)
        # Who gave relative paths can pass the reports on without telling of the own disk.
        for name in ["compare.json", "report.md", "report.html"]:
            text = (self.output / name).read_text(encoding="utf-8")
            self.assertNotIn(str(self.made), text, name)
            self.assertIn("street", text, name)
        for path in self.output.rglob("*"):
            self.assertFalse(path.name.startswith("."), path)

    def test_again(self):
        before, results = states(self.output), results_of(self.output)
        self.assertEqual(len(before), 1 + 2 * len(CHILD_STEPS))
        self.compare(*self.BOTH)
        self.assertEqual(self.run_again(before), set())
        again = results_of(self.output)
        self.assertGreaterEqual(again["provenance"].pop("date"), results["provenance"].pop("date"))
        self.assertEqual(again, results)

        (self.output / "pictures" / "imls-c2c.png").unlink()
        self.compare(*self.BOTH)
        self.assertEqual(self.run_again(before), {"imls/c2c"})
        self.assertTrue((self.output / "pictures" / "imls-c2c.png").exists())

        # The true surface is an input of one step of each competitor.
        before = states(self.output)
        os.utime(self.folder / "street" / "mesh.ply")
        self.compare(*self.BOTH)
        self.assertEqual(self.run_again(before), {"basic/truth", "imls/truth"})

        # A scan within the sequence folder, replaced in its place.
        before = states(self.output)
        scan = next((self.folder / "street" / "sequences" / "00" / "velodyne").iterdir())
        os.utime(scan)
        self.compare(*self.BOTH)
        self.assertEqual(self.run_again(before), {"basic/resimulate", "imls/resimulate"})

        # What another program did is not taken over.
        before = states(self.output)
        state_file = self.output / "work" / "basic" / "picture.json"
        state = json.loads(state_file.read_text())
        state["made_by"]["commit"] = "0" * 40
        state_file.write_text(json.dumps(state))
        self.compare(*self.BOTH)
        self.assertEqual(self.run_again(before), {"basic/picture"})

        # A broken memory of a step counts as none.
        before = states(self.output)
        (self.output / "work" / "basic" / "picture.json").write_text('{"key": 1')
        self.compare(*self.BOTH)
        self.assertEqual(self.run_again(before), {"basic/picture"})

    def test_limits(self):
        """A step that passes a limit is a row; the others are what they were."""
        three = [*self.RUN, "--methods", "basic,descriptors,imls"]
        before = states(self.output)
        text = self.compare(*three, "--memory-limit", "0.00001").stdout
        self.assertIn("descriptors: generate: ended at the memory limit", text)
        rows = rows_of(self.output)
        self.assertEqual([rows[name]["state"] for name in ["basic", "descriptors", "imls"]],
                         ["done", "out of memory", "done"])
        self.assertEqual(self.run_again(before), {"descriptors/generate"})

        # More memory, too little time: it is tried again and fails otherwise.
        self.compare(*three, "--time-limit", "0.01")
        row = rows_of(self.output)["descriptors"]
        self.assertEqual((row["state"], row["failed_step"], row["is_error"]),
                         ("timeout", "generate", False))
        self.assertIn("0.01 s", row["message"])
        for report in ["report.md", "report.html"]:
            self.assertIn("0.01 s", (self.output / report).read_text(encoding="utf-8"))

        # The same limit again would end as before: not tried.
        before = states(self.output)
        self.compare(*three, "--time-limit", "0.01")
        self.assertEqual(self.run_again(before), set())

        self.compare(*three, "--time-limit", "100")
        self.assertEqual(rows_of(self.output)["descriptors"]["state"], "done")
        self.assertEqual(self.run_again(before), {f"descriptors/{step}" for step in CHILD_STEPS})

    def test_failure_and_retry(self):
        (self.folder / "broken.obj").write_text("v 0 0 0\nf 1 2 3\n")
        self.refuse(65, *self.BOTH, "--mesh", "cloud=street/mapping.ply", says=["by an error: cloud"])
        row = rows_of(self.output)["cloud"]
        self.assertEqual((row["state"], row["is_error"]), ("failed", True))
        self.assertIn("no mesh but a point cloud", row["message"])

        broken = [*self.BOTH, "--mesh", "artist=broken.obj"]
        self.refuse(65, *broken)
        rows = rows_of(self.output)
        self.assertEqual([rows[name]["state"] for name in ["basic", "imls", "artist"]],
                         ["done", "done", "failed"])
        self.assertEqual(rows["artist"]["failed_step"], "info")
        self.assertIn("broken.obj:2:", rows["artist"]["message"])
        before = states(self.output)
        self.refuse(65, *broken)
        self.assertEqual(self.run_again(before), set())
        self.refuse(65, *broken, "--retry")
        self.assertEqual(self.run_again(before), {"artist/info"})

    def test_poisson_without_its_programs(self):
        alone = self.folder / "alone"
        alone.mkdir()
        shutil.copy2(ABSOLUTE_PROGRAM, alone / "adasplats")
        self.compare(*self.RUN, "--methods", "poisson", program=str(alone / "adasplats"),
                     env=dict(os.environ, PATH=""))
        row = rows_of(self.output)["poisson"]
        self.assertEqual((row["state"], row["failed_step"], row["is_error"]),
                         ("failed", "generate", False))
        self.assertIn("PoissonRecon", row["message"])

    def interrupt(self, sent, step):
        """Starts a comparison in new/ and sends it a signal while it is at a step of basic."""
        log = self.folder / "new" / "work" / "basic" / f"{step}.log"
        log.unlink(missing_ok=True)
        process = subprocess.Popen([ABSOLUTE_PROGRAM, "compare", *self.NEW], cwd=self.folder,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        try:
            while process.poll() is None and not log.exists():
                time.sleep(0.005)
            time.sleep(0.05)
            self.assertGreater(len(processes_in(self.folder)), 1)  # with the step
            process.send_signal(sent)
            _, errors = process.communicate(timeout=100)
        finally:
            process.kill()
        for _ in range(500):
            if not processes_in(self.folder):
                break
            time.sleep(0.02)
        self.assertEqual(processes_in(self.folder), [])
        return process.returncode, errors

    def test_interrupt(self):
        self.output = self.folder / "new"
        self.assertEqual(self.interrupt(signal.SIGKILL, "render")[0], -signal.SIGKILL)
        before = states(self.output)
        self.assertEqual(set(before), {"original/picture", "basic/generate"})
        self.assertEqual(self.interrupt(signal.SIGINT, "render"),
                         (130, b"adasplats: interrupted\n"))
        self.assertEqual(self.interrupt(signal.SIGTERM, "render")[0], 143)
        self.assertEqual(self.run_again(before), set())
        self.assertEqual([p.name for p in self.output.rglob(".*")], [])

        self.compare(*self.NEW)
        self.assertEqual(rows_of(self.output)["basic"]["state"], "done")
        self.assertEqual(self.run_again(before),
                         {f"basic/{step}" for step in CHILD_STEPS if step != "generate"})

    def test_unsuitable_folders_are_rejected(self):
        before = states(self.output)
        descriptor = os.open(self.output, os.O_RDONLY)
        fcntl.flock(descriptor, fcntl.LOCK_EX)
        self.refuse(73, *self.BOTH, says=["out: another run works in it"])
        os.close(descriptor)
        own = self.folder / "own"
        own.mkdir()
        (own / "thesis.txt").write_text("x")
        self.refuse(73, "street", "-o", "own", *COARSE, says=["own: ", "not empty"])
        self.assertEqual([p.name for p in own.iterdir()], ["thesis.txt"])
        shutil.copytree(self.folder / "street", self.folder / "avenue")
        self.refuse(73, "avenue", "-o", "out", *COARSE, says=["\"street\"", "'avenue'"])
        self.refuse(73, "street", "-o", "no such/out", says=["no such"])
        self.refuse(64, "street", "-o", "street/mesh.ply",
                    says=["mesh.ply", "is inside the input"])
        self.refuse(73, "street", "-o", "own/thesis.txt", says=["thesis.txt"])
        self.assertEqual(self.run_again(before), set())

    def test_arguments(self):
        before = states(self.output)
        run_it = ["street", "-o", "other"]
        for given in ["artist", "artist=", "=file.obj"]:
            self.refuse(64, *run_it, "--mesh", given, says=["--mesh", "NAME=FILE"])
        for name in ["a b", "../x"]:
            self.refuse(64, *run_it, "--mesh", f"{name}=street/mesh.ply",
                        says=[f"'{name}'", "letters, digits"])
        mesh = "street/mesh.ply"
        for name in ["basic", "poisson", "original", "imls-c2c"]:
            self.refuse(64, *run_it, "--methods", "basic", "--mesh", f"{name}={mesh}",
                        says=["mesh", name, "taken"])
        self.refuse(64, *run_it, "--mesh", f"a={mesh}", "--mesh", f"a={mesh}", says=["taken"])
        self.refuse(66, *run_it, "--mesh", "artist=none.obj", says=["none.obj"])
        self.refuse(64, *run_it, "--methods", "basic,descriptor",
                    says=["'descriptor'", "did you mean 'descriptors'"])
        self.refuse(64, *run_it, "--sensor", "hdl-64-papr", says=["hdl-64-paper"])
        self.refuse(64, *run_it, "--remove", "moveable", says=["movable"])
        self.refuse(64, *run_it, "--preset", "paper-kiti", says=["paper-kitti"])
        for value in ["0", "-1", "nan"]:
            self.refuse(64, *run_it, "--time-limit", value, says=["--time-limit"])
        for value in ["-1", "nan"]:
            self.refuse(64, *run_it, "--memory-limit", value, says=["--memory-limit"])
        self.refuse(64, *run_it, "--poisson-depth", "99", says=["--poisson-depth"])
        self.refuse(66, "none", "-o", "other", says=["none"])
        self.refuse(66, *run_it, "--truth", "none.ply", says=["none.ply"])
        self.assertFalse((self.folder / "other").exists())
        self.assertEqual(self.run_again(before), set())

    def test_common_options_reach_the_steps(self):
        (self.folder / "broken.obj").write_text("v 0 0 0\nf 1 2 3\n")
        self.compare("street", "-o", "other", "--threads", "1", "--seed", "7", "--methods",
                     "basic,basic", "--time-limit", "0.01", "--report", "report.json")
        self.output = self.folder / "other"
        results = results_of(self.output)
        self.assertEqual(results["machine"]["cores"], 1)
        self.assertEqual([entry["name"] for entry in results["competitors"]], ["basic"])
        self.assertIn("--threads 1 --seed 7", results["competitors"][0]["generate"]["command"])
        report = json.loads((self.folder / "report.json").read_text(encoding="utf-8"))
        self.assertEqual(report["results"], results)


class Presets(CompareTest):
    """Folders as the authors of the paper's data ship them."""
    RUN = ["-o", "out", "--methods", "basic", *FEW_BEAMS]

    def paper_names(self):
        return [row["name"] for row in results_of(self.output)["paper"]["rows"]]

    def test_paris_carla_3d(self):
        paris = self.folder / "data" / "Paris"
        paris.mkdir(parents=True)
        carla_3d = {40: 7, 50: 1, 80: 5}  # road, building, pole
        points = [(x, y, z, carla_3d[label]) for x, y, z, label in tiny_place()]
        write_cloud(paris / "Soufflot_1.ply", points[::2])
        paper = ["data", "--preset", "paper-pc3d", *self.RUN]
        write_cloud(paris / "Soufflot_10.ply", points)
        self.refuse(65, *paper, says=["Soufflot-2"])
        self.assertFalse(self.output.exists())
        write_cloud(paris / "Soufflot-2.ply", points[1::2])
        self.compare(*paper)
        data = results_of(self.output)["data"]
        self.assertEqual(data["inputs"], ["data/Paris/Soufflot_1.ply", "data/Paris/Soufflot-2.ply"])
        self.assertEqual((data["points"], data["labels"], data["offset_m"], data["preset"]),
                         (len(points), "paris-carla-3d", [1, 1, -1], "paper-pc3d"))
        basic = rows_of(self.output)["basic"]
        self.assertEqual(basic["state"], "done", basic)
        self.assertEqual(set(basic["c2c"]["by_class"]), {"road", "building", "pole"})
        self.assertEqual(results_of(self.output)["paper"]["table"], "PC3D-Paris")
        self.assertEqual(self.paper_names(), ["poisson", "imls", "basic", "descriptors", "kpconv",
                                              "semantic", "semantic-no-resample"])
        # The sensor was over y = 0 at the height of 2 m, at the x of each point.
        places = self.places()
        self.assertEqual([place[0] for place in places], sorted(place[0] for place in places))
        self.assertAlmostEqual(places[-1][0] - places[0][0], 14.5, delta=1)
        for place in places:
            self.assertEqual(place[1:], [0, 2])
        # What was made of the points is made again only where they change.
        before = states(self.output)
        self.compare(*paper)
        self.assertEqual(self.run_again(before), set())

    def network(self):
        """A network that takes what is high for cars; skips where no network can be run."""
        path = self.folder / "high.network"
        write_network(path)
        probe = run("model", self.folder / "place.ply", "-o", self.folder / "probe.ply",
                    "--segment", "--network", path)
        if probe.returncode == 69 and "OpenBLAS" in probe.stderr:
            self.skipTest("built without OpenBLAS")
        return path

    def test_kpconv(self):
        points = tiny_place()
        write_cloud(self.folder / "place.ply", points)
        network = self.network()
        words = ["place.ply", "-o", "out", "--methods", "kpconv,semantic", *FEW_BEAMS, "--labels",
                 "semantickitti", "--network", network.name]
        self.compare(*words)
        rows = rows_of(self.output)
        self.assertEqual([(row["title"], row["state"]) for row in rows.values()],
                         [("AdaSplats-KPConv", "done"), ("AdaSplats, classes", "done")])
        made = rows["kpconv"]["generate"]
        segmentation = made["segmentation"]
        self.assertEqual((segmentation["network"]["name"], segmentation["replaced_labels"]),
                         (network.name, True))
        self.assertEqual(len(segmentation["network"]["sha256"]), 64)
        self.assertEqual(made["points_removed"], {"car": segmentation["classes"]["car"]})
        self.assertGreater(segmentation["classes"]["car"], 100)
        self.assertIn(" --segment ", made["command"])
        self.assertIn(" --network " + network.name, made["command"])
        self.assertNotIn("--labels", made["command"])
        self.assertNotIn("segmentation", rows["semantic"]["generate"])
        # Its own classes are the network's, which has no building; the original's has.
        self.assertIn("--nearest-classes", rows["kpconv"]["c2c"]["command"])
        self.assertNotIn("--nearest-classes", rows["semantic"]["c2c"]["command"])
        walls = [rows[name]["c2c"]["by_class"]["building"]["points"] for name in rows]
        self.assertGreater(walls[0], 0)
        self.assertLess(walls[0], walls[1])
        # The paper's figures, 1064 s and 203 Hz on PC3D-Paris, have a table of their own.
        report = (self.output / "report.md").read_text(encoding="utf-8")
        what_was_run, papers = report.replace(",", "").split("<details>", 1)
        line = next(x for x in papers.splitlines() if x.startswith("| AdaSplats-KPConv"))
        self.assertIn("1064", line)
        self.assertIn("203", line)
        self.assertNotIn("1064", what_was_run)
        before = states(self.output)
        self.compare(*words)
        self.assertEqual(self.run_again(before), set())
        write_network(network, above_m=2)
        self.compare(*words)
        self.assertIn("kpconv/generate", self.run_again(before))
        self.assertNotIn("semantic/generate", self.run_again(before))
        self.refuse(64, *words[:4], "basic", "--network", network.name,
                    says=["--network has no effect without the method kpconv"])
        self.refuse(66, *words[:-1], "none", says=["none"])

    def test_kpconv_of_points_without_labels_or_of_another_scheme(self):
        write_cloud(self.folder / "place.ply", tiny_place(), labels=False)
        network = self.network()
        words = ["place.ply", "-o", "out", *FEW_BEAMS, "--network", network.name]
        self.compare(*words, "--methods", "kpconv")
        row = rows_of(self.output)["kpconv"]
        self.assertEqual(row["state"], "done", row)
        self.assertEqual(row["c2c"]["by_class"], {})
        self.assertEqual(set(row["generate"]["points_removed"]), {"car"})
        self.compare(*words, "--methods", "kpconv", "--remove", "none")
        self.assertEqual(rows_of(self.output)["kpconv"]["generate"]["points_removed"], {})
        paris = [(x, y, z, {40: 7, 50: 1, 80: 5}[label]) for x, y, z, label in tiny_place()]
        write_cloud(self.folder / "place.ply", paris)
        self.compare(*words, "--methods", "kpconv,basic", "--labels", "paris-carla-3d")
        rows = rows_of(self.output)
        for name in ["kpconv", "basic"]:
            self.assertEqual(set(rows[name]["c2c"]["by_class"]), {"road", "building", "pole"})
            self.assertGreater(rows[name]["c2c"]["by_class"]["road"]["points"], 1000)
        # Nobody has to ask for it.
        self.compare(*words, "--time-limit", "0.01")
        self.assertIn("kpconv", rows_of(self.output))

    def test_what_the_paper_removes(self):
        """Section "Adaptive Splatting": moving and parked cars, pedestrians; whatever the scheme."""
        still = tiny_place()
        vehicles = [(10 + 0.1 * i, -3, 0.05 * i, 10) for i in range(30)]
        points = [(x, y, z, {40: 7, 50: 1, 80: 5}[label]) for x, y, z, label in still] + vehicles
        (self.folder / "paris").mkdir()
        write_cloud(self.folder / "paris" / "Soufflot_1.ply", points[::2])
        write_cloud(self.folder / "paris" / "Soufflot_2.ply", points[1::2])
        paper = ["paris", "--preset", "paper-pc3d", "-o", "out", *FEW_BEAMS, "--methods",
                 "basic,imls"]
        self.compare(*paper)
        self.assertEqual(results_of(self.output)["data"]["removed"],
                         {"rule": "movable", "points": 30, "by_class": {"vehicles": 30},
                          "paper": "movable"})
        for name, row in rows_of(self.output).items():
            self.assertEqual(row["state"], "done", (name, row))
            self.assertEqual(row["generate"]["points_in"], len(points), name)
            self.assertIn("--remove movable", row["generate"]["command"])
            self.assertNotIn("vehicles", row["c2c"]["by_class"])
            # All are compared with the same points, of which the same are left out.
            self.assertEqual(row["c2c"]["original_points"], len(still), name)
        self.assertIn("movable: 30 of", (self.output / "report.md").read_text(encoding="utf-8"))
        # The scheme knows nothing that moves, so that "moving" would remove nothing.
        self.refuse(64, *paper, "--remove", "moving", says=["--remove moving", "--remove movable"])
        self.compare(*paper, "--remove", "none")
        self.assertEqual(results_of(self.output)["data"]["removed"]["points"], 0)
        self.assertIn("nothing; the paper removes movable objects",
                      (self.output / "report.md").read_text(encoding="utf-8"))
        for row in rows_of(self.output).values():
            self.assertEqual(row["c2c"]["original_points"], len(points))

    def places(self):
        lines = (self.output / "work" / "trajectory.csv").read_text().splitlines()
        return [[float(v) for v in line.split(",")[1:4]] for line in lines if line[0].isdigit()]

    def test_semantickitti(self):
        cloud, poses = self.folder / "cloud.ply", self.folder / "poses.csv"
        write_cloud(cloud, tiny_place())
        lines = ["time,x,y,z,qw,qx,qy,qz"]
        lines += [f"{0.1 * k:.1f},{4 + 2 * k},0,2,1,0,0,0" for k in range(3)]
        poses.write_text("\n".join(lines) + "\n")
        run("model", cloud, "-o", self.folder / "m.ply", "--labels", "semantickitti", check=True)
        run("simulate", self.folder / "m.ply", "--trajectory", poses, "-o",
            self.folder / "dataset", check=True)
        kitti = ["dataset", "--preset", "paper-kitti", *self.RUN]
        self.compare(*kitti, "--held-out", "dataset/sequences/00", "--held-out-scans", "2:1")
        results = results_of(self.output)
        data = results["data"]
        self.assertEqual((data["inputs"], data["labels"], data["scans"], data["offset_m"]),
                         (["dataset/sequences/00"], "semantickitti", "0:150", [1, 1, -0.5]))
        basic = results["competitors"][0]
        self.assertEqual((basic["state"], basic["simulate"]["scans"]), ("done", 3), basic)
        self.assertGreater(basic["resimulate"]["rays"], 1000)
        self.assertEqual(results["paper"]["table"], "SemanticKITTI")
        self.assertEqual(self.paper_names(),
                         ["poisson", "imls", "basic", "descriptors", "kpconv", "semantic"])
        # The sensor drives where the chosen scans were taken, not along the whole sequence.
        self.assertEqual(self.places(), [[4, 0, 2], [6, 0, 2], [8, 0, 2]])
        self.compare(*kitti, "--scans", "1:2", "--time-limit", "0.01")
        self.assertEqual(self.places(), [[6, 0, 2], [8, 0, 2]])
        self.compare(*kitti, "--scans", "0:2:2", "--time-limit", "0.01")
        self.assertEqual(self.places(), [[4, 0, 2], [8, 0, 2]])
        self.assertLess(results_of(self.output)["data"]["points"], data["points"])
        self.refuse(64, "dataset", "--preset", "paper-kitti", "-o", "other", "--scans", "3:1",
                    says=["3 scans"])
        (self.folder / "empty").mkdir()
        self.refuse(65, "empty", "--preset", "paper-kitti", "-o", "other", says=["sequence 00"])

    def test_m_city(self):
        points = tiny_place()
        header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(points)}"]
        header += [f"property float {axis}" for axis in "xyz"] + ["end_header\n"]
        body = b"".join(struct.pack("<3f", *point[:3]) for point in points)
        (self.folder / "city.ply").write_bytes("\n".join(header).encode() + body)
        (self.folder / "city.obj").write_text(
            "v -5 -8 0\nv 20 -8 0\nv 20 8 0\nv -5 8 0\nf 1 2 3 4\n")
        self.compare("city.ply", "--preset", "paper-mcity", "--mesh", "artist=city.obj", *self.RUN)
        results = results_of(self.output)
        self.assertEqual((results["data"]["inputs"], results["data"]["labels"]), (["city.ply"], ""))
        self.assertEqual(results["data"]["removed"],
                         {"rule": "none", "points": 0, "by_class": {}, "paper": "none"})
        for option, value, says in [("--remove", "movable", "--remove movable"),
                                    ("--labels", "semantickitti", "--labels has no effect"),
                                    ("--poisson-depth", "9", "--poisson-depth has no effect"),
                                    ("--held-out-scans", "0:1", "--held-out-scans has no effect"),
                                    ("--scans", "0", "--scans: expected FIRST:COUNT")]:
            self.refuse(64, "city.ply", "--preset", "paper-mcity", *self.RUN, option, value,
                        says=[says])
        self.assertNotIn(str(self.folder), json.dumps(results, ensure_ascii=False))
        rows = rows_of(self.output)
        self.assertEqual([(row["state"], row["kind"]) for row in rows.values()],
                         [("done", "splats"), ("done", "mesh")])
        self.assertEqual(rows["artist"]["generate"]["primitives"], 2)
        self.assertIsNone(rows["artist"]["generate"]["seconds"])
        self.assertGreater(rows["artist"]["c2c"]["c2c_m"], 0)
        self.assertNotIn("resimulate", rows["basic"])
        self.assertNotIn("truth", rows["basic"])
        self.assertEqual(results["paper"]["table"], "M-City")
        self.assertEqual(self.paper_names(), ["manual", "basic", "descriptors", "semantic"])
        # Oracle: the place is 14.75 m long and flat; its heights begin at 0.
        places = self.places()
        self.assertEqual(len(places), 20)
        self.assertAlmostEqual(places[-1][0] - places[0][0], 0.8 * 14.75, delta=0.5)
        for place in places:
            self.assertAlmostEqual(place[2], 1.8, delta=0.05)


if __name__ == "__main__":
    unittest.main()
