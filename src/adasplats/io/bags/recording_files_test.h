// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// For tests only: messages and recordings put together by the letter of their specifications.

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/io/base/base64.h"
#include "adasplats/io/base/files_test.h"

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

/// A record of a ROS 1 bag: fields of its header, and its data.
inline std::string bag_record(const std::vector<std::pair<std::string, std::string>>& fields,
                              const std::string& data) {
  std::string header;
  for (const auto& [name, value] : fields) header += mcap_text(name + "=" + value);
  return mcap_text(header) + mcap_text(data);
}

/// Records of connections and messages, each topic once.
inline std::string bag_records(const std::vector<Said>& messages,
                               std::vector<std::string>& topics) {
  std::string records;
  for (const Said& said : messages) {
    std::uint32_t id = 0;
    while (id < topics.size() && topics[id] != said.topic) ++id;
    if (id == topics.size()) {
      topics.push_back(said.topic);
      const std::string described = mcap_text("topic=" + said.topic) +
                                    mcap_text("type=" + said.type) + mcap_text("md5sum=*") +
                                    mcap_text("message_definition=d");
      records +=
          bag_record({{"op", "\7"}, {"conn", bytes_of(id)}, {"topic", said.topic}}, described);
    }
    const std::string time = bytes_of(static_cast<std::uint32_t>(said.time_ns / 1'000'000'000)) +
                             bytes_of(static_cast<std::uint32_t>(said.time_ns % 1'000'000'000));
    records += bag_record({{"op", "\2"}, {"conn", bytes_of(id)}, {"time", time}}, said.bytes);
  }
  return records;
}

inline std::string bag_chunk(const std::string& packing, const std::string& packed,
                             std::uint32_t size) {
  return bag_record({{"op", "\5"}, {"compression", packing}, {"size", bytes_of(size)}}, packed);
}

/// A bag around records, with one chunk or none; `index_pos` 0: it was not closed.
inline std::string bag_file(const std::string& records, std::uint64_t index_pos = 1) {
  const std::uint32_t chunks = records.find("compression=") == std::string::npos ? 0 : 1;
  const std::string head = bag_record({{"op", "\3"},
                                       {"index_pos", bytes_of(index_pos)},
                                       {"conn_count", bytes_of(std::uint32_t{0})},
                                       {"chunk_count", bytes_of(chunks)}},
                                      std::string(100, ' '));
  return "#ROSBAG V2.0\n" + head + records;
}

/// Messages in one chunk that is not packed.
inline std::string bag_of(const std::vector<Said>& messages) {
  std::vector<std::string> topics;
  const std::string records = bag_records(messages, topics);
  return bag_file(bag_chunk("none", records, static_cast<std::uint32_t>(records.size())));
}

/// What the packers of zstd, lz4 and bzip2 made of 1000 zeros.
struct PackedZeros {
  const char* packing;
  std::string bytes;
};
inline const PackedZeros kPackedZeros[] = {
    {"zstd",
     std::string("\x28\xb5\x2f\xfd\x64\xe8\x02\x4d\x00\x00\x10\x00\x00\x01\x00\xe3\x2b\x80\x05\x5a"
                 "\x07\x44\x79",
                 23)},
    {"lz4",
     std::string("\x04\x22\x4d\x18\x68\x40\xe8\x03\x00\x00\x00\x00\x00\x00\xf1\x0e\x00\x00\x00\x1f"
                 "\x00\x01\x00\xff\xff\xff\xd2\x50\x00\x00\x00\x00\x00\x00\x00\x00\x00",
                 37)},
    {"bz2",
     std::string("\x42\x5a\x68\x39\x31\x41\x59\x26\x53\x59\x01\xe8\xd0\x60\x00\x00\x01\xc0\x01\xc0"
                 "\x00\x00\x80\x00\x08\x20\x00\x20\xaa\x6d\x41\x98\xba\x83\xc5\xdc\x91\x4e\x14\x24"
                 "\x00\x7a\x34\x18\x00",
                 45)},
};

/// As SQLite 3 made it, in pages of 512 bytes: the messages (5 ns, /a, "first"), (7, /b, 30 times
/// 'x'), (9, /a, ""), of pkg/msg/One and pkg/msg/Two.
inline std::string small_db3() {
  const auto base64 = [] {
    std::string text;
    text += "U1FMaXRlIGZvcm1hdCAzAAIAAQEAQCAgAAAAAwAAAAMAAAAAAAAAAAAAAAIAAAAEAAAAAAAAAAAAAAAB";
    text.append(47, 'A');
    text += "DAC5jAQ0AAAACANsAAXAA2w";
    text.append(142, 'A');
    text +=
        "gRICBxcdHQGBd3RhYmxlbWVzc2FnZXNtZXNzYWdlcwNDUkVBVEUgVEFCTEUgbWVzc2FnZXMoaWQgSU5URUdFUiBQ"
        "UklNQVJZIEtFWSx0b3BpY19pZCBJTlRFR0VSIE5PVCBOVUxMLHRpbWVzdGFtcCBJTlRFR0VSIE5PVCBOVUxMLGRh"
        "dGEgQkxPQiBOT1QgTlVMTCmBDQEHFxkZAYF1dGFibGV0b3BpY3N0b3BpY3MCQ1JFQVRFIFRBQkxFIHRvcGljcyhp"
        "ZCBJTlRFR0VSIFBSSU1BUlkgS0VZLG5hbWUgVEVYVCBOT1QgTlVMTCx0eXBlIFRFWFQgTk9UIE5VTEwsc2VyaWFs"
        "aXphdGlvbl9mb3JtYXQgVEVYVCBOT1QgTlVMTCkNAAAAAgHSAAHpAdI";
    text.append(605, 'A');
    text += "FQIFABEjEy9icGtnL21zZy9Ud29jZHIVAQUAESMTL2Fwa2cvbXNnL09uZWNkcg0AAAADAcQAAfMBzAHE";
    text.append(584, 'A');
    text += "BgMFAAkBDAklAgUAAQFIAgd4eHh4eHh4eHh4eHh4eHh4eHh4eHh4eHh4eHh4eHgLAQUACQEWBWZpcnN0";
    return text;
  };
  return from_base64(base64()).value();
}

}  // namespace adasplats::bags_test
