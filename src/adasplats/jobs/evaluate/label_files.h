// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "adasplats/jobs/session/scan_range.h"
#include "adasplats/jobs/session/session.h"

namespace adasplats {

/// Two files with labels of the same points.
struct LabelFilePair {
  std::filesystem::path predicted;
  std::filesystem::path truth;
};

/// The files of two inputs that belong together. An input is a file (.label, or points with a
/// column of classes); a sequence folder, whose labels are its labels/NNNNNN.label (predicted ones:
/// its predictions/NNNNNN.label, where there are some); a folder of .label files; a tree of these
/// (FOLDER/sequences/NAME or FOLDER/NAME); or a folder of files of points. Two files are a pair
/// whatever their names. Else sequences go by name (one on either side: whatever their names), and
/// scans too. `scans` takes those of the true scans that it chooses of each sequence. Errors:
/// no_input; data (no labels; a sequence or, without `scans`, a scan that one side alone has),
/// usage
/// (`scans` of two files, those of chosen_scans and cloud_inputs).
std::vector<LabelFilePair> pair_label_files(const std::filesystem::path& predicted,
                                            const std::filesystem::path& truth,
                                            const ScanRange& scans);

/// The classes of all points of a file, in its order: none is left out. Errors: data (no labels),
/// those of the readers.
std::vector<std::uint16_t> read_point_classes(const std::filesystem::path& file, Session& session);

}  // namespace adasplats
