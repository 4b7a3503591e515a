// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/unit_files.h"

#include "adasplats/io/base/atomic_file.h"
#include "adasplats/jobs/output/output_folder.h"

namespace adasplats {

FitSensorResult run_fit_sensor(const UnitFilesJob& job, Session& session) {
  check_output_file(job.output);
  FitSensorResult result = fit_sensor(job.fit, session);
  write_file(job.output, result.sensor_toml);
  return result;
}

}  // namespace adasplats
