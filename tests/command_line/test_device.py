# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""--device: the CPU where there is no GPU, and a clear word where one was asked for."""
import unittest

from support import SUBCOMMANDS, ProgramTest, tree_digest

WITH_DEVICE = [["model"], ["simulate"], ["render"], ["evaluate", "resimulate"],
               ["evaluate", "truth"], ["evaluate", "presence"], ["evaluate", "echoes"],
               ["fit-drop"], ["simkitti32"], ["compare"], ["view"], ["serve-sensor"], ["demo"],
               ["segment"], ["calibrate"], ["fit-sensor"], ["evaluate", "unit"]]


class DeviceTest(ProgramTest):
    def gpus(self):
        """What `info` says of this machine's GPUs."""
        return self.report("info", "--devices")["gpus"]

    def simulate_words(self, model, output="scans"):
        return ["simulate", model, "--trajectory", self.poses, "--sensor", self.sensor, "-o",
                self.folder / output]

    def jobs(self, model, scans):
        """A command line with an output (or none) of everything that casts or models."""
        out = self.folder / "output"
        return {"model": ["model", self.cloud, "-o", f"{out}.ply", "--labels", "semantickitti"],
                "simulate": self.simulate_words(model, "output"),
                "render": ["render", model, "-o", f"{out}.png", "--width", "64", "--height", "48"],
                "resimulate": ["evaluate", "resimulate", model, scans],
                "truth": ["evaluate", "truth", model, model, "--trajectory", self.poses],
                "presence": ["evaluate", "presence", model, self.cloud],
                "compare": ["compare", self.cloud, "-o", out],
                "demo": ["demo", "-o", out]}


class AnyMachine(DeviceTest):
    def test_help(self):
        for words in SUBCOMMANDS:
            text = self.run_good(*words, "--help-all").stdout
            self.assertEqual("--device auto|cpu|cuda|optix" in text, words in WITH_DEVICE, words)
            self.assertEqual("--gpus" in text, words in (["simulate"], ["simkitti32"]), words)

    def test_bad_values(self):
        model = self.model()
        before = self.names()
        simulate = self.simulate_words(model)
        self.run_bad(64, *simulate, "--device", "kuda", says=["kuda", "did you mean 'cuda'"])
        self.run_bad(64, "render", model, "-o", self.folder / "p.png", "--device", "gpu",
                     says=["--device", "gpu"])
        self.run_bad(64, *simulate, "--gpus=", says=["--gpus"])
        for value in ["x", "0,", ",0", "0,-1", "0;1", "99999999999", "All"]:
            self.run_bad(64, *simulate, f"--gpus={value}", says=["--gpus", f"'{value}'"])
        self.run_bad(64, *simulate, "--gpus", "1,0,1", says=["--gpus", "once"])
        for value in ["0", "all"]:
            self.run_bad(64, *simulate, "--device", "cpu", "--gpus", value,
                         says=["gpus", "device cpu"])
        self.run_bad(64, "render", model, "-o", self.folder / "p.png", "--gpus", "0",
                     says=["--gpus"])
        self.assertEqual(self.names(), before)

    def test_config(self):
        config = self.folder / "settings.toml"
        config.write_text('[simulate]\ndevice = "cpu"\ngpus = [0, 1]\n')
        self.run_bad(64, *self.simulate_words(self.model()), "--config", config,
                     says=["no effect with --device cpu"])

    def test_gpu_memory_needs_a_gpu(self):
        words = self.simulate_words(self.model())
        self.run_bad(64, *words, "--device", "cpu", "--gpu-memory", "8G",
                     says=["--gpu-memory has no effect with --device cpu"])
        self.run_bad(64, *words, "--gpu-memory", "0", says=["--gpu-memory"])

    def test_info_lists_gpus(self):
        gpus = self.gpus()
        for arguments in [["info"], ["info", "--devices"]]:
            text = self.run_good(*arguments).stdout
            if gpus["devices"]:
                self.assertIn("compute capability", text)
            else:
                self.assertEqual(text, f"no GPU: {gpus['reason']}\n")
        for gpu in gpus["devices"]:
            self.assertGreater(gpu["memory_bytes"], 1 << 30)
            self.assertRegex(gpu["compute_capability"], r"^\d+\.\d$")
            self.assertIn(gpu["name"], text)
        both = self.report("info", self.cloud, "--devices")
        self.assertEqual(len(both["files"]), 1)
        self.assertEqual(both["gpus"]["driver"], gpus["driver"])

    def test_cpu_is_reported(self):
        model = self.folder / "m.ply"
        report = self.report("model", self.cloud, "-o", model, "--labels", "semantickitti",
                             "--device", "cpu")
        self.assertLessEqual({"kind", "name", "driver"}, set(report["device"]))
        self.assertEqual((report["device"]["kind"], report["device"]["driver"]), ("cpu", None))
        self.assertNotIn("reason", report["device"])
        self.assertNotIn("device", self.report("info", self.cloud))
        report = self.report(*self.simulate_words(model), "--device", "cpu")
        self.assertEqual(report["device"]["kind"], "cpu")
        rates = report["scans_per_second"]
        self.assertEqual(list(rates), ["traced", "assembled", "written"])
        self.assertEqual(sorted(rates.values(), reverse=True), list(rates.values()))
        self.assertLessEqual(set(rates), set(report["seconds"]))


class WithoutGpu(DeviceTest):
    def setUp(self):
        super().setUp()
        self.found = self.gpus()
        if self.found["devices"]:
            self.skipTest("this machine has a GPU")

    def test_default_is_the_cpu(self):
        outputs = []
        for arguments in [[], ["--device", "cpu"], ["--device", "auto"]]:
            model = self.model("model.ply", *arguments)
            scans = self.simulate(model, "scans", "--overwrite", *arguments)
            picture = self.folder / "picture.png"
            self.run_good("render", model, "-o", picture, "--width", "64", "--height", "48",
                          *arguments)
            outputs.append((model.read_bytes(), tree_digest(scans), picture.read_bytes()))
        self.assertEqual(outputs[0], outputs[1])
        self.assertEqual(outputs[0], outputs[2])
        report = self.report(*self.simulate_words(model), "--overwrite", "--gpus", "all")
        self.assertEqual((report["device"]["kind"], report["device"]["reason"]),
                         ("cpu", self.found["reason"]))

    def test_a_gpu_that_was_asked_for(self):
        """One line with the reason and the cure, and nothing left."""
        model = self.model()
        scans = self.simulate(model)
        before = self.names()
        for name, words in self.jobs(model, scans).items():
            for device in ["cuda", "optix"]:
                with self.subTest(name, device=device):
                    self.run_bad(69, *words, "--device", device, says=[
                        f"device {device}", self.found["reason"], "use device cpu"])
        self.run_bad(69, *self.simulate_words(model, "new"), "--gpus", "0,1",
                     says=["gpus", self.found["reason"], "use device cpu"])
        self.assertEqual(self.names(), before)


class WithGpu(DeviceTest):
    def setUp(self):
        super().setUp()
        found = self.gpus()
        if not found["devices"]:
            self.skipTest(found["reason"])
        self.first = found["devices"][0]

    def test_default_is_cuda(self):
        model = self.model("model.ply", "--device", "cpu")
        simulate = self.simulate_words(model)
        cpu = self.report(*simulate, "--device", "cpu")
        cuda = self.report(*simulate, "--overwrite")
        self.assertEqual(cuda["device"]["kind"], "cuda")
        self.assertEqual(cuda["device"]["name"], self.first["name"])
        self.assertEqual(cuda["device"]["gpus"], [self.first["number"]])
        self.assertEqual(cuda["rays"], cpu["rays"])
        self.assertAlmostEqual(cuda["hits"] / cpu["hits"], 1, delta=0.001)
        self.run_bad(64, *simulate, "--overwrite", "--gpus", "9999", says=["GPU 9999"])


if __name__ == "__main__":
    unittest.main()
