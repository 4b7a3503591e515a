// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <mutex>
#include <utility>

#include "adasplats/dataset/scan_values.h"
#include "adasplats/dataset/semantickitti_writer.h"
#include "adasplats/synth/city/synth_city.h"
#include "adasplats/synth/street.h"

namespace adasplats {

SynthCityReport write_synth_city(const std::filesystem::path& folder,
                                 const SynthCityOptions& options, const Executor& executor,
                                 ProgressSink& progress) {
  check_settings(options);
  const std::filesystem::path sequence = folder / "sequences" / "00";
  const std::filesystem::path truth = folder / "truth";
  SemanticKittiWriter writer(sequence);
  if (options.truth) create_folder(truth);
  std::mutex mutex;
  std::map<std::size_t, EncodedScan> written;  // of one batch, without their bytes
  SynthCitySink sink;
  sink.scan = [&](std::size_t index, const Scan& scan) {
    EncodedScan encoded = SemanticKittiWriter::encode(index, scan);
    write_encoded(sequence, encoded.files, FileWrites::in_place);
    encoded.files.clear();
    const std::lock_guard lock(mutex);
    written.emplace(index, std::move(encoded));
  };
  sink.scans_done = [&](std::size_t) {
    for (const auto& [index, scan] : written) writer.note_written(index, scan);
    written.clear();
  };
  if (options.truth) {
    sink.piece = [&](const std::string& name, const BuiltMesh& piece) {
      save_street_mesh(truth / (name + ".ply"), piece.mesh, piece.instances, piece.reflectances);
    };
  }
  const SynthCityReport report = scan_synth_city(options, sink, executor, progress);
  writer.finish();
  return report;
}

}  // namespace adasplats
