// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/compare/compare.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/jobs/compare/competitors.h"
#include "adasplats/jobs/compare/steps.h"
#include "adasplats/jobs/provenance/machine.h"
#include "adasplats/jobs/provenance/provenance.h"
#include "adasplats/jobs/segment/point_classes.h"
#include "adasplats/jobs/session/inputs.h"
#include "adasplats/report/report_page.h"
#include "adasplats/sensors/lidar_model.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxPoses = 20;
constexpr double kBehind_m = 12, kAbove_m = 6, kAhead_m = 15;
constexpr double kMemoryShare = 0.9;  // of the machine's memory, if no limit is given

/// Settings of the user override what is found in the data.
ComparisonData data_of(const CompareJob& job) {
  ComparisonData data = find_comparison_data(job.data, job.preset);
  if (!job.labels.empty()) data.labels = job.labels;
  if (job.scans != ScanRange()) data.scans = job.scans;
  if (!job.trajectory.empty()) data.trajectory = job.trajectory;
  if (!job.held_out.empty()) data.held_out = job.held_out;
  data.held_out_scans = job.held_out_scans;
  if (!job.truth.empty()) data.truth = job.truth;
  if (job.offset_m) data.offset_m = job.offset_m;
  data.removal = job.remove.value_or(paper_removal(job.preset));
  data.removal_is_asked = job.remove.has_value();
  for (const fs::path* path : {&data.trajectory, &data.held_out, &data.truth}) {
    if (!path->empty()) require_input(*path);
  }
  for (const auto& [name, file] : job.meshes) require_input(file);
  if (!job.network.empty()) require_input(job.network);
  return data;
}

/// Reports errors that every competitor would fail with.
void check_rules(const CompareJob& job, const ComparisonData& data) {
  check_settings(job);
  check_settings(job.limits);
  if (data.held_out.empty() && data.held_out_scans != ScanRange()) {
    throw Error(ErrorKind::usage, "`held_out_scans` has no effect without a held-out sequence");
  }
  if (!data.labels.empty()) load_label_scheme(data.labels);
  load_lidar_model(job.sensor);
}

/// Camera behind and above the middle pose, looking along the trajectory.
void set_view(const Trajectory& trajectory, CompetitionRules& rules) {
  const std::size_t middle = trajectory.size() / 2;
  const Vec3d position = trajectory[middle].world_from_sensor.translation + rules.offset_m;
  Vec3d ahead = trajectory.back().world_from_sensor.translation -
                trajectory.front().world_from_sensor.translation;
  ahead.z = 0;
  ahead = length(ahead) > 0 ? normalized(ahead) : Vec3d{1, 0, 0};
  const Vec3d up = {0, 0, 1};
  rules.eye = position - kBehind_m * ahead + kAbove_m * up;
  rules.target = position + kAhead_m * ahead;
}

/// How the steps are run; asks the program for its version.
StepRules step_rules_of(const CompareJob& job, const fs::path& program, const WorkFolder& folder,
                        ProgressSink& progress) {
  StepRules rules;
  rules.program = program;
  rules.made_by = build_of_program(program, folder.work(), progress);
  const double bytes = job.limits.memory_gib > 0
                           ? std::max(1.0, job.limits.memory_gib * kBytesPerGiB)
                           : kMemoryShare * static_cast<double>(usable_memory_bytes());
  rules.limits = {job.limits.seconds, static_cast<std::uint64_t>(bytes)};
  rules.retry = job.limits.retry;
  const CompareJob defaults;
  std::vector<std::string>& common = rules.common_arguments;
  if (job.threads != defaults.threads) common = {"--threads", std::to_string(job.threads)};
  if (job.seed != defaults.seed) {
    common.insert(common.end(), {"--seed", std::to_string(job.seed)});
  }
  return rules;
}

/// What all competitors share: data, poses, camera.
CompetitionRules rules_of(const CompareJob& job, const ComparisonData& data,
                          const PointFacts& facts, const WorkFolder& folder,
                          const DeviceChoice& device) {
  CompetitionRules rules{.job = job, .data = data};
  rules.original = facts.original;
  rules.has_classes = facts.has_classes;
  rules.labelled = facts.labelled && !data.labels.empty();
  // A rule that removes nothing is not passed to the steps: they would reject it.
  if (!facts.removed.ids.empty()) rules.removal = data.removal;
  if (data.removal != DynamicRemoval::moving) rules.network_removal = data.removal;
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
  rules.every = job.every > 0 ? job.every : (trajectory.size() + kMaxPoses - 1) / kMaxPoses;
  set_view(trajectory, rules);
  rules.pictures = folder.pictures();
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
  json["held_out_scans"] = text_of(rules.data.held_out_scans);
  json["scans"] = text_of(rules.data.scans);
  json["truth"] = rules.data.truth.string();
  json["trajectory"] = rules.data.trajectory.string();
  json["offset_m"] = {rules.offset_m.x, rules.offset_m.y, rules.offset_m.z};
  json["every"] = rules.every;
  json["preset"] = job.preset == Preset::none ? "" : word_of(job.preset, kPresets);
  json["removed"] = removed_json(job, rules, facts);
  return json;
}

/// Whether the data and this build allow a competitor that was not requested by name.
bool is_possible(const Competitor& competitor, const CompetitionRules& rules) {
  return (rules.labelled || !competitor.needs_labels) && (can_segment() || !competitor.segments);
}

void write_reports(const fs::path& folder, const Json& results) {
  write_file(folder / "compare.json",
             results.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  write_file(folder / "report.md", report_markdown(results));
  write_file(folder / "report.html", report_html(results, folder));
}

}  // namespace

std::vector<UnusedSetting> unused_settings(const CompareJob& job) {
  const auto& methods = job.methods;
  std::vector<UnusedSetting> unused;
  if (methods.empty()) return unused;
  for (const auto& [name, method] :
       {std::pair<std::string_view, std::string>{"poisson_depth", "poisson"},
        {"network", "kpconv"}}) {
    if (std::ranges::find(methods, method) != methods.end()) continue;
    for (const UnusedSetting& each : all_unused(job, "without the method " + method))
      if (each.setting.name == name) unused.push_back(each);
  }
  return unused;
}

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
  const fs::path program = program_of(job.program);
  const WorkFolder folder(job.output, data.title);
  const StepRules steps = step_rules_of(job, program, folder, session.progress);
  const PointFacts facts = survey_points(data, folder.work() / "original.ply", session);
  if (!job.labels.empty() && !facts.has_classes) {
    throw Error(ErrorKind::usage, "`labels` has no effect: the points have no labels");
  }
  const CompetitionRules rules = rules_of(job, data, facts, folder, session.device);

  const Provenance from = provenance_of(session.executor.threads(), session.device);
  Json results = {
      {"program", "adasplats"},
      {"version", from.version},
      {"schema", 1},
      {"title", data.title},
      {"provenance", to_json(from)},
      {"data", data_json(job, rules, facts)},
      {"machine", machine_json(from.threads)},
      {"device", device_json(session.device)},
      {"limits", {{"seconds", steps.limits.seconds}, {"memory_bytes", steps.limits.memory_bytes}}},
      {"command", from.command},
      {"original", Json::object()},
      {"competitors", Json::array()},
      {"paper", paper_figures(job.preset)}};
  results["original"] =
      original_picture(rules, StepRunner(folder.work() / "original", steps, session.progress));
  for (const Competitor& competitor : chosen) {
    if (job.methods.empty() && !is_possible(competitor, rules)) continue;
    const StepRunner runner(folder.work() / competitor.name, steps, session.progress);
    results["competitors"].push_back(compete(competitor, rules, runner));
    // After every competitor, so that an interrupted run leaves a report.
    write_reports(job.output, results);
  }
  write_reports(job.output, results);
  return results;
}

}  // namespace adasplats
