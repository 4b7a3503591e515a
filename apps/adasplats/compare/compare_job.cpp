// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "compare/compare_job.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/pipeline/provenance/machine.h"
#include "adasplats/pipeline/provenance/provenance.h"
#include "adasplats/pipeline/session/inputs.h"
#include "adasplats/sensors/lidar_model.h"
#include "cli/text_table.h"
#include "compare/competitors.h"
#include "compare/paper_figures.h"
#include "compare/steps.h"
#include "compare/work_folder.h"
#include "report_page/report_page.h"

namespace adasplats::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMostPoses = 20;
constexpr double kBehind_m = 12, kAbove_m = 6, kAhead_m = 15;

/// What the user says goes before what was found.
ComparisonData data_of(const CompareJob& job) {
  ComparisonData data = find_comparison_data(job.data, job.preset);
  if (!job.labels.empty()) data.labels = job.labels;
  if (!job.scans.empty()) data.scans = job.scans;
  if (!job.trajectory.empty()) data.trajectory = job.trajectory;
  if (!job.held_out.empty()) data.held_out = job.held_out;
  if (!job.held_out_scans.empty()) data.held_out_scans = job.held_out_scans;
  if (!job.truth.empty()) data.truth = job.truth;
  if (job.offset_m) data.offset_m = job.offset_m;
  for (const fs::path* path : {&data.trajectory, &data.held_out, &data.truth}) {
    if (!path->empty()) require_input(*path);
  }
  for (const auto& [name, file] : job.meshes) require_input(file);
  return data;
}

RemovalRule removal_rule_of(const CompareJob& job) {
  return {job.remove.value_or(paper_removal(job.preset)), job.remove.has_value()};
}

/// Throws what every competitor would fail with.
void check_rules(const CompareJob& job, const ComparisonData& data) {
  if (!(job.steps.limits.seconds > 0)) {
    throw Error(ErrorKind::usage, "--time-limit must be more than 0 seconds");
  }
  if (!data.labels.empty()) load_label_scheme(data.labels);
  load_lidar_model(job.sensor);
}

/// Behind and above the middle pose, looking along the way.
PictureView view_along(const Trajectory& trajectory, Vec3d offset_m) {
  const std::size_t middle = trajectory.size() / 2;
  const Vec3d place = trajectory[middle].world_from_sensor.translation + offset_m;
  Vec3d ahead = trajectory.back().world_from_sensor.translation -
                trajectory.front().world_from_sensor.translation;
  ahead.z = 0;
  ahead = length(ahead) > 0 ? normalized(ahead) : Vec3d{1, 0, 0};
  const Vec3d up = {0, 0, 1};
  return {comma_text(place - kBehind_m * ahead + kAbove_m * up),
          comma_text(place + kAhead_m * ahead)};
}

/// What every competitor is asked with: data, poses, camera, limits.
CompetitionRules rules_of(const CompareJob& job, const ComparisonData& data,
                          const PointFacts& facts, const WorkFolder& folder,
                          const DeviceChoice& device) {
  CompetitionRules rules;
  rules.data = data;
  rules.original = facts.original;
  rules.has_classes = facts.has_classes;
  rules.labelled = facts.labelled && !data.labels.empty();
  rules.sensor = job.sensor;
  // What can remove nothing is not asked of the steps: they would refuse it.
  if (!facts.removed.ids.empty()) rules.removal = removal_rule_of(job).removal;
  rules.poisson_depth = job.poisson_depth;
  rules.picture_width = job.picture_width;
  if (!facts.trajectory.empty()) {
    rules.data.trajectory = folder.work() / "trajectory.csv";
    write_if_changed(rules.data.trajectory,
                     [&](const fs::path& file) { write_trajectory_csv(file, facts.trajectory); });
  }
  const Trajectory trajectory = load_trajectory(rules.data.trajectory);
  if (trajectory.empty()) {
    throw Error(ErrorKind::data, rules.data.trajectory.string() + ": no poses");
  }
  rules.offset_m = data.offset_m.value_or(Vec3d{});
  rules.every = job.every > 0 ? job.every : (trajectory.size() + kMostPoses - 1) / kMostPoses;
  rules.view = view_along(trajectory, rules.offset_m);
  rules.pictures = folder.pictures();
  rules.device_arguments = job.device_arguments;
  rules.device = device_key(device);
  return rules;
}

Json removed_json(const CompareJob& job, const CompetitionRules& rules, const PointFacts& facts) {
  Json json = {{"rule", name_of(rules.removal)},
               {"points", facts.removed.points},
               {"by_class", Json::object()}};
  for (const auto& part : facts.removed.classes) json["by_class"][part.name] = part.points;
  json["paper"] = name_of(paper_removal(job.preset));
  return json;
}

Json data_json(const CompareJob& job, const CompetitionRules& rules, const PointFacts& facts) {
  Json json;
  for (const fs::path& input : rules.data.inputs) json["inputs"].push_back(input.string());
  json["points"] = facts.points;
  json["labels"] = rules.data.labels;
  json["labelled"] = rules.labelled;
  json["held_out"] = rules.data.held_out.string();
  json["held_out_scans"] = rules.data.held_out_scans;
  json["scans"] = rules.data.scans;
  json["truth"] = rules.data.truth.string();
  json["trajectory"] = rules.data.trajectory.string();
  json["offset_m"] = {rules.offset_m.x, rules.offset_m.y, rules.offset_m.z};
  json["every"] = rules.every;
  json["preset"] = preset_name(job.preset);
  json["removed"] = removed_json(job, rules, facts);
  return json;
}

void write_reports(const fs::path& folder, const Json& results) {
  write_file(folder / "compare.json",
             results.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  write_file(folder / "report.md", report_markdown(results));
  write_file(folder / "report.html", report_html(results, folder));
}

}  // namespace

DynamicRemoval paper_removal(Preset preset) {
  return preset == Preset::paper_mcity ? DynamicRemoval::none : DynamicRemoval::movable;
}

std::vector<std::string> compare_method_names() {
  std::vector<std::string> names;
  for (const Competitor& competitor : known_competitors()) names.push_back(competitor.name);
  return names;
}

Json run_compare(const CompareJob& job, Session& session) {
  const ComparisonData data = data_of(job);
  check_rules(job, data);
  const std::vector<Competitor> chosen = chosen_competitors(job.methods, job.meshes);
  const WorkFolder folder(job.output, data.title);
  if (data.held_out.empty() && !data.held_out_scans.empty()) {
    throw Error(ErrorKind::usage, "--held-out-scans has no effect: there is no held-out sequence");
  }
  const PointFacts facts =
      look_at_points(data, removal_rule_of(job), folder.work() / "original.ply", session);
  if (!job.labels.empty() && !facts.has_classes) {
    throw Error(ErrorKind::usage, "--labels has no effect: the points have no labels");
  }
  const CompetitionRules rules = rules_of(job, data, facts, folder, session.device);

  Json results = {
      {"program", "adasplats"},
      {"version", ADASPLATS_VERSION},
      {"schema", 1},
      {"title", data.title},
      {"provenance", to_json(provenance_of(session.executor.threads(), session.device))},
      {"data", data_json(job, rules, facts)},
      {"machine", machine_json(session.executor.threads())},
      {"device", device_json(session.device)},
      {"limits",
       {{"seconds", job.steps.limits.seconds}, {"memory_bytes", job.steps.limits.memory_bytes}}},
      {"command", own_command_line()},
      {"original", Json::object()},
      {"competitors", Json::array()},
      {"paper", paper_figures(job.preset)}};
  results["original"] =
      original_picture(rules, StepRunner(folder.work() / "original", job.steps, session.progress));
  for (const Competitor& competitor : chosen) {
    if (competitor.needs_labels && !rules.labelled && job.methods.empty()) continue;
    const StepRunner runner(folder.work() / competitor.name, job.steps, session.progress);
    results["competitors"].push_back(compete(competitor, rules, runner));
    // After every competitor, so that an interrupted run has shown what it knows.
    write_reports(job.output, results);
  }
  write_reports(job.output, results);
  return results;
}

}  // namespace adasplats::app
