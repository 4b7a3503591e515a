// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/mcap/mcap_file.h"

#include <gtest/gtest.h>

#include "adasplats/io/base/files_test.h"
#include "adasplats/io/mcap/mcap_records_test.h"

namespace adasplats {
namespace {

McapChannel channel(const std::string& topic) {
  return {topic, "cdr", "a/msg/" + topic, "ros2msg", "uint8 x\n"};
}

TEST(McapFile, NoMessages) {
  const TemporaryFolder folder;
  McapFile writer(folder.path() / "a.mcap", "ros2");
  writer.finish();
  const std::string bytes = read_file(folder.path() / "a.mcap");
  const mcap_test::File file = mcap_test::read(bytes);
  EXPECT_EQ(file.messages.size() + file.topics.size() + file.chunks, 0U);
  EXPECT_EQ(file.first_ns + file.last_ns, 0U);
}

// Oracle: the specification, read by mcap_records_test.h. A chunk closes at 4 MiB.
TEST(McapFile, ChunksOfTwoChannels) {
  const TemporaryFolder folder;
  McapFile writer(folder.path() / "a.mcap", "ros2");
  const std::uint16_t a = writer.add_channel(channel("a")), b = writer.add_channel(channel("b"));
  writer.add_channel(channel("silent"));
  const std::uint64_t start = 1'700'000'000'000'000'000;
  std::vector<std::string> sent;
  for (const std::size_t size : {0UL, 1UL, 3UL << 20, 1UL << 20, 9UL << 20, 7UL}) {
    sent.emplace_back(size, static_cast<char>('a' + sent.size()));
    writer.add_message(sent.size() % 2 == 0 ? a : b, start + sent.size(), sent.back());
  }
  writer.finish();
  const std::string bytes = read_file(folder.path() / "a.mcap");
  const mcap_test::File file = mcap_test::read(bytes);
  EXPECT_EQ(file.chunks, 3U);
  EXPECT_EQ(file.topics, (std::vector<std::string>{"a", "b", "silent"}));
  EXPECT_EQ(file.schema_names.at(1), "a/msg/b");
  EXPECT_EQ(file.first_ns, start + 1);
  EXPECT_EQ(file.last_ns, start + 6);
  ASSERT_EQ(file.messages.size(), sent.size());
  for (std::size_t i = 0; i < sent.size(); ++i) {
    EXPECT_TRUE(file.messages[i].data == sent[i]) << i;
    EXPECT_EQ(file.messages[i].channel, i % 2 == 1 ? a : b);
    EXPECT_EQ(file.messages[i].sequence, i / 2);
  }
}

TEST(McapFile, Metadata) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.mcap";
  McapFile writer(path, "ros2");
  const std::uint16_t a = writer.add_channel(channel("a"));
  writer.add_metadata("adasplats", "labels", "asprs");
  writer.add_message(a, 1, "x");
  writer.finish();
  EXPECT_EQ(read_mcap_metadata(path, "adasplats", "labels"), "asprs");
  EXPECT_EQ(read_mcap_metadata(path, "adasplats", "other"), "");
  EXPECT_EQ(read_mcap_metadata(path, "others", "labels"), "");
  EXPECT_EQ(read_mcap_metadata(folder.write("b.mcap", "no MCAP"), "adasplats", "labels"), "");
}

TEST(McapFile, UnknownChannelAndUnfinishedFile) {
  const TemporaryFolder folder;
  {
    McapFile writer(folder.path() / "a.mcap", "ros2");
    EXPECT_THROW(writer.add_message(0, 0, "x"), std::out_of_range);
  }
  EXPECT_EQ(folder.file_count(), 0U);
  expect_error(ErrorKind::cannot_create, {"no", "a.mcap"},
               [&] { McapFile(folder.path() / "no" / "a.mcap", "ros2"); });
}

}  // namespace
}  // namespace adasplats
