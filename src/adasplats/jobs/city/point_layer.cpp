// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/city/point_layer.h"

#include <cstdint>
#include <utility>
#include <vector>

#include "adasplats/cloud/labels/dynamic_removal.h"
#include "adasplats/core/error.h"
#include "adasplats/jobs/session/inputs.h"

namespace adasplats {
namespace fs = std::filesystem;

std::string layer_folder(std::size_t number) { return "layers/" + std::to_string(number); }

LayerWork::LayerWork(const CityJob& its_job, Session& its_session, fs::path its_city,
                     std::size_t number)
    : job(its_job),
      options(consistent_options_of(its_job)),
      session(its_session),
      city(std::move(its_city)) {
  layer.folder = layer_folder(number);
  tiles.grid = {job.tiles.tile_m};
  tiles.halo_m = job.tiles.halo_m;
}

std::optional<LabelScheme> scheme_of(const CityJob& job) {
  if (job.segment.on) return semantickitti_labels();
  return label_scheme_for(job.labels, job.inputs, job.load.label_field);
}

void read_points_of(TileKey tile, const fs::path& folder, const CityJob& job, PointCloud& cloud,
                    const std::function<bool(Vec3f)>& wanted) {
  std::vector<std::uint16_t> classes;
  if (job.segment.on) classes = read_tile_classes(folder, tile);
  if (job.segment.on && classes.empty())
    throw Error(ErrorKind::data,
                (folder / classes_file_of(tile)).string() + ": damaged: it has no classes");
  read_tile_points(folder, tile, cloud, wanted, classes);
}

std::size_t count_rays(const PointCloud& cloud, const LabelScheme* scheme, const CityJob& job) {
  const double min_range_m = consistent_options_of(job).min_range_m;
  const RemovedPoints removed = points_to_remove(cloud, scheme, job.build.remove);
  std::size_t rays = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!is_beam(cloud.origin_kind(i))) continue;
    const float range_m = length(cloud.positions[i] - cloud.sensor_positions[i]);
    const bool stays =
        removed.ids.empty() || cloud.classes.empty() || removed.ids[cloud.classes[i]] == 0;
    if (stays && static_cast<double>(range_m) >= min_range_m) ++rays;
  }
  return rays;
}

}  // namespace adasplats
