// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/scene/scene_files.h"

#include <algorithm>

#include "adasplats/city/city_manifest.h"
#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/io/text/gltf.h"
#include "adasplats/jobs/session/inputs.h"
#include "adasplats/simulate/world/world_file.h"

namespace adasplats {

std::vector<std::filesystem::path> files_of_scene(const std::filesystem::path& model) {
  std::vector<std::filesystem::path> files;
  const auto add = [&files](const std::filesystem::path& file) {
    if (!file.empty() && std::ranges::find(files, file) == files.end()) files.push_back(file);
  };
  const auto add_geometry = [&](const std::filesystem::path& file) {
    if (is_city(file)) {  // its manifest has the SHA-256 of every tile
      add(file / kCityFile);
      add(file / kCityCommonFile);
      return;
    }
    add(file);
    if (!file.empty() && is_gltf(file))
      for (const std::filesystem::path& buffer : gltf_buffer_files(file)) add(buffer);
  };
  require_input(model);
  if (model.extension() != ".toml") {
    add_geometry(model);
    return files;
  }
  const WorldFile world = read_world_file(model);
  add(model);
  add_geometry(world.model);
  for (const WorldFileObject& object : world.objects) {
    add_geometry(object.geometry);
    if (object.trajectory.empty()) continue;
    for (const std::filesystem::path& file : trajectory_files(object.trajectory)) add(file);
  }
  return files;
}

}  // namespace adasplats
