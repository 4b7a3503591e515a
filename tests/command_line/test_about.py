# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""The commands about the program: help, version, completion and man, checked against the parser's help,
and with the installed shells and readers of manual pages."""
import os
import re
import shutil
import subprocess
import unittest

from support import ABOUT, SUBCOMMANDS, ProgramTest, run


def said(*command, **options):
    """stdout and stderr of a command that must succeed."""
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          timeout=120, encoding="utf-8", **options).stdout


def helps_of(words):
    """The help of a command without its examples, and these."""
    text, _, examples = run(*words, "--help-all").stdout.partition("Examples:\n")
    return text, examples


class About(ProgramTest):
    def test_help_is_the_flags(self):
        for words in [[], ["synth"], ["evaluate"], *SUBCOMMANDS, *ABOUT]:
            self.assertEqual(self.run_good("help", *words).stdout,
                             self.run_good(*words, "--help").stdout, words)
        self.assertIn("(required)", self.run_good("help", "model").stdout)
        self.assertIn("--packet-sensor", self.run_good("help", "input").stdout)

    def test_version_is_the_flags(self):
        self.assertEqual(self.run_good("version").stdout, self.run_good("--version").stdout)

    def test_examples(self):
        for words in ABOUT:
            self.assertIn("Examples:\n  adasplats " + " ".join(words),
                          self.run_good(*words, "--help").stdout)

    def test_faults(self):
        self.run_bad(64, "help", "modl", says=["did you mean 'model'"])
        self.run_bad(64, "help", "evaluate", "c3c", says=["did you mean 'c2c'"])
        self.run_bad(64, "help", "model", "more", says=["no subcommands", "more"])
        self.run_bad(64, "man", "nothing-like-it", says=["nothing-like-it"])
        self.run_bad(64, "version", "now", says=["now"])
        self.run_bad(64, "completion", says=["SHELL"])
        self.run_bad(64, "completion", "bsh", says=["did you mean 'bash'"])
        self.run_bad(73, "completion", "bash", "-o", self.folder / "no" / "file", says=["no"])
        self.run_bad(73, "man", "-o", self.cloud / "man1", says=["man1"])


class Completion(ProgramTest):
    def script(self, shell):
        path = self.folder / f"completion.{shell}"
        self.run_good("completion", shell, "-o", path)
        self.assertEqual(path.read_text(encoding="utf-8"),
                         self.run_good("completion", shell).stdout)
        return path

    def need(self, program):
        if not shutil.which(program):
            self.skipTest(f"{program} is not installed")

    def test_zsh(self):
        script = self.script("zsh")
        self.need("zsh")
        self.assertEqual(said("zsh", "-n", script), "")
        home = {**os.environ, "HOME": str(self.folder), "ZDOTDIR": str(self.folder)}
        functions = said("zsh", "-f", "-c", "autoload -Uz compinit && compinit -u -D && "
                         'source "$1" && print -l ${(k)functions} && print $_comps[adasplats]',
                         "zsh", script, env=home).split()
        self.assertEqual(functions[-1], "_adasplats")
        for words in SUBCOMMANDS + ABOUT:
            self.assertIn("_".join(["_adasplats", *words]), functions)

    def test_fish(self):
        script = self.script("fish")
        self.need("fish")
        self.assertEqual(said("fish", "-n", script), "")

        def complete(line):
            command = f"source '{script}'; complete -C '{line}'"
            environment = {**os.environ, "HOME": str(self.folder)}
            lines = said("fish", "--no-config", "-c", command, cwd=self.folder, env=environment)
            return [each.split("\t")[0] for each in lines.splitlines()]

        self.assertEqual(complete("adasplats evalu"), ["evaluate"])
        self.assertIn("c2c", complete("adasplats evaluate "))
        self.assertEqual(complete("adasplats model --method desc"), ["descriptors"])
        self.assertIn("--neighbors", complete("adasplats model --nei"))
        self.assertEqual(complete("adasplats model clou"), ["cloud.ply"])
        self.assertEqual(complete("adasplats help synth str"), ["street"])


class Bash(ProgramTest):
    """The function that bash calls, called as bash does."""

    def setUp(self):
        super().setUp()
        if not shutil.which("bash"):
            self.skipTest("bash is not installed")
        self.script = self.folder / "adasplats.bash"
        self.run_good("completion", "bash", "-o", self.script)

    def complete(self, *words):
        """What is offered for the last of the words."""
        program = ('source "$1"; shift; COMP_WORDS=(adasplats "$@"); COMP_CWORD=$#; '
                   'complete -p adasplats >&2 && _adasplats && '
                   '((${#COMPREPLY[@]} == 0)) || printf "%s\\n" "${COMPREPLY[@]}"')
        result = subprocess.run(["bash", "--norc", "-c", program, "bash", self.script, *words],
                                cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                timeout=60, encoding="utf-8", check=True)
        self.assertEqual(result.stderr, "complete -F _adasplats adasplats\n")
        return result.stdout.splitlines()

    def test_commands(self):
        below = {words[0] for words in SUBCOMMANDS + ABOUT}
        self.assertEqual(set(self.complete("")), below)
        self.assertEqual(self.complete("simk"), ["simkitti32"])
        for group in ["evaluate", "synth"]:
            parts = {words[1] for words in SUBCOMMANDS if words[0] == group}
            self.assertEqual(set(self.complete(group, "")), parts)
            self.assertEqual(set(self.complete("help", group, "")), parts)
        self.assertEqual(set(self.complete("man", "")), below)
        self.assertEqual(self.complete("nothing-like-it"), [])

    def test_every_option_of_every_help(self):
        for words in SUBCOMMANDS + ABOUT:
            text, _ = helps_of(words)
            options = set()
            for line in re.findall(r"^ {2,4}(-[-\w]+(?:, -[-\w]+)*)", text, flags=re.M):
                options.update(line.split(", "))
            self.assertGreater(len(options), 1)
            self.assertEqual(set(self.complete(*words, "-")), options, words)

    def test_every_word_of_every_choice(self):
        checked = 0
        for words in SUBCOMMANDS + ABOUT:
            text, _ = helps_of(words)
            for name, choices in re.findall(r"^ {2,4}(?:-\w, )?(--[-\w]+) ([a-z0-9|-]+)", text,
                                            flags=re.M):
                offered = self.complete(*words, name, "")
                self.assertEqual(offered, choices.split("|"), (words, name))
                self.assertEqual(self.complete(*words, name, "=", ""), offered)
                checked += 1
        self.assertGreater(checked, 20)
        self.assertEqual(self.complete("model", "--method", "=", "d"), ["descriptors"])
        self.assertEqual(self.complete("model", "--method", "="),
                         ["consistent", "basic", "descriptors", "semantic"])
        self.assertEqual(self.complete("completion", ""), ["bash", "zsh", "fish"])
        self.assertEqual(self.complete("simulate", "--gpus", ""), ["all"])

    def test_files(self):
        (self.folder / "a name").mkdir()
        for words in [["model", "cl"], ["model", "-o", "cl"], ["simulate", "m", "--trajectory", "cl"],
                      ["simulate", "m", "--sensor", "cl"], ["info", "x.ply", "cl"]]:
            self.assertEqual(self.complete(*words), ["cloud.ply"], words)
        self.assertEqual(set(self.complete("model", "a")), {"a name", "adasplats.bash"})
        # No file is a number, nor behind a command that takes none.
        self.assertEqual(self.complete("model", "--neighbors", ""), [])
        self.assertEqual(self.complete("model", "--neighbors", "-"), [])
        self.assertEqual(self.complete("version", ""), [])


class Manual(ProgramTest):
    def setUp(self):
        super().setUp()
        self.pages = self.folder / "man1"
        self.run_good("man", "-o", self.pages)

    def test_a_page_for_every_command(self):
        names = {"adasplats", "adasplats-synth", "adasplats-evaluate"}
        names |= {"-".join(["adasplats", *words]) for words in SUBCOMMANDS + ABOUT}
        self.assertEqual({path.name for path in self.pages.iterdir()},
                         {name + ".1" for name in names})
        for words in [[], ["evaluate"], *SUBCOMMANDS]:
            path = self.pages / ("-".join(["adasplats", *words]) + ".1")
            self.assertEqual(path.read_text(encoding="utf-8"),
                             self.run_good("man", *words).stdout)

    def test_written_again(self):
        self.run_good("man", "evaluate", "-o", self.pages)
        self.run_good("man", "evaluate", "-o", self.folder / "new" / "man1")
        self.assertEqual(len(list((self.folder / "new" / "man1").iterdir())), 10)

    def read(self, words):
        """A page as a reader shows it, without bold and italics."""
        if not shutil.which("groff"):
            self.skipTest("groff is not installed")
        path = self.pages / ("-".join(["adasplats", *words]) + ".1")
        result = subprocess.run(["groff", "-man", "-ww", "-rLL=200n", "-P-c", "-Tascii", path],
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=60,
                                encoding="utf-8", check=True)
        self.assertEqual(result.stderr, "", path.name)
        return re.sub(".\b", "", result.stdout)

    def test_what_groff_shows(self):
        for words in [[], ["synth"], ["evaluate"], *SUBCOMMANDS, *ABOUT]:
            text = self.read(words)
            help_text, examples = helps_of(words)
            for option in re.findall(r"^ {2,4}(?:-\w, )?(--[-\w]+)", help_text, flags=re.M):
                self.assertRegex(text, rf"(?m)^ +.*{option}\b", words)
            for line in examples.splitlines():
                self.assertIn(line.strip(), text)
        text = self.read(["model"])
        self.assertRegex(text, r"--neighbors INT\n +Number of neighbours of a point, K.  Default: 40\.")
        self.assertRegex(text, r"-o, --output PATH\n +Model to write, PLY; with --tile or --traffic: a folder.  Required\.")

    def test_mandoc_accepts_them(self):
        if not shutil.which("mandoc"):
            self.skipTest("mandoc is not installed")
        # It warns of pages without a date; ours have the version in its place.
        warnings = [line for line in subprocess.run(
            ["mandoc", "-Tlint", "-Wwarning", *sorted(self.pages.iterdir())],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, encoding="utf-8", timeout=60,
            check=False).stdout.splitlines() if "missing date" not in line]
        self.assertEqual(warnings, [])


if __name__ == "__main__":
    unittest.main()
