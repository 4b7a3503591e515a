// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/text/obj.h"

#include <gtest/gtest.h>

#include "adasplats/io/base/files_test.h"

namespace adasplats {
namespace {

using io_test::values_of;
using Doubles = std::vector<double>;
using Indices = std::vector<std::uint32_t>;

MeshTable read_obj_text(const std::string& content) {
  const TemporaryFolder folder;
  return read_obj_mesh(folder.write("a file.obj", content));
}

bool recognised(const std::string& content) {
  const TemporaryFolder folder;
  return is_obj(folder.write("file", content));
}

constexpr const char* kFourVertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

// Oracle of the tests below: the indices as the Wavefront specification (1992) counts them.
TEST(Obj, TrianglesWithEveryKindOfCorner) {
  const MeshTable mesh = read_obj_text(
      "# a comment\nmtllib x.mtl\no thing\nv 1 2 3\nv 4e0 -5 +6 1.0\r\nv 7 8 9 0.5 0.5 0.5\n"
      "vt 0 0\nvn 0 0 1\ng group\nusemtl m\ns off\nf 1 2 3\nf 1/1 2/1 3/1\nf 3//1 2//1 1//1\n"
      "f 1/1/1 3/1/1 2/1/1 # a comment\n");
  EXPECT_EQ(values_of(mesh.vertices, "x"), (Doubles{1, 4, 7}));
  EXPECT_EQ(values_of(mesh.vertices, "y"), (Doubles{2, -5, 8}));
  EXPECT_EQ(values_of(mesh.vertices, "z"), (Doubles{3, 6, 9}));
  EXPECT_EQ(mesh.triangle_vertices, (Indices{0, 1, 2, 0, 1, 2, 2, 1, 0, 0, 2, 1}));
  EXPECT_EQ(mesh.faces.rows, 4U);
}

TEST(Obj, PolygonsBecomeFans) {
  const MeshTable mesh =
      read_obj_text("v 0 0 0\nv 1 0 0\nv 2 1 0\nv 1 2 0\nv 0 2 0\nf 1 2 3 4 5\nf 5 4 3 2\n");
  EXPECT_EQ(mesh.triangle_vertices, (Indices{0, 1, 2, 0, 2, 3, 0, 3, 4, 4, 3, 2, 4, 2, 1}));
}

TEST(Obj, NegativeIndicesCountFromTheLastVertexSoFar) {
  const MeshTable mesh =
      read_obj_text(std::string(kFourVertices) + "f -4 -3 -2\nv 5 5 5\nf -1/-1 -5 -4\n");
  EXPECT_EQ(mesh.triangle_vertices, (Indices{0, 1, 2, 4, 0, 1}));
}

TEST(Obj, VerticesMayFollowAndLinesMayContinue) {
  const MeshTable mesh = read_obj_text("f 1 2 \\\n  3\nv 0 0 0\nv 1 0 0\nv 0 \\\r\n 1 0\n\n");
  EXPECT_EQ(mesh.triangle_vertices, (Indices{0, 1, 2}));
  EXPECT_EQ(values_of(mesh.vertices, "y"), (Doubles{0, 0, 1}));
}

TEST(Obj, VerticesWithoutFaces) {
  const MeshTable mesh = read_obj_text("v 1 2 3");
  EXPECT_EQ(mesh.vertices.rows, 1U);
  EXPECT_EQ(mesh.faces.rows, 0U);
}

TEST(Obj, BrokenFilesAreErrorsWithLines) {
  const auto bad = [](const std::string& content, const std::vector<std::string>& parts) {
    expect_error(ErrorKind::data, parts, [&] { read_obj_text(content); });
  };
  const std::string good = kFourVertices;
  bad(good + "f 1 2\n", {"a file.obj:5:", "3 corners", "2"});
  bad(good + "f\n", {":5:", "found 0"});
  bad(good + "f 1 2 5\n", {":5:", "vertex 5", "4 vertices"});
  bad(good + "f 1 2 -5\n", {":5:", "'-5'"});
  bad(good + "f 1 2 0\n", {":5:", "'0'"});
  bad(good + "f 1 2 x/1\n", {":5:", "'x/1'"});
  bad(good + "f 1 2 1.5\n", {":5:", "'1.5'"});
  bad(good + "f 1 2 99999999999\n", {":5:", "99999999999"});
  bad(good + "f 1 2 4294967295\n", {":5:", "4294967295"});
  bad(good + "f 1 2 -9223372036854775808\n", {":5:"});
  bad(good + "\nv 1 nan 2\n", {":6:", "vertex 5", "y", "'nan'"});
  bad(good + "v 1 inf 2\n", {":5:", "'inf'"});
  bad(good + "v 1 2\n", {":5:", "z", "''"});
  bad("# nothing\n", {"no vertices"});
  bad("", {"empty"});
  expect_error(ErrorKind::no_input, {"none.obj"}, [] { read_obj_mesh("none.obj"); });
}

TEST(Obj, RecognizedByTheContent) {
  EXPECT_TRUE(recognised("v 1 2 3\n"));
  EXPECT_TRUE(recognised("# Blender\n\n  mtllib a.mtl\n"));
  EXPECT_TRUE(recognised("# caf\xc3\xa9\ro name\r"));
  EXPECT_FALSE(recognised("1 2 3\n4 5 6\n"));
  EXPECT_FALSE(recognised("x y z\n4 5 6\n"));
  EXPECT_FALSE(recognised("ply\nformat ascii 1.0\n"));
  EXPECT_FALSE(recognised("# only a comment"));
  EXPECT_FALSE(recognised(std::string("v 1 2 3\n\0", 9)));
}

}  // namespace
}  // namespace adasplats
