// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/scene/scan_simulator.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

ScanSettings checked(ScanSettings settings, const ScanScene& scene) {
  check(settings);
  if (settings.beam.depth > 1 && scene.has_opacities())
    throw Error(ErrorKind::usage,
                "`depth` averages the hits of opaque splats, and those of the model have "
                "opacities: rays already end at the mean of a surface's hits (use `depth` 1)");
  return settings;
}

}  // namespace

ScanSimulator::ScanSimulator(const ScanScene& scene, ScanSettings settings,
                             const Executor& executor)
    : scene_(scene),
      settings_(checked(std::move(settings), scene)),
      executor_(executor),
      rules_(settings_.sensor, firings_of(settings_.sensor, 0), settings_,
             scene.primitive_table()) {}

/// Maximum distance of a hit from the sensor's pose.
double ScanSimulator::reach_m() const {
  float offset = 0;
  for (const Firing& firing : rules_.cast_firings())
    offset = std::max(offset, length(firing.origin));
  constexpr double kRounding_m = 0.01;
  return settings_.sensor.max_range_m + static_cast<double>(offset) + kRounding_m;
}

/// Casts as many scans at once as the scene has loaded: cast(scans, number of the first).
ReportTimes ScanSimulator::by_spans(std::span<const ScanMotion> scans, Span cast) {
  ReportTimes sum;
  for (std::size_t first = 0; first < scans.size();) {
    const std::size_t count = scene_.prefetch(scans.subspan(first), reach_m());
    sum += cast(scans.subspan(first, count), first);
    first += count;
  }
  return sum;
}

ReportTimes ScanSimulator::run(std::span<const ScanMotion> scans, std::uint64_t first_number,
                               Sink sink) {
  return by_spans(scans, [&](std::span<const ScanMotion> span, std::size_t first) {
    if (repeats(settings_.sensor))
      return run_repeating(span, first_number + first,
                           [&](std::size_t i, Scan&& scan) { sink(first + i, std::move(scan)); });
    ReportTimes sum;
    for (std::size_t i = 0; i < span.size(); ++i) {
      rules_.set_firings(firings_of(settings_.sensor, first_number + first + i));
      sum += run_repeating(span.subspan(i, 1), first_number + first + i,
                           [&](std::size_t, Scan&& scan) { sink(first + i, std::move(scan)); });
    }
    return sum;
  });
}

/// Casts into the model and, object by object, into the world.
ReportTimes ScanSimulator::run_repeating(std::span<const ScanMotion> scans,
                                         std::uint64_t first_number, Sink sink) {
  return scene_.scan_caster().report_world(rules_, scans, first_number, scene_.world(), executor_,
                                           sink);
}

ReportTimes ScanSimulator::run_held(std::span<const ScanMotion> scans, std::uint64_t first_number,
                                    HeldSink sink) {
  if (!scene_.scan_caster().has_large_batches() || !repeats(settings_.sensor))
    return run(scans, first_number, [&](std::size_t i, Scan&& scan) { sink(i, pool_.hold(scan)); });
  return run_batches(scans, first_number, BatchMemory::host, [&](ScanBatch&& batch) {
    for (std::size_t i = 0; i < batch.scans(); ++i)
      sink(batch.first + i, {ScanView(batch, i, scans[batch.first + i], rules_), batch.memory});
  });
}

ReportTimes ScanSimulator::run_batches(std::span<const ScanMotion> scans,
                                       std::uint64_t first_number, BatchMemory memory,
                                       SceneCaster::BatchSink sink) {
  if (repeats(settings_.sensor))
    return by_spans(scans, [&](std::span<const ScanMotion> span, std::size_t first) {
      return scene_.scan_caster().report_batches(rules_, span, first_number + first, scene_.world(),
                                                 executor_, memory, [&](ScanBatch&& batch) {
                                                   batch.first += first;
                                                   sink(std::move(batch));
                                                 });
    });
  if (memory == BatchMemory::device)
    throw Error(ErrorKind::unavailable,
                settings_.sensor.name +
                    ": its pattern does not repeat, so scans cannot stay in GPU memory");
  return run(scans, first_number,
             [&](std::size_t i, Scan&& scan) { sink(batch_of(i, std::move(scan))); });
}

Scan ScanSimulator::scan(const ScanMotion& motion, std::uint64_t number) {
  Scan result;
  run(std::span(&motion, 1), number, [&](std::size_t, Scan&& scan) { result = std::move(scan); });
  return result;
}

}  // namespace adasplats
