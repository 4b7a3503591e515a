// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "compare/steps.h"

#include <algorithm>
#include <array>
#include <optional>
#include <system_error>

#include "adasplats/core/error.h"
#include "adasplats/io/atomic_file.h"

namespace adasplats::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::array<const char*, 4> kEndNames = {"done", "failed", "timeout", "out of memory"};

Json file_stamp(const fs::path& path) {
  std::error_code failure;
  Json stamp = {{"path", path.string()}};
  if (fs::is_regular_file(path, failure)) {
    stamp["bytes"] = fs::file_size(path, failure);
  }
  // A folder's time changes where files are added or replaced in it, which is how we write them.
  const auto time = fs::last_write_time(path, failure);
  if (!failure) stamp["time"] = time.time_since_epoch().count();
  return stamp;
}

Json key_of(const Step& step) {
  Json key = {{"program", file_stamp(own_program())}, {"arguments", step.arguments}};
  for (const fs::path& input : step.inputs) key["inputs"].push_back(file_stamp(input));
  return key;
}

bool all_there(const std::vector<fs::path>& outputs) {
  return std::all_of(outputs.begin(), outputs.end(), [](const fs::path& output) {
    std::error_code failure;
    return fs::exists(output, failure);
  });
}

/// A word as a shell takes it.
std::string quoted(const std::string& word) {
  const char* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./:,@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

}  // namespace

std::string command_text(const std::vector<std::string>& arguments) {
  std::string text = "adasplats";
  for (const std::string& argument : arguments) {
    text += ' ';
    text += quoted(argument);
  }
  return text;
}

namespace {

Json to_json(const ChildResult& child, const ChildLimits& limits) {
  return {{"end", end_name(child.end)},
          {"exit_code", child.exit_code},
          {"seconds", child.seconds},
          {"peak_memory_bytes", child.peak_memory_bytes},
          {"message", child.message},
          {"seconds_limit", limits.seconds},
          {"memory_limit_bytes", limits.memory_bytes}};
}

ChildResult child_from(const Json& json) {
  ChildResult child;
  const std::string name = json.at("end");
  const auto* const found = std::find(kEndNames.begin(), kEndNames.end(), name);
  if (found == kEndNames.end()) throw Json::other_error::create(501, "end", nullptr);
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

/// What a state file remembers, where it is of this step and still holds. A file that is foreign or
/// broken counts as none: the step is run again and the file replaced.
std::optional<StepResult> remembered(const fs::path& file, const Step& step,
                                     const ChildLimits& limits, bool retry) {
  std::error_code failure;
  if (!fs::is_regular_file(file, failure)) return std::nullopt;
  try {
    const Json state = Json::parse(read_file(file));
    if (state.at("key") != key_of(step)) return std::nullopt;
    StepResult result;
    result.child = child_from(state.at("child"));
    result.report = state.at("report");
    result.command = state.at("command");
    if (result.done() && !all_there(step.outputs)) return std::nullopt;
    if (!result.done() && (retry || !would_fail_again(state.at("child"), limits))) {
      return std::nullopt;
    }
    return result;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

}  // namespace

fs::path own_program() { return fs::read_symlink("/proc/self/exe"); }

std::string end_name(ChildEnd end) { return kEndNames.at(static_cast<std::size_t>(end)); }

StepRunner::StepRunner(fs::path folder, const ChildLimits& limits, bool retry)
    : folder_(std::move(folder)), limits_(limits), retry_(retry) {
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
  ChildLimits limits = limits_;
  if (step.seconds_limit > 0) limits.seconds = step.seconds_limit;
  if (auto result = remembered(state_file, step, limits, retry_)) return *std::move(result);

  std::error_code ignored;
  fs::remove(state_file, ignored);
  fs::remove(report_file, ignored);
  std::vector<std::string> arguments = {own_program().string()};
  arguments.insert(arguments.end(), step.arguments.begin(), step.arguments.end());
  arguments.insert(arguments.end(), {"--report", report_file.string()});

  StepResult result;
  result.command = command_text(step.arguments);
  result.child = run_child(arguments, limits, folder_ / (step.name + ".log"));
  if (result.done()) result.report = Json::parse(read_file(report_file));
  const Json state = {{"key", key_of(step)},
                      {"command", result.command},
                      {"child", to_json(result.child, limits)},
                      {"report", result.report}};
  write_file(state_file, state.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  return result;
}

}  // namespace adasplats::app
