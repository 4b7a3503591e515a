// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/synth_city.h"

#include <nlohmann/json.hpp>

#include "adasplats/jobs/output/output_folder.h"
#include "adasplats/jobs/session/settings_json.h"

namespace adasplats {

SynthCityReport run_synth_city(const SynthCityJob& job, Session& session) {
  SynthCityOptions city = job.city;
  city.seed = session.seed;
  nlohmann::ordered_json options = {{"seed", session.seed}, {"sensor", city.sensor}};
  put_settings(city, options);
  OutputFolder folder(job.output, job.overwrite, "synth city", options);
  const SynthCityReport report =
      write_synth_city(folder.path(), city, session.executor, session.progress);
  folder.commit();
  return report;
}

nlohmann::ordered_json to_json(const SynthCityReport& report) {
  return {{"scans", report.scans},
          {"points", report.points},
          {"pieces", report.pieces},
          {"most_pieces", report.max_pieces},
          {"pieces_made_again", report.pieces_made_again},
          {"mesh_triangles", report.mesh_triangles}};
}

}  // namespace adasplats
