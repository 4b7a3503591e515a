// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "adasplats/report/measures.h"

namespace adasplats::page {
namespace {

constexpr std::size_t kCommitDigits = 12;  // enough to be unique

void add_fact(Section& section, std::string term, std::string text) {
  if (!text.empty()) section.facts.push_back({std::move(term), std::move(text)});
}

std::string joined(const Json* list, const std::string& separator) {
  std::string text;
  if (list == nullptr || !list->is_array()) return text;
  for (const Json& element : *list) {
    if (!text.empty()) text += separator;
    text += element.is_string() ? element.get<std::string>() : element.dump();
  }
  return text;
}

std::string or_none(const std::string& text) { return text.empty() ? "none" : text; }

std::string machine_text(const Json& results) {
  std::string text = text_at(results, {"machine", "cpu"});
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (const auto cores = number_at(results, {"machine", "cores"})) {
    add(whole_text(*cores) + (*cores == 1 ? " core" : " cores"));
  }
  if (const auto memory = number_at(results, {"machine", "memory_bytes"})) {
    add(bytes_text(*memory));
  }
  if (const std::string kind = text_at(results, {"device", "kind"});
      !kind.empty() && kind != "cpu") {
    add(text_at(results, {"device", "name"}) + " (" + kind + ")");
  }
  if (const std::string system = text_at(results, {"machine", "system"}); !system.empty()) {
    add(system);
  }
  return text;
}

std::string limits_text(const Json& results) {
  std::string text;
  if (const auto seconds = number_at(results, {"limits", "seconds"})) {
    text = whole_text(*seconds) + " s";
  }
  if (const auto memory = number_at(results, {"limits", "memory_bytes"})) {
    text += (text.empty() ? "" : " and ") + bytes_text(*memory);
  }
  return text.empty() ? text : text + " for each step of each competitor";
}

/// "0.1.0, commit 0123456789ab with changes".
std::string program_text(const Json& made_by) {
  const std::string version = text_at(made_by, {"version"});
  const std::string commit = text_at(made_by, {"commit"});
  std::string text = version.empty() ? "an unknown version" : version;
  if (!commit.empty()) text += ", commit " + commit.substr(0, kCommitDigits);
  const Json* dirty = find(made_by, {"dirty"});
  if (dirty != nullptr && *dirty == true) text += " with changes";
  return text;
}

/// The steps by the program that ran them. More than one program means that results were merged by
/// hand.
std::vector<Fact> programs_of(const std::vector<Competitor>& competitors) {
  std::vector<Fact> programs;
  for (const Competitor& competitor : competitors) {
    static const Json none = {{"all", Json::object()}};
    const Json* steps = find(*competitor.json, {"made_by"});
    if (steps == nullptr || !steps->is_object()) {
      if (!competitor.badge.empty()) continue;
      steps = &none;  // unknown program
    }
    for (const auto& [step, made_by] : steps->items()) {
      const std::string program = program_text(made_by);
      const std::string what = competitor.title + ": " + step;
      const auto found = std::find_if(programs.begin(), programs.end(),
                                      [&](const Fact& fact) { return fact.term == program; });
      if (found == programs.end()) {
        programs.push_back({program, what});
      } else {
        found->text += "; " + what;
      }
    }
  }
  return programs;
}

void add_programs(Section& section, const std::vector<Competitor>& competitors) {
  const std::vector<Fact> programs = programs_of(competitors);
  if (programs.empty()) return;
  if (programs.size() == 1) {
    add_fact(section, "Made by", "adasplats " + programs.front().term);
    return;
  }
  std::string text = "These figures were made by different programs and cannot be compared: ";
  for (const Fact& program : programs) {
    text += "adasplats " + program.term + " (" + program.text + ")";
    text += &program == &programs.back() ? "." : "; ";
  }
  section.paragraphs.push_back(std::move(text));
}

/// "movable: 120 of 1,000 points (car 100, person 20)".
std::string removed_text(const Json& results) {
  const std::string rule = text_at(results, {"data", "removed", "rule"});
  if (rule.empty()) return "";
  std::string text = rule == "none" ? "nothing" : rule;
  const auto points = number_at(results, {"data", "removed", "points"});
  const auto all = number_at(results, {"data", "points"});
  if (rule != "none" && points && all) {
    text += ": " + whole_text(*points) + " of " + whole_text(*all) + " points";
  }
  std::string classes;
  const Json* by_class = find(results, {"data", "removed", "by_class"});
  if (by_class != nullptr && by_class->is_object()) {
    for (const auto& [name, count] : by_class->items()) {
      if (!count.is_number()) continue;
      classes += (classes.empty() ? "" : ", ") + name + " " + whole_text(count.get<double>());
    }
  }
  if (!classes.empty()) text += " (" + classes + ")";
  const std::string paper = text_at(results, {"data", "removed", "paper"});
  if (!paper.empty() && paper != rule)
    text += "; the paper removes " + (paper == "none" ? "nothing" : paper + " objects");
  return text;
}

Section compared_section(const Json& results, const std::vector<Competitor>& competitors) {
  Section section;
  section.id = "compared";
  section.title = "What was compared";
  const auto unfinished = static_cast<std::size_t>(
      std::count_if(competitors.begin(), competitors.end(),
                    [](const Competitor& competitor) { return !competitor.badge.empty(); }));
  if (competitors.empty()) {
    section.paragraphs = {"No competitor was run."};
  } else if (unfinished > 0) {
    section.paragraphs = {std::to_string(unfinished) + " of " + std::to_string(competitors.size()) +
                          " competitors did not finish; see “What failed”."};
  }
  const auto data = [&](const char* key) { return text_at(results, {"data", key}); };
  add_fact(section, "Input", joined(find(results, {"data", "inputs"}), ", "));
  if (const auto points = number_at(results, {"data", "points"})) {
    add_fact(section, "Points", whole_text(*points));
  }
  const Json* labelled = find(results, {"data", "labelled"});
  const bool no_labels = labelled != nullptr && *labelled == false;
  add_fact(section, "Labels", no_labels ? "none" : or_none(data("labels")));
  add_fact(section, "Removed", removed_text(results));
  add_fact(section, "Held-out scans", or_none(data("held_out")));
  add_fact(section, "True surface", or_none(data("truth")));
  std::string path = data("trajectory");
  if (const std::string offset = joined(find(results, {"data", "offset_m"}), ", ");
      !offset.empty()) {
    path += (path.empty() ? "shifted by [" : ", shifted by [") + offset + "] m";
  }
  if (const auto every = number_at(results, {"data", "every"}); every && *every > 1) {
    path += (path.empty() ? "one pose in " : ", one pose in ") + whole_text(*every);
  }
  add_fact(section, "Simulated path", path);
  add_fact(section, "Preset", data("preset"));
  add_programs(section, competitors);
  add_fact(section, "Machine", machine_text(results));
  add_fact(section, "Limits", limits_text(results));
  const std::string command = text_at(results, {"command"});
  if (!command.empty()) section.commands.push_back({"", command});
  return section;
}

struct Prize {
  const char* title;
  Measure measure;
  const char* unit;
};

/// The best competitor in each measure that at least two competitors have.
Section best_section(const std::vector<Competitor>& competitors) {
  const std::vector<Prize> prizes = {
      {"Lowest C2C",
       {"", Better::lower, read({"c2c", "c2c_m"}, kCentimetres), hundredths_text},
       " cm"},
      {"Most held-out beams within 10 cm",
       {"", Better::higher, read({"resimulate", "within", "0.10"}, kPercent), tenths_text},
       " %"},
      {"Fewest held-out beams without a hit",
       {"", Better::lower, read({"resimulate", "no_hit"}, kPercent), tenths_text},
       " %"},
      {"Nearest to the true surface",
       {"", Better::lower, read({"truth", "surface_distance_m", "mean"}, kCentimetres)},
       " cm"},
      {"Fastest to generate", {"", Better::lower, read({"generate", "seconds"})}, " s"},
      {"Fewest primitives", {"", Better::lower, read({"generate", "primitives"}), count_text}, ""},
      {"Most LiDAR scans a second",
       {"", Better::higher, read({"simulate", "scans_per_second", "assembled"})},
       " Hz"}};
  Section section;
  for (const Prize& prize : prizes) {
    std::string winners;
    std::string figure;
    for (const Row& row : table_of("", competitors, {}, {prize.measure}).rows) {
      if (!row.cells.front().best) continue;
      winners += (winners.empty() ? "" : ", ") + row.title;
      figure = row.cells.front().text + prize.unit;
    }
    if (!winners.empty()) section.facts.push_back({prize.title, figure + "\n" + winners});
  }
  if (section.facts.empty()) return section;
  section.id = "best";
  section.title = "Best on this data";
  section.facts_as_tiles = true;
  return section;
}

std::optional<ColorScale> scale_at(const Json& results, const std::string& key) {
  ColorScale scale;
  const Json* colors = find(results, {"scales", key, "colors"});
  if (colors == nullptr || !colors->is_array()) return std::nullopt;
  for (const Json& color : *colors) {
    const std::string text = color.is_string() ? color.get<std::string>() : "";
    const bool is_color = text.size() == 7 && text.front() == '#' &&
                          text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
    if (is_color) scale.colors.push_back(text);
  }
  if (scale.colors.size() < 2) return std::nullopt;
  scale.from = text_at(results, {"scales", key, "from"});
  scale.to = text_at(results, {"scales", key, "to"});
  scale.note = text_at(results, {"scales", key, "note"});
  return scale;
}

Section pictures_section(const Json& results, const std::vector<Competitor>& competitors,
                         const std::string& key, std::string title, std::string text) {
  Section section;
  const std::string original = text_at(results, {"original", "picture"});
  for (const Competitor& competitor : competitors) {
    const std::string path = text_at(*competitor.json, {key, "picture"});
    if (!path.empty()) section.pictures.push_back({competitor.title, competitor.key, path});
  }
  if (section.pictures.empty()) return section;
  if (key == "render" && !original.empty()) {
    section.pictures.insert(section.pictures.begin(), {"Measured points", {}, original});
  }
  section.id = "pictures-" + key;
  section.title = std::move(title);
  section.paragraphs = {std::move(text)};
  section.scale = scale_at(results, key);
  return section;
}

Section failures_section(const std::vector<Competitor>& competitors) {
  Section section;
  Table table;
  table.title = "Competitors that did not finish";
  for (const char* name : {"state", "step", "message"}) {
    table.columns.push_back({"", name, Better::neither, true});
  }
  for (const Competitor& competitor : competitors) {
    if (competitor.badge.empty()) continue;
    Row row{competitor.title, "", competitor.key, {}};
    const std::string step = text_at(*competitor.json, {"failed_step"});
    const std::string message = text_at(*competitor.json, {"message"});
    for (const std::string& text : {competitor.badge, step, message}) {
      row.cells.push_back({text.empty() ? kMissing : text, std::nullopt, "", false});
    }
    table.rows.push_back(std::move(row));
  }
  if (table.rows.empty()) return section;
  section.id = "failures";
  section.title = "What failed";
  section.tables.push_back(std::move(table));
  return section;
}

Section commands_section(const std::vector<Competitor>& competitors) {
  Section section;
  for (const Competitor& competitor : competitors) {
    std::string lines;
    for (const char* step : {"generate", "render", "simulate", "c2c", "resimulate", "truth"}) {
      const std::string command = text_at(*competitor.json, {step, "command"});
      if (!command.empty()) lines += (lines.empty() ? "" : "\n") + command;
    }
    if (!lines.empty()) section.commands.push_back({competitor.title, lines});
  }
  if (section.commands.empty()) return section;
  section.id = "commands";
  section.title = "Commands";
  section.paragraphs = {"The commands that compare ran; each can be run again."};
  return section;
}

}  // namespace

Table with_best_marked(Table table) {
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const Better better = table.columns[c].better;
    if (better == Better::neither) continue;
    const Cell* best = nullptr;
    bool differ = false;
    for (const Row& row : table.rows) {
      const Cell& cell = row.cells[c];
      if (!cell.value) continue;
      differ = differ || (best != nullptr && best->text != cell.text);
      if (best == nullptr ||
          (better == Better::lower ? *cell.value < *best->value : *cell.value > *best->value)) {
        best = &cell;
      }
    }
    if (!differ) continue;
    const std::string best_text = best->text;
    for (Row& row : table.rows) {
      row.cells[c].best = row.cells[c].value.has_value() && row.cells[c].text == best_text;
    }
  }
  return table;
}

Document document_of(const Json& results) {
  const auto competitors = competitors_of(results);
  Document document;
  const std::string title = text_at(results, {"title"});
  document.title = title.empty() ? "Comparison of scene models" : title + ": scene models compared";
  document.subtitle = "Splats and meshes from one point cloud, scanned again by a simulated LiDAR.";
  if (const std::string version = text_at(results, {"version"}); !version.empty()) {
    document.subtitle += " adasplats " + version + ".";
  }
  document.sections = {
      compared_section(results, competitors),
      best_section(competitors),
      paper_section(results, competitors),
      cost_section(competitors),
      clouds_section(competitors),
      beams_section(competitors),
      truth_section(competitors),
      pictures_section(results, competitors, "render", "Renders",
                       "Every model from the same camera."),
      pictures_section(results, competitors, "c2c", "Simulated points by error",
                       "Simulated points, coloured by the distance to the nearest original point."),
      pictures_section(results, competitors, "resimulate", "Held-out scans by error",
                       "Points of a held-out scan, coloured by the error of the simulated range."),
      failures_section(competitors),
      commands_section(competitors)};
  std::erase_if(document.sections, [](const Section& section) { return section.id.empty(); });
  document.footer =
      "Bold: the best of a column. –: not measured. Shares are of all rays unless stated "
      "otherwise.";
  return document;
}

}  // namespace adasplats::page
