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
  std::error_code problem;  // missing paths are not equivalent to anything
  return fs::equivalent(a, b, problem) && !problem;
}

/// The path without links, as far as it exists.
fs::path real_path(const fs::path& path) {
  std::error_code problem;
  fs::path real = fs::weakly_canonical(fs::absolute(path, problem), problem);
  if (problem) real = path.lexically_normal();
  return real.has_filename() ? real : real.parent_path();
}

bool is_inside(const fs::path& path, const fs::path& folder) {
  const fs::path inner = real_path(path), outer = real_path(folder);
  const auto differ = std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end());
  return differ.first == outer.end();
}

/// Whether `file` would be one of the files that are read in a folder, or make the folder
/// ambiguous.
bool counts_in(const fs::path& folder, const fs::path& file) {
  const fs::path parent = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (!is_same(folder, parent) || !has_extension_of_a_kind(file)) return false;
  try {
    return std::ranges::any_of(cloud_inputs(folder, SensorScans::taken),
                               [](const CloudInput& input) { return !input.is_sequence; });
  } catch (const Error&) {
    return false;  // reported when the folder is read
  }
}

}  // namespace

void require_ending(const fs::path& file, std::span<const std::string> endings) {
  const std::string ending = lower_case(file.extension().string());
  if (std::ranges::find(endings, ending) != endings.end()) return;
  std::string possible;
  for (std::size_t i = 0; i < endings.size(); ++i) {
    possible += i == 0 ? "" : i + 1 < endings.size() ? ", " : " or ";
    possible += endings[i].empty() ? "nothing (a folder)" : endings[i];
  }
  throw Error(ErrorKind::usage,
              file.string() + ": the output format needs a name that ends with " + possible);
}

void require_ending(const fs::path& file, const std::string& ending) {
  require_ending(file, std::span(&ending, 1));
}

void require_no_input(const fs::path& file, std::span<const fs::path> inputs) {
  for (const fs::path& input : inputs) {
    if (is_same(file, input))
      throw Error(ErrorKind::usage, file.string() + ": the output is also an input (" +
                                        input.string() + "); choose another name");
    std::error_code ignored;
    if (fs::is_directory(input, ignored) && counts_in(input, file))
      throw Error(ErrorKind::usage, file.string() +
                                        ": would become one of the files of the input " +
                                        input.string() + "; choose another folder");
  }
}

void require_folder_apart(const fs::path& folder, std::span<const fs::path> inputs) {
  for (const fs::path& input : inputs) {
    std::error_code ignored;
    if (is_inside(input, folder) || is_same(input, folder))
      throw Error(ErrorKind::usage, folder.string() +
                                        ": the output folder is or contains the input " +
                                        input.string() + "; choose another folder");
    if (fs::is_directory(input, ignored) && is_inside(folder, input))
      throw Error(ErrorKind::usage, folder.string() + ": the output folder is inside the input " +
                                        input.string() + "; choose another folder");
  }
}

}  // namespace adasplats
