// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/core/maths/vec3.h"
#include "adasplats/segment/pyramid/pyramid.h"

namespace adasplats {

/// A matrix, row by row.
struct Weights {
  std::size_t rows = 0, columns = 0;
  std::vector<float> values;
};

enum class LayerKind : std::uint8_t {
  convolution,  ///< over kernel points (KPConv); from the level below where it is strided
  unary,        ///< every point alone
  largest,      ///< of the neighbours in the level below; what is missing counts as zero
  add,          ///< two values
  upsample,     ///< of the nearest point of the level above
  join          ///< one value behind the other
};

/// One step of a network: makes a value of every point of `level`. Values are numbered.
struct Layer {
  LayerKind kind = LayerKind::unary;
  int level = 0;         ///< of the result
  bool strided = false;  ///< a convolution from the level below onto `level`
  std::size_t input = 0, second = 0, output = 0;
  std::size_t weight = 0, bias = 0;  ///< of Network::weights; convolutions and unary layers
  float slope = 1;                   ///< of the result where it is negative
};

enum class PointFeature : std::uint8_t { one, height, intensity, has_intensity };

/// What a network file holds: kernel point convolutions over the grids of a cloud.
struct Network {
  PyramidShape shape;
  float sigma = 1.2F;                  ///< how far a kernel point reaches, in cells
  float height_unit_m = 4;             ///< of the feature `height`
  std::vector<Vec3f> kernel;           ///< points of the kernel, in cells
  std::vector<PointFeature> features;  ///< of a point: value number 0
  std::vector<Layer> layers;           ///< in their order; the last one gives the logits
  std::size_t values = 1;              ///< how many there are
  std::vector<Weights> weights;
  std::vector<std::string> classes;  ///< by SemanticKITTI's names
  std::string card;                  ///< data, licence, date, figures, intended use
  std::string sha256;                ///< of the file's bytes
};

/// Layers after which values are not used again, by value.
std::vector<std::size_t> last_uses(const Network& network);

/// Format: docs/segmentation.md. Errors: no_input; data, with the file: not a network, of another
/// version, cut off, layers that do not fit each other, weights that are not finite.
Network read_network(const std::filesystem::path& file);
/// The same of a file's content; errors begin with `name`.
Network parse_network(std::string_view content, const std::string& name);
/// The one that the program comes with: networks/default.network.
Network default_network();

}  // namespace adasplats
