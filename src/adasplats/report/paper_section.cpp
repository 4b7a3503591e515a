// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "adasplats/report/measures.h"

// The tables of the paper, section "Results", with its figures next to ours.
namespace adasplats::page {
namespace {

const std::vector<std::string>& thin_classes() {
  static const std::vector<std::string> names = {"fence", "pole", "traffic-sign"};
  return names;
}

Measure generation_time() {
  return {"Gen T (s)", Better::lower, read({"generate", "seconds"}), measure_text,
          read({"generate_s"})};
}

Measure primitives() {
  return {"Primitives", Better::lower, read({"generate", "primitives"}), count_text,
          read({"primitives"})};
}

Measure lidar_frequency() {
  return {"LiDAR (Hz)", Better::higher, read({"simulate", "scans_per_second", "assembled"}),
          measure_text, read({"lidar_hz"})};
}

Measure c2c() {
  return {"C2C (cm)",
          Better::lower,
          read({"c2c", "c2c_m"}, kCentimetres),
          hundredths_text,
          read({"c2c_m"}, kCentimetres),
          short_text};
}

std::vector<Fact> paper_definitions() {
  return {
      {"Gen T", "seconds from the point cloud on disk to the finished model on disk."},
      {"Primitives", "disks of a splat model, triangles of a mesh."},
      {"Render", "pictures of 2560 × 1440 pixels a second."},
      {"LiDAR",
       "revolutions of a simulated HDL-64 a second: rays made, traced and returned as points in "
       "memory; writing files is not counted, as in the paper."},
      {"C2C",
       "cloud to cloud: for each simulated point the distance to the nearest point of the "
       "original cloud, the mean over all simulated points. It measures one direction only: "
       "missing parts of a model do not count."}};
}

/// Competitors that were run without and with resampling, in pairs.
std::vector<Competitor> resampling_pairs(const std::vector<Competitor>& competitors) {
  std::vector<Competitor> pairs;
  for (const Competitor& variant : competitors) {
    if (!variant.key.variant) continue;
    for (const Competitor& base : competitors) {
      if (base.key.variant || base.key.slot != variant.key.slot) continue;
      pairs.push_back(variant);
      pairs.push_back(base);
    }
  }
  return pairs;
}

Table resampling_table(const std::vector<Competitor>& pairs) {
  return table_of("Without and with resampling", pairs, {},
                  {generation_time(), primitives(), lidar_frequency(), c2c()});
}

std::optional<double> mean_of(const std::vector<Reader>& readers, const Json& json) {
  double sum = 0;
  for (const Reader& reader : readers) {
    const auto value = reader(json);
    if (!value) return std::nullopt;
    sum += *value;
  }
  return sum / static_cast<double>(readers.size());
}

/// `paper_rows`: empty for a table of our figures alone.
Table thin_table(const std::vector<Competitor>& competitors,
                 const std::vector<const Json*>& paper_rows) {
  std::vector<Measure> measures;
  std::vector<Reader> here;
  std::vector<Reader> paper;
  for (const std::string& name : thin_classes()) {
    here.push_back(read({"c2c", "by_class", name, "c2c_m"}, kCentimetres));
    paper.push_back(read({"thin", name}, kCentimetres));
    measures.push_back({name + " (cm)", Better::lower, here.back(), hundredths_text, paper.back(),
                        short_text, [name](const Json& json) {
                          const auto points = number_at(json, {"c2c", "by_class", name, "points"});
                          return points ? count_text(*points) + " pts" : std::string();
                        }});
  }
  measures.push_back({"mean (cm)", Better::lower,
                      [here](const Json& json) { return mean_of(here, json); }, hundredths_text,
                      [paper](const Json& row) {
                        const auto printed = read({"thin", "mean"}, kCentimetres)(row);
                        return printed ? printed : mean_of(paper, row);
                      },
                      short_text});
  Table table = table_of("C2C of thin structures", competitors, paper_rows, measures);
  table.definitions = {
      {"C2C of a class",
       "C2C of the simulated points of the class to the original points of the same class. For "
       "classes from a network (AdaSplats-KPConv), a simulated point has the class of the nearest "
       "original one. The small figure is the number of simulated points: with few points, C2C is "
       "uncertain."},
      {"mean",
       "of the three classes with equal weight, only if all three have points; for the paper its "
       "printed average, if available."}};
  if (!paper_rows.empty()) return table;
  ChartPlan plan{ChartKind::bars, "C2C of thin structures", "", "C2C (cm)", {}};
  for (std::size_t c = 0; c < table.columns.size(); ++c) plan.columns.push_back(c);
  table.charts.push_back(std::move(plan));
  return table;
}

bool has_thin_classes(const std::vector<Competitor>& competitors) {
  return std::any_of(competitors.begin(), competitors.end(), [](const Competitor& competitor) {
    return std::any_of(thin_classes().begin(), thin_classes().end(), [&](const std::string& name) {
      return number_at(*competitor.json, {"c2c", "by_class", name, "c2c_m"}).has_value();
    });
  });
}

/// Explains the columns of a table with the paper's figures.
std::string paper_note(const Json& results) {
  std::string cpu = text_at(results, {"machine", "cpu"});
  if (cpu.empty()) cpu = "this machine";
  return "“here” was measured on " + text_at(results, {"title"}) + " with " + cpu +
         "; “paper” is from the paper’s table for " + text_at(results, {"paper", "table"}) +
         " and was measured on the paper’s own data with an NVIDIA GeForce RTX 2070 SUPER. Other "
         "data and another machine: compare the order of the models, not the figures.";
}

}  // namespace

Section paper_section(const Json& results, const std::vector<Competitor>& competitors) {
  Section section;
  section.id = "paper";
  section.title = "The paper’s measures";
  const std::vector<Measure> measures = {
      generation_time(),
      primitives(),
      {"Render (Hz)", Better::higher, read({"render", "images_per_second"}), measure_text,
       read({"render_hz"})},
      lidar_frequency(),
      c2c()};
  section.tables.push_back(table_of("Models, speed and C2C", competitors, {}, measures));
  section.tables.back().definitions = paper_definitions();
  const auto pairs = resampling_pairs(competitors);
  if (!pairs.empty()) section.tables.push_back(resampling_table(pairs));
  const bool thin = has_thin_classes(competitors);
  if (thin) section.tables.push_back(thin_table(competitors, {}));
  const auto paper_rows = paper_rows_of(results);
  if (paper_rows.empty()) return section;
  section.tables.push_back(table_of("With the paper’s figures: models, speed and C2C", competitors,
                                    paper_rows, measures));
  section.tables.back().definitions = {{"columns", paper_note(results)}};
  section.tables.back().on_demand = true;
  if (!thin) return section;
  section.tables.push_back(thin_table(competitors, paper_rows));
  section.tables.back().title = "With the paper’s figures: C2C of thin structures";
  section.tables.back().on_demand = true;
  return section;
}

}  // namespace adasplats::page
