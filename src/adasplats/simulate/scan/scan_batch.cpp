// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/scan/scan_batch.h"

#include <memory>
#include <type_traits>
#include <utility>

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

ScanBatch batch_of(std::size_t first, Scan&& scan) {
  const auto kept = std::make_shared<Scan>(std::move(scan));
  ScanBatch batch;
  batch.first = first;
  batch.offsets = {0, static_cast<std::uint32_t>(kept->size())};
  const auto point = [](auto& array, auto& values) {
    if (!values.empty()) array = values.data();
  };
  point(batch.arrays.positions, kept->positions);
  for_each_scan_attribute(
      [&](const auto& attribute) { point(attribute.of(batch.arrays), attribute.of(*kept)); });
  batch.memory = kept;
  return batch;
}

}  // namespace adasplats
