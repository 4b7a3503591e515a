// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "adasplats/io/las/las_header.h"
#include "adasplats/io/las/las_records.h"

namespace adasplats {

/// Unpacks a LAZ file with LASzip in a process of its own: LASzip reads and writes out of bounds
/// on broken files, and what it breaks must not be this process.
class LazProcess {
 public:
  /// Errors: io where no process can be started.
  LazProcess(const std::filesystem::path& path, const LasHeader& header);
  ~LazProcess();
  LazProcess(const LazProcess&) = delete;
  LazProcess& operator=(const LazProcess&) = delete;

  /// The next points of the file; none at the end or at a fault.
  std::vector<LasPoint> next_points();
  /// What ended the points: LASzip's message, or that it crashed.
  const std::string& fault() const { return fault_; }

 private:
  bool receive(void* to, std::size_t bytes);

  pid_t process_ = -1;
  int pipe_ = -1;
  std::string fault_;
};

}  // namespace adasplats
