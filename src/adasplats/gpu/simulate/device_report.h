// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "adasplats/gpu/base/device_memory.h"
#include "adasplats/simulate/scan/scan_batch.h"
#include "adasplats/simulate/scan/scan_rules.h"

namespace adasplats::gpu {

/// Private to gpu/: attributes of primitives, on the current device.
DeviceBuffer<PrimitiveValues> upload_primitives(const PrimitiveTable& table, cudaStream_t stream);

/// The tables behind FiringRules on the current device. `primitives` (on it) must outlive it.
class DeviceRules {
 public:
  DeviceRules(const ScanRules& rules, const PrimitiveValues* primitives, cudaStream_t stream);
  const FiringRules& view() const { return view_; }

 private:
  void upload_intensity(const SensorIntensity* unit, cudaStream_t stream);

  FiringRules view_;
  DeviceBuffer<Firing> firings_;
  DeviceBuffer<double> range_offsets_m_;
  DeviceBuffer<double> ring_noise_m_;
  DeviceBuffer<float> weights_;
  DeviceBuffer<std::uint8_t> blocked_;
  DeviceBuffer<std::uint32_t> body_cells_;
  DeviceBuffer<BodyCell> body_;
  DeviceBuffer<double> expected_;
  DeviceBuffer<float> gains_;
  DeviceBuffer<float> unit_tables_;
  DeviceBuffer<std::uint8_t> unit_fields_;
};

/// The poses of the scans of a launch, on the device.
struct LaunchPoses {
  const ScanPose* knots = nullptr;
  const ScanPose* frame_knots = nullptr;       ///< null: points stay in the frame of measurement
  const std::uint32_t* first_knots = nullptr;  ///< null: one per scan
  std::uint64_t first_scan = 0;                ///< number of the first scan
  std::uint32_t scans = 0;
  std::uint32_t firings = 0;  ///< per scan
};

/// Working memory of a report, on the device.
struct ReportSpace {
  ReportedReturn* returns = nullptr;      ///< beam.returns of each firing
  std::uint8_t* counts = nullptr;         ///< of firings
  std::uint32_t* block_counts = nullptr;  ///< report_blocks(), then their sum
  std::uint32_t* offsets = nullptr;       ///< of scans; their number + 1
};

/// Number of block counts of a launch.
std::size_t report_blocks(std::size_t scans, std::size_t firings);

/// Queues the computation of the returns of hits[(i * sub_rays + s) * depth + k], where i counts
/// the firings of all scans. `space.offsets` receives the number of returns of each scan.
void queue_reports(const FiringRules& rules, const LaunchPoses& poses, const Hit* hits,
                   const ReportSpace& space, cudaStream_t stream);

/// Queues the writing of the attributes of these returns, in the order of scans and firings.
void queue_returns(const FiringRules& rules, const LaunchPoses& poses, const ReportSpace& space,
                   const ReturnArrays& arrays, cudaStream_t stream);

}  // namespace adasplats::gpu
