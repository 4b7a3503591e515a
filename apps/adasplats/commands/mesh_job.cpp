// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "commands/mesh_job.h"

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "adasplats/baselines/imls.h"
#include "adasplats/baselines/nearest_classes.h"
#include "adasplats/core/error.h"
#include "adasplats/core/progress_meter.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/pipeline/model/label_use.h"
#include "adasplats/pipeline/session/inputs.h"
#include "adasplats/scene/mesh_model.h"
#include "adasplats/splats/model/canonical_order.h"
#include "cli/output_path.h"

namespace adasplats::app {
namespace {

/// The points that stay, in canonical order, with what a mesh needs of them.
PointCloud static_points(PointCloud cloud, const RemovedPoints& removed, const Executor& executor) {
  cloud.intensities = {};
  cloud.instances = {};
  cloud.scan_indices = {};
  std::vector<std::uint32_t> order = canonical_order(cloud, executor);
  if (removed.points > 0) {
    std::erase_if(order, [&](std::uint32_t i) { return removed.ids[cloud.classes[i]] != 0; });
  }
  return gather(cloud, order);
}

/// Steps of the work one after the other, with their times.
class Steps {
 public:
  Steps(std::vector<StepTime>& times, ProgressSink& progress)
      : times_(times), progress_(progress) {}

  /// `passes`: how many ProgressPasses the work consists of; 0: that cannot be said.
  template <class Work>
  auto run(const std::string& name, int passes, Work&& work) {
    progress_.begin_step(name, static_cast<std::uint64_t>(passes) * kPassUnits);
    const Stopwatch watch;
    auto result = work();
    times_.push_back({name, watch.seconds()});
    progress_.end_step();
    return result;
  }

 private:
  std::vector<StepTime>& times_;
  ProgressSink& progress_;
};

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
}

std::vector<Vec3f> normals_of(PointCloud& cloud, const MeshJob& job, Session& session,
                              MeshResult& result) {
  // Some origins alone would turn neighbours against each other.
  const std::span<const Vec3f> sensors = cloud.has_all_origins()
                                             ? std::span<const Vec3f>(cloud.sensor_positions)
                                             : std::span<const Vec3f>();
  OrientedNormals oriented =
      oriented_normals(cloud.positions, sensors, job.normals, session.executor);
  cloud.sensor_positions = {};
  cloud.origin_kinds = {};
  result.from_sensors = oriented.from_sensors;
  result.normal_components = oriented.components;
  if (!oriented.from_sensors) {
    session.progress.warn(
        "no sensor positions: the orientation of normals is guessed from neighbour to neighbour "
        "(give a viewpoint or a trajectory to know it)");
  }
  return std::move(oriented.normals);
}

TriangleMesh poisson_mesh(const PointCloud& cloud, std::span<const Vec3f> normals,
                          const MeshJob& job, const PoissonPrograms& programs, Session& session,
                          MeshResult& result) {
  if (programs.provider == PoissonProvider::open3d &&
      job.poisson.samples_per_node != kOpen3dSamplesPerNode) {
    session.progress.warn(
        "Open3D reconstructs with 1.5 samples per node; PoissonRecon on PATH "
        "takes --samples-per-node");
  }
  PoissonSurface surface =
      poisson_surface(cloud.positions, normals, job.poisson, programs, folder_of(job.output),
                      session.executor.threads(), session.progress);
  result.program = programs.reconstruct.filename().string();
  result.program_peak_memory_bytes = surface.peak_memory_bytes;
  return std::move(surface.mesh);
}

}  // namespace

MeshResult run_mesh(const MeshJob& job, Session& session) {
  check_output_file(job.output);
  for (const auto& input : job.inputs) require_input(input);
  std::optional<PoissonPrograms> programs;  // said before long work where there are none
  if (job.method == MeshMethod::poisson) programs = find_poisson_programs(job.poisson.provider);
  if (programs && programs->provider == PoissonProvider::open3d && job.samples_per_node_is_asked &&
      job.poisson.samples_per_node != kOpen3dSamplesPerNode) {
    throw Error(ErrorKind::usage,
                "--samples-per-node: Open3D has 1.5; PoissonRecon on PATH takes other numbers");
  }
  const Stopwatch total;
  const std::optional<LabelScheme> scheme = label_scheme_for(job.labels, job.inputs);

  MeshResult result;
  Steps steps(result.steps, session.progress);
  PointCloud cloud = steps.run("load", 0, [&] {
    auto [loaded, report] = load_cloud(job.inputs, job.load, session.executor, session.progress);
    result.loaded = report;
    return std::move(loaded);
  });
  result.points_in = cloud.size();
  const LabelScheme* const labels = scheme ? &*scheme : nullptr;
  check_label_use({job.labels, job.remove, job.removal_is_asked}, cloud, labels, session.progress);
  cloud = steps.run("order", 0, [&] {
    const RemovedPoints removed = points_to_remove(cloud, labels, job.remove);
    result.removed_classes = removed.classes;
    return static_points(std::move(cloud), removed, session.executor);
  });
  result.points_used = cloud.size();
  result.points_dynamic = result.points_in - result.points_used;
  if (cloud.empty()) throw Error(ErrorKind::data, "no points: there is nothing to mesh");
  std::vector<Vec3f> normals =
      steps.run("normals", 1, [&] { return normals_of(cloud, job, session, result); });

  MeshModel model;
  model.origin = cloud.origin;
  model.method = programs ? "poisson" : "imls";
  if (scheme) model.label_scheme = scheme_reference(job.labels, *scheme);
  model.mesh = steps.run(model.method, programs ? 0 : 1, [&] {
    return programs ? poisson_mesh(cloud, normals, job, *programs, session, result)
                    : imls_surface(cloud.positions, normals, job.imls, session.executor);
  });
  normals = {};
  if (model.mesh.triangles.empty()) throw Error(ErrorKind::data, "the points give no surface");
  if (!cloud.classes.empty()) {
    model.mesh.classes = steps.run("classes", 1, [&] {
      return nearest_classes(model.mesh, cloud.positions, cloud.classes, session.executor);
    });
  }
  result.vertices = model.mesh.vertices.size();
  result.primitives = steps.run("save", 0, [&] {
    save_mesh(job.output, model);
    return model.size();
  });
  result.seconds = total.seconds();
  return result;
}

nlohmann::ordered_json to_json(const MeshResult& result) {
  nlohmann::ordered_json json;
  json["points_read"] = result.loaded.points_read;
  json["points_not_finite"] = result.loaded.dropped_not_finite;
  json["points_far"] = result.loaded.dropped_far;
  json["points_in"] = result.points_in;
  json["points_dynamic"] = result.points_dynamic;
  json["points_removed"] = nlohmann::ordered_json::object();
  for (const auto& part : result.removed_classes) json["points_removed"][part.name] = part.points;
  json["points_used"] = result.points_used;
  json["primitives"] = result.primitives;
  json["vertices"] = result.vertices;
  json["normals_oriented_by"] = result.from_sensors ? "sensor positions" : "propagation";
  if (!result.from_sensors) json["normal_components"] = result.normal_components;
  if (!result.program.empty()) {
    json["program"] = result.program;
    json["program_peak_memory_bytes"] = result.program_peak_memory_bytes;
  }
  json["seconds"]["total"] = result.seconds;
  for (const StepTime& step : result.steps) json["seconds"][step.name] = step.seconds;
  return json;
}

}  // namespace adasplats::app
