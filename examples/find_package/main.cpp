// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Models a piece of road from points in memory and casts one ray at it.

#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <utility>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/error.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/maths/ray.h"
#include "adasplats/core/progress.h"
#include "adasplats/splats/build_model.h"
#include "adasplats/trace/tracer.h"

namespace {

using adasplats::Vec3f;

constexpr Vec3f kSensor = {0.0F, 0.0F, 2.0F};

/// A flat road of 8 m x 8 m with a point every 5 cm, measured from 2 m above its center.
adasplats::PointCloud road_points(const adasplats::SemanticClass& road) {
  adasplats::PointCloud cloud;
  for (int row = -80; row <= 80; ++row) {
    for (int column = -80; column <= 80; ++column) {
      cloud.positions.push_back(
          {static_cast<float>(row) * 0.05F, static_cast<float>(column) * 0.05F, 0.0F});
      cloud.sensor_positions.push_back(kSensor);
      cloud.classes.push_back(road.id);
    }
  }
  return cloud;
}

int run() {
  const adasplats::LabelScheme labels = adasplats::load_label_scheme("semantickitti");
  const adasplats::SemanticClass* road = labels.find("road");
  if (road == nullptr) return EXIT_FAILURE;

  const adasplats::Executor executor;
  adasplats::ProgressSink silent;
  adasplats::BuildOptions options;
  options.recipe = adasplats::PaperOptions{.variant = adasplats::PaperVariant::semantic};
  const auto [model, report] =
      adasplats::build_model(road_points(*road), &labels, options, executor, silent);
  std::cout << report.points_in << " points became " << model.size() << " splats\n";

  // 30 degrees below the horizon from 2 m above the road: the range is 4 m.
  const adasplats::Vec3d sensor_local = adasplats::vec_cast<double>(kSensor) - model.origin;
  adasplats::Ray ray;
  ray.origin = adasplats::vec_cast<float>(sensor_local);
  ray.direction = {std::sqrt(3.0F) / 2.0F, 0.0F, -0.5F};
  adasplats::Hit hit;
  const std::unique_ptr<adasplats::Tracer> tracer =
      adasplats::make_cpu_tracer(model.view(), executor);
  tracer->nearest({&ray, 1}, {&hit, 1}, executor);
  if (!hit.valid()) {
    std::cerr << "the ray hit nothing\n";
    return EXIT_FAILURE;
  }
  std::cout << "the ray hit '" << labels.find(model.classes[hit.primitive])->name << "' at "
            << hit.t << " m\n";
  return std::fabs(hit.t - 4.0F) < 0.01F ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace

int main() {
  try {
    return run();
  } catch (const adasplats::Error& error) {
    std::cerr << "find_package_example: " << error.what() << '\n';
    return adasplats::exit_code(error.kind());
  }
}
