// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/semantickitti_writer.h"
#include "adasplats/synth/world/world.h"

namespace adasplats {

WorldReport write_world(const std::filesystem::path& folder, const WorldOptions& world_options,
                        const WorldScanOptions& scan_options, const Executor& executor,
                        ProgressSink& progress) {
  const SynthWorld world = make_world(world_options);
  WorldReport report;
  report.mesh_triangles = world.place.fixed.triangles.size();
  report.moving_objects = world.place.moving.size();
  // First, because it rejects a folder with another sequence.
  SemanticKittiWriter sequence(folder / "sequences" / "00");
  scan_world(
      world, scan_options,
      [&](std::size_t index, const Scan& scan) {
        sequence.write_scan(index, scan);
        report.points += scan.size();
        ++report.scans;
      },
      executor, progress);
  sequence.finish();
  save_street_mesh(folder / "mesh.ply", world.place);
  return report;
}

}  // namespace adasplats
