// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/scans/synth.h"

#include <nlohmann/json.hpp>

#include "adasplats/jobs/output/output_folder.h"
#include "adasplats/jobs/session/settings_json.h"

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
          {"max_pieces", report.max_pieces},
          {"pieces_made_again", report.pieces_made_again},
          {"mesh_triangles", report.mesh_triangles}};
}

}  // namespace adasplats
