// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "adasplats/cloud/load/rig.h"
#include "adasplats/core/progress.h"
#include "adasplats/dataset/rig_writer.h"
#include "adasplats/io/packets/capture_writer.h"
#include "adasplats/jobs/scans/simulate.h"

namespace adasplats {

/// The address and port of the `topic` of a sensor, "ADDRESS:PORT"; nothing without one. Errors:
/// usage (another text).
std::optional<UdpEndpoint> sender_of(const Rig& rig, std::size_t sensor);

/// Writes FOLDER/rig.toml, which describes the simulated scans in `job.output` as inputs, with the
/// mounts and clocks of `rig`. `writer`: of make_rig_writer() for `sensors`.
void write_written_rig(const std::filesystem::path& folder, const Rig& rig, const SimulateJob& job,
                       const std::vector<RigWriterSensor>& sensors, const ScanWriter& writer,
                       ProgressSink& progress);

}  // namespace adasplats
