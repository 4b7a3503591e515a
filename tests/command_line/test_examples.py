# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Every command in a help text or a document is one that the program takes: subcommands, options,
words of closed sets and names of sensors."""
import re
import shlex
import unittest
from pathlib import Path

from support import ABOUT, SUBCOMMANDS, ProgramTest

ROOT = Path(__file__).resolve().parents[2]
# docs/compare/ are records of runs, not examples.
DOCUMENTS = sorted([ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "ARCHITECTURE.md",
                    *(ROOT / "docs").glob("*.md"), *(ROOT / "examples").glob("*.py"),
                    *(ROOT / "python" / "adasplats").glob("*.py*"),
                    *(ROOT / "scripts").glob("*.sh")])
FILE_ENDINGS = (".toml", ".json", ".yaml", ".yml", ".csv")
GROUPS = {words[0] for words in SUBCOMMANDS if len(words) > 1}


def commands_of_help(text):
    """The lines behind "Examples:", each as one command."""
    examples = text.partition("Examples:\n")[2].replace("\\\n", " ")
    return [line.strip() for line in examples.splitlines()
            if line.strip().startswith("adasplats ")]


def commands_of_document(text):
    """Commands in fenced blocks and between backticks."""
    inline = re.sub(r"^```.*?^```", "", text, flags=re.M | re.S)
    blocks = "".join(re.findall(r"^```.*?^```", text, flags=re.M | re.S)).replace("\\\n", " ")
    found = re.findall(r"`(adasplats [^`]+)`", inline)
    return found + re.findall(r"^(?:\S*/)?(adasplats .*)$", blocks, flags=re.M)


def sensors_of_text(text):
    """Names of sensors outside of commands: Python, TOML, and in the middle of a sentence."""
    found = re.findall(r"\bSensor\(\"([^\"]+)\"\)", text)
    found += re.findall(r"^like = \"([^\"]+)\"", text, flags=re.M)
    return found + re.findall(r"`((?:velodyne|ouster|hesai|livox|hdl)-[a-z0-9-]+)`", text)


def options_of_help(text):
    """The word for the value of every option in a help text, by its names."""
    options = {}
    for line in text.splitlines():
        if not re.match(r" {2,4}-", line):  # groups of options stand farther in
            continue
        names = re.match(r" +(-[\w-]+(?:, -[\w-]+)*)(?: (\S+))?", line)
        for name in names.group(1).split(", "):
            options[name] = names.group(2) or ""
    return options


def subcommand_of(words):
    """The words of the subcommand that a command begins with."""
    return words[:2] if words[:1] and words[0] in GROUPS else words[:1]


class Examples(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.options = {}

    def setUp(self):
        super().setUp()
        self.sensors = {each["name"] for each in self.report("sensors")["sensors"]}
        self.assertIn("velodyne-vlp-16", self.sensors)

    def options_of(self, subcommand):
        key = " ".join(subcommand)
        if key not in self.options:
            self.options[key] = options_of_help(self.run_good(*subcommand, "--help-all").stdout)
        return self.options[key]

    def check_sensor(self, name, where):
        is_placeholder = name.isupper()
        if not is_placeholder and not name.endswith(FILE_ENDINGS):
            self.assertIn(name, self.sensors, f"{where}: no such sensor")

    def check_command(self, command, where):
        words = shlex.split(command, comments=True)
        if "&&" in words:  # one after the other on a line
            place = words.index("&&")
            self.check_command(shlex.join(words[:place]), where)
            return self.check_command(shlex.join(words[place + 1:]), where)
        words = words[1:]
        for end in [word for word in (">", "|") if word in words]:
            words = words[:words.index(end)]
        if not words or words[0].startswith("-"):
            return None
        subcommand = subcommand_of(words)
        if words[0] in GROUPS and (len(words) == 1 or words[1].startswith("-")):
            return None  # a sentence about all of them
        self.assertIn(subcommand, SUBCOMMANDS + ABOUT, f"{where}: {command}")
        options = self.options_of(subcommand)
        rest = words[len(subcommand):]
        for word, value in zip(rest, rest[1:] + [""]):
            if not re.match(r"-[-a-z]", word):
                continue
            name, _, given = word.partition("=")
            self.assertIn(name, options, f"{where}: {command}")
            kind = options[name]
            is_told = given or value  # a sentence may name an option alone
            if is_told and re.fullmatch(r"[a-z0-9-]+(\|[a-z0-9-]+)+", kind):
                self.assertIn(is_told, kind.split("|"), f"{where}: {command}")
            if is_told and name == "--sensor":
                self.check_sensor(is_told, f"{where}: {command}")
        if subcommand == ["sensors"]:
            for name in [word for word in rest if not word.startswith("-")][:1]:
                self.check_sensor(name, f"{where}: {command}")
        return None

    def test_of_every_help_text(self):
        checked = 0
        for subcommand in SUBCOMMANDS + ABOUT:
            text = self.run_good(*subcommand, "--help-all").stdout
            for command in commands_of_help(text):
                self.check_command(command, " ".join(subcommand) + " --help")
                checked += 1
        self.assertGreater(checked, 2 * len(SUBCOMMANDS))

    def test_of_every_document(self):
        checked = 0
        for path in DOCUMENTS:
            text = path.read_text(encoding="utf-8")
            where = str(path.relative_to(ROOT))
            for command in commands_of_document(text):
                self.check_command(command, where)
                checked += 1
            for name in sensors_of_text(text):
                self.check_sensor(name, where)
        self.assertGreater(checked, 30)

    def test_what_is_wrong_is_found(self):
        for command in ["adasplats simulate m.ply --sensor vlp-16", "adasplats sensors vlp-16",
                        "adasplats simulate m.ply --formt npy", "adasplats simulat m.ply",
                        "adasplats info m.ply && adasplats simulate m.ply --formt npy",
                        "adasplats simulate m.ply --format nyp -o scans"]:
            with self.assertRaises(AssertionError, msg=command):
                self.check_command(command, "test")

    def test_a_part_of_a_name_is_suggested(self):
        for part, name in [("vlp-16", "velodyne-vlp-16"), ("os1-64", "ouster-os1-64"),
                           ("hdl64", "hdl-64-paper"), ("mid40", "livox-mid-40")]:
            said = ["unknown sensor", part, f"did you mean '{name}'"]
            self.run_bad(64, "sensors", part, says=said)
            self.run_bad(64, "simulate", self.cloud, "--trajectory", self.poses, "--sensor", part,
                         "-o", self.folder / "out", says=said)


if __name__ == "__main__":
    unittest.main()
