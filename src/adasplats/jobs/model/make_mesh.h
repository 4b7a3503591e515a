// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/baselines/imls.h"
#include "adasplats/baselines/oriented_normals.h"
#include "adasplats/baselines/poisson.h"
#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/core/setting.h"
#include "adasplats/jobs/model/unused_settings.h"
#include "adasplats/jobs/session/session.h"
#include "adasplats/splats/build_model.h"
#include "adasplats/splats/model/mesh_model.h"

namespace adasplats {

/// The meshes that the paper compares splats with.
enum class MeshMethod : std::uint8_t { imls, poisson };
inline constexpr std::pair<std::string_view, MeshMethod> kMeshMethods[] = {
    {"imls", MeshMethod::imls}, {"poisson", MeshMethod::poisson}};
inline Words<MeshMethod> words_of(MeshMethod) { return kMeshMethods; }

/// How a mesh is made of points.
struct MeshOptions {
  std::string labels;  ///< as label_scheme_for takes it
  MeshMethod method = MeshMethod::imls;
  DynamicRemoval remove = DynamicRemoval::movable;
  bool removal_is_asked = false;  ///< as of ModelOptions
  NormalOptions normals;
  ImlsOptions imls;
  PoissonOptions poisson;
  std::filesystem::path work_folder;  ///< for files of Poisson programs; empty: the system's
};

template <class Visit>
void visit_settings(MeshOptions& mesh, Visit&& visit) {
  visit(
      Setting{
          .name = "method",
          .help =
              "Implicit moving least squares (imls) or screened Poisson reconstruction (poisson)",
          .basic = true},
      mesh.method);
  visit_settings(mesh.normals, visit);
  visit_settings(mesh.imls, visit);
  visit_settings(mesh.poisson, visit);
}

/// The settings of the other method.
std::vector<UnusedSetting> unused_settings(const MeshOptions& options);

/// Of point files.
struct MeshJob : MeshOptions {
  std::vector<std::filesystem::path> inputs;
  LoadOptions load;
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

/// Loads, orients, reconstructs and gives the faces the classes of their nearest points. Errors:
/// usage (a setting out of range, a sampling that Open3D does not have), unavailable (no program
/// for Poisson, with what to install), data (no points, no surface), those of load_cloud().
std::pair<MeshModel, MeshResult> make_mesh(const MeshJob& job, Session& session);

/// Of points in memory. Errors: likewise.
std::pair<MeshModel, MeshResult> make_mesh(const PointCloud& cloud, const MeshOptions& options,
                                           Session& session);

/// Makes a mesh of point files and saves it. Errors: also those of writing.
MeshResult run_mesh(const MeshJob& job, const std::filesystem::path& output, Session& session);

/// The keys of a mesh's --report.
nlohmann::ordered_json to_json(const MeshResult& result);

}  // namespace adasplats
