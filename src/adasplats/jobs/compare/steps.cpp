// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/compare/steps.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <optional>
#include <string_view>
#include <system_error>

#include "adasplats/core/error.h"
#include "adasplats/core/list_folder.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/sha256.h"
#include "adasplats/jobs/output/output_folder.h"
#include "adasplats/jobs/provenance/provenance.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kProgramName = "adasplats";
constexpr std::array<const char*, 4> kEndNames = {"done", "failed", "timeout", "out of memory"};

/// Sizes and newest time of the files directly in a folder. Deeper files may belong to something
/// else, such as a comparison written into its data folder.
void stamp_files_in(const fs::path& folder, Json& stamp) {
  std::uint64_t files = 0, bytes = 0;
  fs::file_time_type newest = fs::file_time_type::min();
  for (const fs::path& path : list_folder_if_any(folder)) {
    std::error_code gone;
    const fs::directory_entry entry(path, gone);
    if (!entry.is_regular_file(gone)) continue;
    ++files;
    bytes += entry.file_size(gone);
    newest = std::max(newest, entry.last_write_time(gone));
  }
  stamp["files"] = files;
  stamp["bytes"] = bytes;
  if (files > 0) stamp["newest"] = newest.time_since_epoch().count();
}

/// Changes if a file, a folder of point files or a sequence folder changes.
Json stamp_of(const fs::path& path) {
  std::error_code failure;
  Json stamp = {{"path", path.string()}};
  const auto time = fs::last_write_time(path, failure);
  if (failure) return stamp;
  stamp["time"] = time.time_since_epoch().count();
  if (fs::is_regular_file(path, failure)) stamp["bytes"] = fs::file_size(path, failure);
  if (!fs::is_directory(path, failure)) return stamp;
  stamp_files_in(path, stamp);
  for (const char* part : {"velodyne", "labels"}) {  // of a sequence
    if (fs::is_directory(path / part, failure)) stamp_files_in(path / part, stamp[part]);
  }
  return stamp;
}

/// A program of another version or commit has another key: its results are not reused. So has one
/// of the same commit that was built again, because its sources may have changed.
Json key_of(const Step& step, const std::vector<std::string>& arguments, const StepRules& rules) {
  std::error_code failure;
  Json key = {{"program", rules.made_by}, {"arguments", arguments}};
  key["program"]["file"] = stamp_of(fs::canonical(rules.program, failure));
  if (!step.device.empty()) key["device"] = step.device;
  for (const fs::path& input : step.inputs) key["inputs"].push_back(stamp_of(input));
  return key;
}

bool all_exist(const std::vector<fs::path>& outputs) {
  return std::all_of(outputs.begin(), outputs.end(), [](const fs::path& output) {
    std::error_code failure;
    return fs::exists(output, failure);
  });
}

Json to_json(const ChildResult& child, const ChildLimits& limits) {
  return {{"end", end_name(child.end)},
          {"exit_code", child.exit_code},
          {"seconds", child.seconds},
          {"peak_memory_bytes", child.peak_memory_bytes},
          {"message", child.message},
          {"seconds_limit", limits.seconds},
          {"memory_limit_bytes", limits.memory_bytes}};
}

/// The inverse of to_json(). Errors: Json::exception; nothing for an unknown end.
std::optional<ChildResult> child_from(const Json& json) {
  ChildResult child;
  const std::string name = json.at("end");
  const auto* const found = std::find(kEndNames.begin(), kEndNames.end(), name);
  if (found == kEndNames.end()) return std::nullopt;
  child.end = static_cast<ChildEnd>(found - kEndNames.begin());
  child.exit_code = json.at("exit_code");
  child.seconds = json.at("seconds");
  child.peak_memory_bytes = json.at("peak_memory_bytes");
  child.message = json.at("message");
  return child;
}

/// Whether a failed step would fail again: the limit that ended it has not been raised.
bool would_fail_again(const Json& child, const ChildLimits& limits) {
  const std::string end = child.at("end");
  if (end == "timeout") return limits.seconds <= child.at("seconds_limit").get<double>();
  if (end == "out of memory") {
    const auto before = child.at("memory_limit_bytes").get<std::uint64_t>();
    return limits.memory_bytes != 0 && limits.memory_bytes <= before;
  }
  return true;
}

/// The result in a state file, if it has this key and is still valid. A foreign or broken file is
/// ignored: the step is run again and the file replaced.
std::optional<StepResult> stored_result(const fs::path& file, const Step& step, const Json& key,
                                        const StepRules& rules) {
  std::error_code failure;
  if (!fs::is_regular_file(file, failure)) return std::nullopt;
  try {
    const Json state = Json::parse(read_file(file));
    if (state.at("key") != key) return std::nullopt;
    const std::optional<ChildResult> child = child_from(state.at("child"));
    if (!child) return std::nullopt;
    StepResult result{*child, state.at("report"), state.at("command"), state.at("made_by")};
    for (const auto& [part, value] : rules.made_by.items()) {
      if (result.made_by.at(part) != value) return std::nullopt;
    }
    if (result.done() && !all_exist(step.outputs)) return std::nullopt;
    if (!result.done() && (rules.retry || !would_fail_again(state.at("child"), rules.limits))) {
      return std::nullopt;
    }
    return result;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

/// Removes the temporary files and folders that a killed child left next to its outputs. No other
/// program uses these folders (WorkFolder).
void remove_unfinished(const Step& step) {
  for (const fs::path& output : step.outputs) {
    std::error_code failure;
    const std::string hidden = "." + output.filename().string();
    std::vector<fs::path> unfinished = {output.parent_path() / (hidden + ".partial"),
                                        output.parent_path() / (hidden + ".unfinished")};
    for (const fs::path& path : list_folder_if_any(output.parent_path()))
      if (path.filename().string().starts_with(".adasplats-")) unfinished.push_back(path);
    for (const fs::path& path : unfinished) fs::remove_all(path, failure);
  }
}

/// Runs a child and removes its unfinished outputs, however it ends.
ChildResult run_cleanly(const Step& step, const std::vector<std::string>& arguments,
                        const ChildLimits& limits, const fs::path& log, ProgressSink& progress) {
  remove_unfinished(step);  // of an earlier run that was killed
  try {
    ChildResult result = run_child({arguments, {}, log, limits}, progress);
    if (result.end != ChildEnd::done) remove_unfinished(step);
    return result;
  } catch (...) {
    remove_unfinished(step);
    throw;
  }
}

/// A full or failing disk says nothing about a method.
void reject_disk_errors(const std::string& name, const ChildResult& child) {
  constexpr std::string_view kPrefix = "adasplats: error: ";
  std::string_view message = child.message;
  if (message.starts_with(kPrefix)) message.remove_prefix(kPrefix.size());
  for (const ErrorKind kind : {ErrorKind::io, ErrorKind::cannot_create})
    if (child.exit_code == exit_code(kind))
      throw Error(kind, name + ": " + std::string(message) + " (the same command resumes)");
}

void make_folder(const fs::path& folder) {
  std::error_code failure;
  fs::create_directory(folder, failure);
  if (failure) {
    throw system_error(ErrorKind::cannot_create, folder, "cannot create the folder",
                       failure.value());
  }
}

bool same_bytes(const fs::path& a, const fs::path& b) {
  std::error_code failure;
  if (!fs::is_regular_file(b, failure) || fs::file_size(a) != fs::file_size(b)) return false;
  return sha256_of_file(a) == sha256_of_file(b);
}

/// Rejects a folder with other content than a comparison of the same data.
void check_content(const fs::path& folder, const std::string& title) {
  if (fs::is_empty(folder)) return;
  const fs::path file = folder / kContentFile;
  const Json content =
      fs::is_regular_file(file) ? Json::parse(read_file(file), nullptr, false) : Json();
  if (!content.is_object() || content.value("command", Json()) != "compare") {
    throw Error(ErrorKind::cannot_create,
                folder.string() + ": the folder is not empty and contains no comparison");
  }
  if (content.value("title", Json()) != title) {
    throw Error(ErrorKind::cannot_create, folder.string() + ": contains a comparison of " +
                                              content.value("title", Json()).dump() + ", not of '" +
                                              title + "'");
  }
}

}  // namespace

WorkFolder::WorkFolder(const fs::path& folder, const std::string& title) : folder_(folder) {
  make_folder(folder_);
  lock_ = open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock_ < 0) throw system_error(ErrorKind::cannot_create, folder_, "cannot open", errno);
  try {
    if (flock(lock_, LOCK_EX | LOCK_NB) != 0) {
      throw Error(ErrorKind::cannot_create, folder_.string() + ": another run works in it");
    }
    check_content(folder_, title);
    write_file(folder_ / kContentFile, content_text("compare", {{"title", title}}));
    // After the content file: otherwise a run that is killed here would find a foreign folder.
    make_folder(work());
    make_folder(pictures());
  } catch (...) {
    close(lock_);
    throw;
  }
}

WorkFolder::~WorkFolder() { close(lock_); }

void write_if_changed(const fs::path& file, const std::function<void(const fs::path&)>& write) {
  const fs::path fresh = file.parent_path() / ("new-" + file.filename().string());
  write(fresh);
  if (same_bytes(fresh, file)) {
    fs::remove(fresh);
  } else {
    fs::rename(fresh, file);
  }
}

fs::path program_of(const fs::path& named) {
  const std::string name = named.empty() ? kProgramName : named.string();
  if (name.find('/') != std::string::npos) return named;
  if (const auto found = find_on_path(name)) return *found;
  throw Error(ErrorKind::no_input,
              name +
                  ": the program that runs the steps of a comparison is not on PATH; install it "
                  "(cmake --install) or set its path (program)");
}

Json build_of_program(const fs::path& program, const fs::path& folder, ProgressSink& progress) {
  const fs::path file = folder / "program-report.json";
  std::error_code ignored;
  fs::remove(file, ignored);
  // A command without input and device.
  const ChildResult asked = run_child(
      {{program.string(), "sensors", "--report", file.string()}, {}, folder / "program.log"},
      progress);
  if (asked.exit_code == kCannotStart)
    throw Error(ErrorKind::no_input, program.string() + ": the program " + asked.message);
  const bool has_report = asked.end == ChildEnd::done && fs::is_regular_file(file, ignored);
  const Json report = has_report ? Json::parse(read_file(file), nullptr, false) : Json();
  Json build = report.is_object() ? report.value("provenance", Json()) : Json();
  const std::string expected = provenance_of(0).version;
  if (!build.is_object() || build.value("version", Json()) != expected)
    throw Error(ErrorKind::usage, program.string() + ": the program is not adasplats " + expected +
                                      (asked.message.empty() ? "" : ": " + asked.message));
  return {{"version", build["version"]}, {"commit", build["commit"]}, {"dirty", build["dirty"]}};
}

std::string end_name(ChildEnd end) { return kEndNames.at(static_cast<std::size_t>(end)); }

StepRunner::StepRunner(fs::path folder, StepRules rules, ProgressSink& progress)
    : folder_(std::move(folder)), rules_(std::move(rules)), progress_(progress) {
  std::error_code failure;
  fs::create_directories(folder_, failure);
  if (failure) {
    throw system_error(ErrorKind::cannot_create, folder_, "cannot create the folder",
                       failure.value());
  }
}

StepResult StepRunner::run(const Step& step) const {
  const fs::path state_file = folder_ / (step.name + ".json");
  const fs::path report_file = folder_ / (step.name + "-report.json");
  std::vector<std::string> arguments = step.arguments;
  arguments.insert(arguments.end(), rules_.common_arguments.begin(), rules_.common_arguments.end());
  // Computed before the step: an input that changes while it runs makes the result outdated.
  const Json key = key_of(step, arguments, rules_);
  if (auto result = stored_result(state_file, step, key, rules_)) return *std::move(result);

  std::error_code ignored;
  fs::remove(state_file, ignored);
  fs::remove(report_file, ignored);
  StepResult result;
  result.command = command_text(arguments);
  result.made_by = rules_.made_by;
  result.made_by["date"] = provenance_of(0).date;
  arguments.insert(arguments.begin(), rules_.program.string());
  arguments.insert(arguments.end(), {"--report", report_file.string()});
  progress_.begin_step(folder_.filename().string() + ": " + step.name, 0);
  result.child =
      run_cleanly(step, arguments, rules_.limits, folder_ / (step.name + ".log"), progress_);
  reject_disk_errors(folder_.filename().string() + ": " + step.name, result.child);
  progress_.end_step();
  if (result.done()) result.report = Json::parse(read_file(report_file));
  const Json state = {{"key", key},
                      {"command", result.command},
                      {"made_by", result.made_by},
                      {"child", to_json(result.child, rules_.limits)},
                      {"report", result.report}};
  write_file(state_file, state.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  return result;
}

}  // namespace adasplats
