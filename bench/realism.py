#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Whether classifiers can distinguish scans of a calibrated sensor from the real scans at the same
poses.

  bench/realism.py build/release/bin/adasplats REAL_DATA OUT [--only NAME...] [--plain]

units.py defines drives, calibrated sensors and the scans that they were fitted to. For each row: a
model of the drive, a sensor fitted to other scans than the tested ones (unless the name of the row
states otherwise), its scans simulated at the poses of the real ones, and `evaluate realism` of both.
--plain: also with the library's sensor of that kind, which shows the effect of fitting. Writes
OUT/realism.json (for bench/results):

  rows     by name: AUC of boosted trees and of logistic regression with all features, geometry,
           dropout and intensity, with 95 % intervals; the same for real against real; statistics of
           both; foretold: what `evaluate unit` reports for held-out scans, where available
  drives   real against real by drive, with as many scans as its largest row

and prints Markdown tables. Existing files are reused. Needs NumPy.
"""
import json

from units import UNIT_OF, Workshop, kitti_rows, labelled_rows, options_parser, other_rows

GROUPS = ("all", "geometry", "dropout", "intensity")
# Sequences that were not used in the development of calibrated sensors.
TESTED = ("03", "05", "07", "09")
# Target AUC of the classifier.
LIMITS = {"all": 0.8, "geometry": 0.65, "dropout": 0.65, "intensity": 0.75}
STATISTICS = (
    ("returns", "returns", "{:.0f}"), ("noise of ranges, mm", "range_noise_m", "{:.1f}"),
    ("offsets of lasers, mm", "laser_offsets_m", "{:.1f}"),
    ("noise of intensities", "intensity_noise", "{:.4f}"),
    ("scatter of rings' intensities", "intensity_rings", "{:.4f}"),
    ("zeros", "intensity_zeros", "{:.1%}"), ("zero after zero", "intensity_zero_next", "{:.2f}"),
    ("missing in runs of one", "missing_runs_of_1", "{:.0f}"),
    ("in runs of 6 to 20", "missing_runs_6_to_20", "{:.0f}"),
    ("from planes, mm", "plane_residual_m", "{:.1f}"),
    ("rings found", "unfolded_rings", "{:.1f}"), ("highest intensity", "intensity_most", "{:.2f}"),
    ("farthest range, m", "range_most_m", "{:.1f}"), ("nearer than 2.5 m", "near_points", "{:.0f}"))


def wanted_rows():
    places = [row for place, row in zip(UNIT_OF, labelled_rows()) if place in TESTED]
    return [*kitti_rows(), *places, *other_rows()]


def plain_scans(workshop, row):
    """Like workshop.scans(), with the library's sensor."""
    drive, name = workshop.drives[row.drive], f"{row.key}-plain-scans"
    workshop.report(["simulate", workshop.model(drive), *drive.driving, "--sensor",
                     drive.plain_sensor, "-o", workshop.out / name, "--overwrite"], name)
    return workshop.out / name


def evaluated(workshop, row, scans, name):
    """Figures of `evaluate realism` for a folder of simulated scans."""
    drive = workshop.drives[row.drive]
    report = workshop.report(
        ["evaluate", "realism", scans / drive.scan_folder, drive.scans, *drive.reading,
         *(["--scans", row.judged_scans] if row.judged_scans else [])], name)
    return {key: report[key] for key in ("sensor", "scans", "patches", "auc", "auc_low", "auc_high",
                                         "logistic", "real_real", "statistics")}


def row_of(workshop, row, with_plain):
    drive = workshop.drives[row.drive]
    fit = workshop.unit(row)[1]
    made = {"name": row.name, "use": row.use, "model_of": drive.model_of,
            "fitted": {"drive": row.fitted_drive, "scans": row.fitted_scans or "all",
                       "agreement": fit.get("agreement")},
            "judged": {"drive": row.drive, "scans": row.judged_scans or "all"}}
    made.update(evaluated(workshop, row, workshop.scans(row, f"{row.key}-scans"), f"{row.key}-realism"))
    made["reached"] = {group: made["auc"][group] is not None and made["auc"][group] <= limit
                       for group, limit in LIMITS.items()}
    made["shown"] = shown_of(made)
    predicted = workshop.predicted(row)
    if predicted is not None:
        made["foretold"] = {key: predicted[key] for key in (
            "within_half_a_metre", "intensity", "intensity_near", "drop", "drop_unblocked",
            "drop_by_rate")}
    if with_plain:
        made["plain"] = evaluated(workshop, row, plain_scans(workshop, row), f"{row.key}-plain-realism")
    return made


def interval(test, group):
    if test["auc"][group] is None:
        return "–"
    return f"{test['auc'][group]:.3f} ({test['auc_low'][group]:.3f} .. {test['auc_high'][group]:.3f})"


def pair_text(row, title, key, form):
    """Text of a statistic, real and simulated."""
    pair, scale = row["statistics"][key], 1000 if title.endswith(", mm") else 1
    return " / ".join("–" if pair[side] is None else form.format(scale * pair[side])
                      for side in ("real", "simulated"))


def shown_of(row):
    """The figures of a row as texts for tables."""
    tests = {"trees": row, "logistic": row["logistic"], "real_real": row["real_real"]}
    return {**{kind: {group: interval(test, group) for group in GROUPS}
               for kind, test in tests.items()},
            "statistics": {key: pair_text(row, title, key, form) for title, key, form in STATISTICS}}


def test_lines(row):
    """One line per classifier."""
    for kind in ("trees", "logistic", "real_real"):
        cells = row["shown"][kind].values()
        yield f"| {row['name']} | {kind.replace('_', ', ')} | " + " | ".join(cells) + " |"


def statistic_lines(rows):
    yield "| of a scan, real / simulated | " + " | ".join(row["name"] for row in rows) + " |"
    yield "|---|" + "--:|" * len(rows)
    for title, key, _ in STATISTICS:
        yield f"| {title} | " + " | ".join(row["shown"]["statistics"][key] for row in rows) + " |"


def real_drives(rows):
    """Real against real for every drive, from its row with the most scans."""
    found = {}
    for row in rows:
        name = row["judged"]["drive"]
        if name not in found or scans_of(row) > found[name]["scans"]:
            found[name] = {"name": name, "scans": scans_of(row), **row["real_real"]}
    return list(found.values())


def scans_of(row):
    scans = row["scans"]
    return scans["real"] if isinstance(scans, dict) else scans


def main():
    parser = options_parser(__doc__)
    parser.add_argument("--plain", action="store_true")
    options = parser.parse_args()
    workshop = Workshop(options.program, options.data, options.out)
    print("| scans | classifier | " + " | ".join(GROUPS) + " |\n|---|---|" + "---|" * len(GROUPS))
    rows = []
    for row in workshop.available(wanted_rows(), options.only):
        rows.append(row_of(workshop, row, options.plain))
        print("\n".join(test_lines(rows[-1])), flush=True)
    print("\n" + "\n".join(statistic_lines(rows)))
    provenance = workshop.provenance(options, "realism.py" + options.plain * " --plain")
    (options.out / "realism.json").write_text(json.dumps(
        {"provenance": provenance, "rows": rows, "drives": real_drives(rows)},
        indent=1) + "\n")


if __name__ == "__main__":
    main()
