# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""--config sets what flags set, and nothing else."""
import unittest

from support import ProgramTest


class Config(ProgramTest):
    def config(self, text):
        path = self.folder / "settings.toml"
        path.write_text(text, encoding="utf-8")
        return path

    def info(self, text, code, says=()):
        return self.run_bad(code, "info", self.cloud, "--config", self.config(text), says=says)

    def test_equals_flags(self):
        flags = self.model("flags.ply", "--method", "semantic", "--neighbors", "25", "--alpha",
                           "0.3", "--no-denoise", "--base-normals", "--viewpoint", "1,2,3.5",
                           "--ground-scale", "2,2,1.5")
        config = self.config('threads = 1\n[model]\nmethod = "semantic"\nneighbors = 25\n'
                             "alpha = 0.3\nno-denoise = true\ngroup-normals = false\n"
                             "viewpoint = [1, 2, 3.5]\nground-scale = [2, 2, 1.5]\n"
                             f'output = "{self.folder}/config.ply"\nlabels = "semantickitti"\n')
        self.run_good("model", self.cloud, "--config", config)
        self.assertEqual(flags.read_bytes(), (self.folder / "config.ply").read_bytes())
        self.assertNotEqual(flags.read_bytes(), self.model("default.ply").read_bytes())

    def test_command_line_wins(self):
        config = self.config('method = "basic"\nneighbors = 7\ndenoise = false\n')
        report = self.report("model", self.cloud, "-o", self.folder / "m.ply", "--remove", "none",
                             "--config", config, "--neighbors", "31")
        self.assertEqual(report["parameters"]["neighbors"], 31)
        self.assertIs(report["parameters"]["denoise"], False)

    def test_nested_tables(self):
        self.run_good("evaluate", "c2c", self.cloud, self.cloud, "--config",
                      self.config("[evaluate.c2c]\nby-class = true\n[simulate]\nevery = 2\n"))

    def test_unknown_keys_and_tables(self):
        self.info("threads = 1\nseeed = 2\n", 78, ["settings.toml:2:", "seeed", "'seed'"])
        self.info("\n\n[model]\nneigbors = 2\n", 78, ["settings.toml:4:", "'neighbors'"])
        self.info("[modell]\nneighbors = 2\n", 78, ["settings.toml:1:", "'model'"])
        self.info("[evaluate]\nby-class = true\n", 78, ["settings.toml:2:"])
        self.info("help = true\n", 78, ["settings.toml:1:"])

    def test_duplicates(self):
        self.info("threads = 1\nthreads = 2\n", 78, ["settings.toml:2:"])
        self.info("threads = 1\n[info]\nthreads = 2\n", 78, ["settings.toml:", "duplicate"])
        config = self.config("denoise = true\nno-denoise = true\n")
        self.run_bad(78, "model", self.cloud, "-o", "m.ply", "--config", config,
                     says=["duplicate"])

    def test_wrong_values(self):
        self.info('threads = "many"\n', 78, ["settings.toml:1:", "threads"])
        self.info("threads = -4\n", 78, ["settings.toml:1:"])
        self.info("strict = 3\n", 78, ["settings.toml:1:", "true or false"])
        self.info("threads = 1979-05-27\n", 78, ["settings.toml:1:"])
        self.info("viewpoint = [1, [2, 3]]\n", 78, ["settings.toml:1:"])

    def test_wrong_syntax(self):
        self.info("threads = = 2\n", 78, ["settings.toml:1:"])
        self.info("a" * 100_000, 78, ["settings.toml:1:"])

    def test_nesting_is_an_error_and_no_crash(self):
        for text in ("threads = " + "[" * 100_000, "[" * 100_000, "threads = " + "{a=" * 100_000,
                     "a" + ".a" * 100_000 + " = 1", "t = {a" + ".a" * 100_000 + " = 1}"):
            self.info(text, 78, ["settings.toml:1:"])


if __name__ == "__main__":
    unittest.main()
