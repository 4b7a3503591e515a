// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/image/image.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/core/progress_meter.h"
#include "adasplats/simulate/image/developing.h"
#include "adasplats/simulate/image/frame.h"
#include "adasplats/simulate/image/pixel_sum.h"
#include "adasplats/simulate/image/shading.h"

namespace adasplats {

namespace {

// A packet of 16 rays is a block of 4 x 4 samples: its rays meet nearly the same boxes.
constexpr int kBlock = 4;
// A tile is what one task renders; its rays are cast in one call.
constexpr int kTile = 64;

struct Sample {
  int x, y;  ///< in samples from the image's top left corner
};

/// The samples of one tile, block by block.
std::vector<Sample> samples_of_tile(Sample first, int columns, int rows) {
  std::vector<Sample> samples;
  samples.reserve(static_cast<std::size_t>(kTile) * kTile);
  const int right = std::min(first.x + kTile, columns);
  const int bottom = std::min(first.y + kTile, rows);
  for (int y = first.y; y < bottom; y += kBlock)
    for (int x = first.x; x < right; x += kBlock)
      for (int v = y; v < std::min(y + kBlock, bottom); ++v)
        for (int u = x; u < std::min(x + kBlock, right); ++u) samples.push_back({u, v});
  return samples;
}

/// Renders tiles into the image's pixels; one object serves all threads.
class Renderer {
 public:
  Renderer(const Tracer& tracer, const ImageScene& scene, const Camera& camera,
           const ImageOptions& options, const Executor& executor)
      : tracer_(tracer),
        camera_(camera),
        camera_rays_(camera.rays(scene.origin)),
        options_(options),
        executor_(executor),
        shading_(scene, options) {}

  Image render() const {
    Frame frame(camera_.width, camera_.height);
    const int tile_pixels = kTile / options_.samples_per_axis;
    const int tile_columns = (frame.width + tile_pixels - 1) / tile_pixels;
    const int tile_rows = (frame.height + tile_pixels - 1) / tile_pixels;
    const auto tiles = static_cast<std::size_t>(tile_columns) * static_cast<std::size_t>(tile_rows);
    const ProgressPass pass(executor_, tiles);
    executor_.for_chunks(tiles, 1, [&](std::size_t tile, std::size_t) {
      const auto index = static_cast<int>(tile);
      render_tile({index % tile_columns * tile_pixels, index / tile_columns * tile_pixels},
                  tile_pixels, frame);
    });
    return develop(frame, Developer(camera_, options_), executor_);
  }

 private:
  void render_tile(Sample corner, int tile_pixels, Frame& frame) const {
    const int axis = options_.samples_per_axis;
    const int right = std::min(corner.x + tile_pixels, frame.width);
    const int bottom = std::min(corner.y + tile_pixels, frame.height);
    const std::vector<Sample> samples =
        samples_of_tile({corner.x * axis, corner.y * axis}, right * axis, bottom * axis);
    std::vector<Ray> rays;
    rays.reserve(samples.size());
    for (const Sample& sample : samples)
      rays.push_back(camera_rays_.ray((sample.x + 0.5) / axis, (sample.y + 0.5) / axis));
    std::vector<Hit> hits(rays.size());
    tracer_.nearest(rays, hits, executor_);

    const int width = (right - corner.x) * axis;
    const auto place = [width](int x, int y) {
      return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
             static_cast<std::size_t>(x);
    };
    std::vector<std::uint32_t> ray_at(samples.size());  // row by row
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const int x = samples[i].x - corner.x * axis, y = samples[i].y - corner.y * axis;
      ray_at[place(x, y)] = static_cast<std::uint32_t>(i);
    }
    for (int y = corner.y; y < bottom; ++y) {
      for (int x = corner.x; x < right; ++x) {
        PixelSum sum;
        const int first_row = (y - corner.y) * axis, first_column = (x - corner.x) * axis;
        for (int v = 0; v < axis; ++v)
          for (int u = 0; u < axis; ++u) {
            const std::uint32_t i = ray_at[place(first_column + u, first_row + v)];
            sum.add(shading_.tables(), camera_rays_, rays[i], hits[i]);
          }
        frame.set(frame.at(x, y), sum.pixel, sum.hits);
      }
    }
  }

  const Tracer& tracer_;
  const Camera& camera_;
  CameraRays camera_rays_;
  const ImageOptions& options_;
  const Executor& executor_;
  Shading shading_;
};

class CpuRenderer final : public ImageRenderer {
 public:
  CpuRenderer(const Tracer& tracer, const ImageScene& scene, const ImageOptions& options,
              const Executor& executor)
      : tracer_(tracer), scene_(scene), options_(options), executor_(executor) {}

  Image render(const Camera& camera) override {
    return render_image(tracer_, scene_, camera, options_, executor_);
  }

 private:
  const Tracer& tracer_;
  ImageScene scene_;
  ImageOptions options_;
  const Executor& executor_;
};

}  // namespace

void check_image(const Camera& camera, const ImageOptions& options) {
  constexpr int kMost = 1 << 15;
  const auto outside = [](int value) { return value < 1 || value > kMost; };
  if (outside(camera.width) || outside(camera.height))
    throw Error(ErrorKind::usage, "an image of " + std::to_string(camera.width) + " x " +
                                      std::to_string(camera.height) +
                                      " pixels; expected 1 to 32768 each");
  if (options.samples_per_axis < 1 || options.samples_per_axis > 16)
    throw Error(ErrorKind::usage, std::to_string(options.samples_per_axis) +
                                      " samples per axis of a pixel; expected 1 to 16");
  if (camera.lens) {
    if (camera.lens->width != camera.width || camera.lens->height != camera.height)
      throw std::logic_error("a camera and its lens have different sizes");
    return;
  }
  const bool parallel = camera.orthographic_width_m > 0;
  if (!parallel && !(camera.horizontal_fov_rad > 0 && camera.horizontal_fov_rad < std::numbers::pi))
    throw Error(ErrorKind::usage, "a camera's field of view must be above 0 and below 180 degrees");
}

Image render_image(const Tracer& tracer, const ImageScene& scene, const Camera& camera,
                   const ImageOptions& options, const Executor& executor) {
  check_image(camera, options);
  return Renderer(tracer, scene, camera, options, executor).render();
}

void ImageRenderer::render_all(std::span<const Camera> cameras, Sink sink) {
  for (std::size_t i = 0; i < cameras.size(); ++i) sink(i, render(cameras[i]).pixels);
}

std::unique_ptr<ImageRenderer> make_cpu_renderer(const Tracer& tracer, const ImageScene& scene,
                                                 const ImageOptions& options,
                                                 const Executor& executor) {
  return std::make_unique<CpuRenderer>(tracer, scene, options, executor);
}

}  // namespace adasplats
