// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/output/output_check.h"

#include <algorithm>

#include "adasplats/cloud/load/cloud_inputs.h"
#include "adasplats/cloud/load/file_kind.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

bool is_same(const fs::path& a, const fs::path& b) {
  std::error_code problem;  // what is not there is nothing's same
  return fs::equivalent(a, b, problem) && !problem;
}

/// The path without links, as far as it is there.
fs::path real_path(const fs::path& path) {
  std::error_code problem;
  fs::path real = fs::weakly_canonical(fs::absolute(path, problem), problem);
  if (problem) real = path.lexically_normal();
  return real.has_filename() ? real : real.parent_path();
}

bool lies_in(const fs::path& path, const fs::path& folder) {
  const fs::path inner = real_path(path), outer = real_path(folder);
  const auto differ = std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end());
  return differ.first == outer.end();
}

/// Whether `file` would count in a folder that is read for its files: as one of them, or as
/// something else that makes the folder unclear.
bool counts_in(const fs::path& folder, const fs::path& file) {
  const fs::path parent = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (!is_same(folder, parent) || !has_extension_of_a_kind(file)) return false;
  try {
    return std::ranges::any_of(cloud_inputs(folder, SensorScans::taken),
                               [](const CloudInput& input) { return !input.is_sequence; });
  } catch (const Error&) {
    return false;  // whoever reads the folder says what is wrong with it
  }
}

}  // namespace

void require_ending(const fs::path& file, std::span<const std::string> endings) {
  const std::string ending = lower_case(file.extension().string());
  if (std::ranges::find(endings, ending) != endings.end()) return;
  std::string possible;
  for (std::size_t i = 0; i < endings.size(); ++i) {
    possible += i == 0 ? "" : i + 1 < endings.size() ? ", " : " or ";
    possible += endings[i].empty() ? "have no ending (a folder)" : endings[i];
  }
  throw Error(ErrorKind::usage, file.string() + ": its name must end with " + possible +
                                    ", as that is what is written");
}

void require_ending(const fs::path& file, const std::string& ending) {
  require_ending(file, std::span(&ending, 1));
}

void require_no_input(const fs::path& file, std::span<const fs::path> inputs) {
  for (const fs::path& input : inputs) {
    if (is_same(file, input))
      throw Error(ErrorKind::usage,
                  file.string() + ": is an input, too (" + input.string() + "); write elsewhere");
    std::error_code ignored;
    if (fs::is_directory(input, ignored) && counts_in(input, file))
      throw Error(ErrorKind::usage, file.string() + ": would count among the files of the input " +
                                        input.string() + " from then on; write elsewhere");
  }
}

void require_folder_apart(const fs::path& folder, std::span<const fs::path> inputs) {
  for (const fs::path& input : inputs) {
    std::error_code ignored;
    if (lies_in(input, folder) || is_same(input, folder))
      throw Error(ErrorKind::usage, folder.string() + ": is or holds the input " + input.string() +
                                        "; write elsewhere");
    if (fs::is_directory(input, ignored) && lies_in(folder, input))
      throw Error(ErrorKind::usage,
                  folder.string() + ": lies in the input " + input.string() + "; write elsewhere");
  }
}

}  // namespace adasplats
