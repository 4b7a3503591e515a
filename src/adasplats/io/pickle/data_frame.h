// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "adasplats/io/base/table.h"

namespace adasplats {

/// The numbers of a data frame of pandas in a pickle, gzipped (.pkl.gz) or not, as PandaSet has its
/// scans: what pandas 0.23 to 2 writes, and what we do. Nothing in the file is executed. Columns of
/// texts and other objects are left out, so is the index. Memory: 2x what the file unpacks to,
/// which is at most 1 GiB, and that of PickledValues. Errors: no_input, io, data.
Table read_data_frame(const std::filesystem::path& path);

/// The same of a pickle's bytes; `path` is for messages.
Table data_frame_of(const std::filesystem::path& path, std::string pickle);

}  // namespace adasplats
