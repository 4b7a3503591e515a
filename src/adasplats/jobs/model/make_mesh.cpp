// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/model/make_mesh.h"

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "adasplats/baselines/imls.h"
#include "adasplats/baselines/nearest_classes.h"
#include "adasplats/core/error.h"
#include "adasplats/core/progress_meter.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/jobs/model/unused_settings.h"
#include "adasplats/jobs/output/output_folder.h"
#include "adasplats/jobs/session/inputs.h"
#include "adasplats/splats/model/canonical_order.h"
#include "adasplats/splats/model/mesh_model.h"

namespace adasplats {
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

  /// `passes`: how many ProgressPasses the work consists of; 0: unknown.
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

std::vector<Vec3f> normals_of(PointCloud& cloud, const NormalOptions& options, Session& session,
                              MeshResult& result) {
  // Some origins alone would turn neighbours against each other.
  const std::span<const Vec3f> sensors = cloud.has_all_origins()
                                             ? std::span<const Vec3f>(cloud.sensor_positions)
                                             : std::span<const Vec3f>();
  OrientedNormals oriented = oriented_normals(cloud.positions, sensors, options, session.executor);
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

/// Throws usage where Open3D would not do what is asked for.
void check_sampling(const PoissonOptions& options, const PoissonPrograms& programs) {
  if (programs.provider != PoissonProvider::open3d) return;
  if (options.samples_per_node.value_or(kOpen3dSamplesPerNode) != kOpen3dSamplesPerNode)
    throw Error(ErrorKind::usage,
                "samples_per_node: Open3D has 1.5; PoissonRecon on PATH takes other numbers");
}

TriangleMesh poisson_mesh(const PointCloud& cloud, std::span<const Vec3f> normals,
                          const MeshOptions& options, const PoissonPrograms& programs,
                          Session& session, MeshResult& result) {
  if (programs.provider == PoissonProvider::open3d && !options.poisson.samples_per_node) {
    session.progress.warn(
        "Open3D reconstructs with 1.5 samples per node; PoissonRecon on PATH takes other numbers "
        "(samples_per_node)");
  }
  const std::filesystem::path folder =
      options.work_folder.empty() ? std::filesystem::temp_directory_path() : options.work_folder;
  PoissonSurface surface = poisson_surface(cloud.positions, normals, options.poisson, programs,
                                           folder, session.executor.threads(), session.progress);
  result.program = programs.reconstruct.filename().string();
  result.program_peak_memory_bytes = surface.peak_memory_bytes;
  return std::move(surface.mesh);
}

/// Makes one mesh of the points that `load_points` gives.
class MeshMaker {
 public:
  MeshMaker(const MeshOptions& options, std::optional<LabelScheme> scheme, Session& session)
      : options_(options), scheme_(std::move(scheme)), session_(session) {
    check_settings(options);
    // Said before long work where there are none.
    if (options.method == MeshMethod::poisson)
      programs_ = find_poisson_programs(options.poisson.provider);
    if (programs_) check_sampling(options.poisson, *programs_);
  }

  template <class Load>
  MeshModel run(const Load& load_points, MeshResult& result) {
    Steps steps(result.steps, session_.progress);
    PointCloud cloud = steps.run("load", 0, load_points);
    result.points_in = cloud.size();
    cloud = steps.run("order", 0, [&] { return without_removed(std::move(cloud), result); });
    if (cloud.empty()) throw Error(ErrorKind::data, "no points: there is nothing to mesh");
    std::vector<Vec3f> normals = steps.run(
        "normals", 1, [&] { return normals_of(cloud, options_.normals, session_, result); });
    MeshModel model;
    model.origin = cloud.origin;
    model.crs = cloud.crs;
    model.method = std::string(word_of(options_.method, kMeshMethods));
    if (scheme_) model.label_scheme = scheme_reference(options_.labels, *scheme_);
    model.mesh = steps.run(model.method, programs_ ? 0 : 1, [&] {
      return programs_ ? poisson_mesh(cloud, normals, options_, *programs_, session_, result)
                       : imls_surface(cloud.positions, normals, options_.imls, session_.executor);
    });
    normals = {};
    if (model.mesh.triangles.empty()) throw Error(ErrorKind::data, "the points give no surface");
    if (!cloud.classes.empty()) {
      model.mesh.classes = steps.run("classes", 1, [&] {
        return nearest_classes(model.mesh, cloud.positions, cloud.classes, session_.executor);
      });
    }
    result.vertices = model.mesh.vertices.size();
    result.primitives = model.size();
    return model;
  }

 private:
  PointCloud without_removed(PointCloud cloud, MeshResult& result) const {
    const LabelScheme* const labels = scheme_ ? &*scheme_ : nullptr;
    check_label_use({options_.labels, options_.remove, options_.removal_is_asked}, cloud, labels,
                    session_.progress);
    const RemovedPoints removed = points_to_remove(cloud, labels, options_.remove);
    result.removed_classes = removed.classes;
    PointCloud kept = static_points(std::move(cloud), removed, session_.executor);
    result.points_used = kept.size();
    result.points_dynamic = result.points_in - result.points_used;
    return kept;
  }

  const MeshOptions& options_;
  std::optional<LabelScheme> scheme_;
  std::optional<PoissonPrograms> programs_;
  Session& session_;
};

}  // namespace

std::vector<UnusedSetting> unused_settings(const MeshOptions& options) {
  return options.method == MeshMethod::imls
             ? all_unused(options.poisson, "with the method imls; it is for the method poisson")
             : all_unused(options.imls, "with the method poisson; it is for the method imls");
}

std::pair<MeshModel, MeshResult> make_mesh(const MeshJob& job, Session& session) {
  for (const auto& input : job.inputs) require_input(input);
  const Stopwatch total;
  MeshResult result;
  MeshMaker maker(job, label_scheme_for(job.labels, job.inputs, job.load.label_field), session);
  MeshModel model = maker.run(
      [&] {
        auto [loaded, report] =
            load_cloud(job.inputs, job.load, session.executor, session.progress);
        result.loaded = report;
        return std::move(loaded);
      },
      result);
  result.seconds = total.seconds();
  return {std::move(model), std::move(result)};
}

std::pair<MeshModel, MeshResult> make_mesh(const PointCloud& cloud, const MeshOptions& options,
                                           Session& session) {
  const Stopwatch total;
  MeshResult result;
  result.loaded.points_read = cloud.size();
  MeshMaker maker(options, label_scheme_for(options.labels, {}), session);
  MeshModel model = maker.run([&] { return cloud; }, result);
  result.seconds = total.seconds();
  return {std::move(model), std::move(result)};
}

MeshResult run_mesh(const MeshJob& job, const std::filesystem::path& output, Session& session) {
  check_output_file(output);
  const Stopwatch total;
  MeshJob beside = job;
  if (beside.work_folder.empty())
    beside.work_folder = output.has_parent_path() ? output.parent_path() : ".";
  auto [model, result] = make_mesh(beside, session);
  Steps steps(result.steps, session.progress);
  steps.run("save", 0, [&output, &mesh = model] {
    save_mesh(output, mesh);
    return mesh.size();
  });
  result.seconds = total.seconds();
  return std::move(result);
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

}  // namespace adasplats
