// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/compare/competitors.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <system_error>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Arguments = std::vector<std::string>;

constexpr const char* kNameCharacters =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_";

/// "1.500000,0.000000,-2.250000".
std::string comma_text(Vec3d v) {
  return std::to_string(v.x) + "," + std::to_string(v.y) + "," + std::to_string(v.z);
}

void add(Arguments& words, const Arguments& more) {
  words.insert(words.end(), more.begin(), more.end());
}

/// The common view, 16:9.
Arguments camera(const CompetitionRules& rules, int width) {
  return {"--eye=" + comma_text(rules.eye),
          "--target=" + comma_text(rules.target),
          "--width",
          std::to_string(width),
          "--height",
          std::to_string(width * 9 / 16)};
}

void add_scans(Arguments& words, const ScanRange& scans) {
  if (scans != ScanRange()) add(words, {"--scans", text_of(scans)});
}

bool is_file(const fs::path& path) {
  std::error_code failure;
  return fs::is_regular_file(path, failure);
}

void note_failure(Json& entry, const Step& step, const StepResult& result) {
  entry["state"] = end_name(result.child.end);
  entry["failed_step"] = step.name;
  entry["message"] = result.child.message;
  // Not what met a limit, or needs a program that is not installed.
  entry["is_error"] = result.child.end == ChildEnd::failed &&
                      result.child.exit_code != exit_code(ErrorKind::unavailable);
}

/// Whether a mesh of this name would collide with the folders or pictures of others.
bool is_taken(const std::string& name, const std::vector<Competitor>& chosen) {
  const auto is_named = [&](const Competitor& other) {
    return name == other.name || name == other.name + "-c2c" || name == other.name + "-beams" ||
           name + "-c2c" == other.name || name + "-beams" == other.name;
  };
  return name == "original" || std::any_of(chosen.begin(), chosen.end(), is_named) ||
         std::any_of(known_competitors().begin(), known_competitors().end(), is_named);
}

/// Runs the steps of one competitor.
class Run {
 public:
  Run(const Competitor& competitor, const CompetitionRules& rules, const StepRunner& runner)
      : competitor_(competitor), rules_(rules), runner_(runner) {
    entry_ = {{"name", competitor.name},
              {"title", competitor.title},
              {"kind", competitor.is_mesh ? "mesh" : "splats"},
              {"state", "done"}};
    model_ = competitor.file.empty() ? runner.folder() / "model.ply" : competitor.file;
  }

  Json result() {
    // All other steps need the model, but not each other.
    if (!generate()) return entry_;
    time_rendering();
    draw();
    if (simulate()) compare_clouds();
    if (!rules_.data.held_out.empty()) resimulate();
    if (!rules_.data.truth.empty()) compare_with_truth();
    return entry_;
  }

 private:
  /// Runs a step; the entry reports the first failure.
  StepResult run(Step step) {
    // Built-in schemes and sensors are not files and never change.
    for (const std::string& file : {rules_.data.labels, rules_.job.sensor}) {
      if (is_file(file)) step.inputs.emplace_back(file);
    }
    StepResult result = runner_.run(step);
    if (!result.done() && entry_["state"] == "done") note_failure(entry_, step, result);
    entry_["made_by"][step.name] = result.made_by;
    note_provenance(result);
    return result;
  }

  /// Runs a step that makes or uses a model, on the device of the job.
  StepResult run_on_device(Step step) {
    if (rules_.job.device != DeviceKind::automatic) {
      add(step.arguments, {"--device", device_word(rules_.job.device)});
    }
    step.device = rules_.device;
    return run(std::move(step));
  }

  /// The version and the first and last date of the steps. Steps of another build of the program
  /// are run again (key_of() in steps.cpp), so there is one version.
  void note_provenance(const StepResult& result) {
    if (!result.report.contains("provenance")) return;
    const Json& from = result.report["provenance"];
    Json& own = entry_["provenance"];
    if (own.is_null()) own = {{"commit", from["commit"]}, {"dirty", from["dirty"]}};
    const std::string date = from["date"];
    own["first_date"] = std::min(own.value("first_date", date), date);
    own["last_date"] = std::max(own.value("last_date", date), date);
  }

  /// The device that a step has used.
  void note_device(const char* key, const StepResult& result) {
    if (!result.done() || !result.report.contains("device")) return;
    entry_[key]["device"] = result.report["device"].value("kind", Json());
  }

  /// Replaces generate() for an existing mesh.
  bool inspect_mesh() {
    entry_["generate"] = {{"command", nullptr}, {"seconds", nullptr}};
    const Step step = {"info", {"info", model_.string()}, {model_}, {}};
    StepResult looked = run(step);
    if (!looked.done()) return false;
    const Json facts = looked.report.at("files").at(0);
    if (!facts.contains("triangles")) {
      looked.child.end = ChildEnd::failed;
      looked.child.message =
          model_.string() + ": is no mesh but a " + facts.at("kind").get<std::string>();
      note_failure(entry_, step, looked);
      return false;
    }
    entry_["generate"]["primitives"] = facts.at("triangles");
    return true;
  }

  bool generate() {
    if (!competitor_.file.empty()) return inspect_mesh();
    Arguments words = {competitor_.is_mesh ? "mesh" : "model"};
    for (const fs::path& input : rules_.data.inputs) words.push_back(input.string());
    add(words, {"-o", model_.string()});
    add(words, competitor_.arguments);
    // Meshes and the reference clouds use the points as given, so models must, too.
    if (!competitor_.is_mesh) add(words, {"--no-calibrate"});
    if (competitor_.name == "poisson") {
      add(words, {"--depth", std::to_string(rules_.job.poisson_depth)});
    }
    if (rules_.has_classes && !rules_.data.labels.empty() && !competitor_.segments) {
      add(words, {"--labels", rules_.data.labels});
    }
    add_scans(words, rules_.data.scans);
    add(words, {"--remove", std::string(name_of(competitor_.segments ? rules_.network_removal
                                                                     : rules_.removal))});
    Step step = {"generate", words, rules_.data.inputs, {model_}};
    if (competitor_.segments && !rules_.job.network.empty()) {
      add(step.arguments, {"--network", rules_.job.network.string()});
      step.inputs.push_back(rules_.job.network);
    }
    const StepResult made = competitor_.is_mesh ? run(step) : run_on_device(step);
    entry_["generate"] = {{"command", made.command},
                          {"seconds", made.done() ? Json(made.child.seconds) : Json()},
                          {"peak_memory_bytes", made.child.peak_memory_bytes}};
    if (!made.done()) entry_["generate"]["ended_after_seconds"] = made.child.seconds;
    for (const char* key : {"primitives", "points_in", "points_used"}) {
      if (made.done()) entry_["generate"][key] = made.report.value(key, Json());
    }
    for (const char* key : {"segmentation", "points_removed"}) {
      if (made.done() && competitor_.segments)
        entry_["generate"][key] = made.report.value(key, Json());
    }
    if (made.done()) entry_["generate"]["step_seconds"] = made.report.value("seconds", Json());
    note_device("generate", made);
    return made.done();
  }

  /// Frequency at the paper's resolution, one ray a pixel.
  void time_rendering() {
    const fs::path picture = runner_.folder() / "render.png";
    Arguments words = {"render", model_.string(), "-o", picture.string(), "--samples",
                       "1",      "--repeat",      "3"};
    add(words, camera(rules_, 2560));
    const StepResult timed = run_on_device({"render", words, {model_}, {picture}});
    if (timed.done()) {
      entry_["render"]["images_per_second"] = timed.report.value("images_per_second", Json());
      note_device("render", timed);
    }
  }

  void draw() {
    const fs::path picture = rules_.pictures / (competitor_.name + ".png");
    Arguments words = {"render", model_.string(), "-o", picture.string()};
    add(words, camera(rules_, rules_.job.picture_width));
    if (run_on_device({"picture", words, {model_}, {picture}}).done()) {
      entry_["render"]["picture"] = relative_to_report(picture);
    }
  }

  Arguments drive() const {
    return {"--sensor",
            rules_.job.sensor,
            "--trajectory",
            rules_.data.trajectory.string(),
            "--offset=" + comma_text(rules_.offset_m),
            "--every",
            std::to_string(rules_.every)};
  }

  bool simulate() {
    scans_ = runner_.folder() / "scans";
    Arguments words = {"simulate", model_.string(), "-o", scans_.string(), "--overwrite"};
    add(words, drive());
    const StepResult driven =
        run_on_device({"simulate", words, {model_, rules_.data.trajectory}, {scans_}});
    if (!driven.done()) return false;
    for (const char* key : {"scans", "rays", "hits", "scans_per_second"}) {
      entry_["simulate"][key] = driven.report.value(key, Json());
    }
    entry_["simulate"]["sensor"] = rules_.job.sensor;
    entry_["simulate"]["command"] = driven.command;
    note_device("simulate", driven);
    return true;
  }

  void compare_clouds() {
    const fs::path picture = rules_.pictures / (competitor_.name + "-c2c.png");
    Arguments words = {"evaluate", "c2c", scans_.string(), rules_.original.string()};
    add(words, {"--picture", picture.string(), "--eye=" + comma_text(rules_.eye),
                "--target=" + comma_text(rules_.target), "--picture-width",
                std::to_string(rules_.job.picture_width)});
    if (rules_.labelled) add(words, {"--by-class", "--labels", rules_.data.labels});
    // Classes of the network would hide errors of the surface: a facade classified as a fence gives
    // metres.
    if (rules_.labelled && competitor_.segments) words.push_back("--nearest-classes");
    const StepResult compared = run({"c2c", words, {scans_, rules_.original}, {picture}});
    store("c2c", compared, picture);
  }

  void resimulate() {
    const fs::path picture = rules_.pictures / (competitor_.name + "-beams.png");
    Arguments words = {"evaluate",  "resimulate",    model_.string(), rules_.data.held_out.string(),
                       "--picture", picture.string()};
    add(words, {"--picture-width", std::to_string(rules_.job.picture_width)});
    add_scans(words, rules_.data.held_out_scans);
    if (!rules_.data.labels.empty()) add(words, {"--labels", rules_.data.labels});
    if (fs::is_directory(rules_.data.held_out / "labels")) add_left_out(words);
    store("resimulate",
          run_on_device({"resimulate", words, {model_, rules_.data.held_out}, {picture}}), picture);
  }

  void compare_with_truth() {
    Arguments words = {"evaluate", "truth", model_.string(), rules_.data.truth.string()};
    add(words, drive());
    if (!rules_.data.labels.empty()) add(words, {"--labels", rules_.data.labels});
    add_left_out(words);
    store("truth",
          run_on_device({"truth", words, {model_, rules_.data.truth, rules_.data.trajectory}, {}}),
          {});
  }

  /// Leaves out the beams and rays on objects that were removed from the points.
  void add_left_out(Arguments& words) const {
    if (rules_.removal == DynamicRemoval::movable) words.push_back("--drop-movable");
    if (rules_.removal == DynamicRemoval::none) words.push_back("--keep-moving");
  }

  void store(const char* key, const StepResult& result, const fs::path& picture) {
    if (!result.done()) return;
    Json& part = entry_[key];
    part = result.report;
    // Keys of every report that no table shows.
    for (const char* common :
         {"program", "version", "provenance", "parameters", "threads", "warnings"}) {
      part.erase(common);
    }
    part["command"] = result.command;
    note_device(key, result);
    if (!picture.empty()) part["picture"] = relative_to_report(picture);
  }

  static std::string relative_to_report(const fs::path& picture) {
    return (fs::path("pictures") / picture.filename()).string();
  }

  const Competitor& competitor_;
  const CompetitionRules& rules_;
  const StepRunner& runner_;
  Json entry_;
  fs::path model_;
  fs::path scans_;
};

}  // namespace

const std::vector<Competitor>& known_competitors() {
  static const std::vector<Competitor> known = {
      {.name = "basic", .title = "Basic splats", .arguments = {"--method", "basic"}},
      {.name = "descriptors",
       .title = "AdaSplats, descriptors",
       .arguments = {"--method", "descriptors"}},
      {.name = "descriptors-no-resample",
       .title = "AdaSplats, descriptors, no resampling",
       .arguments = {"--method", "descriptors", "--no-resample"}},
      {.name = "kpconv",
       .title = "AdaSplats-KPConv",
       .segments = true,
       .arguments = {"--method", "semantic", "--segment"}},
      {.name = "semantic",
       .title = "AdaSplats, classes",
       .needs_labels = true,
       .arguments = {"--method", "semantic"}},
      {.name = "semantic-no-resample",
       .title = "AdaSplats, classes, no resampling",
       .needs_labels = true,
       .arguments = {"--method", "semantic", "--no-resample"}},
      {.name = "consistent",
       .title = "Ray-consistent splats",
       .arguments = {"--method", "consistent"}},
      {.name = "imls", .title = "Mesh, IMLS", .is_mesh = true, .arguments = {"--method", "imls"}},
      {.name = "poisson",
       .title = "Mesh, Poisson",
       .is_mesh = true,
       .arguments = {"--method", "poisson"}}};
  return known;
}

std::vector<Competitor> chosen_competitors(
    const std::vector<std::string>& names,
    const std::vector<std::pair<std::string, fs::path>>& meshes) {
  std::vector<std::string> known;
  for (const Competitor& competitor : known_competitors()) known.push_back(competitor.name);
  std::vector<Competitor> chosen;
  for (const std::string& name : names.empty() ? known : names) {
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) throw Error(ErrorKind::usage, unknown_word("method", name, known));
    const bool given_before = std::any_of(chosen.begin(), chosen.end(),
                                          [&](const Competitor& c) { return c.name == name; });
    if (given_before) continue;
    chosen.push_back(known_competitors()[static_cast<std::size_t>(found - known.begin())]);
  }
  for (const auto& [name, file] : meshes) {
    if (name.empty() || name.find_first_not_of(kNameCharacters) != std::string::npos) {
      throw Error(ErrorKind::usage,
                  "the mesh's name '" + name + "' must consist of letters, digits, - and _");
    }
    if (is_taken(name, chosen)) {
      throw Error(ErrorKind::usage, "the mesh's name '" + name + "' is taken");
    }
    chosen.push_back({.name = name, .title = "Mesh, " + name, .is_mesh = true, .file = file});
  }
  return chosen;
}

Json compete(const Competitor& competitor, const CompetitionRules& rules,
             const StepRunner& runner) {
  return Run(competitor, rules, runner).result();
}

Json original_picture(const CompetitionRules& rules, const StepRunner& runner) {
  const fs::path picture = rules.pictures / "original.png";
  Arguments words = {"render", rules.original.string()};
  add(words, {"-o", picture.string()});
  add(words, camera(rules, rules.job.picture_width));
  if (rules.has_classes && !rules.data.labels.empty()) {
    add(words, {"--labels", rules.data.labels});
  }
  Step step = {"picture", words, {rules.original}, {picture}};
  if (is_file(rules.data.labels)) step.inputs.emplace_back(rules.data.labels);
  const StepResult drawn = runner.run(step);
  if (drawn.done()) return {{"picture", "pictures/original.png"}};
  Json original;
  note_failure(original, step, drawn);
  return original;
}

}  // namespace adasplats
