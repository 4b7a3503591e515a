// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// For tests only: messages of ROS 2 taken apart by the specification of CDR.

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <string_view>

#include "adasplats/io/mcap/mcap_records_test.h"

namespace adasplats::ros_test {

// Types of sensor_msgs/PointField.
inline constexpr std::uint8_t kU8 = 2, kU16 = 4, kU32 = 6, kF32 = 7, kF64 = 8;

/// CDR by the letter: every number at a multiple of its size behind the encapsulation.
class CdrReader {
 public:
  explicit CdrReader(std::string_view message) : reader_(message) {
    EXPECT_EQ(reader_.take(4), std::string_view("\0\1\0\0", 4));
  }
  template <class T>
  T number() {
    while ((reader_.place() - 4) % sizeof(T) != 0) EXPECT_EQ(reader_.number<char>(), 0);
    return reader_.number<T>();
  }
  std::string text() {
    std::string text(reader_.take(number<std::uint32_t>()));
    EXPECT_EQ(text.back(), '\0');
    text.pop_back();
    return text;
  }
  std::string_view bytes() { return reader_.take(number<std::uint32_t>()); }
  std::uint64_t time_ns() {
    const auto seconds = number<std::int32_t>();
    const auto nanoseconds = number<std::uint32_t>();
    return static_cast<std::uint64_t>(seconds) * 1'000'000'000 + nanoseconds;
  }
  bool at_end() const { return reader_.at_end(); }

 private:
  mcap_test::FieldReader reader_;
};

struct Field {
  std::uint32_t offset;
  std::uint8_t type;
};

struct Cloud {
  std::uint64_t time_ns;
  std::string frame;
  std::uint32_t height, width, points, step;
  bool is_dense;
  std::map<std::string, Field> fields;
  std::string data;

  template <class T>
  T at(std::size_t point, const std::string& name) const {
    T value;
    std::memcpy(&value, data.data() + point * step + fields.at(name).offset, sizeof(T));
    return value;
  }
};

inline Cloud cloud_of(std::string_view message) {
  CdrReader reader(message);
  Cloud cloud{};
  cloud.time_ns = reader.time_ns();
  cloud.frame = reader.text();
  cloud.height = reader.number<std::uint32_t>();
  cloud.width = reader.number<std::uint32_t>();
  cloud.points = cloud.height * cloud.width;
  const auto fields = reader.number<std::uint32_t>();
  for (std::uint32_t k = 0; k < fields; ++k) {
    const std::string name = reader.text();
    const auto offset = reader.number<std::uint32_t>();
    cloud.fields[name] = {offset, reader.number<std::uint8_t>()};
    EXPECT_EQ(reader.number<std::uint32_t>(), 1U) << "count";
  }
  EXPECT_EQ(reader.number<std::uint8_t>(), 0) << "is_bigendian";
  cloud.step = reader.number<std::uint32_t>();
  EXPECT_EQ(reader.number<std::uint32_t>(), cloud.step * cloud.width) << "row_step";
  cloud.data = reader.bytes();
  EXPECT_EQ(cloud.data.size(), std::size_t{cloud.step} * cloud.points);
  cloud.is_dense = reader.number<std::uint8_t>() == 1;
  EXPECT_TRUE(reader.at_end());
  return cloud;
}

}  // namespace adasplats::ros_test
