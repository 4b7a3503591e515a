// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/ply/ply.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "adasplats/io/base/files_test.h"

namespace adasplats {
namespace {

using io_test::big_endian;
using io_test::bytes_of;
using io_test::values_of;
using Doubles = std::vector<double>;

Table read_ply_bytes(const std::string& content) {
  const TemporaryFolder folder;
  return read_ply(folder.write("file.ply", content));
}

MeshTable read_mesh(const std::string& content) {
  const TemporaryFolder folder;
  return read_ply_mesh(folder.write("file.ply", content));
}

void expect_ply_error(const std::string& content, const std::vector<std::string>& parts) {
  expect_error(ErrorKind::data, parts, [&] { read_ply_bytes(content); });
}

const std::string kXyzFloat = "property float x\nproperty float y\nproperty float z\n";
const std::string kBinary = "ply\nformat binary_little_endian 1.0\n";
const std::string kAscii = "ply\nformat ascii 1.0\n";

TEST(Ply, AsciiOfEveryType) {
  const Table table = read_ply_bytes(
      kAscii +
      "comment hello there\nobj_info more\nelement vertex 2\n"
      "property char a\nproperty uint8 b\nproperty short c\nproperty uint16 d\nproperty int e\n"
      "property uint f\nproperty float32 g\nproperty double h\nend_header\n"
      "-128 255 -32768 65535 -2147483648 4294967295 1.5 -1e300\n"
      " 127\t0.0 +1 2 3 4e0 nan -inf  \n");
  EXPECT_EQ(table.rows, 2U);
  EXPECT_EQ(table.comments, (std::vector<std::string>{"hello there", "more"}));
  EXPECT_EQ(values_of(table, "a"), (Doubles{-128, 127}));
  EXPECT_EQ(values_of(table, "b"), (Doubles{255, 0}));
  EXPECT_EQ(values_of(table, "c"), (Doubles{-32768, 1}));
  EXPECT_EQ(values_of(table, "d"), (Doubles{65535, 2}));
  EXPECT_EQ(values_of(table, "e"), (Doubles{-2147483648.0, 3}));
  EXPECT_EQ(values_of(table, "f"), (Doubles{4294967295.0, 4}));
  EXPECT_EQ(values_of(table, "g")[0], 1.5);
  EXPECT_TRUE(std::isnan(values_of(table, "g")[1]));
  EXPECT_EQ(values_of(table, "h"), (Doubles{-1e300, -std::numeric_limits<double>::infinity()}));
  EXPECT_TRUE(std::holds_alternative<std::vector<std::int8_t>>(table.find("a")->values));
  EXPECT_TRUE(std::holds_alternative<std::vector<float>>(table.find("g")->values));
  EXPECT_EQ(table.find("no such"), nullptr);
}

TEST(Ply, BinaryOfBothByteOrdersWithOtherElementsAround) {
  const std::string elements =
      "element other 2\nproperty list uchar short w\nproperty double v\n"
      "element vertex 2\nproperty double x\nproperty uchar s\nproperty short t\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const auto body = [](auto&& encode) {
    using U8 = std::uint8_t;
    using I16 = std::int16_t;
    return encode(U8{2}) + encode(I16{7}) + encode(I16{8}) + encode(9.0) +  // other 0
           encode(U8{0}) + encode(10.0) +                                   // other 1
           encode(600000.125) + encode(U8{200}) + encode(I16{-2}) +         // vertex 0
           encode(-1.0) + encode(U8{1}) + encode(I16{300});                 // vertex 1
  };
  const Table little =
      read_ply_bytes(kBinary + elements + body([](auto v) { return bytes_of(v); }));
  const Table big = read_ply_bytes("ply\nformat binary_big_endian 1.0\n" + elements +
                                   body([](auto v) { return big_endian(v); }));
  for (const Table& table : {little, big}) {
    EXPECT_EQ(values_of(table, "x"), (Doubles{600000.125, -1}));
    EXPECT_EQ(values_of(table, "s"), (Doubles{200, 1}));
    EXPECT_EQ(values_of(table, "t"), (Doubles{-2, 300}));
  }
}

TEST(Ply, ListInsideTheVertexElementIsSteppedOver) {
  const std::string header =
      "element vertex 2\nproperty float x\nproperty list uchar int l\n"
      "property uchar c\nend_header\n";
  const Table binary =
      read_ply_bytes(kBinary + header + bytes_of(1.5F) + "\x02" + bytes_of(5) + bytes_of(6) +
                     "\x07" + bytes_of(2.5F) + std::string(1, '\0') + "\x08");
  const Table ascii = read_ply_bytes(kAscii + header + "1.5 2 5 6 7\n2.5 0 8\n");
  for (const Table& table : {binary, ascii}) {
    EXPECT_EQ(values_of(table, "x"), (Doubles{1.5, 2.5}));
    EXPECT_EQ(values_of(table, "c"), (Doubles{7, 8}));
    EXPECT_EQ(table.columns.size(), 2U);
  }
}

// Fault 6: where the header ends decides where the values begin.
TEST(Ply, LineEndsOfTheHeader) {
  const auto with_line_end = [](const std::string& end) {
    std::string text;
    for (const char* line : {"ply", "format binary_little_endian 1.0", "element vertex 1",
                             "property int x", "end_header"})
      text += line + end;
    return text;
  };
  // 0x0a0d0a is a body that begins with newlines: bytes 0a 0d 0a 00.
  for (const int value : {1, 0x0a0d0a, 0x0d0a0d, 0x0a0a0a0a}) {
    for (const char* end : {"\n", "\r\n", "\r"}) {
      const Table table = read_ply_bytes(with_line_end(end) + bytes_of(value));
      EXPECT_EQ(values_of(table, "x"), Doubles{static_cast<double>(value)});
    }
  }
  EXPECT_EQ(values_of(read_ply_bytes("ply\rformat ascii 1.0\relement vertex 2\rproperty int x\r"
                                     "end_header\r4\r5\r"),
                      "x"),
            (Doubles{4, 5}));
  EXPECT_EQ(
      values_of(read_ply_bytes("ply\r\nformat ascii 1.0\r\nelement vertex 2\r\nproperty int x\r\n"
                               "end_header\r\n4\r\n\r\n5"),
                "x"),
      (Doubles{4, 5}));
}

TEST(Ply, ZeroRecords) {
  for (const std::string& start : {kAscii, kBinary})
    EXPECT_EQ(read_ply_bytes(start + "element vertex 0\n" + kXyzFloat + "end_header\n").rows, 0U);
}

// Fault 1.
TEST(Ply, FewerRecordsThanTheHeaderStates) {
  const std::string header = "element vertex 2\n" + kXyzFloat + "end_header\n";
  expect_ply_error(kBinary + header + std::string(23, '\1'),
                   {"file.ply", "byte", "room for 1", "states 2"});
  expect_ply_error(kAscii + header + "1 2 3\n", {"file.ply", "states 2"});
  expect_ply_error(kAscii + header + "1 2 3            \n", {"file.ply:", "after 1", "states 2"});
  expect_ply_error(kAscii + header + "1 2 3\n4 5\n6\n", {"file.ply:9", "'z'", "end of the line"});
}

// Fault 2, and other broken headers.
TEST(Ply, BrokenHeaders) {
  expect_ply_error(kAscii + "element vertex 1\n" + kXyzFloat, {"end_header"});
  expect_ply_error(kAscii + "element vertex 1\n" + kXyzFloat + "1 2 3\n", {"file.ply:7", "'1'"});
  expect_ply_error("ply\nend_header\n", {"no 'format'"});
  expect_ply_error("plx\n", {"'plx'", "'ply'"});
  expect_ply_error("ply\nformat binary 1.0\n", {"file.ply:2", "'binary'"});
  expect_ply_error("ply\nformat ascii 2.0\n", {"'2.0'", "1.0"});
  expect_ply_error(kAscii + "property float x\n", {"before the first element"});
  expect_ply_error(kAscii + "element vertex 1\nproperty real x\n", {"'real'"});
  expect_ply_error(kAscii + "element vertex 1\nproperty float\n", {"without a name"});
  expect_ply_error(kAscii + "element vertex 1\nproperty int x\nproperty int x\n", {"twice"});
  expect_ply_error(kAscii + "element vertex 1\nelement vertex 1\n", {"twice"});
  expect_ply_error(kAscii + "element vertex 1\nend_header\n1\n", {"no properties"});
  expect_ply_error(kAscii + "element points 1\nproperty int x\nend_header\n1\n", {"'vertex'"});
  expect_ply_error("", {"empty"});
}

// Fault 3: counts are rejected before allocation; products of sizes would wrap.
TEST(Ply, HugeCounts) {
  for (const char* count : {"4294967295", "9223372036854775808", "18446744073709551615",
                            "1537228672809129302" /* x 12 wraps to 8 */}) {
    const std::string header = "element vertex " + std::string(count) + "\n" + kXyzFloat;
    const std::string list = "property list uchar int l\n";
    for (const std::string& start : {kAscii, kBinary}) {
      expect_ply_error(start + header + "end_header\n" + std::string(1000, '1'), {count});
      expect_ply_error(start + header + list + "end_header\n" + std::string(1000, '1'), {count});
    }
    const std::string before = "element other " + std::string(count) + "\nproperty double a\n";
    expect_ply_error(kBinary + before + header + "end_header\n" + std::string(100, '1'), {count});
    expect_ply_error(kAscii + before + header + "end_header\n1\n1\n", {"after 2"});
  }
  for (const char* count : {"-1", "1.5", "18446744073709551616", "", "0x10"})
    expect_ply_error(kBinary + "element vertex " + count + "\n", {"file.ply:3", "count"});
}

// Fault 4.
TEST(Ply, BadListLengths) {
  const std::string vertices = "element vertex 3\nproperty uchar x\n";
  const auto faces = [&](const std::string& list) {
    return vertices + "element face 1\nproperty list " + list + " vertex_indices\nend_header\n";
  };
  const auto expect = [](const std::string& content, const std::vector<std::string>& parts) {
    expect_error(ErrorKind::data, parts, [&] { read_mesh(content); });
  };
  const std::string xs = "\1\2\3";
  expect(kBinary + faces("int int") + xs + bytes_of(-1) + bytes_of(0), {"found -1"});
  expect(kBinary + faces("int int") + xs + bytes_of(2147483647) + bytes_of(0), {"2147483647"});
  expect(kBinary + faces("uint uchar") + xs + bytes_of(0xffffffffU) + "123", {"4294967295"});
  expect(kBinary + faces("float int") + xs, {"real number"});
  expect(kBinary + faces("uchar float") + xs + "\3" + std::string(12, '\0'), {"real numbers"});
  expect(kBinary + faces("uchar int") + xs + "\2" + bytes_of(0) + bytes_of(1), {"face 0", "3"});
  expect(kBinary + faces("uchar char") + xs + "\3" + std::string("\0\1\xff", 3), {"found -1"});
  expect(kBinary + faces("uchar char") + xs + "\3" + std::string("\0\1\3", 3), {"index 3"});
  expect(kBinary + faces("uchar int") + xs + "\3" + bytes_of(0) + bytes_of(1), {"room for 2"});
  expect(kAscii + faces("uchar int") + "1\n2\n3\n-3 0 1 2\n", {"file.ply:11", "'-3'"});
  expect(kAscii + faces("uchar int") + "1\n2\n3\n3 0 1\n", {"file.ply:11", "end of the line"});
  expect(kAscii + faces("uchar int") + "1\n2\n3\n4294967296 0 1\n", {"file.ply:11"});
  expect(kAscii + faces("uchar int") + "1\n2\n3\n3 0 1 2 3\n", {"'3' after the last"});
}

// Fault 5.
TEST(Ply, BadTokens) {
  const auto with = [](const char* type, const char* token) {
    return kAscii + "element vertex 1\nproperty " + type + " x\nend_header\n" + token + "\n";
  };
  for (const char* token : {"256", "-1", "1.5", "abc", "0x10", "1e3", "1,5", "nan", "--1", "+-1"})
    expect_ply_error(with("uchar", token), {"file.ply:6", "'x'", token});
  for (const char* token : {"1e39", "abc", "1..2", "1,5", "1.5f", "+", "1e400", "-1e400"})
    expect_ply_error(with("float", token), {"file.ply:6", "'x'", token});
  expect_ply_error(with("int", "2147483648"), {"'2147483648'"});
  expect_ply_error(with("int", "1 2"), {"'2' after the last"});
  EXPECT_EQ(values_of(read_ply_bytes(with("float", "1e-60")), "x"), Doubles{0});
  EXPECT_EQ(values_of(read_ply_bytes(with("double", "-1e-400")), "x"), Doubles{-0.0});
  EXPECT_EQ(values_of(read_ply_bytes(with("float", "1e-40")), "x"),
            Doubles{static_cast<double>(1e-40F)});
  EXPECT_EQ(values_of(read_ply_bytes(with("float", "-1.#INF")), "x"),
            Doubles{-std::numeric_limits<double>::infinity()});
  EXPECT_TRUE(std::isnan(values_of(read_ply_bytes(with("double", "1.#QNAN")), "x")[0]));
}

// Fault 9.
TEST(Ply, FilesThatAreNotPly) {
  const TemporaryFolder folder;
  expect_error(ErrorKind::no_input, {"missing.ply"},
               [&] { read_ply(folder.path() / "missing.ply"); });
  expect_error(ErrorKind::no_input, {"folder"}, [&] { read_ply(folder.path()); });
  const std::filesystem::path fifo = folder.path() / "fifo.ply";
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  expect_error(ErrorKind::no_input, {"FIFO"}, [&] { read_ply(fifo); });
}

TEST(PlyMesh, PolygonsAreFannedAndTheirPropertiesRepeated) {
  const MeshTable mesh =
      read_mesh(kAscii +
                "comment c\nelement face 3\nproperty uchar class\n"
                "property list uchar int vertex_index\nproperty list uchar float texcoord\n"
                "element vertex 5\nproperty float x\nend_header\n"
                "7 3 0 1 2 0\n8 5 0 1 2 3 4 2 0.5 0.5\n9 4 4 3 2 1 0\n1\n2\n3\n4\n5\n");
  EXPECT_EQ(mesh.triangle_vertices,
            (std::vector<std::uint32_t>{0, 1, 2, 0, 1, 2, 0, 2, 3, 0, 3, 4, 4, 3, 2, 4, 2, 1}));
  EXPECT_EQ(mesh.faces.rows, 6U);
  EXPECT_EQ(values_of(mesh.faces, "class"), (Doubles{7, 8, 8, 8, 9, 9}));
  EXPECT_EQ(values_of(mesh.vertices, "x"), (Doubles{1, 2, 3, 4, 5}));
  EXPECT_EQ(mesh.vertices.comments, std::vector<std::string>{"c"});
}

TEST(PlyMesh, ManyPropertiesOfALongPolygonDoNotTakeMoreThanTheFileAllows) {
  std::string header = kAscii + "element vertex 1\nproperty uchar x\nelement face 1\n";
  std::string record;
  for (int k = 0; k < 2000; ++k) {
    header += "property double p" + std::to_string(k) + "\n";
    record += "1 ";
  }
  record += "20000";
  for (int k = 0; k < 20000; ++k) record += " 0";
  const std::string content =
      header + "property list int int vertex_indices\nend_header\n1\n" + record + "\n";
  expect_error(ErrorKind::data, {"16 times"}, [&] { read_mesh(content); });
}

TEST(PlyMesh, NeedsFacesWithCorners) {
  const std::string vertices = kAscii + "element vertex 1\nproperty uchar x\n";
  expect_error(ErrorKind::data, {"'face'"}, [&] { read_mesh(vertices + "end_header\n1\n"); });
  expect_error(ErrorKind::data, {"vertex_indices"},
               [&] { read_mesh(vertices + "element face 0\nproperty uchar c\nend_header\n1\n"); });
  const TemporaryFolder folder;
  const std::string faces = "\nproperty list uchar int vertex_indices\nend_header\n1\n";
  EXPECT_FALSE(ply_has_faces(folder.write("a.ply", vertices + "end_header\n1\n")));
  EXPECT_FALSE(ply_has_faces(folder.write("b.ply", vertices + "element face 0" + faces)));
  EXPECT_TRUE(ply_has_faces(folder.write("c.ply", vertices + "element face 1" + faces)));
}

// Fault 5 of an index: 2^32 in a uint64 list must not wrap to vertex 0.
TEST(PlyMesh, IndicesDoNotWrap) {
  const std::string content = kBinary +
                              "element vertex 3\nproperty uchar x\nelement face 1\n"
                              "property list uchar uint64 vertex_indices\nend_header\n\1\2\3\3" +
                              bytes_of(std::uint64_t{1} << 32) + bytes_of(std::uint64_t{1}) +
                              bytes_of(~std::uint64_t{0});
  expect_error(ErrorKind::data, {"4294967296"}, [&] { read_mesh(content); });
}

}  // namespace
}  // namespace adasplats
