// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/bags/recording.h"

#include <gtest/gtest.h>

#include "adasplats/io/bags/recording_files_test.h"
#include "adasplats/io/bags/unpack.h"
#include "adasplats/io/base/mutator_test.h"
#include "adasplats/io/mcap/mcap_file.h"

namespace adasplats {
namespace {

using bags_test::kPackedZeros;
using bags_test::mcap_chunk;
using bags_test::mcap_file;
using bags_test::mcap_of;
using bags_test::mcap_records;
using bags_test::PackedZeros;
using bags_test::Said;

const std::vector<Said> kSaid = {{"/a", "pkg/msg/One", 5, "first"},
                                 {"/b", "pkg/msg/Two", 7, std::string(3000, 'x')},
                                 {"/a", "pkg/msg/One", 9, ""}};

/// The messages of a recording, read again by position, with their types.
std::vector<Said> contents_of(const std::filesystem::path& path) {
  const Recording recording(path);
  std::vector<Said> said;
  std::vector<MessagePosition> places;
  recording.for_each_message([&](const RecordedMessage& message) {
    said.push_back(
        {message.topic.name, message.topic.type, message.time_ns, std::string(message.bytes)});
    places.push_back(message.place);
  });
  for (std::size_t k = places.size(); k-- > 0;)
    EXPECT_EQ(recording.message(places[k]), said[k].bytes) << k;
  return said;
}

void expect_messages(const std::filesystem::path& path, const std::vector<Said>& expected = kSaid) {
  const std::vector<Said> found = contents_of(path);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    EXPECT_EQ(found[k].topic, expected[k].topic);
    EXPECT_EQ(found[k].type, short_type_name(expected[k].type));
    EXPECT_EQ(found[k].time_ns, expected[k].time_ns);
    EXPECT_EQ(found[k].bytes, expected[k].bytes);
  }
}

// Oracle: files put together by the letter of the specification.
TEST(McapRecording, ChunksAndLooseRecordsGiveTheirMessages) {
  const TemporaryFolder folder;
  expect_messages(folder.write("chunk.mcap", mcap_of(kSaid)));
  std::vector<std::string> topics;
  expect_messages(folder.write("loose.mcap", mcap_file(mcap_records(kSaid, topics))));
  topics.clear();
  const std::string first = mcap_records({kSaid[0]}, topics);
  const std::string rest = mcap_records({kSaid[1], kSaid[2]}, topics);
  expect_messages(folder.write("two.mcap", mcap_file(mcap_chunk("", first, first.size()) +
                                                     mcap_chunk("", rest, rest.size()))));
  EXPECT_TRUE(contents_of(folder.write("none.mcap", mcap_file(""))).empty());
}

// Oracle: the writer, whose files are tested against the specification (io/mcap).
TEST(McapRecording, ReadsWhatIsWritten) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "a.mcap";
  std::vector<Said> said;
  {
    McapFile file(path, "ros2");
    const auto channel = file.add_channel({"/c", "cdr", "pkg/msg/C", "ros2msg", "d"});
    for (std::uint64_t k = 0; k < 7; ++k) {  // more than a chunk
      said.push_back({"/c", "pkg/C", k, std::string(1'000'000, static_cast<char>('a' + k))});
      file.add_message(channel, k, said.back().bytes);
    }
    file.finish();
  }
  expect_messages(path, said);
}

TEST(McapRecording, DamageIsAnError) {
  const TemporaryFolder folder;
  const std::string whole = mcap_of(kSaid);
  const auto read = [&](const std::string& content) {
    const auto path = folder.write("a.mcap", content);
    return [path] { contents_of(path); };
  };
  expect_error(ErrorKind::data, {"a.mcap", "first bytes"}, read("no recording at all"));
  // Wherever a recording is cut off.
  for (std::size_t size = 8; size < whole.size(); size += 37)
    expect_error(ErrorKind::data, {"a.mcap"}, read(whole.substr(0, size)));
  std::vector<std::string> topics;
  const std::string records = mcap_records(kSaid, topics);
  expect_error(ErrorKind::data, {"checksum"},
               read(mcap_file(mcap_chunk("", records, records.size(), 12345))));
  expect_error(ErrorKind::data, {"expected"},
               read(mcap_file(mcap_chunk("", records, records.size() + 1))));
  expect_error(ErrorKind::data, {"'snappy'", "zstd"},
               read(mcap_file(mcap_chunk("snappy", records, records.size()))));
  expect_error(ErrorKind::data, {"expected at most"},
               read(mcap_file(mcap_chunk("zstd", records, std::uint64_t{1} << 40))));
  const std::string orphan = bags_test::mcap_record(5, std::string(22, '\3'));
  expect_error(ErrorKind::data, {"channel 771"}, read(mcap_file(orphan)));
}

// Oracle: bags put together by the letter of the specification.
TEST(RosbagRecording, ChunksAndLooseRecordsGiveTheirMessages) {
  const TemporaryFolder folder;
  expect_messages(folder.write("chunk.bag", bags_test::bag_of(kSaid)));
  std::vector<std::string> topics;
  expect_messages(
      folder.write("loose.bag", bags_test::bag_file(bags_test::bag_records(kSaid, topics))));
  EXPECT_TRUE(contents_of(folder.write("none.bag", bags_test::bag_file(""))).empty());
}

TEST(RosbagRecording, DamageIsAnError) {
  const TemporaryFolder folder;
  const std::string whole = bags_test::bag_of(kSaid);
  const auto read = [&](const std::string& content) {
    const auto path = folder.write("a.bag", content);
    return [path] { contents_of(path); };
  };
  expect_error(ErrorKind::data, {"a.bag", "2.0"}, read("#ROSBAG V1.2\n"));
  expect_error(ErrorKind::data, {"a.bag", "no bag header"}, read("#ROSBAG V2.0\n"));
  for (std::size_t size = 13; size < whole.size(); size += 37)
    expect_error(ErrorKind::data, {"a.bag"}, read(whole.substr(0, size)));
  const std::size_t head = bags_test::bag_record({}, "").size() + bags_test::bag_file("").size();
  expect_error(ErrorKind::data, {"number of chunks"},
               read(whole.substr(0, head - bags_test::bag_record({}, "").size())));
  expect_error(ErrorKind::data, {"not closed"}, read(bags_test::bag_file("", 0)));
  std::vector<std::string> topics;
  const std::string records = bags_test::bag_records(kSaid, topics);
  expect_error(ErrorKind::data, {"expected"},
               read(bags_test::bag_file(bags_test::bag_chunk("none", records, 5))));
  const auto none = [](const char* op, const std::string& name) {
    return bags_test::bag_file(bags_test::bag_record({{"op", op}, {name, "12345678"}}, ""));
  };
  expect_error(ErrorKind::data, {"'conn'"}, read(none("\2", "time")));
  expect_error(ErrorKind::data, {"'conn'", "8 bytes, expected 4"}, read(none("\2", "conn")));
  expect_error(ErrorKind::data, {"'op'"}, read(bags_test::bag_file(bags_test::bag_record({}, ""))));
}

/// Runs code that needs SQLite; without it, expects the error for that.
template <class F>
void with_sqlite(F&& action) {
  try {
    action();
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::unavailable) throw;
    EXPECT_NE(std::string(error.what()).find("libsqlite3-dev"), std::string::npos);
  }
}

const std::vector<Said> kMessagesInDb3 = {{"/a", "pkg/msg/One", 5, "first"},
                                          {"/b", "pkg/msg/Two", 7, std::string(30, 'x')},
                                          {"/a", "pkg/msg/One", 9, ""}};

// Oracle: what was put into the database with SQLite's own program.
TEST(SqliteRecording, GivesItsMessages) {
  const TemporaryFolder folder;
  with_sqlite(
      [&] { expect_messages(folder.write("a.db3", bags_test::small_db3()), kMessagesInDb3); });
  const std::filesystem::path text = folder.write("b.db3", "this is no database, but some text");
  const Error error = io_test::error_of([&] { contents_of(text); });
  EXPECT_TRUE(error.kind() == ErrorKind::data || error.kind() == ErrorKind::unavailable);
  EXPECT_NE(std::string(error.what()).find("b.db3"), std::string::npos) << error.what();
}

TEST(Ros2Bag, AFolderIsItsFilesInTheirOrder) {
  const TemporaryFolder folder;
  const std::filesystem::path bag = folder.path() / "drive";
  std::filesystem::create_directories(bag);
  const auto describe = [&](const std::string& files, const std::string& more = "") {
    io_test::write_bytes(bag / "metadata.yaml",
                         "rosbag2_bagfile_information:\n  version: 5\n"
                         "  relative_file_paths:\n" +
                             files + "  duration:\n    - 7\n" + more);
  };
  io_test::write_bytes(bag / "drive_0.mcap", mcap_of({kSaid[0]}));
  io_test::write_bytes(bag / "drive_1.mcap", mcap_of({kSaid[1], kSaid[2]}));
  EXPECT_FALSE(is_recording(bag));
  describe("    - drive_0.mcap\n    - \"drive_1.mcap\"\n", "  compression_mode: \"\"\n");
  EXPECT_TRUE(is_recording(bag));
  expect_messages(bag);
  describe("    - drive/drive_0.mcap\n    - drive/drive_1.mcap\n");  // version 3
  expect_messages(bag);
  describe("  - drive_1.mcap\n");
  EXPECT_EQ(contents_of(bag).size(), 2U);
  const auto read = [&] { contents_of(bag); };
  describe("    - absent.mcap\n");
  expect_error(ErrorKind::no_input, {"absent.mcap"}, read);
  describe("    - drive_0.txt\n");
  expect_error(ErrorKind::data, {".mcap, .bag, .db3"}, read);
  describe("    - ../other/drive_0.mcap\n");
  expect_error(ErrorKind::data, {"metadata.yaml:4", "../other"}, read);
  describe("");
  expect_error(ErrorKind::data, {"relative_file_paths"}, read);
  describe("    - drive_0.mcap\n", "  compression_mode: CHUNK\n");
  expect_error(ErrorKind::data, {"CHUNK", "ros2 bag convert"}, read);
}

/// A frame of zstd (RFC 8878) of at most 128 KiB: one segment with its size, one raw block.
std::string zstd_frame(const std::string& bytes) {
  const auto size = static_cast<std::uint32_t>(bytes.size());
  std::string frame("\x28\xb5\x2f\xfd\xa0", 5);
  for (int k = 0; k < 4; ++k) frame += static_cast<char>(size >> (8 * k));
  const std::uint32_t block = size << 3 | 1;  // the last one
  for (int k = 0; k < 3; ++k) frame += static_cast<char>(block >> (8 * k));
  return frame + bytes;
}

/// Runs code that needs zstd; without it, expects the error for that.
template <class F>
void with_zstd(F&& action) {
  try {
    action();
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::unavailable) throw;
    EXPECT_NE(std::string(error.what()).find("libzstd-dev"), std::string::npos);
  }
}

// Oracle: the same bag as it is.
TEST(Ros2Bag, CompressedFilesLeaveNothingBehind) {
  const TemporaryFolder folder, unpacked;
  ASSERT_EQ(setenv("TMPDIR", unpacked.path().c_str(), 1), 0);
  const std::string plain = mcap_of(kSaid);
  with_zstd([&] {
    const auto path = folder.write("drive.mcap.zstd", zstd_frame(plain));
    EXPECT_TRUE(is_recording(path));
    expect_messages(path);
    // Consecutive frames.
    expect_messages(folder.write("parts.MCAP.zst",
                                 zstd_frame(plain.substr(0, 100)) + zstd_frame(plain.substr(100))));
    io_test::write_bytes(folder.path() / "metadata.yaml",
                         "rosbag2_bagfile_information:\n  version: 4\n  relative_file_paths:\n"
                         "    - drive.mcap.zstd\n  compression_format: zstd\n"
                         "  compression_mode: FILE\n");
    expect_messages(folder.path());
    const auto refused = [&](const std::string& bytes, std::vector<std::string> words) {
      const auto broken = folder.write("broken.mcap.zstd", bytes);
      words.push_back(broken.string());
      expect_error(ErrorKind::data, words, [&] { contents_of(broken); });
    };
    const std::string whole = zstd_frame(plain);
    refused(whole.substr(0, whole.size() - 1), {"end early"});
    refused(whole.substr(0, 3), {"end early"});
    refused("this is not zstd but some text", {"damaged zstd data"});
    refused(whole + "more", {"damaged"});
    // Errors inside name the file of the user.
    refused(zstd_frame(plain.substr(0, plain.size() / 2)), {"(decompressed)"});
  });
  EXPECT_TRUE(std::filesystem::is_empty(unpacked.path()));
  ASSERT_EQ(setenv("TMPDIR", (unpacked.path() / "absent").c_str(), 1), 0);
  EXPECT_THROW(contents_of(folder.path() / "drive.mcap.zstd"), Error);
  ASSERT_EQ(unsetenv("TMPDIR"), 0);
}

// Oracle: the same messages as they are.
TEST(Ros2Bag, MessagesCompressedOneByOne) {
  const TemporaryFolder folder;
  std::vector<Said> packed = kSaid;
  for (Said& said : packed) said.bytes = zstd_frame(said.bytes);
  const auto describe = [&](const std::string& format) {
    io_test::write_bytes(folder.path() / "metadata.yaml",
                         "rosbag2_bagfile_information:\n  version: 5\n  relative_file_paths:\n"
                         "    - drive.mcap\n  compression_format: " +
                             format + "\n  compression_mode: message\n");
  };
  describe("zstd");
  with_zstd([&] {
    folder.write("drive.mcap", mcap_of(packed));
    expect_messages(folder.path());
    packed[1].bytes.pop_back();
    folder.write("drive.mcap", mcap_of(packed));
    expect_error(ErrorKind::data, {"drive.mcap", "/b", "end early"},
                 [&] { contents_of(folder.path()); });
    folder.write("drive.mcap", mcap_of(kSaid));
    expect_error(ErrorKind::data, {"drive.mcap", "/a", "damaged"},
                 [&] { contents_of(folder.path()); });
    describe("lz4");
    expect_error(ErrorKind::data, {"drive.mcap", "lz4", "zstd"},
                 [&] { contents_of(folder.path()); });
  });
}

// Nothing broken escapes but as an Error, and every message that a file gives can be read again.
TEST(Recording, BrokenFilesAreErrors) {
  const TemporaryFolder folder;
  std::vector<std::string> topics;
  const std::string records = mcap_records(kSaid, topics);
  const std::pair<std::string, std::string> seeds[] = {
      {"a.mcap", mcap_of(kSaid)},
      {"a.mcap", mcap_file(records)},
      {"a.mcap", mcap_file(mcap_chunk("zstd", kPackedZeros[0].bytes, 1000))},
      {"a.mcap", mcap_file(mcap_chunk("lz4", kPackedZeros[1].bytes, 1000))},
      {"a.bag", bags_test::bag_of(kSaid)},
      {"a.bag", bags_test::bag_file(bags_test::bag_chunk("bz2", kPackedZeros[2].bytes, 1000))},
      {"a.bag", bags_test::bag_file(bags_test::bag_chunk("lz4", kPackedZeros[1].bytes, 1000))},
      {"a.db3", bags_test::small_db3()}};
  io_test::Mutator mutator(20240711);
  std::size_t read = 0, refused = 0;
  for (int round = 0; round < 400; ++round) {
    for (const auto& [name, content] : seeds) {
      const auto path = folder.write(name, mutator.mutate(content, seeds[0].second));
      try {
        contents_of(path);
        ++read;
      } catch (const Error& error) {
        ++refused;
        EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
      }
    }
  }
  EXPECT_GT(read, 100U);
  EXPECT_GT(refused, 1000U);
}

TEST(Unpack, ReadsDataOfOtherPrograms) {
  for (const PackedZeros& packed : kPackedZeros) {
    std::string found;
    try {
      found = unpack(packed.packing, packed.bytes, 1000, "x");
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::unavailable) continue;  // built without that library
      throw;
    }
    EXPECT_EQ(found, std::string(1000, '\0')) << packed.packing;
    for (const std::uint64_t size : {std::uint64_t{999}, std::uint64_t{1001}, std::uint64_t{0},
                                     kMaxChunkBytes, kMaxChunkBytes + 1})
      expect_error(ErrorKind::data, {"x"},
                   [&] { unpack(packed.packing, packed.bytes, size, "x"); });
    for (std::size_t size = 0; size + 4 < packed.bytes.size(); ++size)
      expect_error(ErrorKind::data, {"x"},
                   [&] { unpack(packed.packing, packed.bytes.substr(0, size), 1000, "x"); });
  }
}

}  // namespace
}  // namespace adasplats
