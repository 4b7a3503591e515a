#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""How soon `adasplats view CITY` shows a picture, and at what cost: headless Chromium without a GPU.

usage: view_city.py PROGRAM CITY... [--runs N] [--other PROGRAM] [--page FOLDER] [--cold]
                    [--threads N] [--until first|all] [--shots FOLDER] [--json FILE]

For each run and city starts the program, then the browser (view_city.mjs), and prints medians over
the runs as JSON: `first_picture` is the first picture with 1,000 disks or more, `streets` the first
with 10,000. --other: a second program; its runs alternate with those of the first. --page: a page
(viewer/build.mjs) instead of the programs' own. --cold: drop the city's files from the system's
cache before each run. Times depend on other load on the machine (`load`: before each run); requests,
bytes and CPU seconds hardly do. Needs Node.js, Chromium and `npm ci` in viewer/.
"""
import argparse
import json
import os
import pathlib
import re
import statistics
import subprocess
import sys
import time

from provenance import provenance_of

HERE = pathlib.Path(__file__).resolve().parent
TICKS = os.sysconf("SC_CLK_TCK")


def drop_from_cache(city):
    """Drops a city's files from the cache, so that they are read from disk."""
    for path in (p for p in city.rglob("*") if p.is_file()):
        with path.open("rb") as file:
            os.posix_fadvise(file.fileno(), 0, 0, os.POSIX_FADV_DONTNEED)


def memory_bytes(pid, key):
    status = pathlib.Path(f"/proc/{pid}/status").read_text(encoding="ascii")
    return 1024 * int(re.search(rf"{key}:\s+(\d+) kB", status).group(1))


def cpu_seconds(pid):
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / TICKS


def look(program, city, given, shots):
    """Figures of one start of server and browser."""
    if given.cold:
        drop_from_cache(city)
    load = os.getloadavg()[0]
    start = time.monotonic()
    server = subprocess.Popen([program, "view", city, "--no-browser", "--threads", str(given.threads),
                               "--device", "cpu"], stdout=subprocess.PIPE, text=True)
    try:
        url = server.stdout.readline().strip()
        found = {"load": load, "server_ready_ms": 1000 * (time.monotonic() - start),
                 "server_ready_cpu_s": cpu_seconds(server.pid),
                 "server_ready_bytes": memory_bytes(server.pid, "VmRSS")}
        if not url:
            sys.exit(f"{program} view {city} failed")
        words = ["node", HERE / "view_city.mjs", url, str(server.pid)]
        words += ["--page", given.page] if given.page else []
        words += ["--shots", shots] if shots else []
        words += ["--until", given.until]
        done = subprocess.run(words, stdout=subprocess.PIPE, text=True, timeout=300, check=True)
        found |= json.loads(done.stdout)
        for what in ("", "streets_"):
            found[f"{what}from_command_ms"] = \
                found["server_ready_ms"] + found[f"{what}from_browser_start_ms"]
        found["server_most_bytes"] = memory_bytes(server.pid, "VmHWM")
    finally:
        server.terminate()
        server.wait()
    return found


def medians(runs):
    """Medians of all numbers, and the requests of the last run."""
    found = {"runs": len(runs)}
    for key, value in runs[-1].items():
        if isinstance(value, (int, float)):
            found[key] = round(statistics.median(run[key] for run in runs), 3)
    for key in ("first_picture_ms", "streets_ms", "from_command_ms", "streets_from_command_ms", "load"):
        found[f"{key}_of_runs"] = [round(run[key], 2) for run in runs]
    found["request_list"] = [{k: round(v) if k != "path" else v for k, v in request.items()}
                             for request in runs[-1]["request_list"]]
    return found


def folder_of_shots(given, role, city):
    folder = given.shots.resolve() / f"{role}-{city.name}"
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("cities", type=pathlib.Path, nargs="+")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--other", type=pathlib.Path)
    parser.add_argument("--page", type=pathlib.Path)
    parser.add_argument("--cold", action="store_true")
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("--until", choices=("first", "all"), default="all",
                        help="when to stop: at the first picture, or when everything visible has loaded")
    parser.add_argument("--shots", type=pathlib.Path)
    parser.add_argument("--json", type=pathlib.Path, help="write the figures to a file, too")
    given = parser.parse_args()
    programs = {"program": given.program, **({"other": given.other} if given.other else {})}
    found = {(role, city): [] for role in programs for city in given.cities}
    for _ in range(given.runs):
        for (role, city), runs in found.items():
            runs.append(look(programs[role], city, given, None))
    for role, city in found if given.shots else []:  # in separate runs, since screenshots take time
        look(programs[role], city, given, folder_of_shots(given, role, city))
    facts = {}
    # Paths without their folders, which are meaningless on other machines.
    command = " ".join(["bench/view_city.py", *(word if word.startswith("-") else pathlib.Path(word).name
                                                for word in sys.argv[1:])])
    for role, program in programs.items():
        facts[role] = {"provenance": {**provenance_of(program), "command": command}, "cities": []}
        for city in given.cities:
            manifest = json.loads((city / "city.json").read_text(encoding="utf-8"))
            facts[role]["cities"].append({"city": city.name, "splats": manifest["splats"],
                                          "tiles": len(manifest["tiles"]), "cold": given.cold,
                                          **medians(found[role, city])})
    text = json.dumps(facts, indent=1)
    print(text)
    if given.json:
        given.json.write_text(text + "\n", encoding="ascii")


if __name__ == "__main__":
    main()
