// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace adasplats {

/// The file of an output folder that describes how it was made.
inline constexpr const char* kContentFile = "adasplats.json";

/// Throws cannot_create if a file of that name cannot be written: no such folder, no permission, a
/// folder or a device of that name. To be called before long work.
void check_output_file(const std::filesystem::path& file);

/// `folder` without a trailing slash. Throws cannot_create if it must not be written: no such
/// parent, or it exists and is not earlier output of `command` that `overwrite` may replace.
std::filesystem::path checked_output_folder(const std::filesystem::path& folder, bool overwrite,
                                            const std::string& command);

/// Creates `partial`, in which `folder` is filled, and locks it against other processes. Returns
/// the descriptor that holds the lock. Errors: cannot_create.
int create_and_lock(const std::filesystem::path& partial, const std::filesystem::path& folder);

/// The text of adasplats.json: program, version, command and `content`.
std::string content_text(const std::string& command, const nlohmann::ordered_json& content);

/// Renames the complete folder `partial` to `folder`, and removes an older folder of that name.
void put_in_place(const std::filesystem::path& partial, const std::filesystem::path& folder);

/// An output folder that appears complete or not at all: filled under the name ".NAME.partial" in
/// the same parent, and renamed by commit(). Without commit() it is removed.
class OutputFolder {
 public:
  /// `content` is written to the folder's adasplats.json, with the program's version and the
  /// command; the file distinguishes our output from other folders. With `overwrite` a folder of
  /// the same command is replaced; what a killed process left is removed. Errors: cannot_create
  /// (the folder is not empty; another process is filling it).
  OutputFolder(const std::filesystem::path& folder, bool overwrite, const std::string& command,
               const nlohmann::ordered_json& content);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Where to write to.
  const std::filesystem::path& path() const { return partial_; }
  void commit();

 private:
  std::filesystem::path folder_;
  std::filesystem::path partial_;
  int lock_ = -1;  ///< descriptor of the partial folder, locked
};

}  // namespace adasplats
