// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/pipeline/inputs.h"

#include <fstream>

#include "adasplats/cloud/kitti_sequence.h"
#include "adasplats/core/error.h"

namespace adasplats {

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

std::string scheme_reference(const std::string& labels, const LabelScheme& scheme) {
  std::error_code failure;
  return fs::is_regular_file(labels, failure) ? fs::absolute(labels).string() : scheme.name();
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

bool is_splat_model(const fs::path& file) {
  std::error_code failure;
  if (!fs::is_regular_file(file, failure)) return false;
  std::ifstream stream(file, std::ios::binary);
  bool has_radius = false;
  bool has_normal = false;
  std::string line;
  // The header alone: what follows may be large. A header of more lines is not one of ours.
  for (int i = 0; i < 1000 && std::getline(stream, line); ++i) {
    while (!line.empty() && line.back() == '\r') line.pop_back();
    if (i == 0 && line != "ply") return false;
    if (line == "end_header") break;
    const bool is_property = line.starts_with("property ");
    has_radius = has_radius || (is_property && line.ends_with(" radius"));
    has_normal = has_normal || (is_property && line.ends_with(" nx"));
  }
  return has_radius && has_normal;
}

Trajectory load_trajectory(const fs::path& path) {
  require_input(path);
  if (!fs::is_directory(path)) return read_trajectory(path);
  return open_kitti_sequence(resolve_cloud_input(path)).trajectory;
}

Trajectory poses_along(const fs::path& path, Vec3d offset_m, std::size_t every) {
  if (every == 0) throw Error(ErrorKind::usage, "--every must be at least 1");
  const Trajectory all = shifted(load_trajectory(path), offset_m);
  Trajectory taken;
  for (std::size_t i = 0; i < all.size(); i += every) taken.push_back(all[i]);
  if (taken.empty()) throw Error(ErrorKind::data, path.string() + ": no poses");
  return taken;
}

}  // namespace adasplats
