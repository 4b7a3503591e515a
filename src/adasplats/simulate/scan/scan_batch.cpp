// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/scan/scan_batch.h"

#include <type_traits>

namespace adasplats {

ReturnLayout::ReturnLayout(const ScanFields& fields, std::size_t returns, std::uint8_t* base) {
  constexpr std::size_t kBorder = 256;
  const auto place = [&](auto*& array, bool wanted) {
    if (!wanted) return;
    using Value = std::remove_pointer_t<std::remove_reference_t<decltype(array)>>;
    if (base != nullptr) array = reinterpret_cast<Value*>(base + bytes);
    bytes += (returns * sizeof(Value) + kBorder - 1) / kBorder * kBorder;
  };
  place(arrays.positions, fields.positions);
  for_each_scan_attribute(
      [&](const auto& attribute) { place(attribute.of(arrays), fields.*attribute.wanted); });
}

void copy_scan(const ScanBatch& batch, std::size_t i, const ScanMotion& motion, std::size_t rays,
               Scan& scan) {
  scan.world_from_sensor = motion.reference.world_from_sensor;
  scan.time_s = motion.reference.time_s;
  scan.rays = rays;
  const auto copy = [&](auto& values, const auto* array) {
    if (array == nullptr) {
      values.clear();
    } else {
      values.assign(array + batch.offsets[i], array + batch.offsets[i + 1]);
    }
  };
  copy(scan.positions, batch.arrays.positions);
  for_each_scan_attribute(
      [&](const auto& attribute) { copy(attribute.of(scan), attribute.of(batch.arrays)); });
}

}  // namespace adasplats
