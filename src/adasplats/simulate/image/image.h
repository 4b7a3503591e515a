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
#include "adasplats/core/executor.h"
#include "adasplats/core/function_ref.h"
#include "adasplats/sensors/camera.h"
#include "adasplats/simulate/image/color_map.h"
#include "adasplats/simulate/scan/scan.h"
#include "adasplats/trace/tracer.h"

namespace adasplats {

/// What colours a picture shows.
enum class ImageColor : std::uint8_t {
  shading,    ///< grey by the angle between view and surface
  semantic,   ///< colour of the class, where it has none (or black) of the group, else grey; shaded
  normal,     ///< surface normal turned to the camera as RGB
  intensity,  ///< measured intensity, 2nd to 98th percentile; grey where there is none
  range,      ///< distance, on a logarithmic scale from 1 m to 100 m
  height,     ///< world z, 2nd to 98th percentile
  error,      ///< the intensities are errors with a sign: blue, white, red; grey where not known
};

/// 8-bit RGB, rows from the top.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;
};

struct ImageOptions {
  ImageColor color = ImageColor::semantic;
  int samples_per_axis = 1;  ///< rays a pixel: the square of this
  std::array<std::uint8_t, 3> background = {238, 240, 243};
  bool sky = true;  ///< from the horizon up the background turns into a light blue, down into grey
  /// Corners and edges are darker, neighbouring splats of one surface run into each other, and
  /// gaps in a surface are dark. Without it every sample has its own colour alone.
  bool relief = true;
  /// What the ends of the colours of intensities (heights: m from the scene's origin) stand for;
  /// else shown_range().
  std::optional<ValueRange> range;

  friend bool operator==(const ImageOptions&, const ImageOptions&) = default;
};

/// What a picture needs to know of the scene besides the tracer.
struct ImageScene {
  SceneView view;
  PrimitiveAttributes attributes;
  std::span<const SemanticGroup> groups;  ///< one a primitive, or empty
  const LabelScheme* labels = nullptr;
  Vec3d origin;
};

/// What the ends of the scale of a colour stand for in a scene: the 2nd and 98th percentile of
/// intensities, or of heights relative to the scene's origin, m; {0, 1} for other colours.
ValueRange shown_range(const ImageScene& scene, ImageColor color);

/// Checks what render_image() is asked for. Errors: usage.
void check_image(const Camera& camera, const ImageOptions& options);

/// Casts rays through every pixel. Both sides of a surface are lit. The same bytes for any number
/// of threads. Errors: usage (width, height or samples below 1, a field of view outside (0, pi)).
Image render_image(const Tracer& tracer, const ImageScene& scene, const Camera& camera,
                   const ImageOptions& options, const Executor& executor);

/// Makes pictures of one scene with the same options, on the CPU or on a GPU. Several threads may
/// use it.
class ImageRenderer {
 public:
  virtual ~ImageRenderer() = default;

  /// The picture that render_image() makes. Errors: those of check_image().
  virtual Image render(const Camera& camera) = 0;

  /// Calls `sink` with the pixels (8-bit RGB, rows from the top) of every camera, in their order;
  /// they are valid during the call only. A GPU makes the next picture meanwhile; there all cameras
  /// must have the same width and height.
  using Sink = FunctionRef<void(std::size_t camera, std::span<const std::uint8_t> pixels)>;
  virtual void render_all(std::span<const Camera> cameras, Sink sink);
};

/// Tracer, executor and whatever `scene` views must outlive it.
std::unique_ptr<ImageRenderer> make_cpu_renderer(const Tracer& tracer, const ImageScene& scene,
                                                 const ImageOptions& options,
                                                 const Executor& executor);

}  // namespace adasplats
