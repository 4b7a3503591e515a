// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/lidar_library.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "adasplats/sensors/lidar_files.h"

namespace adasplats {

namespace {

LidarModel library_model(std::string_view name) {
  auto file = read_library_lidar(name);
  if (!file) throw std::logic_error("the library has no sensor " + std::string(name));
  return finished_model(std::move(*file));
}

}  // namespace

std::optional<LidarFile> read_library_lidar(std::string_view name) {
  const auto library = lidar_library();
  const auto known = std::ranges::find(library, name, &LibraryLidar::name);
  if (known == library.end()) return std::nullopt;
  return read_lidar_toml(known->toml, std::string(name) + ".toml", 0);
}

std::vector<std::string> lidar_model_names() {
  std::vector<std::string> names;
  for (const LibraryLidar& lidar : lidar_library()) names.emplace_back(lidar.name);
  return names;
}

LidarModel hdl_64_paper() { return library_model("hdl-64-paper"); }

LidarModel hdl_32_paper() { return library_model("hdl-32-paper"); }

LidarModel load_lidar_model(const std::string& name_or_path) {
  return finished_model(read_lidar(name_or_path, 0));
}

}  // namespace adasplats
