#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Writes the figures of README.md, docs/*.md and docs/research/*.md from measured JSON files.

A figure is a link whose definition, at the end of the document, names file, key and format:

    Built in [66 s][kitti time].
    [kitti time]: bench/results/cpu.json "kitti/models/consistent/model/seconds/total as 0 s"

The key goes down through objects by name, through lists by the member "name". The zeros of the
format are digits, its unit scales: % cm mm ms GB MB kB M k; "0,000" groups digits, "0.0x" is a
ratio, "text" copies the value. "A over B" divides, "mean of A, B" averages values of one file,
"1 - A" subtracts; "mean of" binds tightest, then "over", then "1 -". A missing value becomes "–".
Whole tables are between

    <!-- table: comparison compare/street/compare.json -->   and   <!-- /table -->

(a name of TABLES, a file, for bench/results also the key of the models).

Between <!-- log --> and <!-- /log --> are figures of an earlier version that are not measured
again; elsewhere in the documents of STRICT and STRICT_FOLDERS a figure without a link is an error.

usage: tools/make_figures.py               writes the documents
       tools/make_figures.py --check       runs a self-test, reports differences; exit code 1 if any
       tools/make_figures.py --commits     lists the commits of the figures of STRICT outside of logs,
                                           with their files; exit code 1 if there are several
"""
import json
import pathlib
import re
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
STRICT = ("README.md", "docs/results.md", "docs/performance.md")
STRICT_FOLDERS = ("docs/research/",)
MISSING = "–"
# Files that were measured before they stored their commit.
BEFORE_COMMITS = ()

LOOKS_DEFINED = re.compile(r'^\[[^\]\n]+\]: \S+\.json.*$', re.M)
DEFINITION = re.compile(r'^\[([^\]\n]+)\]: (\S+\.json) "(.+) as (.+)"$', re.M)
LINK = re.compile(r"\[([^\[\]\n]*)\]\[([^\[\]\n]+)\]")
TABLE = re.compile(r"(<!-- table: (\w+) (\S+\.json)(?: ([^\n]+?))? -->\n)(.*?)(<!-- /table -->)", re.S)
FORMAT = re.compile(r"(0,000|0)(?:\.(0+))?( ?)(%|cm|mm|ms|s|m|GB|MB|kB|M|k|x|times|)$")
SCALES = {"%": 100, "cm": 100, "mm": 1000, "ms": 1000, "GB": 1e-9, "MB": 1e-6, "kB": 1e-3,
          "M": 1e-6, "k": 1e-3}
# A number with one of these units reads like a measured figure.
NAKED = re.compile(r"(?<![\w.,-])\d[\d,.]*\d*(?: to \d[\d.,]*)? ?"
                   r"(?:%|cm\b|mm\b|ms\b|s\b|GB\b|MB\b|x\b|times\b|scans/s\b|a second\b)")
# Not our measurements: code, comments, link targets, the paper's figures, names of metrics.
CODE = (re.compile(r"^```.*?^```", re.S | re.M), re.compile(r"`[^`\n]*`"))
QUIET = (re.compile(r"<!-- log -->.*?<!-- /log -->", re.S),
         re.compile(r"<!-- table: .*?<!-- /table -->", re.S), re.compile(r"<!--.*?-->", re.S),
         re.compile(r"\(?\bpaper(?:: [^)|]*|, [^)|]*)"),
         re.compile(r"\]\([^)]*\)"), re.compile(r"(?:within|more than|>) \d+ cm"))


class Fault(Exception):
    """An invalid definition of a figure."""


def part_of(value, name):
    """One step down; None where there is none."""
    if isinstance(value, dict):
        return value.get(name)
    if isinstance(value, list):
        return next((x for x in value if isinstance(x, dict) and x.get("name") == name), None)
    return None


def value_at(data, key):
    """The value of a key, see the module's text; None where one of its parts is missing."""
    if key.startswith("1 - "):
        rest = value_at(data, key[4:])
        return None if rest is None else 1 - rest
    if " over " in key:
        above, below = (value_at(data, part) for part in key.split(" over "))
        return None if above is None or not below else above / below
    if key.startswith("mean of "):
        values = [value_at(data, part) for part in key[8:].split(", ")]
        return None if None in values else sum(values) / len(values)
    for name in key.split("/"):
        data = part_of(data, name)
    return data


def text_of(value, form):
    """A value as a document shows it."""
    if value is None:
        return MISSING
    if form == "text":
        return str(value)
    match = FORMAT.fullmatch(form)
    if not match:
        raise Fault(f"'{form}' is no format: zeros and a unit, like '0.00 cm'")
    whole, places, space, unit = match.groups()
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise Fault(f"{value!r} is no number")
    number = f"{value * SCALES.get(unit, 1):{',' if ',' in whole else ''}.{len(places or '')}f}"
    return number + space + unit


class Files:
    """The JSON files, each read once, and whether they name their commit."""

    def __init__(self):
        self.read = {}

    def at(self, document, name):
        path = (document.parent / name).resolve()
        if path not in self.read:
            self.read[path] = json.loads(path.read_text()) if path.exists() else {}
        return self.read[path]

    def sources(self, root):
        """(name, content, provenances of its parts) of every file that was read."""
        for path, data in sorted(self.read.items()):
            parts = list(data.get("parts", {}).values()) or [data]
            name = str(path.relative_to(root.resolve()))
            yield name, data, [x.get("provenance", x) for x in parts]

    def faults(self, root):
        """Files without a commit, and entries of BEFORE_COMMITS that are not needed."""
        for name, data, sources in self.sources(root):
            has_commit = all(x.get("commit") not in (None, "", "unknown") for x in sources)
            if any(x.get("dirty") for x in sources):
                yield name + ": measured with uncommitted changes"
            if data and has_commit == (name in BEFORE_COMMITS):
                yield name + (": names its commit but is in BEFORE_COMMITS" if has_commit else
                              ": names no commit")


def figure_of(data, key, form):
    """The text of a value, "–" where its file or its part of it has not been measured."""
    value = value_at(data, key)
    names = key.removeprefix("1 - ").removeprefix("mean of ").split("/")
    of_several = names[0] in ("parts", "runs", "competitors")
    part = value_at(data, "/".join(names[:2 if of_several else 1]))
    if value is None and part is not None:
        raise Fault(f"nothing is at '{key}'")
    return text_of(value, form)


# ---- whole tables --------------------------------------------------------------------------

COMPARISON = [
    ("primitives", "generate/primitives", "0.00 M"), ("generate", "generate/seconds", "0 s"),
    ("C2C", "c2c/c2c_m", "0.00 cm"), ("fence", "c2c/by_class/fence/c2c_m", "0.0 cm"),
    ("pole", "c2c/by_class/pole/c2c_m", "0.0 cm"),
    ("traffic-sign", "c2c/by_class/traffic-sign/c2c_m", "0.0 cm"),
    ("no hit", "resimulate/no_hit", "0.0 %"), ("early", "resimulate/early_50cm", "0.0 %"),
    ("late", "resimulate/late_50cm", "0.0 %"),
    ("median", "resimulate/range_error_m/median", "0.00 cm"),
    ("within 10 cm", "resimulate/within/0.10", "0.0 %"),
    ("RMSE", "resimulate/range_error_m/rmse", "0.00 m"), ("holes", "truth/hole_share", "0.0 %"),
    ("ghosts", "truth/ghost_share", "0.0 %"),
    ("to surface", "truth/surface_distance_m/mean", "0.00 cm")]
THIN = ("fence", "pole", "traffic-sign")


def c2c_columns(sensor, name):
    at = f"{sensor}/c2c/by_class/%s/c2c_m"
    columns = [(f"C2C {name}", f"{sensor}/c2c/c2c_m", "0.00 cm")]
    columns += [(f"{thing} {name}", at % thing, "0.00 cm") for thing in THIN]
    mean = "mean of " + ", ".join(at % thing for thing in THIN)
    return columns + [(f"thin mean {name}", mean, "0.00 cm")]


MODELS = [("splats", "model/primitives", "0.00 M"), *c2c_columns("hdl-64-paper", "HDL-64"),
          *c2c_columns("hdl-32-paper", "HDL-32"),
          *(column for column in COMPARISON if column[1].startswith("resimulate"))]
CALIBRATION = [
    ("figures", "use", "text"), ("within 10 cm, as given", "as_given/within_10cm", "0.0 %"),
    ("calibrated", "calibrated/within_10cm", "0.0 %"),
    ("registered", "registered/within_10cm", "0.0 %"),
    ("median, as given", "as_given/median_m", "0.00 cm"),
    ("calibrated", "calibrated/median_m", "0.00 cm"),
    ("no hit", "calibrated/no_hit", "0.0 %"), ("early", "calibrated/early_50cm", "0.0 %"),
    ("late", "calibrated/late_50cm", "0.0 %"), ("splats", "calibrated/primitives", "0.00 M"),
    ("planes", "calibration/planes", "0,000"),
    ("ranges (RMS)", "calibration/range_offset_rms_m", "0.0 cm"),
    ("ghosts", "calibrated/returns/ghosts", "0.0 %"),
    ("holes", "calibrated/returns/upward/holes", "0.0 %"),
    ("returns predicted (F1)", "calibrated/returns/upward/f1", "0.0 %")]
CALIBRATION_PARTS = [
    ("all parts", "calibrated/within_10cm", "0.0 %"), *(
        (title, f"parts/{key}/within_10cm", "0.0 %") for title, key in (
            ("without poses", "no_poses"), ("without ranges", "no_ranges"),
            ("without elevations", "no_elevations"), ("without mount", "no_mount"),
            ("driven path kept", "driven_path_kept"), ("without empty beams", "no_empty_beams")))]
REFINEMENT = [
    *((f"< 10 cm, {title}", f"{key}/within/0.10", "0.0 %") for title, key in (
        ("opaque splats", "without"), ("refined", "refined"),
        ("opaque above 0.3", "opaque above 0.3"))),
    *((f"lost beams, F1: {title}", f"{key}/sensor/{at}/f1", "0.000")
      for at, rule in (("lost", "chance above 1/2"), ("lost_by_rate", "as many as expected"))
      for title, key in ((f"{rule}, without `drop`", "no drop"), ("with it", "refined"))),
    *((f"rank correlation of intensities, {title}", f"{key}/sensor/intensity/rank_correlation",
       "0.000") for title, key in (("one for all splats", "one intensity"),
                                   ("of each splat", "refined")))]
MOUNTS = [
    ("remaining rotation error, degrees", "mount/turn_left_deg", "0.000"),
    ("remaining shift", "mount/shift_left_m", "0.0 cm"),
    ("remaining height error", "mount/height_left_m", "0.0 cm"),
    *(column for column in CALIBRATION[1:6])]
STREETS = [
    ("splats", "primitives", "0.00 M"), ("ghosts", "ghosts", "0.0 %"), ("holes", "holes", "0.0 %"),
    *((f"{thing} found", f"found/{thing}", "0.0 %") for thing in THIN),
    *((f"{thing} beams within 50 cm", f"beams_within_50cm/{thing}", "0.0 %") for thing in THIN),
    ("within 10 cm", "beams/within_10cm", "0.0 %"), ("median", "beams/median_m", "0.00 cm")]
LIDAR4D = [
    ("Chamfer, m2", "beams/lidar4d/points/chamfer_m2", "0.0000"), ("F-score", "beams/lidar4d/points/f_score", "0.0000"),
    ("F-score at 5 cm", "beams/lidar4d/points/f_score_5cm", "0.0000"), *(
        (f"{image} {measure}", f"beams/lidar4d/{key}/{of}", form)
        for image, key in (("depth", "depth_m"), ("intensity", "intensity"))
        for measure, of, form in (("RMSE", "rmse", "0.0000"), ("MedAE", "medae", "0.0000"),
                                  ("SSIM", "ssim", "0.0000"), ("PSNR", "psnr_db", "0.00"))),
    ("ray drop RMSE", "beams/lidar4d/ray_drop/rmse", "0.0000"), ("accuracy", "beams/lidar4d/ray_drop/accuracy", "0.0000"),
    ("F", "beams/lidar4d/ray_drop/f_score", "0.0000")]
SEGMENTATION = [
    ("groups", "groups/miou", "0.0 %"), *(
        (group, f"groups/iou/{group}", "0.0 %")
        for group in ("ground", "surface", "linear", "non-surface", "movable")),
    ("classes", "miou_present", "0.0 %"), ("accuracy", "accuracy", "0.0 %")]
SEGMENTATION_ABLATION = [
    ("steps", "steps", "0,000"), ("groups", "with/groups", "0.0 %"), *(
        (f"fold {fold}", f"folds/{fold}/with/groups", "0.0 %") for fold in "abc"),
    ("classes", "with/classes", "0.0 %"), ("groups without intensities", "without/groups", "0.0 %"),
    ("classes without", "without/classes", "0.0 %")]
SEGMENTATION_MODELS = [
    ("splats", "primitives/network", "0.00 M"),
    ("ratio", "primitives/network over primitives/true", "0.00x"), *(
        (thing, f"c2c/network/nearest/{thing}/c2c_m over c2c/true/nearest/{thing}/c2c_m", "0.00x")
        for thing in THIN),
    ("recall", "movable/removed over movable/points", "0.0 %"),
    ("lost", "movable/others_removed over movable/others", "0.0 %")]
REALISM_GROUPS = ("all", "geometry", "dropout", "intensity")
REALISM = [("figures", "use", "text"), *((group, f"shown/trees/{group}", "text")
                                         for group in REALISM_GROUPS)]
REALISM_LOGISTIC = [
    *((f"{group}, logistic", f"shown/logistic/{group}", "text") for group in REALISM_GROUPS),
    ("all, real against real", "shown/real_real/all", "text")]
REALISM_STATISTICS = [(title, f"shown/statistics/{key}", "text") for title, key in (
    ("returns", "returns"), ("range noise, mm", "range_noise_m"),
    ("laser offsets, mm", "laser_offsets_m"), ("intensity noise", "intensity_noise"),
    ("spread of rings' intensities", "intensity_rings"), ("zeros", "intensity_zeros"),
    ("zero after zero", "intensity_zero_next"), ("missing in runs of one", "missing_runs_of_1"),
    ("in runs of 6 to 20", "missing_runs_6_to_20"),
    ("distance from planes, mm", "plane_residual_m"),
    ("rings found", "unfolded_rings"), ("highest intensity", "intensity_most"),
    ("farthest range, m", "range_most_m"), ("nearer than 2.5 m", "near_points"))]
PREDICTED = [
    ("rank correlation of intensities", "foretold/intensity/rank_correlation", "0.000"),
    ("RMSE after one curve", "foretold/intensity/rmse_after_curve", "0.0000"),
    ("of beams within 0.5 m", "foretold/intensity_near/rmse_after_curve", "0.0000"),
    ("lost beams: accuracy", "foretold/drop/accuracy", "0.0 %"), ("F1", "foretold/drop/f1", "0.000"),
    ("outside of the shadow: accuracy", "foretold/drop_unblocked/accuracy", "0.0 %"),
    ("F1", "foretold/drop_unblocked/f1", "0.000"),
    ("F1 by the expected rate", "foretold/drop_by_rate/f1", "0.000")]
UNFOLDING = [
    ("scans", "scans", "0"), ("real with 64 rings", "scans_with_64_rings/real", "0 %"),
    ("simulated with 64 rings", "scans_with_64_rings/simulated", "0 %"),
    ("right ring, worst scan", "right_ring/least", "0.0 %"), ("mean", "right_ring/mean", "0.0 %"),
    ("points per ring, simulated / real, minimum", "rings/ratio_least", "0.000"),
    ("maximum", "rings/ratio_most", "0.000"),
    ("points in the vehicle's shadow, real", "shadow/real", "0"),
    ("simulated", "shadow/simulated", "0")]
TRANSFER = [
    *((f"{network} on {judged}", f"figures/{network} on {judged}/miou", "0.0 %")
      for network in ("real", "simulated") for judged in ("real", "simulated")),
    ("loss of the real network on simulated scans", "losses/real network, real to simulated",
     "0.0"),
    ("simulated network below the real one on real scans",
     "losses/on real, real to simulated network", "0.0")]
INPUT_KINDS = [("written by", "written_by", "text"), ("other reader", "other_reader", "text"),
               ("points", "points", "0,000"), ("largest difference", "shown", "text")]
INPUT_DRIVES = [("scans of", "scans_of", "text"), ("held-out beams", "rays", "0,000"),
                ("median", "median_m", "0.00 cm"), ("within 10 cm", "within_10cm", "0.0 %"),
                ("no hit", "no_hit", "0.0 %"), ("C2C", "c2c_m", "0.00 cm")]
LAZ_SPEED = [("points", "points", "0,000"), ("format", "point_format", "0"), *(
    (title, f"million_points_per_second/{key}", "0.0") for title, key in (
        ("1 thread", "read_las/1"), ("2 threads", "read_las/2"), ("16 threads", "read_las/16"),
        ("LASzip, 1 thread", "LASzip/1"), ("unpacking alone, 1 thread", "decoder/1"),
        ("2 threads", "decoder/2")))]
HEADLINES = [("before", "before", "text"), ("this release", "now", "text")]
DENSITY = [("splats", "primitives", "0.00 M"), ("C2C, scans of the model", "own_scans/c2c_m", "0.00 cm"),
           ("C2C, all scans", "all_scans/c2c_m", "0.00 cm"), *(
               (thing, f"all_scans/by_class/{thing}/c2c_m", "0.0 cm")
               for thing in ("road", "building", "vegetation", *THIN)),
           ("rays with a hit", "hits", "0.0 %"),
           ("measured to simulated", "all_scans/completeness_m", "0.0 cm")]
ODOMETRY = [
    ("drift, real", "real/drift", "0.00 %"), ("simulated", "simulated/drift", "0.00 %"),
    ("held-out scans", "scans", "0"), *(
        (f"{title}, {name}", f"{key}/{value}_m", "0.0 cm")
        for title, key in (("on simulated", "with_simulated"), ("on real", "with_real"))
        for name, value in (("shift", "shift"), ("forward", "forward"), ("left", "left"), ("up", "up")))]
THIN_THINGS = [column for column in COMPARISON if column[0] in ("primitives", *THIN)]
# Name: (default key of the rows, columns). A column without values is omitted.
TABLES = {"comparison": ("competitors", COMPARISON), "models": (None, MODELS),
          "calibration": ("drives", CALIBRATION),
          "parts": ("drives", CALIBRATION_PARTS), "refinement": ("drives", REFINEMENT),
          "mounts": ("mounts", MOUNTS), "streets": ("streets", STREETS),
          "lidar4d": (None, LIDAR4D),
          "headlines": ("figures", HEADLINES), "density": (None, DENSITY),
          "odometry": ("drives", ODOMETRY),
          "segmentation": ("networks", SEGMENTATION),
          "segmentation_ablation": ("lessons", SEGMENTATION_ABLATION),
          "segmentation_models": ("places", SEGMENTATION_MODELS),
          "realism": ("rows", REALISM), "realism_logistic": ("rows", REALISM_LOGISTIC),
          "realism_statistics": ("rows", REALISM_STATISTICS), "predicted": ("rows", PREDICTED),
          "unfolding": ("rows", UNFOLDING),
          "transfer": ("ways", TRANSFER), "input_kinds": ("kinds", INPUT_KINDS),
          "input_drives": ("drives", INPUT_DRIVES), "laz": ("files", LAZ_SPEED),
          "thin": ("competitors", THIN_THINGS)}


def rows_of(data, key):
    """(title, entry) of every row."""
    rows = value_at(data, key)
    if isinstance(rows, dict):
        rows = [{"title": name, **entry} for name, entry in rows.items()]
    return [(row.get("title", row.get("name", row.get("file"))), row) for row in rows or []]


def table_of(kind, data, key):
    if kind not in TABLES:
        raise Fault(f"no table '{kind}'; known: {', '.join(TABLES)}")
    default_key, columns = TABLES[kind]
    rows = rows_of(data, key or default_key)
    if not rows:
        return f"{MISSING} (not measured yet)\n"
    columns = [c for c in columns if any(value_at(row, c[1]) is not None for _, row in rows)]
    lines = ["| model | " + " | ".join(name for name, _, _ in columns) + " |",
             "|---|" + "--:|" * len(columns)]
    for title, row in rows:
        cells = [text_of(value_at(row, at), form) for _, at, form in columns]
        lines.append(f"| {title} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


# ---- documents -----------------------------------------------------------------------------

def made(document, text, files):
    """The text with every figure and table from the files, and the errors."""
    faults = []

    def guarded(function, otherwise):
        try:
            return function()
        except Fault as fault:
            faults.append(f"{document.name}: {fault}")
            return otherwise

    known = {}
    for name, file, key, form in DEFINITION.findall(text):
        known[name] = guarded(lambda: figure_of(files.at(document, file), key, form), None)
    whole = {match[0] for match in DEFINITION.finditer(text)}
    faults += [f"{document.name}: '{line}' is no definition of a figure" for line in
               LOOKS_DEFINED.findall(text) if line not in whole]
    used = {name for _, name in LINK.findall(text)}
    faults += [f"{document.name}: nothing uses the figure [{name}]" for name in known
               if name not in used]
    prose = hidden(text, CODE)
    faults += [f"{document.name}: nothing defines [{name}]" for name in
               sorted({name for _, name in LINK.findall(prose)}) if f"\n[{name}]: " not in text]

    def table(match):
        begin, kind, file, key, before, end = match.groups()
        return begin + guarded(lambda: table_of(kind, files.at(document, file), key), before) + end

    text = TABLE.sub(table, text)
    return LINK.sub(lambda m: m[0] if known.get(m[2]) is None else f"[{known[m[2]]}][{m[2]}]",
                    text), faults


def blank(match):
    """Blanks of the same length: line numbers stay."""
    return re.sub(r"[^\n]", " ", match[0])


def hidden(text, patterns):
    for pattern in patterns:
        text = pattern.sub(blank, text)
    return text


def naked_figures(text):
    """(line, figure) of figures that name no source."""
    figures = {name for name, *_ in DEFINITION.findall(text)}
    text = hidden(text, (*QUIET, *CODE, DEFINITION))
    text = LINK.sub(lambda m: blank(m) if m[2] in figures else m[0], text)
    for number, line in enumerate(text.splitlines(), 1):
        for match in NAKED.finditer(line):
            yield number, match[0]


def differences(name, before, after):
    for number, (old, new) in enumerate(zip(before.splitlines(), after.splitlines()), 1):
        if old == new:
            continue
        shown = {m[2]: m[1] for m in LINK.finditer(old)}
        changed = [f"[{m[2]}] is '{m[1]}' in its file, not '{shown[m[2]]}'"
                   for m in LINK.finditer(new) if shown.get(m[2], m[1]) != m[1]]
        yield f"{name}:{number}: " + ("; ".join(changed) or f"'{new}' expected, not '{old}'")
    if len(before.splitlines()) != len(after.splitlines()):
        yield f"{name}: a table has other lines than its file"


def documents(root):
    return [root / "README.md", *sorted((root / "docs").glob("*.md")),
            *sorted((root / "docs" / "research").glob("*.md"))]


def work(root, check):
    """Writes or checks all documents; returns the errors, one line each."""
    files, faults, missing = Files(), [], 0
    for document in documents(root):
        before = document.read_text(encoding="utf-8")
        after, found = made(document, before, files)
        faults += found
        name = str(document.relative_to(root))
        missing += after.count(f"[{MISSING}][")
        if check:
            faults += differences(name, before, after)
        elif after != before:
            document.write_text(after, encoding="utf-8")
            print(f"make_figures: wrote {name}")
        if name in STRICT or name.startswith(STRICT_FOLDERS):
            faults += [f"{name}:{line}: '{figure}' names no source" for line, figure in
                       naked_figures(after)]
    faults += files.faults(root)
    if missing:
        print(f"make_figures: {missing} figures have not been measured yet ('{MISSING}')")
    return faults


def print_commits(root):
    """The commits of the figures of STRICT, with their files; returns how many there are."""
    files = Files()
    for name in STRICT:
        document = root / name
        text = document.read_text(encoding="utf-8")
        shown = hidden(text, QUIET[:1])
        links = {link for _, link in LINK.findall(shown)}
        for one, file, *_ in DEFINITION.findall(text):
            if one in links:
                files.at(document, file)
        for _, _, file, *_ in TABLE.findall(shown):
            files.at(document, file)
    commits = {}
    for name, _, sources in files.sources(root):
        for commit in {str(source.get("commit")) for source in sources}:
            commits.setdefault(commit, []).append(name)
    for commit, names in commits.items():
        print(f"{commit}: {', '.join(names)}")
    return len(commits)


def self_test():
    """Detects a figure, a table and a figure without source that were changed by hand."""
    text = ("Built in [2.50 s][time], [88 %][share] of it, [0.50x][means].\n\n"
            "<!-- table: comparison ../a.json -->\n<!-- /table -->\n"
            '\n[time]: ../a.json "x/seconds as 0.00 s"\n[share]: ../a.json "1 - x/rest as 0 %"\n'
            '[means]: ../a.json "mean of y/a, y/b over mean of y/c, y/b as 0.00x"\n')
    data = {"commit": "1a2b", "x": {"seconds": 2.504, "rest": 0.12}, "y": {"a": 1, "b": 3, "c": 5},
            "competitors": [{"title": "A", "generate": {"seconds": 3}}]}
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        (root / "docs").mkdir()
        (root / "README.md").write_text("Nothing here.\n")
        (root / "a.json").write_text(json.dumps(data))
        page = root / "docs" / "results.md"
        page.write_text(text)
        assert work(root, check=False) == [] and work(root, check=True) == []
        good = page.read_text()
        assert "| A | 3 s |" in good and "[2.50 s][time]" in good, good
        for old, new, said in (("2.50 s", "2.40 s", "results.md:1: [time] is '2.50 s'"),
                               ("| 3 s |", "| 2 s |", "results.md:6"),
                               ("of it,", "of it, 7 GB,", "'7 GB' names no source"),
                               ("as 0 %", "as 8 %", "is no format"),
                               ("x/seconds as", "x/second as", "nothing is at 'x/second'"),
                               ('0.00 s"', '0.00 s" ', "is no definition of a figure")):
            page.write_text(good.replace(old, new))
            faults = work(root, check=True)
            assert faults and said in faults[0], (old, faults)
            print(f"self-test found: {faults[0]}")
        page.write_text(good)
        (root / "a.json").write_text(json.dumps({**data, "commit": ""}))
        assert work(root, check=True) == ["a.json: names no commit"]
        (root / "a.json").write_text(json.dumps({**data, "dirty": True}))
        assert work(root, check=True) == ["a.json: measured with uncommitted changes"]


def main():
    if sys.argv[1:] not in ([], ["--check"], ["--commits"]):
        sys.exit(__doc__)
    if sys.argv[1:] == ["--commits"]:
        sys.exit(print_commits(ROOT) > 1)
    check = sys.argv[1:] == ["--check"]
    if check:
        self_test()
    faults = work(ROOT, check)
    for fault in faults:
        print(fault, file=sys.stderr)
    if faults:
        sys.exit(f"make_figures: {len(faults)} errors; tools/make_figures.py writes the figures")
    print("make_figures: every figure agrees with its file")


if __name__ == "__main__":
    main()
