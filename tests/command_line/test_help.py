# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Help and version: every subcommand explains itself with an example."""
import unittest

from support import SUBCOMMANDS, ProgramTest, run


class Help(ProgramTest):
    def test_program(self):
        text = self.run_good("--help").stdout
        for name in ["synth", "info", "model", "simulate", "render", "evaluate", "compare", "demo"]:
            self.assertIn(name, text)

    def test_subcommands(self):
        for words in SUBCOMMANDS:
            short = self.run_good(*words, "--help").stdout
            self.assertLessEqual(len(short.splitlines()), 40, words)
            text = self.run_good(*words, "--help-all").stdout
            self.assertIn("Examples:\n  adasplats " + " ".join(words), text)
            for flag in ["--threads", "--seed", "--report", "--config", "--version"]:
                self.assertIn(flag, text, words)

    def test_groups(self):
        self.assertIn("resimulate", self.run_good("evaluate", "--help").stdout)
        self.assertIn("street", self.run_good("synth", "--help").stdout)

    def test_required_options_are_marked(self):
        self.assertIn("(required)", self.run_good("model", "--help").stdout)

    def test_every_build_option_is_a_flag(self):
        text = self.run_good("model", "--help-all").stdout
        for flag in """--method --neighbors --alpha --smoothness --radius --error-bound --remove
                       --denoise --no-denoise --denoise-sigmas --denoise-votes --no-resample
                       --resample-base --labels --label-field --sensor-fields --viewpoint
                       --trajectory --scans --strict --salvage --ground-scale --surface-scale
                       --linear-scale --non-surface-scale --planar-scale --group-normals
                       --base-normals""".split():
            self.assertIn(flag, text)

    def test_version(self):
        self.assertRegex(self.run_good("--version").stdout, r"^adasplats \d+\.\d+\.\d+\n$")
        self.assertEqual(run("model", "--version").stdout, run("--version").stdout)


if __name__ == "__main__":
    unittest.main()
