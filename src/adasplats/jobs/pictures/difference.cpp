// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/pictures/difference.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/simulate/captions/color_bar.h"
#include "adasplats/simulate/image/color_map.h"
#include "adasplats/simulate/image/developing.h"
#include "adasplats/simulate/image/frame.h"

namespace adasplats {
namespace {

constexpr float kMost_m = 0.2F;
constexpr Rgb kOnlyFirst = {120, 190, 90}, kOnlySecond = {190, 110, 200};
constexpr std::size_t kRowsPerChunk = 16;

/// To centimetres.
std::string rounded_box(Vec3d low, Vec3d high) {
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = std::round(100 * low[axis]) / 100;
    high[axis] = std::round(100 * high[axis]) / 100;
  }
  return box_text(low, high);
}

/// The colour of a pixel in which at least one of them is hit.
Vec3f pixel_color(const Hit& first, const Hit& second) {
  if (!second.valid()) return color_of(kOnlyFirst);
  if (!first.valid()) return color_of(kOnlySecond);
  return signed_color(0.5F + 0.5F * (second.t - first.t) / kMost_m);
}

}  // namespace

Image draw_difference(const ModelScene& first, const ModelScene& second, const Camera& camera,
                      const Executor& executor) {
  ImageOptions options;
  check_image(camera, options);
  const Developer developer(camera, options);
  Frame frame(camera.width, camera.height);
  const auto width = static_cast<std::size_t>(camera.width);
  // Each scene has an origin of its own: the same rays, relative to each.
  const CameraRays rays_of[2] = {camera.rays(first.origin()), camera.rays(second.origin())};
  const Tracer* const tracers[2] = {&first.picture_tracer(), &second.picture_tracer()};
  for (std::size_t begin = 0; begin < static_cast<std::size_t>(camera.height);
       begin += kRowsPerChunk) {
    const std::size_t end =
        std::min(begin + kRowsPerChunk, static_cast<std::size_t>(camera.height));
    std::vector<Ray> rays((end - begin) * width);
    std::vector<Hit> hits[2] = {std::vector<Hit>(rays.size()), std::vector<Hit>(rays.size())};
    for (int k = 0; k < 2; ++k) {
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const std::size_t row = begin + i / width;
        rays[i] =
            rays_of[k].ray(static_cast<double>(i % width) + 0.5, static_cast<double>(row) + 0.5);
      }
      tracers[k]->nearest(rays, hits[k], executor);
    }
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Hit& shown = hits[0][i].valid() ? hits[0][i] : hits[1][i];
      if (!shown.valid()) continue;
      frame.set(begin * width + i,
                {pixel_color(hits[0][i], hits[1][i]), nearness_of(rays_of[0], rays[i], shown.t)},
                1);
    }
  }
  return develop(frame, developer, executor);
}

void require_overlap(const ModelScene& first, const std::filesystem::path& first_file,
                     const ModelScene& second, const std::filesystem::path& second_file) {
  const auto [first_low, first_high] = world_box_of(first.model());
  const auto [second_low, second_high] = world_box_of(second.model());
  const Vec3d apart = max(first_low - second_high, second_low - first_high);
  if (std::max({apart.x, apart.y, apart.z}) <= 0) return;
  throw Error(ErrorKind::data,
              "a difference is of models of one place, and the boxes of these do "
              "not overlap: " +
                  first_file.string() + " is in " + rounded_box(first_low, first_high) + " and " +
                  second_file.string() + " in " + rounded_box(second_low, second_high));
}

void write_difference_legend(Image& image, const std::string& first, const std::string& second) {
  draw_color_bar(image, signed_scale(),
                 {second + " less " + first + ", along the view, cm",
                  {{0, "-20 nearer"}, {0.5, "0"}, {1, "farther +20"}},
                  {{kOnlyFirst, "only in " + first}, {kOnlySecond, "only in " + second}}});
}

}  // namespace adasplats
