// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "adasplats/baselines/imls_field.h"
#include "adasplats/baselines/oriented_normals.h"
#include "adasplats/baselines/poisson.h"
#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/splats/build_model.h"
#include "cli/session.h"

namespace adasplats::app {

/// The meshes that the paper compares splats with.
enum class MeshMethod : std::uint8_t { imls, poisson };

/// Point files in, mesh file out.
struct MeshJob {
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path output;
  std::string labels;  ///< as label_scheme_for takes it
  LoadOptions load;
  MeshMethod method = MeshMethod::imls;
  DynamicRemoval remove = DynamicRemoval::movable;
  bool removal_is_asked = false;  ///< as of ModelOptions
  NormalOptions normals;
  ImlsOptions imls;
  PoissonOptions poisson;
  bool samples_per_node_is_asked = false;  ///< else Open3D's other number is only said
};

struct MeshResult {
  LoadReport loaded;
  std::size_t points_in = 0;
  std::size_t points_dynamic = 0;  ///< removed by label
  std::vector<RemovedPoints::OfClass> removed_classes;
  std::size_t points_used = 0;
  std::size_t primitives = 0;  ///< triangles
  std::size_t vertices = 0;
  bool from_sensors = true;           ///< normals turned to sensor positions, else spread
  std::size_t normal_components = 0;  ///< parts with a sign of their own, where spread
  std::string program;                ///< that reconstructed; empty where none was needed
  std::uint64_t program_peak_memory_bytes = 0;
  std::vector<StepTime> steps;
  double seconds = 0;
};

/// Loads, orients, reconstructs, gives the faces the classes of their nearest points, and saves.
MeshResult run_mesh(const MeshJob& job, Session& session);

/// The keys of a mesh's --report.
nlohmann::ordered_json to_json(const MeshResult& result);

}  // namespace adasplats::app
