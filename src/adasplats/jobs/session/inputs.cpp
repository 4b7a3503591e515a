// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/session/inputs.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "adasplats/city/city_manifest.h"
#include "adasplats/cloud/load/cloud_inputs.h"
#include "adasplats/cloud/load/data_tree.h"
#include "adasplats/cloud/load/file_kind.h"
#include "adasplats/cloud/load/recording_poses.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/error.h"
#include "adasplats/io/bags/recording.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/base/point_files.h"
#include "adasplats/io/mcap/mcap_file.h"
#include "adasplats/io/ply/ply.h"
#include "adasplats/io/point_format.h"
#include "adasplats/io/text/gltf.h"

namespace adasplats {

namespace fs = std::filesystem;

void require_input(const fs::path& path) {
  std::error_code failure;
  if (!fs::exists(path, failure)) {
    throw Error(ErrorKind::no_input, path.string() + ": no such file or folder");
  }
}

namespace {

/// A scheme as our files state it; nothing if it cannot be loaded here.
std::optional<LabelScheme> stated_scheme(const std::string& scheme) {
  if (scheme.empty()) return std::nullopt;
  ProgressSink silent;
  return load_labels_of_model(scheme, silent);
}

/// The name of the scheme in the adasplats.json of a folder with output of this program, or of the
/// folders above, as far as the tree of a simulation goes; empty if the numbers are of no scheme.
std::optional<std::string> scheme_name_of_folder(fs::path folder) {
  constexpr int kLevels = 3;                                // OUTPUT/sequences/00
  constexpr const char* kFolderContent = "adasplats.json";  // as jobs/output has it
  folder = fs::absolute(folder / ".").lexically_normal();   // an empty path: the current folder
  if (!folder.has_filename()) folder = folder.parent_path();
  for (int level = 0; level < kLevels; ++level, folder = folder.parent_path()) {
    std::error_code ignored;
    if (!fs::is_regular_file(folder / kFolderContent, ignored)) continue;
    const auto content = nlohmann::json::parse(read_file(folder / kFolderContent), nullptr, false);
    const auto labels = content.is_object() ? content.find("labels") : content.end();
    if (!content.is_object() || labels == content.end() || !labels->is_object()) continue;
    const auto name = labels->find("name");
    if (name != labels->end() && name->is_string()) return name->get<std::string>();
  }
  return std::nullopt;
}

/// Whether the classes of a file are those of the specification of LAS, as far as that can be
/// determined: in files of this program they are of any scheme.
bool has_las_classes(const LasFacts& las, const std::string& label_field) {
  if (!label_field.empty()) return label_field == "classification";
  return las.software != "adasplats" && std::ranges::none_of(las.extra_fields, [](auto name) {
           return lower_case(name) == "label" || lower_case(name) == "class";
         });
}

std::optional<LabelScheme> scheme_of_file(const fs::path& file, const std::string& label_field) {
  const std::string extension = lower_case(file.extension().string());
  if (!fs::is_regular_file(file)) return std::nullopt;
  if (extension == ".mcap")
    return stated_scheme(read_mcap_metadata(file, kMcapMetadataName, kMcapLabelsKey));
  if (extension == ".las" || extension == ".laz") {
    const LasFacts las = read_las_facts(file);
    if (!las.labels.empty()) return stated_scheme(las.labels);
    if (has_las_classes(las, label_field)) return asprs_labels();
  } else if (is_octree_part(file)) {
    if (label_field.empty()) return asprs_labels();  // made from LAS
  } else if (extension == ".ply" || extension == ".pcd" || extension == ".csv") {
    for (const std::string& comment :
         extension == ".ply" ? read_ply_comments(file) : leading_comments(file))
      if (comment.starts_with(kLabelsComment))
        return stated_scheme(comment.substr(kLabelsComment.size()));
  }
  const auto name = scheme_name_of_folder(file.parent_path());
  return name ? stated_scheme(*name) : std::nullopt;
}

}  // namespace

std::optional<LabelScheme> label_scheme_for(const std::string& labels,
                                            std::span<const fs::path> inputs,
                                            const std::string& label_field) {
  if (!labels.empty()) {
    const LabelScheme stated = load_label_scheme(labels);
    for (const fs::path& input : inputs) require_labels_of_tree(input, stated);
    return stated;
  }
  for (const fs::path& input : inputs) {
    if (auto own = labels_of_tree(input)) return own;
    const std::vector<CloudInput> parts = cloud_inputs(input, SensorScans::taken);
    for (const CloudInput& one : parts) {
      if (!one.is_sequence || !fs::is_directory(one.path / "labels")) continue;
      const auto name = scheme_name_of_folder(one.path);
      if (name && name->empty()) return std::nullopt;
      const auto own = name ? stated_scheme(*name) : std::nullopt;
      return own ? own : semantickitti_labels();
    }
    // The files of a folder are of one kind: the first stands for all.
    if (!parts.empty() && !parts.front().is_sequence)
      if (auto own = scheme_of_file(parts.front().path, label_field)) return own;
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
  if (!fs::is_regular_file(file, failure)) return false;
  const FileKind kind = kind_of_file(file);
  return kind == FileKind::splat_model ||
         (kind == FileKind::mesh && is_gltf(file) && has_gltf_splats(file));
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
