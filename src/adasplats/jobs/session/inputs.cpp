// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/session/inputs.h"

#include "adasplats/city/city_manifest.h"
#include "adasplats/cloud/load/cloud_inputs.h"
#include "adasplats/cloud/load/data_tree.h"
#include "adasplats/cloud/load/file_kind.h"
#include "adasplats/cloud/load/recording_poses.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/error.h"
#include "adasplats/io/bags/recording.h"

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
  if (!labels.empty()) {
    const LabelScheme stated = load_label_scheme(labels);
    for (const fs::path& input : inputs) require_labels_of_tree(input, stated);
    return stated;
  }
  for (const fs::path& input : inputs) {
    if (auto own = labels_of_tree(input)) return own;
    for (const CloudInput& one : cloud_inputs(input, SensorScans::taken)) {
      if (one.is_sequence && fs::is_directory(one.path / "labels")) return semantickitti_labels();
    }
  }
  return std::nullopt;
}

std::optional<LabelScheme> load_labels_of_model(const std::string& scheme, ProgressSink& progress) {
  if (scheme.empty()) return std::nullopt;
  try {
    return load_label_scheme(scheme);
  } catch (const Error& error) {
    progress.warn(std::string("labels of the model: ") + error.what());
    return std::nullopt;
  }
}

std::string scheme_reference(const std::string& labels, const LabelScheme& scheme) {
  std::error_code failure;
  return fs::is_regular_file(labels, failure) ? fs::absolute(labels).string() : scheme.name();
}

std::vector<fs::path> resolve_cloud_inputs(const fs::path& input) {
  require_input(input);
  const std::vector<CloudInput> inputs = cloud_inputs(input, SensorScans::taken);
  // A folder of scans with poses stays one: its files alone are in the sensor frame.
  std::error_code ignored;
  if (!inputs.front().is_sequence &&
      (inputs.size() > 1 || fs::exists(input / "poses.csv", ignored)))
    return {input};
  std::vector<fs::path> paths;
  paths.reserve(inputs.size());
  for (const CloudInput& one : inputs) paths.push_back(one.path);
  return paths;
}

fs::path resolve_cloud_input(const fs::path& input) {
  const std::vector<fs::path> inputs = resolve_cloud_inputs(input);
  if (inputs.size() == 1) return inputs.front();
  throw Error(ErrorKind::usage, input.string() + ": contains " + std::to_string(inputs.size()) +
                                    " sequences; name one of them, for example " +
                                    inputs.front().string());
}

bool is_splat_model(const fs::path& file) {
  std::error_code failure;
  if (is_city(file)) return true;
  return fs::is_regular_file(file, failure) && kind_of_file(file) == FileKind::splat_model;
}

Trajectory load_trajectory(const fs::path& path) {
  require_input(path);
  if (is_recording(path)) {
    ProgressSink silent;
    return trajectory_of_recording(path, "", "", silent).motion;
  }
  if (!fs::is_directory(path)) return read_trajectory(path);
  return open_kitti_sequence(resolve_cloud_input(path)).trajectory;
}

Trajectory poses_along(const fs::path& path, Vec3d offset_m, std::size_t every) {
  if (every == 0) throw Error(ErrorKind::usage, "`every` must be at least 1");
  const Trajectory all = shifted(load_trajectory(path), offset_m);
  Trajectory taken;
  for (std::size_t i = 0; i < all.size(); i += every) taken.push_back(all[i]);
  if (taken.empty()) throw Error(ErrorKind::data, path.string() + ": no poses");
  return taken;
}

}  // namespace adasplats
