// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/function_ref.h"
#include "adasplats/sensors/camera.h"
#include "adasplats/simulate/image/color_map.h"
#include "adasplats/simulate/scan/scan.h"
#include "adasplats/trace/tracer.h"

namespace adasplats {

/// Colouring of a picture.
enum class ImageColor : std::uint8_t {
  shading,    ///< grey by the angle between view and surface
  semantic,   ///< colour of the class, otherwise (or if black) of the group, otherwise grey; shaded
  normal,     ///< surface normal, oriented towards the camera, as RGB
  intensity,  ///< measured intensity, 2nd to 98th percentile; grey if there is none
  range,      ///< distance, on a logarithmic scale from 1 m to 100 m
  height,     ///< world z, 2nd to 98th percentile
  rgb,        ///< colours of the points in their file; grey if there are none
  error,      ///< the intensities are signed errors: blue, white, red; grey if unknown
};

/// 8-bit RGB, rows from the top.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;
};

struct ImageOptions {
  ImageColor color = ImageColor::semantic;
  int samples_per_axis = 1;  ///< the number of rays per pixel is its square
  std::array<std::uint8_t, 3> background = {238, 240, 243};
  bool sky = true;  ///< the background fades to light blue above the horizon and to grey below
  /// Corners and edges are darker, neighbouring splats of one surface blend, and gaps in a surface
  /// are dark. Without it, every sample has its own colour.
  bool relief = true;
  /// Values at the ends of the colour scale of intensities (or heights, m from the scene's origin);
  /// default: shown_range().
  std::optional<ValueRange> range;

  friend bool operator==(const ImageOptions&, const ImageOptions&) = default;
};

/// Scene data of a picture in addition to the tracer.
struct ImageScene {
  SceneView view;
  PrimitiveAttributes attributes;
  std::span<const SemanticGroup> groups;  ///< one per primitive, or empty
  const LabelScheme* labels = nullptr;
  Vec3d origin;
  std::span<const ColorBytes> colors;  ///< of the points in their file; one per primitive, or empty
};

/// Values at the ends of a colour scale in a scene: the 2nd and 98th percentile of intensities, or
/// of heights relative to the scene's origin, m; {0, 1} for other colourings.
ValueRange shown_range(const ImageScene& scene, ImageColor color);

/// Checks the arguments of render_image(). Errors: usage.
void check_image(const Camera& camera, const ImageOptions& options);

/// Casts rays through every pixel. Both sides of a surface are lit. The bytes do not depend on the
/// number of threads. Errors: usage (width, height or samples below 1, a field of view outside (0,
/// pi)).
Image render_image(const Tracer& tracer, const ImageScene& scene, const Camera& camera,
                   const ImageOptions& options, const Executor& executor);

/// Renders pictures of one scene with the same options, on the CPU or on a GPU. Thread-safe.
class ImageRenderer {
 public:
  virtual ~ImageRenderer() = default;

  /// The picture of render_image(). Errors: those of check_image().
  virtual Image render(const Camera& camera) = 0;

  /// Calls `sink` with the pixels (8-bit RGB, rows from the top) of every camera, in order; they
  /// are valid only during the call. A GPU renders the next picture meanwhile and needs the same
  /// width and height for all cameras.
  using Sink = FunctionRef<void(std::size_t camera, std::span<const std::uint8_t> pixels)>;
  virtual void render_all(std::span<const Camera> cameras, Sink sink);
};

/// Tracer, executor and the data viewed by `scene` must outlive it.
std::unique_ptr<ImageRenderer> make_cpu_renderer(const Tracer& tracer, const ImageScene& scene,
                                                 const ImageOptions& options,
                                                 const Executor& executor);

}  // namespace adasplats
