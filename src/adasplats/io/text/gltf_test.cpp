// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/text/gltf.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <nlohmann/json.hpp>
#include <random>

#include "adasplats/core/maths/vec3.h"
#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

using Gltf = nlohmann::json;
using Corners = std::vector<std::uint32_t>;

template <class T>
std::string buffer_of(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

std::string base64(const std::string& bytes) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? digits[bits >> (18 - 6 * k) & 63U] : '=';
  }
  return text;
}

std::string glb(const Gltf& json, const std::string& binary) {
  constexpr std::uint32_t kJson = 0x4e4f534a, kBin = 0x004e4942;
  const auto chunk = [](std::string content, std::uint32_t type, char filler) {
    while (content.size() % 4 != 0) content += filler;
    return buffer_of<std::uint32_t>({static_cast<std::uint32_t>(content.size()), type}) + content;
  };
  const std::string chunks = chunk(json.dump(), kJson, ' ') + chunk(binary, kBin, '\0');
  return std::string("glTF") +
         buffer_of<std::uint32_t>({2, static_cast<std::uint32_t>(12 + chunks.size())}) + chunks;
}

/// A pyramid's four vertices, and indices of two triangles as bytes.
std::string vertices_and_indices() {
  return buffer_of<float>({0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3}) +
         buffer_of<std::uint8_t>({0, 1, 2, 0, 3, 1});
}

/// With the buffer left to the caller.
Gltf two_triangles() {
  return Gltf::parse(R"({
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
    "accessors": [
      {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
      {"bufferView": 1, "componentType": 5121, "count": 6, "type": "SCALAR"}],
    "bufferViews": [{"buffer": 0, "byteLength": 48},
                    {"buffer": 0, "byteOffset": 48, "byteLength": 6}],
    "buffers": [{"byteLength": 54}]})");
}

Gltf with_data(Gltf json, const std::string& bytes) {
  json["buffers"][0] = {
      {"byteLength", bytes.size()},
      {"uri", std::string("data:application/octet-stream;base64,") + base64(bytes)}};
  return json;
}

std::vector<Vec3d> vertices_of(const MeshTable& mesh) {
  std::vector<Vec3d> vertices;
  for (std::size_t i = 0; i < mesh.vertices.rows; ++i)
    vertices.push_back({mesh.vertices.find("x")->as_double(i),
                        mesh.vertices.find("y")->as_double(i),
                        mesh.vertices.find("z")->as_double(i)});
  return vertices;
}

class GltfTest : public testing::Test {
 protected:
  MeshTable read(const Gltf& json, const std::string& bytes = vertices_and_indices()) const {
    return read_gltf_mesh(folder_.write("mesh.gltf", with_data(json, bytes).dump()));
  }
  void expect_rejected(const Gltf& json, const std::vector<std::string>& parts) const {
    expect_error(ErrorKind::data, parts, [&] { read(json); });
  }

  TemporaryFolder folder_;
};

// Oracle: the numbers in the file; glTF's left, up, forward (x, y, z) are our y, z, x.
TEST_F(GltfTest, SameMeshFromAllThreeContainers) {
  Gltf beside = two_triangles();
  beside["buffers"][0]["uri"] = "a%20b%2ebin";
  folder_.write("a b.bin", vertices_and_indices());
  for (const auto& path :
       {folder_.write("within.gltf", with_data(two_triangles(), vertices_and_indices()).dump(1)),
        folder_.write("beside.gltf", beside.dump()),
        folder_.write("one.glb", glb(two_triangles(), vertices_and_indices()))}) {
    ASSERT_TRUE(is_gltf(path));
    const MeshTable mesh = read_gltf_mesh(path);
    EXPECT_EQ(vertices_of(mesh), (std::vector<Vec3d>{{0, 0, 0}, {0, 1, 0}, {0, 0, 2}, {3, 0, 0}}));
    EXPECT_EQ(mesh.triangle_vertices, (Corners{0, 1, 2, 0, 3, 1}));
    EXPECT_EQ(mesh.faces.rows, 2U);
  }
}

TEST_F(GltfTest, IsRecognisedByItsContent) {
  EXPECT_TRUE(is_gltf(folder_.write("car.dat", glb(two_triangles(), vertices_and_indices()))));
  EXPECT_FALSE(is_gltf(folder_.write("report.json", R"({"figures": [1, 2]})")));
  EXPECT_FALSE(is_gltf(folder_.write("blank", "   \n")));
  EXPECT_FALSE(is_gltf(folder_.write("short", "g")));
}

// Oracle: the products written out. The child is turned by 90 degrees about y (z to x), scaled
// and moved by its parent; the other node has a matrix.
TEST_F(GltfTest, NodesPlaceMeshes) {
  Gltf json = two_triangles();
  json["scenes"][0]["nodes"] = {0, 2};
  json["nodes"] = Gltf::parse(R"([
    {"translation": [10, 20, 30], "scale": [1, 2, 4], "children": [1]},
    {"mesh": 0, "rotation": [0, 0.7071067811865476, 0, 0.7071067811865476]},
    {"mesh": 0, "matrix": [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1]},
    {"mesh": 0}])");
  const MeshTable mesh = read(json);
  const std::vector<Vec3d> vertices = vertices_of(mesh);
  ASSERT_EQ(vertices.size(), 8U) << "the last node is not in the scene";
  // In glTF's axes.
  const std::vector<Vec3d> by_matrix = {{5, 6, 7}, {5, 7, 7}, {3, 6, 7}, {5, 6, 10}};
  const std::vector<Vec3d> by_parts = {{10, 20, 30}, {10, 20, 26}, {10, 24, 30}, {13, 20, 30}};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto ours = [](Vec3d p) { return Vec3d{p.z, p.x, p.y}; };
    EXPECT_NEAR(length(vertices[i] - ours(by_parts[i])), 0, 1e-12) << i;
    EXPECT_NEAR(length(vertices[4 + i] - ours(by_matrix[i])), 0, 1e-12) << i;
  }
  EXPECT_EQ(mesh.triangle_vertices, (Corners{0, 1, 2, 0, 3, 1, 4, 5, 6, 4, 7, 5}));
}

// Oracle: section 3.7.2.1 of the specification.
TEST_F(GltfTest, TrianglesOfEveryMode) {
  Gltf json = two_triangles();
  Gltf& primitive = json["meshes"][0]["primitives"][0];
  const auto corners = [&] { return read(json).triangle_vertices; };
  primitive["mode"] = 5;
  EXPECT_EQ(corners(), (Corners{0, 1, 2, 1, 2, 0, 2, 0, 3, 0, 3, 1}));
  primitive["mode"] = 6;
  EXPECT_EQ(corners(), (Corners{0, 1, 2, 0, 2, 0, 0, 0, 3, 0, 3, 1}));
  for (const int mode : {0, 1, 2, 3}) {
    primitive["mode"] = mode;
    EXPECT_TRUE(corners().empty());
  }
  primitive.erase("mode");
  primitive.erase("indices");
  json["accessors"][0]["count"] = 3;
  EXPECT_EQ(corners(), (Corners{0, 1, 2}));
  json["accessors"][0]["count"] = 0;
  EXPECT_TRUE(corners().empty());
  primitive["attributes"].erase("POSITION");
  EXPECT_TRUE(corners().empty());
}

TEST_F(GltfTest, InterleavedVerticesAndWiderIndices) {
  Gltf json = two_triangles();
  const std::string vertices = buffer_of<float>({9, 0, 0, 0, 9, 1, 0, 0, 9, 0, 2, 0, 9, 0, 0, 3});
  json["bufferViews"][0] = {{"buffer", 0}, {"byteLength", 64}, {"byteStride", 16}};
  json["accessors"][0]["byteOffset"] = 4;
  const std::vector<Vec3d> expected = vertices_of(read(two_triangles()));
  json["bufferViews"][1] = {{"buffer", 0}, {"byteOffset", 64}, {"byteLength", 12}};
  json["accessors"][1]["componentType"] = 5123;
  MeshTable mesh = read(json, vertices + buffer_of<std::uint16_t>({0, 1, 2, 0, 3, 1}));
  EXPECT_EQ(vertices_of(mesh), expected);
  EXPECT_EQ(mesh.triangle_vertices, (Corners{0, 1, 2, 0, 3, 1}));
  json["bufferViews"][1]["byteLength"] = 24;
  json["accessors"][1]["componentType"] = 5125;
  mesh = read(json, vertices + buffer_of<std::uint32_t>({0, 1, 2, 0, 3, 1}));
  EXPECT_EQ(mesh.triangle_vertices, (Corners{0, 1, 2, 0, 3, 1}));
}

TEST_F(GltfTest, WithoutScenesEveryMeshOnce) {
  Gltf json = two_triangles();
  json.erase("scenes");
  json.erase("scene");
  EXPECT_EQ(read(json).faces.rows, 2U);
  json.erase("meshes");
  EXPECT_EQ(read(json).faces.rows, 0U);
  json["scenes"] = Gltf::parse("[{}]");
  EXPECT_EQ(read(json).faces.rows, 0U);
}

TEST_F(GltfTest, IndicesOutsideTheirArrays) {
  const auto changed = [](const char* pointer, const Gltf& value) {
    Gltf json = two_triangles();
    json[Gltf::json_pointer(pointer)] = value;
    return json;
  };
  expect_rejected(changed("/scene", 1), {"mesh.gltf", "scene", "found 1", "there are only 1"});
  expect_rejected(changed("/scenes/0/nodes/0", 7), {"scenes[0].nodes[0]", "found 7"});
  expect_rejected(changed("/nodes/0/mesh", 1), {"nodes[0].mesh"});
  expect_rejected(changed("/nodes/0/children", {3}), {"nodes[0].children[0]"});
  expect_rejected(changed("/nodes/0/children", {0}), {"nodes[0]", "twice"});
  expect_rejected(changed("/meshes/0/primitives/0/indices", 2), {"primitives[0].indices"});
  expect_rejected(changed("/accessors/0/bufferView", 5), {"accessors[0].bufferView"});
  expect_rejected(changed("/accessors/0/count", 5), {"accessors[0]", "bufferViews[0]"});
  expect_rejected(changed("/accessors/0/count", 4294967295U), {"accessors[0]"});
  expect_rejected(changed("/accessors/0/count", std::uint64_t{1} << 63), {"accessors[0]"});
  expect_rejected(changed("/accessors/0/byteOffset", ~std::uint64_t{0}), {"accessors[0]"});
  expect_rejected(changed("/accessors/0/count", 3), {"primitives[0]", "index 4 is 3"});
  expect_rejected(changed("/bufferViews/1/byteOffset", ~std::uint64_t{0} - 3), {"bufferViews[1]"});
  expect_rejected(changed("/bufferViews/0/byteLength", 55), {"bufferViews[0]", "54 bytes"});
  expect_rejected(changed("/bufferViews/0/byteStride", 11), {"accessors[0]"});
  expect_rejected(changed("/accessors/1/count", 5), {"primitives[0]", "5 corners"});
}

TEST_F(GltfTest, ValuesOfTheWrongType) {
  const auto changed = [](const char* pointer, const Gltf& value) {
    Gltf json = two_triangles();
    json[Gltf::json_pointer(pointer)] = value;
    return json;
  };
  expect_rejected(changed("/asset/version", "1.0"), {"asset.version", "found 1.0"});
  expect_rejected(changed("/nodes/0", 3), {"nodes[0]", "object"});
  expect_rejected(changed("/nodes/0/mesh", -1), {"nodes[0].mesh", "whole number"});
  expect_rejected(changed("/nodes/0/rotation", {0, 0, 0, 0}), {"nodes[0].rotation", "quaternion"});
  expect_rejected(changed("/nodes/0/scale", {1, 2}), {"nodes[0].scale", "3 numbers"});
  expect_rejected(changed("/nodes", "x"), {"nodes", "array"});
  expect_rejected(changed("/accessors/0/type", "VEC2"), {"accessors[0].type", "VEC3"});
  expect_rejected(changed("/accessors/0/componentType", 5123), {"componentType", "5126"});
  expect_rejected(changed("/accessors/1/componentType", 5126), {"componentType", "5121"});
  expect_rejected(changed("/accessors/0/sparse", Gltf::object()), {"sparse"});
  expect_rejected(changed("/meshes/0/primitives/0/mode", 7), {"mode 7"});
  expect_rejected(changed("/extensionsRequired", {"KHR_draco_mesh_compression"}),
                  {"draco", "export"});
  EXPECT_EQ(read(changed("/extensionsRequired", {"KHR_materials_unlit"})).faces.rows, 2U);
}

TEST_F(GltfTest, MissingBuffers) {
  Gltf json = two_triangles();
  const auto expect = [&](ErrorKind kind, const std::vector<std::string>& parts) {
    expect_error(kind, parts, [&] { read_gltf_mesh(folder_.write("m.gltf", json.dump())); });
  };
  expect(ErrorKind::data, {"buffers[0]", "uri"});
  json["buffers"][0]["uri"] = "none.bin";
  expect(ErrorKind::no_input, {"none.bin"});
  for (const char* uri : {"/etc/hostname", "http://example.org/a.bin", "", "data:;base64,a*b"}) {
    json["buffers"][0]["uri"] = uri;
    expect(ErrorKind::data, {"buffers[0].uri"});
  }
  json["buffers"][0]["uri"] = "data:;base64,AAAA";
  expect(ErrorKind::data, {"buffers[0]", "has 3 bytes, expected 54"});
}

TEST_F(GltfTest, BrokenContainers) {
  const auto rejected = [&](const std::string& content, const std::vector<std::string>& parts) {
    expect_error(ErrorKind::data, parts, [&] { read_gltf_mesh(folder_.write("m.glb", content)); });
  };
  const std::string whole = glb(two_triangles(), vertices_and_indices());
  rejected(whole.substr(0, 4), {"version", "the end"});
  rejected(whole.substr(0, 12), {"glTF"});
  rejected(whole.substr(0, 15), {"byte 12", "chunk"});
  rejected(whole.substr(0, whole.size() - 1), {"chunk"});
  rejected(std::string("glTF") + buffer_of<std::uint32_t>({1, 12}), {"version 2", "found 1"});
  rejected("{\"asset\": ", {"glTF", "line 1"});
  rejected("[]", {"object"});
  rejected("{}", {"'asset' is missing"});
  rejected(std::string(100'000, '['), {"glTF"});
  rejected("{\"asset\": \xff}", {"glTF"});
}

// Broken files, the same in each run: nothing but Error may escape, and indices stay in range.
TEST_F(GltfTest, MutatedFilesNeverCrash) {
  std::mt19937_64 random(11);
  const auto below = [&](std::size_t limit) { return static_cast<std::size_t>(random() % limit); };
  const std::array<std::string, 2> seeds = {
      glb(two_triangles(), vertices_and_indices()),
      with_data(two_triangles(), vertices_and_indices()).dump()};
  std::size_t good = 0;
  for (int round = 0; round < 2000; ++round) {
    std::string content = seeds[below(2)];
    for (std::size_t step = 0; step <= below(3); ++step) {
      const std::size_t place = below(content.size());
      switch (below(5)) {
        case 0: content[place] = static_cast<char>(random()); break;
        case 1: content[place] = static_cast<char>('0' + below(10)); break;
        case 2: content.erase(place, 1 + below(9)); break;
        case 3: content.insert(place, "99999999999999999999", below(20)); break;
        default: content[place] = static_cast<char>(content[place] ^ (1 << below(8)));
      }
      if (content.empty()) content = "{";
    }
    // A file that is truncated and written again takes milliseconds on some systems.
    std::filesystem::remove(folder_.path() / "m");
    try {
      const MeshTable mesh = read_gltf_mesh(folder_.write("m", content));
      for (const std::uint32_t corner : mesh.triangle_vertices)
        ASSERT_LT(corner, mesh.vertices.rows);
      ++good;
    } catch (const Error&) {
    }
  }
  EXPECT_GT(good, 100U) << "most mutations must not stop at the first check";
}

}  // namespace
}  // namespace adasplats
