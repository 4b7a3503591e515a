// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>
#include <vector>

#include "adasplats/splats/model/splat_model.h"

// For tests.
namespace adasplats {

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  if (a.size() != b.size()) return false;
  return a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

inline bool same_bytes(const SplatModel& a, const SplatModel& b) {
  return same_bytes(a.disks, b.disks) && same_bytes(a.classes, b.classes) &&
         same_bytes(a.groups, b.groups) && same_bytes(a.intensities, b.intensities);
}

}  // namespace adasplats
