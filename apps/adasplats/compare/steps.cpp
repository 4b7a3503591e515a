// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "compare/steps.h"

#include <algorithm>
#include <array>
#include <optional>
#include <system_error>

#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/pipeline/provenance/provenance.h"

namespace adasplats::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// Stays the running program where its file is replaced meanwhile.
constexpr const char* kOwnProgram = "/proc/self/exe";
constexpr std::array<const char*, 4> kEndNames = {"done", "failed", "timeout", "out of memory"};

/// Sizes and the newest time of the files that lie in a folder itself; what lies deeper belongs to
/// others (a comparison beside its data, say).
void stamp_files_in(const fs::path& folder, Json& stamp) {
  std::uint64_t files = 0, bytes = 0;
  fs::file_time_type newest = fs::file_time_type::min();
  std::error_code failure;
  for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end;
       entry.increment(failure)) {
    std::error_code gone;
    if (!entry->is_regular_file(gone)) continue;
    ++files;
    bytes += entry->file_size(gone);
    newest = std::max(newest, entry->last_write_time(gone));
  }
  stamp["files"] = files;
  stamp["bytes"] = bytes;
  if (files > 0) stamp["newest"] = newest.time_since_epoch().count();
}

/// What changes where a file, a folder of point files or a sequence folder changes.
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

/// "version", "commit" and "dirty" of this program, which runs all steps.
Json own_program() {
  const Json own = adasplats::to_json(provenance_of(0));
  return {{"version", own["version"]}, {"commit", own["commit"]}, {"dirty", own["dirty"]}};
}

/// A program of another version or commit has another key: its results are not taken over. So has
/// one of the same commit that was built again, whose sources may have been changed.
Json key_of(const Step& step, const std::vector<std::string>& arguments) {
  std::error_code failure;
  Json key = {{"program", own_program()}, {"arguments", arguments}};
  key["program"]["file"] = stamp_of(fs::read_symlink(kOwnProgram, failure));
  if (!step.device.empty()) key["device"] = step.device;
  for (const fs::path& input : step.inputs) key["inputs"].push_back(stamp_of(input));
  return key;
}

bool all_there(const std::vector<fs::path>& outputs) {
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

/// The opposite of to_json(). Errors: Json::exception; nothing for an end that is not known.
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

/// Whether a failure would come again: the limit that ended it is not higher now.
bool would_fail_again(const Json& child, const ChildLimits& limits) {
  const std::string end = child.at("end");
  if (end == "timeout") return limits.seconds <= child.at("seconds_limit").get<double>();
  if (end == "out of memory") {
    const auto before = child.at("memory_limit_bytes").get<std::uint64_t>();
    return limits.memory_bytes != 0 && limits.memory_bytes <= before;
  }
  return true;
}

/// What a state file remembers, where it is of this key and still holds. A file that is foreign or
/// broken counts as none: the step is run again and the file replaced.
std::optional<StepResult> remembered(const fs::path& file, const Step& step, const Json& key,
                                     const StepRules& rules) {
  std::error_code failure;
  if (!fs::is_regular_file(file, failure)) return std::nullopt;
  try {
    const Json state = Json::parse(read_file(file));
    if (state.at("key") != key) return std::nullopt;
    const std::optional<ChildResult> child = child_from(state.at("child"));
    if (!child) return std::nullopt;
    StepResult result{*child, state.at("report"), state.at("command"), state.at("made_by")};
    const Json own = own_program();
    for (const auto& [part, value] : own.items()) {
      if (result.made_by.at(part) != value) return std::nullopt;
    }
    if (result.done() && !all_there(step.outputs)) return std::nullopt;
    if (!result.done() && (rules.retry || !would_fail_again(state.at("child"), rules.limits))) {
      return std::nullopt;
    }
    return result;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

/// Removes what a killed child has left beside its outputs: files and folders that were to be
/// renamed when they were whole. The folders are ours alone (see WorkFolder).
void remove_unfinished(const Step& step) {
  for (const fs::path& output : step.outputs) {
    std::error_code failure;
    std::vector<fs::path> unfinished = {output.parent_path() /
                                        ("." + output.filename().string() + ".partial")};
    for (fs::directory_iterator entry(output.parent_path(), failure), end; !failure && entry != end;
         entry.increment(failure)) {
      const std::string name = entry->path().filename().string();
      if (name.rfind(".adasplats-", 0) == 0) unfinished.push_back(entry->path());
    }
    for (const fs::path& path : unfinished) fs::remove_all(path, failure);
  }
}

/// Runs a child, which leaves nothing unfinished behind however it ends.
ChildResult run_cleanly(const Step& step, const std::vector<std::string>& arguments,
                        const ChildLimits& limits, const fs::path& log, ProgressSink& progress) {
  remove_unfinished(step);  // this program may have been killed before
  try {
    ChildResult result = run_child(arguments, limits, log, progress);
    if (result.end != ChildEnd::done) remove_unfinished(step);
    return result;
  } catch (...) {
    remove_unfinished(step);
    throw;
  }
}

}  // namespace

std::string command_text(const std::vector<std::string>& arguments) {
  std::string text = "adasplats";
  for (const std::string& argument : arguments) {
    text += ' ';
    text += shell_word(argument);
  }
  return text;
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
  // Before the step: what changes while it runs has not been used.
  const Json key = key_of(step, arguments);
  if (auto result = remembered(state_file, step, key, rules_)) return *std::move(result);

  std::error_code ignored;
  fs::remove(state_file, ignored);
  fs::remove(report_file, ignored);
  StepResult result;
  result.command = command_text(arguments);
  result.made_by = own_program();
  result.made_by["date"] = provenance_of(0).date;
  arguments.insert(arguments.begin(), kOwnProgram);
  arguments.insert(arguments.end(), {"--report", report_file.string()});
  progress_.begin_step(folder_.filename().string() + ": " + step.name, 0);
  result.child =
      run_cleanly(step, arguments, rules_.limits, folder_ / (step.name + ".log"), progress_);
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

}  // namespace adasplats::app
