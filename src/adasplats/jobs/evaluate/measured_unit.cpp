// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/evaluate/measured_unit.h"

#include <cmath>

#include "adasplats/core/error.h"
#include "adasplats/evaluate/share.h"
#include "adasplats/jobs/evaluate/evaluate_resimulation.h"
#include "adasplats/jobs/evaluate/ring_scans.h"
#include "adasplats/jobs/scene/model_scene.h"
#include "adasplats/jobs/session/inputs.h"

namespace adasplats {
namespace {

KittiSequence open_unit_scans(const UnitScansJob& job, Session& session) {
  KittiSequence sequence = open_ring_scans(job.scans_of, job.trajectory, session);
  if (sequence.beams.sensor.empty())
    throw Error(ErrorKind::data, sequence.folder.string() +
                                     ": the points lie on the beams of no sensor of the library, "
                                     "so nothing tells which laser measured them");
  const bool as_measured = sequence.reader == nullptr && sequence.beams.sweeps_m.empty();
  if (!job.motion.empty() && !as_measured)
    throw Error(ErrorKind::usage,
                "`motion` needs scans of a sequence as they were measured; "
                "those of " +
                    sequence.folder.string() + " are motion-compensated");
  if (as_measured)
    set_raw_motions(sequence.beams, sequence.trajectory,
                    job.motion.empty() ? sequence.trajectory : load_trajectory(job.motion));
  return sequence;
}

/// Share of the returns that the model has within half a metre: nine in ten where scans and model
/// are of one place, four in ten where they are not but both are of roads.
double agreement_of(const std::vector<UnitBeam>& beams) {
  std::size_t returns = 0, near = 0;
  for (const UnitBeam& beam : beams) {
    if (!beam.returned()) continue;
    ++returns;
    near += beam.hit && std::fabs(beam.range_m - beam.expected_m) < 0.5F ? 1 : 0;
  }
  return share_of(near, returns);
}

}  // namespace

void require_one_place(double agreement, const std::string& scans) {
  constexpr double kLeast = 0.6;
  if (agreement >= kLeast) return;
  throw Error(ErrorKind::data,
              scans + ": " + std::to_string(std::lround(100 * agreement)) +
                  " % of the returns lie within 0.5 m of the model, expected at least 60 %: the "
                  "scans are of another place, or their poses are wrong");
}

MeasuredUnit measure_unit(const UnitScansJob& job, Session& session) {
  require_input(job.model);
  KittiSequence sequence = open_unit_scans(job, session);
  const std::vector<std::size_t> chosen =
      chosen_scans(job.scans, sequence.scans.size(), sequence.folder);
  ModelScene scene(job.model, "", session);
  calibrate_held_out(scene, sequence, session.progress);
  MeasuredUnit measured;
  measured.sensor_name = sequence.beams.sensor;
  measured.sensor = load_lidar_model(measured.sensor_name);
  measured.offsets = sequence.beams.offsets;
  measured.scans = chosen.size();
  const std::vector<double> heights_m = laser_heights_m(measured.sensor);
  measured.step_rad = firing_step_rad(sequence, chosen, heights_m, "SCANS");
  measured.beams =
      collect_unit_beams({scene.tracer(), scene.attributes(), scene.origin()}, sequence, chosen,
                         heights_m, measured.step_rad, session.executor, session.progress);
  measured.agreement = agreement_of(measured.beams);
  require_one_place(measured.agreement, job.scans_of.string());
  return measured;
}

}  // namespace adasplats
