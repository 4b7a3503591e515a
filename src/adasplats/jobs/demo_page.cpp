// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>
#include <vector>

#include "adasplats/jobs/demo.h"
#include "adasplats/jobs/provenance/provenance.h"
#include "adasplats/report/document.h"
#include "adasplats/report/text_format.h"

namespace adasplats {
namespace {

page::Cell number(double value, int digits, const char* unit) {
  page::Cell cell;
  cell.value = value;
  cell.text = page::fixed_text(value, digits) + unit;
  return cell;
}

page::Table table_of(const DemoResult& result) {
  using page::Better;
  page::Table table;
  table.title = "Every method on the same street";
  table.columns = {{"", "splats", Better::neither},
                   {"", "model, s", Better::lower},
                   {"simulated to original", "C2C, cm", Better::lower},
                   {"simulated to original", "thin objects, cm", Better::lower},
                   {"held-out beams", "within 10 cm", Better::higher},
                   {"held-out beams", "early", Better::lower}};
  for (const DemoRow& row : result.rows) {
    page::Row line;
    line.title = row.method;
    line.cells = {number(static_cast<double>(row.model.built.primitives), 0, ""),
                  number(row.model.seconds, 2, ""),
                  number(100 * row.comparison.distance.c2c_m, 2, ""),
                  number(100 * row.thin_c2c_m, 2, ""),
                  number(100 * row.held_out.all.within.at(0.10), 1, " %"),
                  number(100 * row.held_out.all.early_50cm, 2, " %")};
    table.rows.push_back(std::move(line));
  }
  table.definitions = {
      {"C2C", "mean distance of a simulated point to the nearest original point"},
      {"thin objects", "C2C of fences, poles and traffic signs"},
      {"within 10 cm", "share of the held-out beams whose range the model predicts within 10 cm"},
      {"early", "share of the held-out beams that hit the model more than 50 cm too early"}};
  return page::with_best_marked(std::move(table));
}

std::string model_in(const std::filesystem::path& folder) {
  return (folder / "consistent.ply").string();
}

std::string sequence_in(const std::filesystem::path& folder) {
  return (folder / "street" / "sequences" / "00").string();
}

/// Commands to try next.
std::vector<page::Fact> commands_for(const std::filesystem::path& name) {
  return {
      {"view the scene, drive a sensor", view_command(name)},
      {"errors of held-out beams in the viewer",
       command_text(
           {"view", model_in(name), "--errors", (name / "consistent-errors.ply").string()})},
      {"your own points", "adasplats model YOUR_POINTS -o model.ply && adasplats view model.ply"},
      {"scans of another sensor",
       command_text({"simulate", model_in(name), "--sensor", "velodyne-vlp-16", "--trajectory",
                     sequence_in(name), "-o", "scans"})}};
}

}  // namespace

std::string view_command(const std::filesystem::path& name) {
  return command_text({"view", model_in(name), "--sequence", sequence_in(name)});
}

std::string demo_page(const DemoResult& result, const std::filesystem::path& folder,
                      const std::filesystem::path& name) {
  page::Document document;
  document.title = "adasplats demo";
  document.subtitle = "A procedural street of " + page::fixed_text(result.street.length_m, 0) +
                      " m: " + page::whole_text(static_cast<double>(result.street.mapping_points)) +
                      " points of a mapping drive become splat models; " +
                      std::to_string(result.street.driving_scans) +
                      " held-out scans measure how well each model predicts ranges.";
  page::Section seen;
  seen.id = "picture";
  seen.title = "The models and their errors";
  seen.paragraphs = {
      "Top: each model by class. Bottom: the same view by the error of held-out beams at each "
      "splat: "
      "blue: hit too early, red: too late, orange: no hit."};
  seen.pictures = {{"All methods", {}, result.picture.string()}};
  page::Section figures;
  figures.id = "figures";
  figures.title = "Figures";
  figures.tables = {table_of(result)};
  page::Section more;
  more.id = "pictures";
  more.title = "Each method";
  for (const auto& picture : result.pictures)
    more.pictures.push_back({picture.stem().string(), {}, picture.string()});
  page::Section next;
  next.id = "next";
  next.title = "Next steps";
  next.commands = commands_for(name);
  document.sections = {std::move(seen), std::move(figures), std::move(more), std::move(next)};
  return page::html_page(document, folder);
}

}  // namespace adasplats
