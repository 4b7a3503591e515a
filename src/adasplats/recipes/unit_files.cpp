// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/recipes/unit_files.h"

#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/pipeline/output/output_folder.h"

namespace adasplats {

FitSensorResult run_fit_sensor(const UnitFilesJob& job, Session& session) {
  check_output_file(job.output);
  if (!job.drop.empty()) check_output_file(job.drop);
  if (job.drop == job.output)
    throw Error(ErrorKind::usage,
                "the sensor and the drop model are the same file, " + job.output.string());
  FitSensorResult result = fit_sensor(job.fit, session);
  if (!job.drop.empty() && !result.drop)
    throw Error(ErrorKind::data, "no drop model to write; " + result.not_told.back());
  write_file(job.output, result.sensor_toml);
  if (!job.drop.empty()) save_ray_drop(job.drop, *result.drop);
  return result;
}

}  // namespace adasplats
