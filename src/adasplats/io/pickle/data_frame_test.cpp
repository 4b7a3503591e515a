// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/pickle/data_frame.h"

#include <gtest/gtest.h>

#include <variant>
#include <vector>

#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/files_test.h"
#include "adasplats/io/base/mutator_test.h"
#include "adasplats/io/pickle/gzip.h"
#include "adasplats/io/pickle/pickle_samples_test.h"

namespace adasplats {
namespace {

using io_test::from_base64;
using io_test::values_of;
using Doubles = std::vector<double>;

Table frame_of(std::string_view base64) { return data_frame_of("f", from_base64(base64)); }

std::string our_frame() {
  return pickled_data_frame(std::vector<FrameColumn>{{"x", Doubles{1.5, 2}},
                                                     {"d", std::vector<std::int64_t>{-1, 1}},
                                                     {"b", std::vector<bool>{true, false}},
                                                     {"s", std::vector<std::string>{"ä", ""}}});
}

// Oracle: what pandas was given.
TEST(DataFrame, ReadsWhatPandasWrites) {
  for (const std::string_view sample :
       {io_test::kPandasFour, io_test::kPandasFive, io_test::kPandasOld}) {
    const Table table = frame_of(sample);
    ASSERT_EQ(table.rows, 2U);
    ASSERT_EQ(table.columns.size(), 3U);
    EXPECT_EQ(values_of(table, "x"), (Doubles{1.5, 2}));
    EXPECT_EQ(values_of(table, "t"), (Doubles{0.1, 0.2}));
    EXPECT_EQ(values_of(table, "d"), (Doubles{0, 1}));
    EXPECT_TRUE(std::holds_alternative<std::vector<std::int64_t>>(table.find("d")->values));
  }
  const Table rows = frame_of(io_test::kPandasRows);
  EXPECT_EQ(values_of(rows, "x"), (Doubles{1, 4}));
  EXPECT_EQ(values_of(rows, "z"), (Doubles{3, 6}));
  const Table mixed = frame_of(io_test::kPandasMixed);
  EXPECT_EQ(mixed.columns.size(), 2U);
  EXPECT_EQ(values_of(mixed, "w"), (Doubles{1, 0}));
  EXPECT_EQ(values_of(mixed, "k"), (Doubles{-1, 2}));
}

// Oracle: what pandas was given.
TEST(DataFrame, TextsOfPandas) {
  const FrameTable mixed = frame_table_of("f", from_base64(io_test::kPandasMixed));
  EXPECT_EQ(mixed.numbers.columns.size(), 2U);
  ASSERT_EQ(mixed.texts.size(), 1U);
  EXPECT_EQ(mixed.texts.at("s"), (std::vector<std::string>{"a", "b"}));
}

TEST(DataFrame, TextsThatWeWrite) {
  const FrameTable table = frame_table_of("f", our_frame());
  EXPECT_EQ(table.numbers.columns.size(), 3U);
  EXPECT_EQ(table.texts.at("s"), (std::vector<std::string>{"ä", ""}));
  const std::vector<FrameColumn> twice = {{"s", std::vector<std::string>{"a"}},
                                          {"s", std::vector<std::string>{"b"}}};
  expect_error(ErrorKind::data, {"two columns 's'"},
               [&] { frame_table_of("f", pickled_data_frame(twice)); });
}

// Oracle: round trip; tests/exports lets pandas read them.
TEST(DataFrame, ReadsWhatWeWrite) {
  const TemporaryFolder folder;
  for (const bool packed : {true, false}) {
    const auto path = folder.path() / "a.pkl.gz";
    write_file(path, packed ? gzipped(our_frame()) : our_frame());
    const Table table = read_data_frame(path);
    EXPECT_EQ(table.rows, 2U);
    EXPECT_EQ(values_of(table, "x"), (Doubles{1.5, 2}));
    EXPECT_EQ(values_of(table, "d"), (Doubles{-1, 1}));
    EXPECT_EQ(values_of(table, "b"), (Doubles{1, 0}));
    EXPECT_EQ(table.find("s"), nullptr);
  }
  const Table empty =
      data_frame_of("f", pickled_data_frame(std::vector<FrameColumn>{{"x", Doubles{}}}));
  EXPECT_EQ(empty.rows, 0U);
  EXPECT_EQ(data_frame_of("f", pickled_data_frame({})).columns.size(), 0U);
  const std::vector<FrameColumn> unequal = {{"x", Doubles{1}}, {"y", Doubles{}}};
  EXPECT_THROW(pickled_data_frame(unequal), std::logic_error);
}

// Oracle: the classic pickle that runs a command; nothing of it may happen but the error.
TEST(DataFrame, ExecutesNothing) {
  for (const char* const call : {"cposix\nsystem\nX\x04\0\0\0true\x85R.", "cos\nsystem\n."}) {
    const std::string pickle =
        std::string("\x80\x03") + (call[1] == 'p'
                                       ? std::string("cposix\nsystem\nX\x04\0\0\0true\x85R.", 26)
                                       : std::string(call));
    expect_error(ErrorKind::data, {"f: byte 2: contains '", "system'", "nothing was executed"},
                 [&] { data_frame_of("f", pickle); });
  }
  expect_error(ErrorKind::data, {"contains 'builtins.eval'"}, [&] {
    data_frame_of("f", std::string("\x80\x04\x8c\x08"
                                   "builtins\x8c\x04"
                                   "eval\x93."));
  });
}

TEST(DataFrame, NamesTheFault) {
  const auto fails = [](const std::string& pickle, const std::string& part) {
    expect_error(ErrorKind::data, {"f: ", part}, [&] { data_frame_of("f", pickle); });
  };
  fails("", "the pickle ends early");
  fails("\x80\x03N.", "holds no data frame");
  fails("\x80\x07N.", "protocol 7, expected 2 to 5");
  fails("\x80\x03P", "opcode 0x50");
  fails("\x80\x03R.", "nothing on the stack");
  fails("\x80\x03h\x05.", "nothing in the memo at 5");
  fails("\x80\x03" + std::string(1'000'001, 'N'), "more than a million opcodes");
  const std::string good = our_frame();
  for (std::size_t size = 0; size < good.size(); ++size)
    fails(good.substr(0, size), "the pickle ends early");
  std::string wrong = good;
  wrong.replace(wrong.find("<f8"), 3, ">f8");
  fails(wrong, "an array of type '>f8'");
  wrong = good;
  wrong.replace(wrong.find("<f8"), 3, "<f4");
  fails(wrong, "columns of 4 and of 2 rows");
}

// A value may be remembered and used again and again: that must not make much of little.
TEST(DataFrame, SharedValuesAreRejected) {
  const std::string values(8000, '\0');
  std::string pickle =
      "\x80\x03"
      "cpandas\nDataFrame\n}(";
  const auto name = [](int k) { return std::string("X\x03\0\0\0", 5) + std::to_string(100 + k); };
  pickle += name(0) + "cnumpy\nfrombuffer\nB" + std::string("\x40\x1f\0\0", 4) + values +
            std::string("X\x03\0\0\0", 5) + "<f8\x86Rq" + std::string(1, '\0');
  for (int k = 1; k < 500; ++k) pickle += name(k) + "h" + std::string(1, '\0');
  expect_error(ErrorKind::data, {"columns share their values"},
               [&] { data_frame_of("f", pickle + "u\x85R."); });
}

// Broken pickles, the same in each run: nothing but Error may escape, columns have equal lengths.
TEST(DataFrame, Fuzz) {
  const std::vector<std::string> seeds = {
      our_frame(), from_base64(io_test::kPandasFour), from_base64(io_test::kPandasFive),
      from_base64(io_test::kPandasOld), from_base64(io_test::kPandasMixed)};
  io_test::Mutator mutator(20261125);
  std::size_t read = 0, refused = 0;
  for (int round = 0; round < 4000; ++round) {
    const std::size_t k = static_cast<std::size_t>(round) % seeds.size();
    const std::string broken = mutator.mutate(seeds[k], seeds[(k + 1) % seeds.size()]);
    try {
      const Table table = data_frame_of("f", broken);
      for (const Column& column : table.columns) EXPECT_EQ(column.size(), table.rows);
      ++read;
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(read, 20U);
  EXPECT_GT(refused, 2000U);
}

// The same of gzipped files.
TEST(DataFrame, FuzzGzip) {
  const std::string packed = gzipped(our_frame());
  io_test::Mutator mutator(7);
  for (int round = 0; round < 1000; ++round) {
    try {
      gunzipped("f", mutator.mutate(packed, packed), 1 << 20);
    } catch (const Error&) {
      continue;
    }
  }
}

}  // namespace
}  // namespace adasplats
