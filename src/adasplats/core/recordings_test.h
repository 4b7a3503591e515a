// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

namespace adasplats {

/// The message of a test that is skipped without a folder of recordings.
inline constexpr const char* kNoRecordings =
    "no recordings: ADASPLATS_TEST_DATA names the folder that has them";

/// The path of a real recording (or a folder of them) for a test: `name` in the folder of the
/// environment variable ADASPLATS_TEST_DATA, else in that of the CMake variable of the same name.
/// None where both are empty, and the test skips itself. A folder that is named but lacks the
/// recording is an error and no reason to skip: throws std::runtime_error.
inline std::optional<std::filesystem::path> recording(const std::string& name) {
  const char* const variable = std::getenv("ADASPLATS_TEST_DATA");
  const std::filesystem::path folder = variable != nullptr ? variable : ADASPLATS_TEST_DATA;
  if (folder.empty()) return std::nullopt;
  std::filesystem::path path = folder / name;
  if (!std::filesystem::exists(path))
    throw std::runtime_error("ADASPLATS_TEST_DATA: there is no " + path.string());
  return path;
}

}  // namespace adasplats
