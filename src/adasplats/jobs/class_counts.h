// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>

#include "adasplats/core/executor.h"

namespace adasplats {

/// Points of one class in the sequence and in what was simulated.
struct ClassCount {
  std::size_t original = 0;
  std::size_t simulated = 0;
};

/// Counts the labels of files, by class; scan i of both is one. Errors: those of
/// read_kitti_labels().
std::map<std::uint16_t, ClassCount> count_classes(std::span<const std::filesystem::path> originals,
                                                  std::span<const std::filesystem::path> simulated,
                                                  const Executor& executor);

}  // namespace adasplats
