// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

#include "adasplats/city/city_manifest.h"
#include "adasplats/city/tile_stream.h"
#include "adasplats/jobs/scene/scan_scene.h"
#include "adasplats/jobs/session/session.h"

namespace adasplats {

/// Whether tiles can be loaded on demand: the folder of a city, or a world file
/// (simulate/world/world_file.h) with a city as its model.
bool is_streamable(const std::filesystem::path& model);

/// A city with only the tiles near the sensor in memory. The scans are those of the complete city
/// in memory (ModelScene), byte for byte.
class CityScene final : public ScanScene {
 public:
  /// `model`: is_streamable(). `labels`: scheme of the classes, as for load_label_scheme; empty:
  /// the city's. `memory_bytes`: maximum memory for tiles. Errors: those of load_city_manifest,
  /// load_model, load_label_scheme and read_world_file; data (no splats); unavailable (a requested
  /// GPU fails).
  CityScene(const std::filesystem::path& model, const std::string& labels, Session& session,
            std::size_t memory_bytes);
  ~CityScene() override;

  Vec3d origin() const override;
  const SceneCaster& scan_caster() const override;
  const World* world() const override;
  const LabelScheme* labels() const override;
  std::shared_ptr<const PrimitiveTable> primitive_table() const override;
  /// Reads all tiles.
  float highest_intensity() const override;
  /// Of all splats.
  std::pair<Vec3d, Vec3d> middle_box() const override;
  std::size_t prefetch(std::span<const ScanMotion> scans, double reach_m) const override;
  const CityManifest& manifest() const;
  /// Tiles loaded so far.
  TileStreamCounts counts() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace adasplats
