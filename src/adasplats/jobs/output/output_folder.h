// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace adasplats {

/// Of an output folder: says what made it.
inline constexpr const char* kContentFile = "adasplats.json";

/// Throws cannot_create where a file of that name could not be written: no such folder, no
/// permission, a folder or a device in its place. To be called before long work.
void check_output_file(const std::filesystem::path& file);

/// `folder` without a trailing slash. Throws cannot_create where it must not be written: no such
/// parent, or something is there that is not, with `overwrite`, earlier output of `command`.
std::filesystem::path checked_output_folder(const std::filesystem::path& folder, bool overwrite,
                                            const std::string& command);

/// Creates `partial`, where `folder` is filled, and locks it against other processes; gives the
/// descriptor that holds the lock. Errors: cannot_create.
int create_and_lock(const std::filesystem::path& partial, const std::filesystem::path& folder);

/// The text of adasplats.json: program, version, command and `content`.
std::string content_text(const std::string& command, const nlohmann::ordered_json& content);

/// Gives the whole folder `partial` the name `folder`; an older one of that name is removed.
void put_in_place(const std::filesystem::path& partial, const std::filesystem::path& folder);

/// An output folder that appears whole or not at all: filled beside its place under the name
/// ".NAME.partial" and renamed by commit(). Without commit() what was written is removed.
class OutputFolder {
 public:
  /// `content` goes into the file adasplats.json of the folder, with the program's version and the
  /// command; it distinguishes output of ours from other folders. A folder that is not empty is
  /// refused; with `overwrite` one that the same command wrote is replaced. A folder that another
  /// process fills now is refused; what a killed process left is removed. Errors: cannot_create.
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
