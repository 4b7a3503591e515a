// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/model/mesh_model.h"

#include <gtest/gtest.h>

#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/ply/ply.h"

namespace adasplats {
namespace {

using Corners = std::array<std::uint32_t, 3>;
using Classes = std::vector<std::uint16_t>;

MeshModel tetrahedron() {
  MeshModel model;
  model.mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  model.mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  model.mesh.classes = {40, 50, 80, 65535};
  model.label_scheme = "semantickitti";
  model.method = "by hand";
  return model;
}

void expect_equal(const MeshModel& found, const MeshModel& expected) {
  EXPECT_EQ(found.origin, expected.origin);
  EXPECT_EQ(found.mesh.vertices, expected.mesh.vertices);
  EXPECT_EQ(found.mesh.triangles, expected.mesh.triangles);
  EXPECT_EQ(found.mesh.classes, expected.mesh.classes);
  EXPECT_EQ(found.label_scheme, expected.label_scheme);
  EXPECT_EQ(found.method, expected.method);
}

TEST(MeshModel, RoundTrip) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "a mesh.ply";
  save_mesh(path, tetrahedron());
  EXPECT_TRUE(is_mesh_file(path));
  expect_equal(load_mesh(path), tetrahedron());
  EXPECT_EQ(load_mesh(path).view().primitive_count(), 4U);
}

TEST(MeshModel, RoundTripFarFromZeroWithoutClasses) {
  const TemporaryFolder folder;
  MeshModel model = tetrahedron();
  model.origin = {652000, 6861000, 0};
  model.mesh.classes.clear();
  model.label_scheme.clear();
  model.method.clear();
  save_mesh(folder.path() / "m.ply", model);
  expect_equal(load_mesh(folder.path() / "m.ply"), model);
}

TEST(MeshModel, RoundTripOfAnEmptyMesh) {
  const TemporaryFolder folder;
  save_mesh(folder.path() / "m.ply", {});
  expect_equal(load_mesh(folder.path() / "m.ply"), {});
}

std::string ply_with_class(const std::string& declaration, const std::string& value) {
  return "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty "
         "double z\nelement face 1\nproperty list uchar int vertex_indices\nproperty " +
         declaration + "\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 " + value + "\n";
}

// Oracle: the number in the file.
TEST(MeshModel, ClassesOfAnyTypeAndUsualName) {
  const TemporaryFolder folder;
  for (const char* type : {"uchar", "int", "ushort", "uint", "float", "double"})
    for (const char* name :
         {"class", "label", "semantic", "category", "Classification", "sem_class"}) {
      const auto path =
          folder.write("m.ply", ply_with_class(std::string(type) + " " + name, "252"));
      EXPECT_EQ(load_mesh(path).mesh.classes, Classes{252}) << type << " " << name;
    }
  EXPECT_EQ(load_mesh(folder.write("m.ply", ply_with_class("int quality", "7"))).mesh.classes,
            Classes{});
}

TEST(MeshModel, ClassesOutOfRange) {
  const TemporaryFolder folder;
  for (const char* value : {"-1", "65536", "1.5", "nan"})
    expect_error(ErrorKind::data, {"m.ply", "triangle 0", "class", "65535"},
                 [&] { load_mesh(folder.write("m.ply", ply_with_class("double class", value))); });
}

TEST(MeshModel, FilesOfOtherFormatsAreErrors) {
  const TemporaryFolder folder;
  std::string text = ply_with_class("int class", "1");
  text.insert(text.find("element"), "comment adasplats.mesh 1\n");
  EXPECT_EQ(load_mesh(folder.write("m.ply", text)).mesh.classes.size(), 1u);
  text.replace(text.find("mesh 1"), 6, "mesh 2");
  expect_error(ErrorKind::data, {"m.ply", "format version 2", "reads version 1"},
               [&] { load_mesh(folder.write("m.ply", text)); });
}

TEST(MeshModel, VerticesThatAreNotFinite) {
  const TemporaryFolder folder;
  std::string text = ply_with_class("int class", "1");
  text.replace(text.find("\n1 0 0\n"), 7, "\n1 nan 0\n");
  expect_error(ErrorKind::data, {"m.ply", "vertex 1"},
               [&] { load_mesh(folder.write("m.ply", text)); });
  text.replace(text.find("\n1 nan 0\n"), 9, "\n1 1e300 0\n");
  expect_error(ErrorKind::data, {"m.ply", "vertex"},
               [&] { load_mesh(folder.write("m.ply", text)); });
}

TEST(MeshModel, ObjIsRecognisedByItsContent) {
  const TemporaryFolder folder;
  const auto path = folder.write("mesh.txt",
                                 "v 3000000 0 0\nv 3000001 0 0\nv 3000001 1 0\nv 3000000 1 "
                                 "0\nf 1 2 3 4\n");
  EXPECT_TRUE(is_mesh_file(path));
  const MeshModel model = load_mesh(path);
  EXPECT_EQ(model.mesh.triangles, (std::vector<Corners>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(model.origin, (Vec3d{3000000, 0, 0}));
  EXPECT_EQ(model.mesh.vertices[1], (Vec3f{1, 0, 0}));
  EXPECT_TRUE(model.mesh.classes.empty());
}

TEST(MeshModel, GltfIsRecognisedByItsContent) {
  const TemporaryFolder folder;
  folder.write("triangle.bin", std::string("\0\0\0\0\0\0\0\0\0\0\0\0"      // (0, 0, 0)
                                           "\0\0\x80\x3f\0\0\0\0\0\0\0\0"  // (1, 0, 0)
                                           "\0\0\0\0\0\0\0\0\0\0\0\x40",   // (0, 0, 2)
                                           36));
  const auto path = folder.write("car.dat", R"({
    "asset": {"version": "2.0"},
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36, "uri": "triangle.bin"}]})");
  EXPECT_TRUE(is_mesh_file(path));
  const MeshModel model = load_mesh(path);
  EXPECT_EQ(model.mesh.triangles, (std::vector<Corners>{{0, 1, 2}}));
  EXPECT_EQ(model.mesh.vertices[2], (Vec3f{2, 0, 0}));
  EXPECT_FALSE(is_mesh_file(folder.write("report.json", R"({"figures": [1, 2]})")));
}

TEST(MeshModel, OtherFilesAreRejected) {
  const TemporaryFolder folder;
  const std::string points =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float "
      "z\nend_header\n1 2 3\n";
  EXPECT_FALSE(is_mesh_file(folder.write("points.ply", points)));
  EXPECT_FALSE(is_mesh_file(folder.write("points.xyz", "1 2 3\n")));
  EXPECT_FALSE(is_mesh_file(folder.write("pl", "pl")));
  expect_error(ErrorKind::data, {"points.xyz", "OBJ"},
               [&] { load_mesh(folder.path() / "points.xyz"); });
  expect_error(ErrorKind::data, {"points.ply", "face"},
               [&] { load_mesh(folder.path() / "points.ply"); });
  expect_error(ErrorKind::no_input, {"none"}, [&] { is_mesh_file(folder.path() / "none"); });
}

}  // namespace
}  // namespace adasplats
