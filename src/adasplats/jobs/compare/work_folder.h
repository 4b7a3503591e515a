// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace adasplats {

/// The output folder of a comparison, which grows step by step and stays after an interruption:
/// OUTPUT/work for what steps make, OUTPUT/pictures, and a file adasplats.json that distinguishes
/// it from other folders. Locked as long as the object lives.
class WorkFolder {
 public:
  /// Errors: cannot_create (not empty and not of a comparison, of a comparison of data with
  /// another title, or used by another run).
  WorkFolder(const std::filesystem::path& folder, const std::string& title);
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  std::filesystem::path work() const { return folder_ / "work"; }
  std::filesystem::path pictures() const { return folder_ / "pictures"; }

 private:
  std::filesystem::path folder_;
  int lock_ = -1;
};

/// Has `write` make a file under another name beside it and puts it in place where its bytes are
/// others: what was made from the same file need not be made again.
void write_if_changed(const std::filesystem::path& file,
                      const std::function<void(const std::filesystem::path&)>& write);

}  // namespace adasplats
