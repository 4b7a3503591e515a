// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/ply/packed_ply.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/flat_gaussian.h"

namespace adasplats {
namespace {

constexpr std::size_t kChunkGaussians = 256;
constexpr std::array<const char*, 14> kUnpacked = {
    "x",      "y",      "z",     "scale_0", "scale_1", "scale_2", "f_dc_0",
    "f_dc_1", "f_dc_2", "rot_0", "rot_1",   "rot_2",   "rot_3",   "opacity"};
/// The ranges of a chunk, in the order of kUnpacked.
constexpr std::array<const char*, 9> kRanged = {"x",       "y", "z", "scale_x", "scale_y",
                                                "scale_z", "r", "g", "b"};
constexpr std::array<const char*, 4> kPacked = {"packed_position", "packed_scale", "packed_color",
                                                "packed_rotation"};

/// `bits` bits of a word from `shift` on, from 0 to 1.
double share_of(std::uint32_t word, int shift, int bits) {
  const std::uint32_t most = (1U << bits) - 1;
  return static_cast<double>(word >> shift & most) / most;
}

std::array<double, 3> shares_11_10_11(std::uint32_t word) {
  return {share_of(word, 21, 11), share_of(word, 11, 10), share_of(word, 0, 11)};
}

/// The index of the largest component of w, x, y, z in two bits, then the others in ten.
std::array<double, 4> unpacked_rotation(std::uint32_t word) {
  const std::size_t largest = word >> 30;
  std::array<double, 4> q{};
  double square = 0;
  int shift = 20;
  for (std::size_t k = 0; k < q.size(); ++k) {
    if (k == largest) continue;
    q[k] = (share_of(word, shift, 10) - 0.5) * std::numbers::sqrt2;
    square += q[k] * q[k];
    shift -= 10;
  }
  q[largest] = std::sqrt(std::max(0.0, 1 - square));
  return q;
}

class Unpacker {
 public:
  Unpacker(const InputFile& file, const Table& chunks, const Table& packed) {
    const std::size_t needed = (packed.rows + kChunkGaussians - 1) / kChunkGaussians;
    if (chunks.rows != needed)
      throw data_error({file.path(), {}, {}}, std::to_string(chunks.rows) +
                                                  " chunks of compressed Gaussians, expected " +
                                                  std::to_string(needed) + " for " +
                                                  std::to_string(packed.rows) + " Gaussians");
    for (std::size_t k = 0; k < kPacked.size(); ++k) {
      const Column* const found = packed.find(kPacked[k]);
      if (found == nullptr || !std::holds_alternative<std::vector<std::uint32_t>>(found->values))
        throw data_error({file.path(), {}, {}}, "compressed Gaussians without the property 'uint " +
                                                    std::string(kPacked[k]) + "'");
      words_[k] = &std::get<std::vector<std::uint32_t>>(found->values);
    }
    for (std::size_t k = 0; k < kRanged.size(); ++k) {
      low_[k] = chunks.find("min_" + std::string(kRanged[k]));
      high_[k] = chunks.find("max_" + std::string(kRanged[k]));
      const bool is_color = k >= 6;  // colours are from 0 to 1 without a range
      if ((low_[k] == nullptr) != (high_[k] == nullptr) || (low_[k] == nullptr && !is_color))
        throw data_error(
            {file.path(), {}, {}},
            "chunks of compressed Gaussians without a range of " + std::string(kRanged[k]));
    }
  }

  std::array<double, kUnpacked.size()> row(std::size_t i) const {
    const auto position = shares_11_10_11(word(0, i)), scale = shares_11_10_11(word(1, i));
    const std::uint32_t rgba = word(2, i);
    const std::array<double, 9> shares = {position[0],
                                          position[1],
                                          position[2],
                                          scale[0],
                                          scale[1],
                                          scale[2],
                                          share_of(rgba, 24, 8),
                                          share_of(rgba, 16, 8),
                                          share_of(rgba, 8, 8)};
    std::array<double, kUnpacked.size()> values{};
    for (std::size_t k = 0; k < shares.size(); ++k) {
      const double low = low_[k] != nullptr ? low_[k]->as_double(i / kChunkGaussians) : 0;
      const double high = high_[k] != nullptr ? high_[k]->as_double(i / kChunkGaussians) : 1;
      values[k] = low * (1 - shares[k]) + high * shares[k];
      if (k >= 6) values[k] = (values[k] - 0.5) / kHarmonic0;
    }
    const std::array<double, 4> q = unpacked_rotation(word(3, i));
    std::ranges::copy(q, values.begin() + 9);
    const double opacity = share_of(rgba, 0, 8);
    values[13] = std::log(opacity / (1 - opacity));
    return values;
  }

 private:
  std::uint32_t word(std::size_t k, std::size_t i) const { return (*words_[k])[i]; }

  std::array<const std::vector<std::uint32_t>*, kPacked.size()> words_{};
  std::array<const Column*, kRanged.size()> low_{}, high_{};
};

}  // namespace

bool has_packed_gaussians(const PlyHeader& header) {
  const PlyElement* const vertex = header.find("vertex");
  return header.find("chunk") != nullptr && vertex != nullptr &&
         std::ranges::any_of(vertex->properties,
                             [](const PlyProperty& p) { return p.name == "packed_position"; });
}

Table read_packed_gaussians(const InputFile& file, const PlyHeader& header, PlyBody& body) {
  Table chunks, packed;
  for (const PlyElement& element : header.elements) {
    if (element.name == "chunk") {
      chunks = body.read(element).scalars;
    } else if (element.name == "vertex") {
      packed = body.read(element).scalars;
    } else {
      body.skip(element);
    }
  }
  const Unpacker unpacker(file, chunks, packed);
  std::array<std::vector<double>, kUnpacked.size()> columns;
  for (std::vector<double>& column : columns) column.reserve(packed.rows);
  for (std::size_t i = 0; i < packed.rows; ++i) {
    const auto row = unpacker.row(i);
    for (std::size_t k = 0; k < row.size(); ++k) columns[k].push_back(row[k]);
  }
  Table table;
  table.rows = packed.rows;
  table.columns.reserve(columns.size());
  for (std::size_t k = 0; k < columns.size(); ++k)
    table.columns.push_back({kUnpacked[k], std::move(columns[k])});
  return table;
}

}  // namespace adasplats
