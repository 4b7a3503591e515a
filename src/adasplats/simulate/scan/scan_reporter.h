// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/function_ref.h"
#include "adasplats/simulate/scan/scan_rules.h"

namespace adasplats {

/// Makes scans from hits on the CPU, and reuses its memory. Not thread-safe.
class ScanReporter {
 public:
  /// Writes the hits of the rays of firings [begin, end) to `hits`, hits_per_firing() each. Called
  /// for consecutive firings, some of them twice, from several threads.
  using HitsOf = FunctionRef<void(std::size_t begin, std::size_t end, std::span<Hit> hits)>;

  /// Both must outlive it.
  ScanReporter(const ScanRules& rules, const Executor& executor);

  /// Writes the scan with these hits to `scan`, reusing its memory. The bytes do not depend on the
  /// number of threads.
  void report(const ScanMotion& motion, const ScanPoses& poses, std::uint64_t scan_index,
              HitsOf hits_of, Scan& scan);
  /// The same for given hits: hits[(i * sub_rays + s) * depth + k].
  void report(const ScanMotion& motion, const ScanPoses& poses, std::uint64_t scan_index,
              std::span<const Hit> hits, Scan& scan);

 private:
  /// Returns of consecutive firings. The vectors have the maximum possible size.
  struct Chunk {
    std::vector<ReportedReturn> returns;
    std::vector<std::uint32_t> firings;  ///< of the returns
    std::vector<double> normals;         ///< of the range noise of the firings
    std::size_t count = 0;
    std::size_t first = 0;  ///< of its returns in the scan
  };
  using ReportChunk = FunctionRef<void(std::size_t begin, std::size_t end, Chunk& chunk)>;

  template <int kMost>
  void report_each(const ScanState& state, std::size_t begin, std::size_t end, const ScanHits& hits,
                   Chunk& chunk) const;
  void report_firings(const ScanState& state, std::size_t begin, std::size_t end,
                      const ScanHits& hits, Chunk& chunk) const;
  void report_chunks(const ScanMotion& motion, const ScanState& state, ReportChunk report_chunk,
                     Scan& scan);
  void resize(Scan& scan, std::size_t returns) const;
  void fill(Scan& scan, const ScanState& state, const Chunk& chunk) const;

  const ScanRules& rules_;
  const Executor& executor_;
  FiringRules view_;
  std::size_t firings_a_chunk_;
  std::vector<Chunk> chunks_;
};

}  // namespace adasplats
