// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "adasplats/city/city_manifest.h"
#include "adasplats/city/layer_facts.h"
#include "adasplats/io/text/gltf.h"
#include "adasplats/levels/level_file.h"
#include "adasplats/segment/network/network.h"
#include "adasplats/simulate/world/world_file.h"
#include "adasplats/splats/model/mesh_model.h"
#include "adasplats/splats/model/splat_model.h"
#include "fuzz_readers.h"

namespace adasplats::fuzz {

void read_mesh(const Input& input) {
  if (!is_mesh_file(input.file)) return;
  const MeshModel model = load_mesh(input.file);
  for (const auto& triangle : model.mesh.triangles)
    for (const std::uint32_t index : triangle)
      require(index < model.mesh.vertices.size(), "vertices that are there");
  for (const Vec3f& vertex : model.mesh.vertices)
    require(is_finite(vertex), "vertices that are finite");
}

void read_splat_model(const Input& input) {
  const SplatModel model = load_model(input.file);
  require(model.classes.empty() || model.classes.size() == model.size(), "a class a splat");
  require(model.groups.empty() || model.groups.size() == model.size(), "a group a splat");
  require(model.intensities.empty() || model.intensities.size() == model.size(),
          "an intensity a splat");
  for (const Disk& disk : model.disks)
    require(is_finite(disk.center) && disk.radius > 0 && std::isfinite(disk.radius),
            "disks that can be");
}

void read_gltf(const Input& input) {
  if (has_gltf_splats(input.file)) {
    read_splat_model(input);
    return;
  }
  gltf_buffer_files(input.file);
  require_sound(read_gltf_mesh(input.file));
}

void read_world(const Input& input) {
  for (const WorldFileObject& object : read_world_file(input.file).objects)
    require(object.scale > 0 && is_finite(object.placement.translation), "objects that can be");
}

void read_city(const Input& input) {
  const CityManifest city = load_city_manifest(input.file.parent_path());
  require(city.grid.side_m > 0, "tiles that have a size");
  require(std::ranges::is_sorted(city.tiles, {}, &CityTile::key), "tiles in their order");
}

void read_layer_facts(const Input& input) {
  const LayerFacts facts = load_facts(input.file);
  require(is_finite(facts.origin), "an origin");
  for (const auto& [tile, count] : facts.tiles)
    require(count.points == 0 || count.rays.low_x <= count.rays.high_x, "rays that are somewhere");
}

void read_level_file(const Input& input) {
  const LevelTable table = read_levels(input.file);
  require(!table.nodes.empty(), "a root");
  const std::vector<bool> own = table.own_nodes();
  const std::uint64_t bytes = std::filesystem::file_size(input.file);
  std::uint64_t offset = table.elements_at;
  for (std::size_t n = 0; n < own.size(); ++n) {
    if (!own[n]) continue;
    const std::size_t count = table.nodes[n].count;
    offset += read_level_elements(input.file, bytes, offset, count).size();
  }
  require(offset == bytes, "elements to the end of the file");
}

void read_network_bytes(const Input& input) {
  const Network network = parse_network(input.bytes, "a.network");
  for (const Weights& weights : network.weights)
    require(weights.values.size() == weights.rows * weights.columns, "a value an element");
  for (const Layer& layer : network.layers)
    require(layer.input < network.values && layer.output < network.values, "values that are there");
}

}  // namespace adasplats::fuzz
