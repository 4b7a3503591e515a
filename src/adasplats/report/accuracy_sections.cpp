// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "adasplats/report/measures.h"

// Measures that the paper does not have: cost, both directions of the cloud distance, held-out
// beams and exact truth.
namespace adasplats::page {
namespace {

bool any_has(const std::vector<Competitor>& competitors, const std::string& key) {
  return std::any_of(competitors.begin(), competitors.end(), [&](const Competitor& competitor) {
    const Json* found = find(*competitor.json, {key});
    return found != nullptr && found->is_object() && !found->empty();
  });
}

/// Columns of range errors; `at` leads to an object with the keys of `evaluate resimulate`.
std::vector<Measure> range_measures(const KeyPath& at) {
  const auto from = [&](KeyPath tail, double factor) {
    tail.insert(tail.begin(), at.begin(), at.end());
    return read(std::move(tail), factor);
  };
  return {{"no hit (%)", Better::lower, from({"no_hit"}, kPercent), tenths_text},
          {"early (%)", Better::lower, from({"early_50cm"}, kPercent), tenths_text},
          {"late (%)", Better::lower, from({"late_50cm"}, kPercent), tenths_text},
          {"≤ 2 cm (%)", Better::higher, from({"within", "0.02"}, kPercent), tenths_text},
          {"≤ 5 cm (%)", Better::higher, from({"within", "0.05"}, kPercent), tenths_text},
          {"≤ 10 cm (%)", Better::higher, from({"within", "0.10"}, kPercent), tenths_text},
          {"≤ 50 cm (%)", Better::higher, from({"within", "0.50"}, kPercent), tenths_text},
          {"median (cm)", Better::lower, from({"range_error_m", "median"}, kCentimetres)},
          {"RMSE (m)", Better::lower, from({"range_error_m", "rmse"}, 1)}};
}

std::vector<Fact> range_definitions() {
  return {
      {"no hit", "share of the rays that do not hit the model."},
      {"early, late",
       "share of the rays whose simulated range is more than 50 cm too short, or too long."},
      {"≤ 2, 5, 10, 50 cm",
       "share of the rays with at most that range error; rays without a hit do not count as "
       "within."},
      {"median, RMSE",
       "of the absolute range error, and root mean square error, over the rays that hit. A model "
       "with holes leaves out its worst rays, so read them together with “no hit”."}};
}

Breakdown by_range(std::string title, KeyPath figure) {
  Breakdown breakdown;
  breakdown.title = std::move(title);
  breakdown.groups = {"resimulate", "by_range"};
  breakdown.figure = std::move(figure);
  breakdown.factor = kPercent;  // of a share, or from metres to centimetres
  breakdown.category_title = "measured range (m)";
  breakdown.group_unit = " m";
  return breakdown;
}

std::vector<Breakdown> beam_breakdowns() {
  Breakdown error = by_range("Range error over range", {"range_error_m", "median"});
  error.value_title = "median of |range error| (cm)";
  Breakdown within = by_range("Beams within 10 cm over range", {"within", "0.10"});
  within.value_title = "share of the beams (%)";
  within.better = Better::higher;
  within.text = tenths_text;
  Breakdown holes = by_range("Beams without a hit over range", {"no_hit"});
  holes.value_title = within.value_title;
  holes.text = tenths_text;
  Breakdown incidence = error;
  incidence.title = "Range error over incidence";
  incidence.groups = {"resimulate", "by_incidence"};
  incidence.category_title = "angle between beam and the normal of the surface it hit (degrees)";
  incidence.group_unit = " deg";
  Breakdown classes = error;
  classes.title = "Range error by class";
  classes.groups = {"resimulate", "by_class"};
  classes.chart = ChartKind::dots;
  classes.category_title = "";
  classes.group_unit = "";
  classes.weight = {"rays"};
  Breakdown within_classes = classes;
  within_classes.title = "Beams within 10 cm by class";
  within_classes.figure = within.figure;
  within_classes.better = within.better;
  within_classes.text = within.text;
  within_classes.value_title = within.value_title;
  return {error, within, incidence, holes, classes, within_classes};
}

void add_breakdown(Section& section, const Breakdown& breakdown,
                   const std::vector<Competitor>& competitors) {
  Table table = table_of(breakdown, competitors);
  if (!table.rows.empty()) section.tables.push_back(std::move(table));
}

std::vector<std::size_t> columns_named(const Table& table, const std::string& name) {
  std::vector<std::size_t> columns;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    if (table.columns[c].name == name) columns.push_back(c);
  }
  return columns;
}

}  // namespace

Section cost_section(const std::vector<Competitor>& competitors) {
  Section section;
  if (!any_has(competitors, "generate") && !any_has(competitors, "simulate")) return section;
  section.id = "cost";
  section.title = "Time, memory, size";
  Table table = table_of(
      "What each model costs", competitors, {},
      {{"generate (s)", Better::lower, read({"generate", "seconds"})},
       {"peak memory", Better::lower, read({"generate", "peak_memory_bytes"}), bytes_text},
       {"points used", Better::neither, read({"generate", "points_used"}), count_text},
       {"primitives", Better::lower, read({"generate", "primitives"}), count_text},
       {"scans", Better::neither, read({"simulate", "scans"}), whole_text},
       {"rays", Better::neither, read({"simulate", "rays"}), count_text},
       {"hits", Better::neither, read({"simulate", "hits"}), count_text},
       {"traced (scans/s)", Better::higher, read({"simulate", "scans_per_second", "traced"})},
       {"complete (scans/s)", Better::higher, read({"simulate", "scans_per_second", "assembled"})},
       {"written (scans/s)", Better::higher, read({"simulate", "scans_per_second", "written"})}});
  table.definitions = {
      {"peak memory", "maximum resident memory of the program that generated the model."},
      {"points used", "input points that the model was made from, after filtering."},
      {"traced, complete, written",
       "scans per second: casting rays; also making points; also writing files."}};
  table.charts = {
      {ChartKind::bars, "Time to generate", "", "seconds", columns_named(table, "generate (s)")},
      {ChartKind::bars, "Primitives", "", "disks or triangles",
       columns_named(table, "primitives")}};
  section.tables.push_back(std::move(table));
  return section;
}

Section clouds_section(const std::vector<Competitor>& competitors) {
  Section section;
  if (!any_has(competitors, "c2c")) return section;
  section.id = "clouds";
  section.title = "Simulated against original points";
  Table table = table_of(
      "Distances between the clouds", competitors, {},
      {{"C2C (cm)", Better::lower, read({"c2c", "c2c_m"}, kCentimetres)},
       {"completeness (cm)", Better::lower, read({"c2c", "completeness_m"}, kCentimetres)},
       {"Chamfer (cm)", Better::lower, read({"c2c", "chamfer_m"}, kCentimetres)},
       {"Chamfer (m²)", Better::lower, read({"c2c", "chamfer_m2"})},
       {"F 5 cm (%)", Better::higher, read({"c2c", "f_score", "0.05"}, kPercent), tenths_text},
       {"F 10 cm (%)", Better::higher, read({"c2c", "f_score", "0.10"}, kPercent), tenths_text},
       {"F 22.4 cm (%)", Better::higher, read({"c2c", "f_score", "0.224"}, kPercent),
        tenths_text}});
  table.definitions = {
      {"C2C", "mean distance of a simulated point to the nearest original point."},
      {"completeness",
       "the other direction: mean distance of an original point to the nearest simulated one, "
       "including points that the simulated sensor could not see from its path."},
      {"Chamfer",
       "in cm the mean of both means; in m² the sum of both means of squared distances, as in "
       "lidar-nerf, LiDAR4D, GS-LiDAR and LiDAR-RT."},
      {"F",
       "harmonic mean of two shares: simulated points nearer than the bound to an original "
       "point, and original points nearer than the bound to a simulated one. 22.4 cm is the "
       "square root of 0.05 m², the “0.05” of those papers."}};
  section.tables.push_back(std::move(table));
  Breakdown classes;
  classes.title = "C2C by class";
  classes.groups = {"c2c", "by_class"};
  classes.figure = {"c2c_m"};
  classes.factor = kCentimetres;
  classes.chart = ChartKind::dots;
  classes.value_title = "C2C to points of the same class (cm)";
  classes.weight = {"points"};
  classes.total = read({"c2c", "c2c_m"}, kCentimetres);
  add_breakdown(section, classes, competitors);
  return section;
}

Section beams_section(const std::vector<Competitor>& competitors) {
  Section section;
  if (!any_has(competitors, "resimulate")) return section;
  section.id = "beams";
  section.title = "Held-out beams";
  section.paragraphs = {
      "Every beam of the held-out scans is cast again, from the sensor position through the "
      "measured "
      "point, and the simulated range is compared with the measured one."};
  std::vector<Measure> measures = {
      {"rays", Better::neither, read({"resimulate", "rays"}), count_text}};
  for (Measure& measure : range_measures({"resimulate"})) measures.push_back(std::move(measure));
  section.tables.push_back(table_of("Range of held-out beams", competitors, {}, measures));
  section.tables.back().definitions = range_definitions();
  for (const Breakdown& breakdown : beam_breakdowns()) {
    add_breakdown(section, breakdown, competitors);
  }
  return section;
}

Section truth_section(const std::vector<Competitor>& competitors) {
  Section section;
  if (!any_has(competitors, "truth")) return section;
  section.id = "truth";
  section.title = "Exact truth";
  section.paragraphs = {
      "The rays of the sensor along the simulated path are cast, without noise, into the model and "
      "into a mesh of the true surface."};
  const auto surface = [](const char* key) {
    return read({"truth", "surface_distance_m", key}, kCentimetres);
  };
  std::vector<Measure> measures = {
      {"rays", Better::neither, read({"truth", "rays"}), count_text},
      {"holes (%)", Better::lower, read({"truth", "hole_share"}, kPercent), tenths_text},
      {"ghosts (%)", Better::lower, read({"truth", "ghost_share"}, kPercent), tenths_text},
      {"bleeding (%)", Better::lower, read({"truth", "bleeding_share"}, kPercent), tenths_text},
      {"to surface: mean (cm)", Better::lower, surface("mean")},
      {"median (cm)", Better::lower, surface("median")},
      {"p95 (cm)", Better::lower, surface("p95")},
      {"RMSE (cm)", Better::lower, surface("rmse")}};
  section.tables.push_back(table_of("Surface", competitors, {}, measures));
  section.tables.back().definitions = {
      {"holes",
       "share of the rays to the true surface that fall through the model: they hit nothing, or "
       "something more than 50 cm behind."},
      {"ghosts",
       "share of the rays without a true surface in the sensor’s range that hit the model."},
      {"bleeding",
       "share of the simulated points between two objects: more than 10 cm from the true surface, "
       "and with the same margin between the nearest and the farthest true range of the beam and "
       "the beams around it."},
      {"to surface",
       "distance of a simulated point to the nearest point of the true surface: mean, median, 95th "
       "percentile and root of the mean square."}};
  section.tables.push_back(
      table_of("Range against the true mesh", competitors, {}, range_measures({"truth", "range"})));
  section.tables.back().definitions = range_definitions();
  Breakdown classes;
  classes.title = "Distance to the true surface by class";
  classes.groups = {"truth", "by_class"};
  classes.figure = {"surface_distance_m", "mean"};
  classes.factor = kCentimetres;
  classes.chart = ChartKind::dots;
  classes.value_title = "mean distance to the true surface (cm)";
  classes.weight = {"rays"};
  add_breakdown(section, classes, competitors);
  Breakdown holes = classes;
  holes.title = "Holes by class";
  holes.figure = {"hole_share"};
  holes.text = tenths_text;
  holes.value_title = "rays to the class that fall through (%)";
  add_breakdown(section, holes, competitors);
  return section;
}

}  // namespace adasplats::page
