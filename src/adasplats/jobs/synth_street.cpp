// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/synth_street.h"

#include <nlohmann/json.hpp>

#include "adasplats/jobs/output/output_folder.h"

namespace adasplats {

StreetReport run_synth_street(const SynthJob& job, Session& session) {
  StreetOptions street = job.street;
  StreetScanOptions scan = job.scan;
  street.seed = scan.seed = session.seed;
  OutputFolder folder(
      job.output, job.overwrite, "synth street",
      {{"seed", session.seed}, {"points", scan.points}, {"length_m", street.length_m}});
  const StreetReport report =
      write_street(folder.path(), street, scan, session.executor, session.progress);
  folder.commit();
  return report;
}

nlohmann::ordered_json to_json(const StreetReport& report) {
  return {{"length_m", report.length_m},
          {"mesh_triangles", report.mesh_triangles},
          {"moving_objects", report.moving_objects},
          {"mapping_points", report.mapping_points},
          {"mapping_scans", report.mapping_scans},
          {"driving_scans", report.driving_scans}};
}

}  // namespace adasplats
