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
  unary,        ///< on each point
  largest,      ///< of the neighbours in the level below; missing ones count as zero
  add,          ///< adds two values
  upsample,     ///< from the nearest point of the level above
  join          ///< concatenates two values
};

/// One step of a network: computes a value for every point of `level`. Values have indices.
struct Layer {
  LayerKind kind = LayerKind::unary;
  int level = 0;         ///< of the result
  bool strided = false;  ///< a convolution from the level below onto `level`
  std::size_t input = 0, second = 0, output = 0;
  std::size_t weight = 0, bias = 0;  ///< indices in Network::weights; convolutions and unary layers
  float slope = 1;                   ///< factor on negative results
};

enum class PointFeature : std::uint8_t { one, height, intensity, has_intensity };

/// Contents of a network file: kernel point convolutions over the grids of a cloud.
struct Network {
  PyramidShape shape;
  float sigma = 1.2F;                  ///< reach of a kernel point, in cells
  float height_unit_m = 4;             ///< of the feature `height`
  std::vector<Vec3f> kernel;           ///< points of the kernel, in cells
  std::vector<PointFeature> features;  ///< of a point: value 0
  std::vector<Layer> layers;           ///< in order; the last one gives the logits
  std::size_t values = 1;              ///< number of values
  std::vector<Weights> weights;
  std::vector<std::string> classes;  ///< SemanticKITTI's names
  std::string card;                  ///< data, licence, date, figures, intended use
  std::string sha256;                ///< of the file's bytes
};

/// For each value, the index of the last layer that uses it.
std::vector<std::size_t> last_uses(const Network& network);

/// Format: docs/segmentation.md. Errors: no_input; data, with the file: not a network, another
/// version, truncated, layers that do not match, weights that are not finite.
Network read_network(const std::filesystem::path& file);
/// The same for a file's content; errors begin with `name`.
Network parse_network(std::string_view content, const std::string& name);
/// The built-in network: networks/default.network.
Network default_network();

}  // namespace adasplats
