// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "adasplats/cloud/load/open_inputs.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"

namespace adasplats {

/// Cuts files into pieces of at most `records` each, where they have records at random
/// (records_at_random()); others are one piece. Points with sensor positions and numbers of scans,
/// ascending, are cut between scans (one of up to twice that stays whole), which takes another pass
/// over the file: such pieces have whole scans and the path beyond. Where the numbers do not
/// ascend, or a scan is longer, that is said. Errors: those of read_points(); std::logic_error for
/// a drive.
std::vector<InputPiece> file_pieces(const OpenInputs& inputs, std::uint64_t records,
                                    const Executor& executor, ProgressSink& progress);

}  // namespace adasplats
