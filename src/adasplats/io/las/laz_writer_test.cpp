// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/las/laz_writer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/files_test.h"
#include "adasplats/io/base/point_files.h"
#include "adasplats/io/las/las_writer.h"
#include "adasplats/io/las/laz_layout.h"
#include "adasplats/io/laz/layered_writer.h"
#include "adasplats/io/laz/laz_samples_test.h"

namespace adasplats {
namespace {

using laz_test::kLazSamples;
using laz_test::LazSample;

constexpr std::size_t kPointBytes = 30, kPointLayers = 9;

std::uint32_t u32_of(const std::string& bytes, std::size_t at) {
  std::uint32_t number = 0;
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

/// The layers of a layered chunk at the beginning of `bytes`, of records of `record_bytes`.
std::vector<std::string> layers_of(const std::string& bytes, std::size_t record_bytes,
                                   std::size_t count) {
  const std::size_t sizes_at = record_bytes + 4;
  std::size_t at = sizes_at + 4 * count;
  std::vector<std::string> layers;
  for (std::size_t k = 0; k < count; ++k) {
    layers.push_back(bytes.substr(at, u32_of(bytes, sizes_at + 4 * k)));
    at += layers.back().size();
  }
  return layers;
}

/// The records of a sample without the bytes between the point and the extra bytes.
std::string format_6_of(const LazSample& sample) {
  const std::string records = sample_records(sample);
  const std::size_t bytes = records.size() / sample.rows;
  std::string kept;
  for (std::size_t row = 0; row < sample.rows; ++row) {
    kept += records.substr(row * bytes, kPointBytes);
    kept += records.substr((row + 1) * bytes - laz_test::kExtraBytes, laz_test::kExtraBytes);
  }
  return kept;
}

// Oracle: LASzip 3.5.0, which packed the same points with all scanner channels; attributes are
// layers, so those of the point and the extra bytes do not depend on the rest of the format.
TEST(LazWriter, GivesTheBytesOfLaszip) {
  const TemporaryFolder folder;
  constexpr std::size_t kRecordBytes = kPointBytes + laz_test::kExtraBytes;
  for (const std::size_t which : {2U, 3U}) {
    const LazSample& sample = kLazSamples[which];
    SCOPED_TRACE(sample.name);
    const std::string file = laz_file(sample);
    const LazLayout layout = read_laz_layout(folder.write("a.laz", file), false);
    const std::size_t between = sample.format == 10 ? 3 : 1;  // layers of colours and packets
    const std::string records = format_6_of(sample);
    std::size_t first = 0;
    ASSERT_GT(layout.chunks.size(), 1U);
    for (const LazChunk& chunk : layout.chunks) {
      const auto points = static_cast<std::size_t>(chunk.points);
      const auto wanted =
          layers_of(file.substr(static_cast<std::size_t>(chunk.offset_bytes)),
                    layout.packing.record_bytes, kPointLayers + between + laz_test::kExtraBytes);
      const std::string packed = pack_layered_chunk(
          reinterpret_cast<const std::byte*>(records.data() + first * kRecordBytes), points,
          kRecordBytes);
      EXPECT_EQ(packed.substr(0, kRecordBytes), records.substr(first * kRecordBytes, kRecordBytes));
      EXPECT_EQ(u32_of(packed, kRecordBytes), points);
      const auto found = layers_of(packed, kRecordBytes, kPointLayers + laz_test::kExtraBytes);
      for (std::size_t k = 0; k < kPointLayers; ++k) EXPECT_EQ(found[k], wanted[k]) << k;
      // Version 4 has the extra bytes of channels in another way.
      for (std::size_t k = kPointLayers; k < found.size() && sample.version == 3; ++k)
        EXPECT_EQ(found[k], wanted[k + between]) << k;
      first += points;
    }
    EXPECT_EQ(first, sample.rows);
  }
}

// Oracle: LASzip 3.5.0, which packed the same points with wave packets, a layer of their own.
TEST(LazWriter, GivesTheColoursOfLaszip) {
  const TemporaryFolder folder;
  constexpr std::size_t kColourBytes = 8, kColourLayers = 2;
  const LazSample& sample = kLazSamples[2];
  ASSERT_EQ(sample.format, 10U);
  const std::string file = laz_file(sample), all = sample_records(sample);
  const std::size_t bytes = all.size() / sample.rows;
  std::string records;
  for (std::size_t row = 0; row < sample.rows; ++row) {
    records += all.substr(row * bytes, kPointBytes + kColourBytes);
    records += all.substr((row + 1) * bytes - laz_test::kExtraBytes, laz_test::kExtraBytes);
  }
  constexpr std::size_t kRecordBytes = kPointBytes + kColourBytes + laz_test::kExtraBytes;
  std::size_t first = 0;
  for (const LazChunk& chunk : read_laz_layout(folder.write("a.laz", file), false).chunks) {
    const auto points = static_cast<std::size_t>(chunk.points);
    const std::string packed = pack_layered_chunk(
        reinterpret_cast<const std::byte*>(records.data() + first * kRecordBytes), points,
        kRecordBytes, kColourBytes);
    constexpr std::size_t kLayers = kPointLayers + kColourLayers + laz_test::kExtraBytes;
    const auto found = layers_of(packed, kRecordBytes, kLayers);
    auto wanted =
        layers_of(file.substr(static_cast<std::size_t>(chunk.offset_bytes)), bytes, kLayers + 1);
    wanted.erase(wanted.begin() + kPointLayers + kColourLayers);
    EXPECT_EQ(found, wanted);
    first += points;
  }
  EXPECT_EQ(first, sample.rows);
}

/// Points whose attributes change in every way that has a symbol of its own.
struct Walk {
  std::vector<double> x, y, z, time;
  std::vector<std::uint16_t> intensity, source;
  std::vector<std::uint8_t> number, returns, classification, user, small;
  std::vector<float> value;

  static constexpr double kFar = 2147483.647;  // 2^31 - 1 steps of a millimetre

  explicit Walk(std::size_t rows) {
    std::mt19937 random(5);
    const auto below = [&random](unsigned limit) {
      return static_cast<unsigned>(random()) % limit;
    };
    double at[3] = {0, 0, 0}, now = 1e9;
    for (std::size_t row = 0; row < rows; ++row) {
      for (double& one : at) one += 0.001 * (static_cast<int>(below(2000)) - 1000);
      at[0] = below(500) != 0 ? std::clamp(at[0], -kFar, kFar) : below(2) == 0 ? kFar : -kFar;
      x.push_back(at[0]);
      y.push_back(at[1]);
      z.push_back(at[2]);
      time.push_back(next_time(now, below(40), below(1000)));
      now = time.back();
      intensity.push_back(static_cast<std::uint16_t>(below(3) == 0 ? below(65536) : 300));
      source.push_back(static_cast<std::uint16_t>(below(20) == 0 ? below(65536) : 7));
      returns.push_back(static_cast<std::uint8_t>(1 + below(below(5) == 0 ? 15 : 2)));
      number.push_back(static_cast<std::uint8_t>(1 + below(returns.back())));
      classification.push_back(static_cast<std::uint8_t>(below(4) == 0 ? below(256) : 2));
      user.push_back(static_cast<std::uint8_t>(below(9) == 0 ? below(256) : 0));
      small.push_back(static_cast<std::uint8_t>(row / 100));
      value.push_back(static_cast<float>(below(100)) / 7.0F);
    }
  }

  /// The same, a step, several, very many, back, far away, nothing that is a time.
  static double next_time(double now, unsigned kind, unsigned size) {
    const auto by = [now](std::int64_t steps) {
      return std::bit_cast<double>(std::bit_cast<std::int64_t>(now) + steps);
    };
    switch (kind) {
      case 0: return by(5000 * std::int64_t{size});
      case 1: return by(-3000 * std::int64_t{size % 12});
      case 2: return by(1 + size % 3);
      case 3: return now == 1e9 ? 2e9 : 1e9;
      case 4: return size < 100 ? -1.0 * size : by(7000000);
      case 5: return size < 20 ? std::bit_cast<double>(0x7ff8000000000000 + size) : now;
      case 6: return std::bit_cast<double>(std::uint64_t{size} << 52);
      default: return kind % 2 == 0 ? now : by(5000);
    }
  }

  std::vector<ColumnView> columns() const {
    return {{"x", ColumnType::f64, x.data(), 8},
            {"y", ColumnType::f64, y.data(), 8},
            {"z", ColumnType::f64, z.data(), 8},
            {"gps_time", ColumnType::f64, time.data(), 8},
            {"intensity", ColumnType::u16, intensity.data(), 2},
            {"point_source_id", ColumnType::u16, source.data(), 2},
            {"return_number", ColumnType::u8, number.data(), 1},
            {"number_of_returns", ColumnType::u8, returns.data(), 1},
            {"classification", ColumnType::u8, classification.data(), 1},
            {"user_data", ColumnType::u8, user.data(), 1},
            {"small", ColumnType::u8, small.data(), 1},
            {"value", ColumnType::f32, value.data(), 4}};
  }
};

// NaN equals itself here.
void expect_same_values(const Table& found, const Table& wanted) {
  ASSERT_EQ(found.rows, wanted.rows);
  ASSERT_EQ(found.columns.size(), wanted.columns.size());
  for (std::size_t k = 0; k < found.columns.size(); ++k) {
    EXPECT_EQ(found.columns[k].name, wanted.columns[k].name);
    std::visit(
        [&](const auto& values) {
          const auto& others = std::get<std::decay_t<decltype(values)>>(wanted.columns[k].values);
          ASSERT_EQ(values.size(), others.size());
          const std::size_t bytes = values.size() * sizeof(values[0]);
          EXPECT_TRUE(bytes == 0 || std::memcmp(values.data(), others.data(), bytes) == 0)
              << found.columns[k].name;
        },
        found.columns[k].values);
  }
}

// Oracle: the same columns as LAS, for none, one, full and other chunks.
TEST(LazWriter, IsReadAsTheLas) {
  const TemporaryFolder folder;
  LasWriteOptions options;
  options.crs.wkt = "LOCAL_CS[\"here\"]";
  for (const std::size_t rows : {0U, 1U, 2U, 50000U, 50001U, 120007U}) {
    SCOPED_TRACE(rows);
    const Walk walk(rows);
    options.is_packed = false;
    write_las(folder.path() / "a.las", rows, walk.columns(), options);
    options.is_packed = true;
    write_las(folder.path() / "a.laz", rows, walk.columns(), options);
    expect_same_values(read_las(folder.path() / "a.laz"), read_las(folder.path() / "a.las"));
    const LasFacts facts = read_las_facts(folder.path() / "a.laz");
    EXPECT_EQ(facts.points, rows);
    EXPECT_EQ(facts.crs.wkt, options.crs.wkt);
    const std::string bytes = read_file(folder.path() / "a.laz");
    EXPECT_EQ(static_cast<unsigned char>(bytes[104]), 6U | 128U);
    ByteBuffer again;
    put_las(again, "a.laz", rows, walk.columns(), options);
    EXPECT_EQ(again.take(), bytes);
  }
}

// Attributes that do not change take no bytes: a million equal points are small.
TEST(LazWriter, EqualPointsTakeHardlyAnyBytes) {
  const std::vector<double> zeros(1000000, 0.0);
  ByteBuffer file;
  const ColumnView columns[] = {{"x", ColumnType::f64, zeros.data(), 8},
                                {"y", ColumnType::f64, zeros.data(), 8},
                                {"z", ColumnType::f64, zeros.data(), 8}};
  put_las(file, "a.laz", zeros.size(), columns, {.is_packed = true});
  const std::string bytes = file.take();
  EXPECT_LT(bytes.size(), 30000U);
  const TemporaryFolder folder;
  const Table table = read_las(folder.write("a.laz", bytes));
  EXPECT_EQ(table.rows, zeros.size());
}

TEST(LazWriter, NamesOfLaz) {
  EXPECT_TRUE(is_laz_name("a.laz"));
  EXPECT_TRUE(is_laz_name("a.LAZ"));
  EXPECT_FALSE(is_laz_name("a.las"));
  EXPECT_FALSE(is_laz_name("laz"));
}

}  // namespace
}  // namespace adasplats
