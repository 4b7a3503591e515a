// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "commands/evaluate/evaluate_pictures.h"

#include <cmath>
#include <vector>

#include "adasplats/evaluate/cloud_metrics.h"
#include "adasplats/io/arrays/png.h"
#include "adasplats/simulate/captions/color_bar.h"
#include "adasplats/simulate/image/point_image.h"

namespace adasplats::app {
namespace {

constexpr double kFar_m = 0.20;
constexpr double kWrong_m = 0.50;
constexpr Rgb kNoHit = {120, 120, 120};

void write(const std::filesystem::path& file, const Image& image) {
  write_png(file, image.width, image.height, image.pixels);
}

}  // namespace

void write_distance_picture(const std::filesystem::path& file, const PointCloud& simulated,
                            const PointCloud& original, const ViewChoice& view, Session& session) {
  session.progress.begin_step("draw the distances", 0);
  const ColorScale& scale = distance_scale();
  std::vector<Rgb> colors;
  colors.reserve(simulated.size());
  for (const float distance_m : distances_to(simulated, original, session.executor)) {
    colors.push_back(scale.at(static_cast<double>(distance_m) / kFar_m));
  }
  Image image = draw_points(simulated.positions, simulated.origin, colors,
                            camera_of(view, shown_part(original.positions, original.origin)), {},
                            session.executor);
  draw_color_bar(image, scale,
                 {"distance to the points", {{0, "0"}, {0.5, "10"}, {1, ">20 cm"}}, {}});
  write(file, image);
  session.progress.end_step();
}

void write_beam_picture(const std::filesystem::path& file, const ScanErrors& scan, int width,
                        Session& session) {
  session.progress.begin_step("draw a scan", 0);
  const ColorScale& scale = signed_scale();
  std::vector<Rgb> colors;
  colors.reserve(scan.errors_m.size());
  for (const float error_m : scan.errors_m) {
    const double share = 0.5 + 0.5 * static_cast<double>(error_m) / kWrong_m;
    colors.push_back(std::isnan(error_m) ? kNoHit : scale.at(share));
  }
  // The sensor's own frame: x ahead.
  Camera camera = look_at({-16, 0, 11}, {9, 0, -1});
  camera.width = width;
  camera.height = width * 9 / 16;
  PointImageOptions options;
  options.background = {22, 22, 26};  // what is right is white
  options.point_size_m = 0.08;
  options.relief = false;  // rings of a scan hang in the air: every one would be a step
  Image image = draw_points(scan.measured, {}, colors, camera, options, session.executor);
  draw_color_bar(image, scale,
                 {"predicted less measured range, cm",
                  {{0, "-50 early"}, {0.5, "0"}, {1, "late +50"}},
                  {{kNoHit, "no hit"}}});
  write(file, image);
  session.progress.end_step();
}

}  // namespace adasplats::app
