// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/evaluate/evaluate_clouds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>

#include "adasplats/cloud/load/cloud_inputs.h"
#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/cloud/load/sensor_frame.h"
#include "adasplats/core/error.h"
#include "adasplats/core/progress_meter.h"
#include "adasplats/evaluate/error_points.h"
#include "adasplats/io/arrays/png.h"
#include "adasplats/jobs/evaluate/json_values.h"
#include "adasplats/jobs/output/output_folder.h"
#include "adasplats/jobs/session/inputs.h"
#include "adasplats/simulate/captions/color_bar.h"
#include "adasplats/simulate/image/point_image.h"

namespace adasplats {
namespace {

std::string class_name(const LabelScheme* scheme, std::uint16_t id) {
  const SemanticClass* found = scheme != nullptr ? scheme->find(id) : nullptr;
  return found == nullptr ? "class " + std::to_string(id) : found->name;
}

/// The simulated positions with the classes of the nearest original points.
PointCloud with_nearest_classes(const PointCloud& simulated, const PointCloud& original,
                                const Executor& executor) {
  PointCloud points;
  points.origin = simulated.origin;
  points.positions = simulated.positions;
  points.classes = nearest_classes(simulated, original, executor);
  return points;
}

void write_distance_picture(const CloudPair& clouds, const CloudComparisonJob& job,
                            Session& session) {
  constexpr double kFar_m = 0.20;
  session.progress.begin_step("draw the distances", 0);
  const PointCloud& simulated = clouds.simulated;
  const PointCloud& original = clouds.original;
  const ColorScale& scale = distance_scale();
  std::vector<Rgb> colors;
  colors.reserve(simulated.size());
  for (const float distance_m : distances_to(simulated, original, session.executor))
    colors.push_back(scale.at(static_cast<double>(distance_m) / kFar_m));
  Image image = draw_points(simulated.positions, simulated.origin, colors,
                            camera_of(job.view, shown_part(original.positions, original.origin)),
                            {}, session.executor);
  draw_color_bar(image, scale,
                 {"distance to the points", {{0, "0"}, {0.5, "10"}, {1, ">20 cm"}}, {}});
  write_png(job.picture, image.width, image.height, image.pixels);
  session.progress.end_step();
}

/// Throws data if only one of the clouds is in the frame of a sensor.
void require_same_frame(const std::array<LoadReport, 2>& reports,
                        const std::array<std::filesystem::path, 2>& inputs) {
  if (reports[0].sensor_frames.empty() == reports[1].sensor_frames.empty()) return;
  const std::size_t scan = reports[0].sensor_frames.empty() ? 1 : 0;
  const auto& [file, because] = reports[scan].sensor_frames.front();
  throw Error(ErrorKind::data, file.string() + ": is one scan in the sensor frame (" + because +
                                   "), unlike " + inputs[1 - scan].string() + "; " +
                                   advice_for_scans(file, "POSES.csv") +
                                   ", with its pose in POSES.csv (time,x,y,z,qw,qx,qy,qz)");
}

}  // namespace

CloudPair load_clouds(const CloudFiles& files, Session& session) {
  const std::array<std::filesystem::path, 2> inputs = {resolve_cloud_input(files.simulated),
                                                       resolve_cloud_input(files.original)};
  std::array<LoadReport, 2> reports;
  const auto load = [&](std::size_t k) {
    auto [cloud, report] =
        load_cloud(std::span(inputs).subspan(k, 1), {}, session.executor, session.progress);
    reports[k] = std::move(report);
    return std::move(cloud);
  };
  CloudPair pair;
  pair.labels = label_scheme_for(files.labels, inputs);
  pair.simulated = load(0);
  pair.original = load(1);
  require_same_frame(reports, inputs);
  require_same_crs({{inputs[0], pair.simulated.crs}, {inputs[1], pair.original.crs}},
                   session.progress);
  return pair;
}

CloudComparison evaluate_clouds(const PointCloud& simulated, const PointCloud& original,
                                ByClass by_class, const LabelScheme* labels, Session& session) {
  CloudComparison comparison;
  session.progress.begin_step("compare", kPassUnits);
  comparison.distance = cloud_distance(simulated, original, session.executor);
  if (by_class != ByClass::no) {
    session.progress.begin_step("compare classes", kPassUnits);
    for (const ClassDistance& c :
         by_class == ByClass::own
             ? cloud_distance_by_class(simulated, original, session.executor)
             : cloud_distance_by_class(with_nearest_classes(simulated, original, session.executor),
                                       original, session.executor))
      comparison.by_class.emplace_back(class_name(labels, c.class_id), c);
  }
  session.progress.end_step();
  return comparison;
}

CloudComparison evaluate_clouds(const CloudComparisonJob& job, Session& session) {
  check(job.view);
  if (!job.picture.empty()) check_output_file(job.picture);
  if (!job.errors.empty()) check_output_file(job.errors);
  CloudPair clouds = load_clouds(job, session);
  CloudComparison comparison = evaluate_clouds(clouds.simulated, clouds.original, job.by_class,
                                               clouds.labels ? &*clouds.labels : nullptr, session);
  if (!job.picture.empty()) write_distance_picture(clouds, job, session);
  if (!job.errors.empty())
    write_error_points(job.errors, distance_points(std::move(clouds.simulated), clouds.original,
                                                   session.executor));
  return comparison;
}

double c2c_of_classes(const CloudComparison& comparison, const std::vector<std::string>& names) {
  double sum_m = 0;
  double points = 0;
  for (const auto& [name, distance] : comparison.by_class) {
    const bool wanted = std::find(names.begin(), names.end(), name) != names.end();
    if (!wanted || std::isnan(distance.c2c_m)) continue;
    sum_m += distance.c2c_m * static_cast<double>(distance.simulated_points);
    points += static_cast<double>(distance.simulated_points);
  }
  return points > 0 ? sum_m / points : std::numeric_limits<double>::quiet_NaN();
}

nlohmann::ordered_json to_json(const CloudDistance& distance) {
  nlohmann::ordered_json json;
  json["c2c_m"] = distance.c2c_m;
  json["completeness_m"] = distance.completeness_m;
  json["chamfer_m"] = distance.chamfer_m;
  json["chamfer_m2"] = distance.chamfer_m2;
  json["f_score"] = json_by_bound(distance.f_score);
  return json;
}

nlohmann::ordered_json to_json(const CloudComparison& comparison) {
  nlohmann::ordered_json json = to_json(comparison.distance);
  json["simulated_points"] = comparison.distance.simulated_points;
  json["original_points"] = comparison.distance.original_points;
  json["by_class"] = nlohmann::ordered_json::object();
  for (const auto& [name, distance] : comparison.by_class) {
    json["by_class"][name] = {{"c2c_m", distance.c2c_m},
                              {"c2c_to_all_m", distance.c2c_to_all_m},
                              {"points", distance.simulated_points},
                              {"original_points", distance.original_points}};
  }
  return json;
}

}  // namespace adasplats
