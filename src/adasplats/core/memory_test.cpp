// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/core/memory.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>

namespace adasplats {
namespace {

/// Resident memory of this process now, bytes.
std::size_t resident_bytes() {
  std::ifstream file("/proc/self/statm");
  std::size_t all = 0, resident = 0;
  file >> all >> resident;
  return resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

TEST(SparseArray, TakesMemoryOnlyForWrittenElements) {
  constexpr std::size_t kMiB = 1 << 20;
  SparseArray<std::uint64_t> array(std::size_t{1} << 35U);  // 256 GiB
  const std::size_t before = resident_bytes();
  EXPECT_EQ(array[(std::size_t{1} << 35U) - 1], 0U);
  const std::size_t begin = (std::size_t{1} << 34U) + 77, end = begin + 8 * kMiB;  // 64 MiB
  for (std::size_t i = begin; i < end; ++i) array[i] = i;
  for (std::size_t i = begin; i < end; i += 1000) ASSERT_EQ(array[i], i);
  EXPECT_GT(resident_bytes(), before + 60 * kMiB);
  array.release(begin, end);
  EXPECT_LT(resident_bytes(), before + 10 * kMiB);
  EXPECT_EQ(array[begin + kMiB], 0U);
  EXPECT_EQ(array[begin - 1], 0U);
}

TEST(SparseArray, LeavesNeighboursAlone) {
  SparseArray<std::uint8_t> array(100'000);
  for (std::size_t i = 0; i < array.size(); ++i) array[i] = 9;
  array.release(5'000, 60'001);
  EXPECT_EQ(array[4'999], 9);
  EXPECT_EQ(array[60'001], 9);
  EXPECT_EQ(array[30'000], 0);
  array.release(70'000, 70'100);  // no whole page
  EXPECT_EQ(array[70'050], 9);
}

}  // namespace
}  // namespace adasplats
