// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "inputs.h"

#include "adasplats/cloud/kitti_sequence.h"
#include "adasplats/core/error.h"

namespace adasplats::app {

namespace fs = std::filesystem;

void require_input(const fs::path& path) {
  std::error_code failure;
  if (!fs::exists(path, failure)) {
    throw Error(ErrorKind::no_input, path.string() + ": no such file or folder");
  }
}

std::optional<LabelScheme> label_scheme_for(const std::string& labels,
                                            std::span<const fs::path> inputs) {
  if (!labels.empty()) return load_label_scheme(labels);
  for (const fs::path& input : inputs) {
    if (is_kitti_sequence(input) && fs::is_directory(input / "labels")) {
      return semantickitti_labels();
    }
  }
  return std::nullopt;
}

fs::path resolve_cloud_input(const fs::path& input) {
  require_input(input);
  fs::path sequence = input / "sequences" / "00";
  if (is_kitti_sequence(sequence)) return sequence;
  if (fs::exists(input / "poses.csv") && !is_kitti_sequence(input)) {
    throw Error(ErrorKind::data,
                input.string() +
                    ": holds scans in the sensor frame; simulate with --format semantickitti to "
                    "compare them");
  }
  return input;
}

Trajectory load_trajectory(const fs::path& path) {
  require_input(path);
  if (!fs::is_directory(path)) return read_trajectory(path);
  return open_kitti_sequence(resolve_cloud_input(path)).trajectory;
}

}  // namespace adasplats::app
