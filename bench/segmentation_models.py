#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""What classes of a network cost: AdaSplats-KPConv against the same method with true labels.

  bench/segmentation_models.py build/release/bin/adasplats OUT PLACE[=NETWORK]... [--network FILE]

PLACE is a labelled sequence folder, or what `synth street` wrote. NETWORK is a file of the place's
own (one that did not learn from it); else --network, else the network of the program. Writes
OUT/segmentation_models.json and prints a Markdown table. Models and scans stay in OUT; what is there
is not made again, unless the network is another one. Per place:

- splats of `model --method semantic`, with --segment and with true labels, and their ratio;
- C2C of fence, pole and traffic-sign: of simulated points (hdl-64-paper, trajectory shifted as in
  the paper) that are nearest to a true point of the class, whatever class they have themselves.
  `own`: of those that have the class to points that truly have it, which tells how far from any
  fence something was taken for one. `missing`: from the true points to the simulated ones;
- of the points that truly are movable the share that the network calls so (recall), and of all
  other points with a true class the share that it calls so (lost).
"""
import argparse
import hashlib
import json
import pathlib
import subprocess

from provenance import provenance_of

THIN = ["fence", "pole", "traffic-sign"]
MOVABLE = {"car", "bicycle", "motorcycle", "truck", "other-vehicle", "person", "bicyclist",
           "motorcyclist"}
# What is to be shown: at most, at most, at least, at most.
LIMITS = {"primitives": 1.25, "c2c": 1.2, "recall": 0.8, "lost": 0.02}


def report_of(words, file):
    """What a command reports; not run where the report is there."""
    if not file.exists():
        words = [*map(str, words), "--report", str(file)]
        done = subprocess.run(words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        if done.returncode != 0:
            raise SystemExit(f"{' '.join(words)}: {done.stderr}")
    return json.loads(file.read_text())


def sum_of(counts, rows, columns):
    return sum(counts[row][column] for row in rows for column in columns)


class Place:
    """The models of one place and what is measured on them."""

    def __init__(self, program, place, network, out):
        self.program, self.network = program, network
        self.name = place.name
        self.is_street = (place / "mapping.ply").exists()
        self.points = place / "mapping.ply" if self.is_street else place
        poses = place / "sequences/00" if self.is_street else place
        offset = "1,1,-1" if self.is_street else "1,1,-0.5"
        self.drive = ["--sensor", "hdl-64-paper", "--trajectory", poses, f"--offset={offset}",
                      "--every", "4" if self.is_street else "2"]
        digest = hashlib.sha256(network.read_bytes()).hexdigest()[:12] if network else "default"
        self.true, self.by_network = out / self.name / "true", out / self.name / digest
        for folder in (self.true, self.by_network):
            folder.mkdir(parents=True, exist_ok=True)

    def network_words(self):
        return ["--network", self.network] if self.network else []

    def model(self, folder, words):
        """The report of a model, and the path of its simulated scans."""
        model, scans = folder / "model.ply", folder / "scans"
        made = report_of([self.program, "model", self.points, "-o", model, "--method", "semantic",
                          "--no-calibrate", *words], folder / "model.json")
        report_of([self.program, "simulate", model, *self.drive, "-o", scans, "--overwrite"],
                  folder / "simulate.json")
        return made, scans / "sequences/00"

    def c2c(self, scans, folder):
        """The distances of thin classes by what they are of."""
        def classes(simulated, original, name, key, *words):
            found = report_of([self.program, "evaluate", "c2c", simulated, original, "--by-class",
                               "--labels", "semantickitti", *words],
                              folder / f"c2c-{name}.json")["by_class"]
            return {thin: {"c2c_m": found[thin][key], "points": found[thin]["points"]}
                    for thin in THIN if thin in found and found[thin]["points"]}

        return {"nearest": classes(scans, self.points, "nearest", "c2c_m", "--nearest-classes"),
                "own": classes(scans, self.points, "own", "c2c_m"),
                "missing": classes(self.points, scans, "missing", "c2c_to_all_m")}

    def agreement(self):
        """How the network's classes of all points agree with the true ones."""
        folder = self.by_network
        out = folder / ("labelled.ply" if self.is_street else "labelled")
        words = [] if self.is_street else ["--overwrite"]
        report_of([self.program, "segment", self.points, "-o", out, *words, *self.network_words()],
                  folder / "segment.json")
        return report_of([self.program, "evaluate", "segmentation", out, self.points, "--labels",
                          "semantickitti"], folder / "segmentation.json")

    def figures(self):
        true, true_scans = self.model(self.true, ["--labels", "semantickitti"])
        made, scans = self.model(self.by_network, ["--segment", *self.network_words()])
        agreement = self.agreement()
        names = agreement["confusion"]["classes"]
        counts = agreement["confusion"]["counts"]
        movable = [k for k, name in enumerate(names) if name in MOVABLE]
        others = [k for k, name in enumerate(names) if name not in MOVABLE]
        every = range(len(names) + 1)
        return {
            "network": made["segmentation"]["network"],
            "primitives": {"network": made["primitives"], "true": true["primitives"]},
            "c2c": {"true": self.c2c(true_scans, self.true),
                    "network": self.c2c(scans, self.by_network)},
            "movable": {"points": sum_of(counts, movable, every),
                        "removed": sum_of(counts, movable, movable),
                        "others": sum_of(counts, others, every),
                        "others_removed": sum_of(counts, others, movable)},
            "removed": made["points_removed"],
            "miou": agreement["miou_present"],
            "groups": agreement["groups"]["iou"],
            "seconds": {"segment": made["seconds"]["segment"], "network": made["seconds"]["total"],
                        "true": true["seconds"]["total"]}}


def with_ratios(row):
    """A row with what is to be shown, and whether it is."""
    ratios = {"primitives": row["primitives"]["network"] / row["primitives"]["true"]}
    true, network = row["c2c"]["true"], row["c2c"]["network"]
    for key, name in (("nearest", "c2c"), ("own", "c2c_own"), ("missing", "c2c_missing")):
        ratios[name] = {thin: part["c2c_m"] / true[key][thin]["c2c_m"]
                        for thin, part in network[key].items()
                        if part["c2c_m"] is not None and true[key].get(thin, {}).get("c2c_m")}
    movable = row["movable"]
    recall = movable["removed"] / movable["points"] if movable["points"] else None
    lost = movable["others_removed"] / movable["others"]
    reached = {"primitives": ratios["primitives"] <= LIMITS["primitives"],
               "c2c": {name: ratio <= LIMITS["c2c"] for name, ratio in ratios["c2c"].items()},
               "recall": recall is None or recall >= LIMITS["recall"],
               "lost": lost <= LIMITS["lost"]}
    return {**row, "ratios": ratios, "recall": recall, "lost": lost, "reached": reached}


def pooled(rows):
    """All places as one: sums of splats and points, C2C weighted by simulated points."""
    def mean(model, key, thin):
        parts = [row["c2c"][model][key].get(thin) for row in rows]
        parts = [part for part in parts if part and part["c2c_m"] is not None]
        points = sum(part["points"] for part in parts)
        total_m = sum(part["c2c_m"] * part["points"] for part in parts)
        return {"c2c_m": total_m / points if points else None, "points": points}

    def total(key):
        return {name: sum(row[key][name] for row in rows) for name in rows[0][key]}

    c2c = {model: {key: {thin: mean(model, key, thin) for thin in THIN} for key in parts}
           for model, parts in rows[0]["c2c"].items()}
    return with_ratios({"primitives": total("primitives"), "c2c": c2c, "movable": total("movable"),
                        "seconds": total("seconds")})


def share(value):
    return "–" if value is None else f"{100 * value:.1f} %"


def line_of(name, row):
    c2c = row["ratios"]["c2c"]
    cells = [f"{c2c[thin]:.2f}" if thin in c2c else "–" for thin in THIN]
    return (f"| {name} | {row['primitives']['network'] / 1e6:.2f} M "
            f"| {row['ratios']['primitives']:.2f} | {' | '.join(cells)} | {share(row['recall'])} "
            f"| {share(row['lost'])} | {row['seconds']['segment']:.0f} s |")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("places", nargs="+", metavar="PLACE[=NETWORK]")
    parser.add_argument("--network", type=pathlib.Path)
    arguments = parser.parse_args()
    print("| place | splats | ratio | fence | pole | sign | recall | lost | segment |")
    print("|---|--:|--:|--:|--:|--:|--:|--:|--:|")
    rows = {}
    for text in arguments.places:
        place, _, own = text.partition("=")
        network = pathlib.Path(own) if own else arguments.network
        one = Place(arguments.program, pathlib.Path(place).resolve(), network, arguments.out)
        rows[one.name] = with_ratios(one.figures())
        print(line_of(one.name, rows[one.name]), flush=True)
    everything = pooled(list(rows.values()))
    if len(rows) > 1:
        print(line_of("all", everything))
    result = {"provenance": provenance_of(arguments.program), "limits": LIMITS, "places": rows,
              "all": everything}
    file = arguments.out / "segmentation_models.json"
    file.write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
