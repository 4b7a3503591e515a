// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// For tests only: messages and recordings put together by the letter of their specifications.

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/io/base/test_files.h"

namespace adasplats::bags_test {

using io_test::bytes_of;

/// A ROS message value by value: CDR, or ROS 1's without alignment.
class MessageComposer {
 public:
  explicit MessageComposer(bool cdr = true, bool big_endian = false)
      : cdr_(cdr),
        big_(big_endian),
        bytes_(cdr ? std::string{'\0', big_endian ? '\0' : '\1', 0, 0} : std::string()) {}
  template <class T>
  MessageComposer& put(T value) {
    while (cdr_ && (bytes_.size() - 4) % sizeof(T) != 0) bytes_ += '\0';
    bytes_ += big_ ? io_test::big_endian(value) : bytes_of(value);
    return *this;
  }
  MessageComposer& text(const std::string& value) {
    put(static_cast<std::uint32_t>(value.size() + (cdr_ ? 1 : 0)));
    bytes_ += value;
    if (cdr_) bytes_ += '\0';
    return *this;
  }
  MessageComposer& raw(std::string_view bytes) {
    put(static_cast<std::uint32_t>(bytes.size()));
    bytes_ += bytes;
    return *this;
  }
  MessageComposer& header(std::int64_t stamp_ns, const std::string& frame) {
    if (!cdr_) put(std::uint32_t{7});  // seq
    put(static_cast<std::uint32_t>(stamp_ns / 1'000'000'000));
    put(static_cast<std::uint32_t>(stamp_ns % 1'000'000'000));
    return text(frame);
  }
  const std::string& get() const { return bytes_; }

 private:
  bool cdr_, big_;
  std::string bytes_;
};

struct FieldOfPoints {
  std::string name;
  std::uint32_t offset;
  std::uint8_t type;  ///< of sensor_msgs/PointField
  std::uint32_t count = 1;
};

struct CloudWords {
  std::int64_t stamp_ns = 0;
  std::string frame = "lidar";
  std::vector<FieldOfPoints> fields;
  std::uint32_t height = 1, width = 0, step = 0, row_step = 0;
  bool big_endian_points = false;
  std::string points;
};

inline std::string cloud_message(const CloudWords& words, bool cdr = true,
                                 bool big_endian = false) {
  MessageComposer message(cdr, big_endian);
  message.header(words.stamp_ns, words.frame).put(words.height).put(words.width);
  message.put(static_cast<std::uint32_t>(words.fields.size()));
  for (const FieldOfPoints& field : words.fields)
    message.text(field.name).put(field.offset).put(field.type).put(field.count);
  message.put(std::uint8_t{words.big_endian_points}).put(words.step).put(words.row_step);
  return message.raw(words.points).put(std::uint8_t{1}).get();
}

/// Numbers of a pose: x y z, qx qy qz qw.
using PoseNumbers = std::vector<double>;

inline std::string transforms_message(std::int64_t stamp_ns, const std::string& parent,
                                      const std::string& child, const PoseNumbers& pose,
                                      bool cdr = true) {
  MessageComposer message(cdr);
  message.put(std::uint32_t{1}).header(stamp_ns, parent).text(child);
  for (const double value : pose) message.put(value);
  return message.get();
}

inline std::string odometry_message(std::int64_t stamp_ns, const std::string& parent,
                                    const std::string& child, const PoseNumbers& pose,
                                    bool cdr = true) {
  MessageComposer message(cdr);
  message.header(stamp_ns, parent).text(child);
  for (const double value : pose) message.put(value);
  for (int k = 0; k < 36 + 6 + 36; ++k) message.put(0.0);
  return message.get();
}

inline std::string pose_message(std::int64_t stamp_ns, const std::string& parent,
                                const PoseNumbers& pose, bool cdr = true) {
  MessageComposer message(cdr);
  message.header(stamp_ns, parent);
  for (const double value : pose) message.put(value);
  return message.get();
}

/// A message to be recorded.
struct Said {
  std::string topic, type;
  std::uint64_t time_ns = 0;
  std::string bytes;
};

inline std::string mcap_text(std::string_view value) {
  return bytes_of(static_cast<std::uint32_t>(value.size())) + std::string(value);
}
inline std::string mcap_record(int opcode, const std::string& content) {
  return std::string(1, static_cast<char>(opcode)) +
         bytes_of(static_cast<std::uint64_t>(content.size())) + content;
}

/// Records of schemas, channels and messages, each topic once.
inline std::string mcap_records(const std::vector<Said>& messages, std::vector<std::string>& topics,
                                const std::string& encoding = "cdr") {
  std::string records;
  for (const Said& said : messages) {
    std::size_t id = 0;
    while (id < topics.size() && topics[id] != said.topic) ++id;
    const auto number = static_cast<std::uint16_t>(id + 1);
    if (id == topics.size()) {
      topics.push_back(said.topic);
      records += mcap_record(3, bytes_of(number) + mcap_text(said.type) + mcap_text("ros2msg") +
                                    mcap_text("definition"));
      records += mcap_record(4, bytes_of(number) + bytes_of(number) + mcap_text(said.topic) +
                                    mcap_text(encoding) + bytes_of(std::uint32_t{0}));
    }
    records += mcap_record(5, bytes_of(number) + bytes_of(std::uint32_t{0}) +
                                  bytes_of(said.time_ns) + bytes_of(said.time_ns) + said.bytes);
  }
  return records;
}

/// A chunk of records that are packed already.
inline std::string mcap_chunk(const std::string& packing, const std::string& packed,
                              std::uint64_t size, std::uint32_t crc = 0) {
  return mcap_record(6, bytes_of(std::uint64_t{0}) + bytes_of(std::uint64_t{0}) + bytes_of(size) +
                            bytes_of(crc) + mcap_text(packing) +
                            bytes_of(static_cast<std::uint64_t>(packed.size())) + packed);
}

/// A file around records of data, without a summary.
inline std::string mcap_file(const std::string& data) {
  const std::string magic = "\x89MCAP0\r\n";
  return magic + mcap_record(1, mcap_text("ros2") + mcap_text("test")) + data +
         mcap_record(15, bytes_of(std::uint32_t{0})) + mcap_record(2, std::string(20, '\0')) +
         magic;
}

/// Messages in one chunk that is not packed.
inline std::string mcap_of(const std::vector<Said>& messages) {
  std::vector<std::string> topics;
  const std::string records = mcap_records(messages, topics);
  return mcap_file(mcap_chunk("", records, records.size()));
}

}  // namespace adasplats::bags_test
