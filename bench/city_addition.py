#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Adding a second drive to a city: its cost, and how well both together predict beams.

  bench/city_addition.py PROGRAM WORK OUT.json [--drive DRIVE --held-out OTHER] [--shift M]...
      [--tile M] [--points N] [--device cuda|cpu] [--name NAME]

With a recording: its even scans make the city; its odd ones are added, unchanged and with all their
poses shifted sideways by each `shift`: registered to the city, and unregistered (an error unless
--max-shift allows it). For comparison, the first city alone and a city from all scans at once;
`evaluate resimulate` reports how well each predicts the beams of another pass. With `points`: a
procedural city of that size; the first four fifths of its scans make the city, the rest is added;
reports the seconds of both steps and of all scans at once. On a GPU, an unmeasured small model comes
first. Writes OUT.json (for bench/results).
"""
import argparse
import json
import pathlib
import shutil
import subprocess
import sys
import time

from provenance import provenance_of

POINTS_A_METRE = 125_000
HELD_OUT = ("rays", "no_hit", "early_50cm", "late_50cm", "within", "range_error_m")


def run(command):
    """Runs a command; returns its seconds."""
    start = time.monotonic()
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}:\n{done.stderr}")
    return time.monotonic() - start


def error_of(command):
    """The error of a command that must fail."""
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode == 0:
        sys.exit(f"{' '.join(map(str, command))}: succeeded, but an error was expected")
    return done.stderr.strip().splitlines()[-1]


def shifted_drive(drive, folder, shift_m):
    """A copy of a sequence with its poses shifted to the right; other files are linked."""
    folder.mkdir(parents=True)
    for file in drive.iterdir():
        if file.name != "poses.txt":
            (folder / file.name).symlink_to(file.resolve())
    lines = []
    for line in (drive / "poses.txt").read_text().splitlines():
        numbers = [float(word) for word in line.split()]
        numbers[3] += shift_m  # camera frame: x to the right
        lines.append(" ".join(map(repr, numbers)))
    (folder / "poses.txt").write_text("\n".join(lines) + "\n")
    return folder


class Bench:
    def __init__(self, given):
        self.given = given
        self.report = given.work / "report.json"
        self.provenance = None

    def model(self, name, *words):
        """Makes a city; returns its folder and its report, with the seconds of the command."""
        output = self.given.work / name
        seconds = run([self.given.program, "model", *words, "-o", output, "--device",
                       self.given.device, "--report", self.report])
        report = json.loads(self.report.read_text())
        self.provenance = report["provenance"]
        found = {"seconds": seconds, "points": report["points"], "splats": report["primitives"],
                 "tiles": report["tiles"], "steps_s": report["seconds"]}
        found |= {key: report[key] for key in ("tiles_kept", "fit", "alignment") if key in report}
        return output, found

    def evaluated(self, name, *words):
        output, found = self.model(name, *words)
        run([self.given.program, "evaluate", "resimulate", output, self.given.held_out, "--device",
             self.given.device, "--report", self.report])
        report = json.loads(self.report.read_text())
        found["held_out"] = {key: report[key] for key in HELD_OUT}
        return output, found

    def of_recording(self):
        drive, tile = self.given.drive, ["--tile", self.given.tile]
        scans = len((drive / "poses.txt").read_text().splitlines())
        even, odd = ["--scans", f"0:{(scans + 1) // 2}:2"], ["--scans", f"1:{scans // 2}:2"]
        city, first = self.evaluated("first", drive, *even, *tile, "--keep-points")
        found = {"first": first, "at_once": self.evaluated("at_once", drive, *tile)[1],
                 "added": self.evaluated("added", drive, *odd, "--add-to", city)[1]}
        for shift in self.given.shift:
            moved = shifted_drive(drive, self.given.work / f"moved_{100 * shift:.0f}" / "sequences" / "00", shift)
            add = [moved, *odd, "--add-to", city]
            found[f"moved_{shift}"] = {
                "refused_where_it_is": error_of(
                    [self.given.program, "model", *add, "-o",
                     self.given.work / f"refused_{100 * shift:.0f}", "--device",
                     self.given.device, "--no-calibrate"]),
                "laid_on": self.evaluated(f"laid_{100 * shift:.0f}", *add)[1],
                "left_where_it_is": self.evaluated(f"left_{100 * shift:.0f}", *add, "--no-calibrate", "--max-shift",
                                                "100")[1]}
        return found

    def of_procedural(self):
        work, points = self.given.work, self.given.points
        run([self.given.program, "synth", "city", "-o", work / "drive", "--length",
             f"{points / POINTS_A_METRE:.0f}m", "--points", f"{points:.0f}", "--no-truth"])
        drive = work / "drive" / "sequences" / "00"
        scans = len((drive / "poses.txt").read_text().splitlines())
        first_scans = scans * 4 // 5
        tile = ["--tile", 64, "--no-calibrate"]
        self.model("warm", drive, "--scans", "0:3", *tile)
        at_once = self.model("whole", drive, *tile)[1]
        city, first = self.model("most", drive, *tile, "--scans", f"0:{first_scans}", "--keep-points")
        added = self.model("longer", drive, "--scans", f"{first_scans}:{scans - first_scans}", "--no-calibrate",
                           "--add-to", city)[1]
        return {"scans": scans, "at_once": at_once, "first": first, "added": added}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("work", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--drive", type=pathlib.Path)
    parser.add_argument("--held-out", type=pathlib.Path)
    parser.add_argument("--shift", type=float, action="append", default=[])
    parser.add_argument("--tile", type=float, default=24)
    parser.add_argument("--points", type=float, default=0)
    parser.add_argument("--device", default="cpu")
    parser.add_argument("--name", default="", help="name of the recording")
    given = parser.parse_args()
    shutil.rmtree(given.work, ignore_errors=True)
    given.work.mkdir(parents=True)
    bench = Bench(given)
    found = {}
    if given.points > 0:
        found["procedural"] = bench.of_procedural()
    if given.drive:
        found["recording"] = {"name": given.name, "tile_m": given.tile} | bench.of_recording()
    provenance = provenance_of(given.program)
    provenance["command"] = " ".join(["bench/city_addition.py PROGRAM WORK OUT.json", *sys.argv[4:]])
    provenance["device"] = bench.provenance["device"]
    found = {"provenance": provenance} | found
    print(json.dumps(found, indent=1))
    given.out.write_text(json.dumps(found, indent=1) + "\n")


if __name__ == "__main__":
    main()
