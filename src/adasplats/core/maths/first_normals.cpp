// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/core/maths/first_normals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "adasplats/core/maths/elementary.h"
#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

constexpr std::size_t kBlock = 128;  // fits the first cache

/// The steps of Random::normal() in loops of their own, which the compiler vectorises.
[[gnu::always_inline]] inline void fill_normals(std::uint64_t seed, std::uint64_t stream,
                                                std::uint64_t first_index,
                                                std::span<double> normals) {
  std::array<double, kBlock> lengths{}, turns{};
  for (std::size_t begin = 0; begin < normals.size(); begin += kBlock) {
    const std::size_t count = std::min(kBlock, normals.size() - begin);
    for (std::size_t i = 0; i < count; ++i) {
      Random random(seed, stream, first_index + begin + i);
      lengths[i] = 1.0 - random.uniform();
      turns[i] = random.uniform();
    }
    for (std::size_t i = 0; i < count; ++i) lengths[i] = std::sqrt(-2.0 * log_of(lengths[i]));
    double* const out = normals.data() + begin;
    for (std::size_t i = 0; i < count; ++i) out[i] = lengths[i] * cos_of_turns(turns[i]);
  }
}

using FillNormals = void (*)(std::uint64_t, std::uint64_t, std::uint64_t, std::span<double>);

#if defined(__x86_64__)
[[gnu::target("avx2")]] void fill_with_avx2(std::uint64_t seed, std::uint64_t stream,
                                            std::uint64_t first_index, std::span<double> normals) {
  fill_normals(seed, stream, first_index, normals);
}
#endif

FillNormals best_fill() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) return fill_with_avx2;
#endif
  return fill_normals;
}

}  // namespace

void first_normals(std::uint64_t seed, std::uint64_t stream, std::uint64_t first_index,
                   std::span<double> normals) {
  static const FillNormals fill = best_fill();
  fill(seed, stream, first_index, normals);
}

}  // namespace adasplats
