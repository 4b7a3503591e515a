// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/panoramas/lidar4d_protocol.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/evaluate/cloud_metrics.h"

namespace adasplats {
namespace {

/// The largest finite intensity of all scans; none without intensities.
std::optional<float> largest_intensity(const KittiSequence& sequence, const Executor& executor) {
  std::optional<float> largest;
  for (std::size_t index = 0; index < sequence.scans.size(); ++index) {
    executor.check_interruption();
    for (const float intensity : read_kitti_points(sequence, index).intensities)
      if (std::isfinite(intensity)) largest = std::max(largest.value_or(intensity), intensity);
  }
  return largest;
}

double scale_for(float largest) {
  for (const double scale : {1.0, 255.0})
    if (static_cast<double>(largest) <= scale) return scale;
  return 65535;
}

/// To 0..1; values that are not finite become 0.
void normalize(std::vector<float>& intensities, double scale) {
  for (float& intensity : intensities)
    intensity = std::isfinite(intensity) ? intensity / static_cast<float>(scale) : 0.0F;
}

Panorama measured_image(const KittiSequence& sequence, std::size_t index,
                        const PanoramaLayout& layout) {
  const KittiScan scan = read_kitti_points(sequence, index);
  Panorama image = panorama_of(scan.positions, scan.intensities, layout);
  const auto returned = [](float range_m) { return range_m > 0; };
  if (std::ranges::none_of(image.ranges_m, returned))
    throw Error(ErrorKind::data,
                sequence.scans[index].string() + ": no points within the range image");
  return image;
}

Panorama image_of_scan(const Scan& scan, const PanoramaLayout& layout) {
  Panorama image{std::vector<float>(layout.pixels()), std::vector<float>(layout.pixels())};
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    const std::size_t pixel = std::size_t{scan.rings[i]} * layout.columns + scan.columns[i];
    image.ranges_m[pixel] = scan.ranges_m[i];
    if (!scan.intensities.empty()) image.intensities[pixel] = scan.intensities[i];
  }
  return image;
}

void add(ImageError& sum, const ImageError& error) {
  sum.rmse += error.rmse;
  sum.medae += error.medae;
  sum.ssim += error.ssim;
  sum.psnr_db += error.psnr_db;
}

void divide(ImageError& sum, double by) {
  for (double* value : {&sum.rmse, &sum.medae, &sum.ssim, &sum.psnr_db}) *value /= by;
}

/// Sums over scans, and their means.
class Lidar4dMeans {
 public:
  Lidar4dMeans(const PanoramaLayout& layout, std::optional<double> intensity_scale) {
    sum_.layout = layout;
    if (!intensity_scale) return;
    sum_.intensity.emplace();
    sum_.intensity_scale = *intensity_scale;
  }

  /// False if the images have no points to compare.
  bool add_scan(Panorama predicted, Panorama measured, const Executor& executor) {
    const PanoramaLayout& layout = sum_.layout;
    ++sum_.scans;
    add(sum_.depth,
        image_error(predicted.ranges_m, measured.ranges_m, layout.columns, layout.max_range_m));
    if (sum_.intensity) {
      normalize(predicted.intensities, sum_.intensity_scale);
      normalize(measured.intensities, sum_.intensity_scale);
      add(*sum_.intensity,
          image_error(predicted.intensities, measured.intensities, layout.columns, 1.0));
    }
    const DropError drop = drop_error(predicted.ranges_m, measured.ranges_m);
    sum_.drop.rmse += drop.rmse;
    sum_.drop.accuracy += drop.accuracy;
    sum_.drop.f_score += drop.f_score;
    return add_points(predicted, measured, executor);
  }

  Lidar4dResult means() const {
    Lidar4dResult result = sum_;
    const auto scans = static_cast<double>(result.scans);
    divide(result.depth, scans);
    if (result.intensity) divide(*result.intensity, scans);
    for (double* value : {&result.drop.rmse, &result.drop.accuracy, &result.drop.f_score})
      *value /= scans;
    const double clouds = clouds_ == 0 ? kNaN : static_cast<double>(clouds_);
    for (double* value : {&result.chamfer_m2, &result.f_score_224mm, &result.f_score_5cm})
      *value /= clouds;
    return result;
  }

 private:
  bool add_points(const Panorama& predicted, const Panorama& measured, const Executor& executor) {
    PointCloud from, to;
    from.positions = points_of(predicted, sum_.layout);
    to.positions = points_of(measured, sum_.layout);
    if (from.empty()) return false;
    const CloudDistance distance = cloud_distance(from, to, executor);
    ++clouds_;
    sum_.chamfer_m2 += distance.chamfer_m2;
    sum_.f_score_224mm += distance.f_score.rbegin()->second;  // sqrt(0.05) m, the largest bound
    sum_.f_score_5cm += distance.f_score.begin()->second;
    return true;
  }

  Lidar4dResult sum_;
  std::size_t clouds_ = 0;
};

}  // namespace

Lidar4dResult evaluate_lidar4d(const Tracer& tracer, const PrimitiveAttributes& attributes,
                               Vec3d scene_origin, const KittiSequence& sequence,
                               const Executor& executor, ProgressSink& progress) {
  if (sequence.scans.empty())
    throw Error(ErrorKind::data, sequence.folder.string() + ": no scans to compare");
  const PanoramaLayout layout;
  const LidarModel sensor = sensor_of(layout);
  const std::vector<Firing> firings = firings_of(sensor);
  SimulateOptions options;
  options.noise = false;
  std::optional<double> scale;
  if (!attributes.intensities.empty())
    if (const auto largest = largest_intensity(sequence, executor)) scale = scale_for(*largest);
  Lidar4dMeans means(layout, scale);
  progress.begin_step("compare range images", sequence.scans.size());
  for (std::size_t index = 0; index < sequence.scans.size(); ++index) {
    ScanMotion still;
    still.reference = sequence.trajectory[index];
    const Scan scan = simulate_scan(tracer, attributes, scene_origin, sensor, firings, still, index,
                                    options, executor);
    if (!means.add_scan(image_of_scan(scan, layout), measured_image(sequence, index, layout),
                        executor))
      progress.warn(sequence.scans[index].string() +
                    ": no pixel hits the model; the scan is left out of the distances of points");
    progress.advance(index + 1);
  }
  progress.end_step();
  return means.means();
}

}  // namespace adasplats
