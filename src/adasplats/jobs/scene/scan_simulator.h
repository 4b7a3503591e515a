// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "adasplats/core/executor.h"
#include "adasplats/core/function_ref.h"
#include "adasplats/jobs/scene/scan_scene.h"
#include "adasplats/jobs/scene/scan_settings.h"
#include "adasplats/simulate/scan/scan_rules.h"
#include "adasplats/simulate/scan/scan_view.h"

namespace adasplats {

/// A LiDAR in a scene: poses in, scans out.
class ScanSimulator {
 public:
  /// Receives scan i of a run; called in order on the caller's thread. It may move out of `scan`;
  /// memory that it leaves is reused. An exception ends the run and reaches the caller.
  using Sink = ScanCaster::ScanSink;

  /// Scene and executor must outlive it. Errors: those of check(), usage (a depth above 1 in a
  /// scene with opacities).
  ScanSimulator(const ScanScene& scene, ScanSettings settings, const Executor& executor);

  const ScanSettings& settings() const { return settings_; }
  /// Of a scan; if the pattern does not repeat, of the last simulated scan.
  std::span<const Firing> firings() const { return rules_.firings(); }
  const ScanScene& scene() const { return scene_; }
  const ScanRules& rules() const { return rules_; }

  /// Scan i has the number `first_number` + i. Its noise, the firings of a pattern that does not
  /// repeat and the positions of moving objects depend on it.
  ReportTimes run(std::span<const ScanMotion> scans, std::uint64_t first_number, Sink sink);
  using HeldSink = FunctionRef<void(std::size_t i, HeldScan&& scan)>;
  /// The same without a copy, for sinks that only read. A sink that is slower than the casting
  /// should hold a few scans at most. The scans refer to `scans`.
  ReportTimes run_held(std::span<const ScanMotion> scans, std::uint64_t first_number,
                       HeldSink sink);
  /// The same in batches (SceneCaster::report_batches); one scan a batch of a pattern that does not
  /// repeat. Errors: unavailable (device memory for a scene on the CPU, or for such a pattern).
  ReportTimes run_batches(std::span<const ScanMotion> scans, std::uint64_t first_number,
                          BatchMemory memory, SceneCaster::BatchSink sink);
  /// One scan.
  Scan scan(const ScanMotion& motion, std::uint64_t number);

 private:
  using Span = FunctionRef<ReportTimes(std::span<const ScanMotion> scans, std::size_t first)>;
  ReportTimes by_spans(std::span<const ScanMotion> scans, Span cast);
  ReportTimes run_repeating(std::span<const ScanMotion> scans, std::uint64_t first_number,
                            Sink sink);
  double reach_m() const;

  const ScanScene& scene_;
  ScanSettings settings_;
  const Executor& executor_;
  ScanRules rules_;
  ScanPool pool_;
};

}  // namespace adasplats
