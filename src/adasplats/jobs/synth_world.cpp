// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/synth_world.h"

#include <nlohmann/json.hpp>

#include "adasplats/jobs/output/output_folder.h"
#include "adasplats/jobs/session/settings_json.h"

namespace adasplats {

WorldReport run_synth_world(const WorldJob& job, Session& session) {
  WorldOptions world = job.world;
  WorldScanOptions scan = job.scan;
  world.seed = scan.seed = session.seed;
  nlohmann::ordered_json options = {{"seed", session.seed}, {"sensor", scan.sensor}};
  put_settings(world, options);
  put_settings(scan, options);
  OutputFolder folder(job.output, job.overwrite, "synth world", options);
  const WorldReport report =
      write_world(folder.path(), world, scan, session.executor, session.progress);
  folder.commit();
  return report;
}

nlohmann::ordered_json to_json(const WorldReport& report) {
  return {{"mesh_triangles", report.mesh_triangles},
          {"moving_objects", report.moving_objects},
          {"scans", report.scans},
          {"points", report.points}};
}

}  // namespace adasplats
