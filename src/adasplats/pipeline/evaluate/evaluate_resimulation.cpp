// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/pipeline/evaluate/evaluate_resimulation.h"

#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/cloud/sequence/pose_check.h"
#include "adasplats/core/error.h"
#include "adasplats/pipeline/session/inputs.h"

namespace adasplats {
namespace {

KittiSequence with_scans(KittiSequence all, const ScanRange& range) {
  KittiSequence chosen;
  chosen.folder = all.folder;
  chosen.beams.from_hdl64 = all.beams.from_hdl64;
  for (const std::size_t i : chosen_scans(range, all.scans.size(), all.folder)) {
    chosen.scans.push_back(all.scans[i]);
    if (!all.labels.empty()) chosen.labels.push_back(all.labels[i]);
    chosen.trajectory.push_back(all.trajectory[i]);
    if (!all.beams.sweeps_m.empty()) chosen.beams.sweeps_m.push_back(all.beams.sweeps_m[i]);
    if (!all.beams.raw_motions.empty())
      chosen.beams.raw_motions.push_back(all.beams.raw_motions[i]);
  }
  return chosen;
}

}  // namespace

KittiSequence open_held_out(const HeldOutScans& scans) {
  KittiSequence all = open_kitti_sequence(resolve_cloud_input(scans.sequence));
  require_poses_that_fit(all);
  if (!scans.beams_from_poses) all.beams = recognize_beams(all);
  if (!scans.motion.empty()) {
    if (!all.beams.sweeps_m.empty())
      throw Error(ErrorKind::usage, "`motion` is for scans as they were measured; those of " +
                                        all.folder.string() + " are motion-compensated");
    set_raw_motions(all.beams, all.trajectory, load_trajectory(scans.motion));
  }
  return with_scans(std::move(all), scans.scans);
}

ResimulateResult evaluate_resimulation(const ModelScene& scene, const KittiSequence& sequence,
                                       const std::string& labels, const ResimulateOptions& options,
                                       Session& session) {
  return resimulate(scene.tracer(), scene.view(), scene.origin(), sequence,
                    load_label_scheme(labels), options, session.executor, session.progress);
}

}  // namespace adasplats
