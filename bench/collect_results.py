#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Merges the reports of a part into one JSON file, and all parts into another (for
bench/results_cpu.sh).

usage: collect_results.py part FOLDER OUT.json COMMAND    all *.json in FOLDER; subfolders are keys
       collect_results.py all OUT.json PART.json...
       collect_results.py current PART.json PROGRAM COMMAND
                                    exit code 0: from the program's clean commit and this command
       collect_results.py compactly FILE.json FOLDER
                                    rewrite the file with objects of plain values on one line

The reports of a part must come from one commit. If parts come from several commits, the merged
result names none, and each part names its own.
"""
import json
import pathlib
import sys

from provenance import provenance_of

# Keys of reports that are no figures or too detailed for a table.
LEFT_OUT = {"program", "version", "command", "device", "provenance", "parameters", "warnings",
            "files", "by_range", "by_incidence", "by_surroundings", "by_elevation", "laser_bias",
            "step_seconds"}


def figures_of(report):
    if not isinstance(report, dict):
        return report
    return {key: value for key, value in report.items() if key not in LEFT_OUT}


def common(values, what, folder):
    """The value that all have in common."""
    if not values or any(value != values[0] for value in values):
        sys.exit(f"collect_results: {folder}: the reports differ in their {what}: {values}")
    return values[0]


def part(folder, out, command):
    folder, result, sources = pathlib.Path(folder), {}, []
    for file in sorted(folder.rglob("*.json")):
        report = json.loads(file.read_text())
        if isinstance(report, dict) and "provenance" in report:
            sources.append(report["provenance"])
        node = result
        for name in file.relative_to(folder).parts[:-1]:
            node = node.setdefault(name, {})
        node.setdefault(file.stem, {})
        node[file.stem] = figures_of(report)
    dates = sorted(source["date"] for source in sources)
    cores = [source["machine"].pop("cores", 0) for source in sources]  # may differ within a part
    shared = {key: common([source[key] for source in sources], key, folder)
            for key in ("version", "commit", "dirty", "machine")}
    shared["machine"]["cores"] = max(cores)
    devices = [{name: source["device"].get(name) for name in ("kind", "name", "driver")}
               for source in sources]
    shared["device"] = common(devices, "device", folder)
    shared.update(first_date=dates[0] if dates else None, last_date=dates[-1] if dates else None,
                command=command)
    write(out, {"provenance": shared, **result})


def everything(out, parts):
    results = {pathlib.Path(file).stem: json.loads(pathlib.Path(file).read_text())
               for file in parts}
    sources = [(x["provenance"]["commit"], x["provenance"]["dirty"]) for x in results.values()]
    one = sources[0] if len(set(sources)) == 1 else (None, None)
    write(out, {"commit": one[0], "dirty": one[1], "parts": results})


def is_current(file, program, command):
    shared = json.loads(pathlib.Path(file).read_text())["provenance"]
    now = provenance_of(program)
    same = (shared["commit"], shared["dirty"]) == (now["commit"], now["dirty"])
    return (same and shared["command"] == command and now["dirty"] is not True
            and now["commit"] != "unknown")


def text_of(value, margin=""):
    """JSON with one line per object that contains no other objects."""
    if not isinstance(value, dict) or not any(isinstance(one, dict) for one in value.values()):
        return json.dumps(value)
    rows = (f"{margin} {json.dumps(key)}: {text_of(one, margin + ' ')}"
            for key, one in value.items())
    return "{\n" + ",\n".join(rows) + f"\n{margin}}}"


def write(out, result):
    pathlib.Path(out).write_text(text_of(result) + "\n")


def main():
    match sys.argv[1:]:
        case ["part", folder, out, command]:
            part(folder, out, command)
        case ["all", out, *parts] if parts:
            everything(out, parts)
        case ["compactly", file, folder]:
            write(pathlib.Path(folder) / pathlib.Path(file).name,
                  json.loads(pathlib.Path(file).read_text()))
        case ["current", file, program, command]:
            sys.exit(0 if is_current(file, program, command) else 1)
        case _:
            sys.exit(__doc__)


if __name__ == "__main__":
    main()
