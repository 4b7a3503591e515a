// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/text/gltf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/flat_gaussian.h"
#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/base64.h"
#include "adasplats/io/base/crs.h"
#include "adasplats/io/base/input_file.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

using GltfJson = nlohmann::json;

constexpr const char* kSplatting = "KHR_gaussian_splatting";
constexpr std::array<const char*, 12> kSplatColumns = {
    "x",           "y",           "z",       "nx",  "ny",    "nz",
    "deviation_0", "deviation_1", "opacity", "red", "green", "blue"};

/// Limits against small files that instantiate a mesh many times.
constexpr std::size_t kMaxSplats = 100'000'000;
constexpr std::size_t kMaxVertices = 50'000'000;
constexpr std::size_t kMaxTriangles = 100'000'000;

/// An affine map, as nodes have.
struct AffineMap {
  Mat3d linear;
  Vec3d offset;

  Vec3d operator*(Vec3d p) const { return linear * p + offset; }
  friend AffineMap operator*(const AffineMap& a, const AffineMap& b) {
    return {a.linear * b.linear, a * b.offset};
  }
};

std::optional<std::uint32_t> word_at(std::string_view bytes, std::size_t offset) {
  std::uint32_t word = 0;
  if (bytes.size() < sizeof(word) || offset > bytes.size() - sizeof(word)) return std::nullopt;
  std::memcpy(&word, bytes.data() + offset, sizeof(word));
  return word;
}

/// The JSON of a file and the binary chunk of a .glb (section 4.4, "Binary glTF Layout").
struct Chunks {
  std::string_view json;
  std::string_view binary;
};

Chunks split(const std::filesystem::path& path, std::string_view file) {
  constexpr std::string_view kMagic = "glTF";
  constexpr std::uint32_t kJson = 0x4e4f534a, kBinary = 0x004e4942;
  constexpr std::size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;
  if (!file.starts_with(kMagic)) return {file, {}};
  const std::optional<std::uint32_t> version = word_at(file, 4);
  if (version != 2U)
    throw data_error({path, 4, {}}, "expected version 2 of binary glTF, found " +
                                        (version ? std::to_string(*version) : "the end"));
  Chunks chunks;
  std::size_t offset = kHeaderBytes;
  while (offset < file.size()) {
    const auto length = word_at(file, offset), type = word_at(file, offset + 4);
    if (!length || !type || *length > file.size() - offset - kChunkHeaderBytes)
      throw data_error({path, offset, {}}, "a chunk extends beyond the end of the file");
    const std::string_view content = file.substr(offset + kChunkHeaderBytes, *length);
    if (*type == kJson && chunks.json.empty()) chunks.json = content;
    if (*type == kBinary && chunks.binary.empty()) chunks.binary = content;
    offset += kChunkHeaderBytes + *length;
  }
  return chunks;
}

/// Decodes percent escapes (RFC 3986), such as "%20"; leaves invalid ones unchanged.
std::string without_percents(std::string_view uri) {
  const auto digit = [](char c) {
    constexpr std::string_view kDigits = "0123456789abcdefABCDEF";
    const std::size_t index = kDigits.find(c);
    return index == std::string_view::npos ? -1 : static_cast<int>(index < 16 ? index : index - 6);
  };
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const bool coded =
        uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0;
    text += coded ? static_cast<char>(digit(uri[i + 1]) * 16 + digit(uri[i + 2])) : uri[i];
    if (coded) i += 2;
  }
  return text;
}

/// A JSON value with its path in the document, for error messages.
class GltfMember {
 public:
  GltfMember(const std::filesystem::path& path, const GltfJson& value, std::string pointer)
      : path_(&path), value_(&value), pointer_(std::move(pointer)) {}

  const std::string& pointer() const { return pointer_; }

  Error error(const std::string& message) const {
    return data_error({*path_, {}, {}}, pointer_ + ": " + message);
  }

  /// A required member. Errors: data.
  GltfMember operator[](const char* key) const {
    if (const std::optional<GltfMember> found = find(key)) return *found;
    throw error("'" + std::string(key) + "' is missing");
  }
  std::optional<GltfMember> find(const char* key) const {
    if (!value_->is_object()) throw error("is not an object");
    const auto found = value_->find(key);
    if (found == value_->end()) return std::nullopt;
    return GltfMember(*path_, *found, pointer_.empty() ? key : pointer_ + "." + key);
  }

  bool is_object() const { return value_->is_object(); }
  std::vector<std::string> keys() const {
    std::vector<std::string> keys;
    for (const auto& [key, value] : value_->items()) keys.push_back(key);
    return keys;
  }
  bool truth() const {
    if (!value_->is_boolean()) throw error("is not true or false");
    return value_->get<bool>();
  }

  std::size_t size() const {
    if (!value_->is_array()) throw error("is not an array");
    return value_->size();
  }
  GltfMember at(std::size_t i) const {
    return {*path_, (*value_)[i], pointer_ + "[" + std::to_string(i) + "]"};
  }
  std::vector<GltfMember> elements() const {
    std::vector<GltfMember> all;
    for (std::size_t i = 0; i < size(); ++i) all.push_back(at(i));
    return all;
  }

  std::uint64_t whole_number() const {
    if (!value_->is_number_unsigned()) throw error("is not a whole number of at least 0");
    return value_->get<std::uint64_t>();
  }
  std::size_t index_below(std::size_t count) const {
    const std::uint64_t index = whole_number();
    if (index >= count)
      throw error("found " + std::to_string(index) + ", but there are only " +
                  std::to_string(count));
    return static_cast<std::size_t>(index);
  }
  double number() const {
    const double value = value_->is_number() ? value_->get<double>() : HUGE_VAL;
    if (!std::isfinite(value)) throw error("is not a finite number");
    return value;
  }
  template <std::size_t N>
  std::array<double, N> numbers() const {
    if (size() != N) throw error("expected " + std::to_string(N) + " numbers");
    std::array<double, N> all;
    for (std::size_t i = 0; i < N; ++i) all[i] = at(i).number();
    return all;
  }
  const std::string& text() const {
    if (!value_->is_string()) throw error("is not a string");
    return value_->get_ref<const std::string&>();
  }

 private:
  const std::filesystem::path* path_;
  const GltfJson* value_;
  std::string pointer_;
};

std::uint64_t whole_number_or(const std::optional<GltfMember>& member, std::uint64_t otherwise) {
  return member ? member->whole_number() : otherwise;
}

/// Section 3.6.2.2, "Accessor Data Types".
enum class Component : std::uint16_t {
  i8 = 5120,
  u8 = 5121,
  i16 = 5122,
  u16 = 5123,
  u32 = 5125,
  f32 = 5126
};

std::size_t component_bytes(Component component) {
  switch (component) {
    case Component::i8:
    case Component::u8: return 1;
    case Component::i16:
    case Component::u16: return 2;
    default: return 4;
  }
}

/// Elements of an accessor, all within its buffer.
struct Elements {
  const char* begin = nullptr;
  std::size_t count = 0;
  std::size_t stride_bytes = 0;
  Component component = Component::f32;

  template <class T>
  T value(std::size_t element, std::size_t component_index = 0) const {
    T value;
    std::memcpy(&value, begin + element * stride_bytes + component_index * sizeof(T), sizeof(T));
    return value;
  }
  /// Normalized integers are from 0 or -1 to 1 (section 3.6.2.2).
  double number(std::size_t i, std::size_t k, bool normalized) const {
    const auto scaled = [&](auto raw, double most) {
      return normalized ? std::max(static_cast<double>(raw) / most, -1.0)
                        : static_cast<double>(raw);
    };
    switch (component) {
      case Component::i8: return scaled(value<std::int8_t>(i, k), 127);
      case Component::u8: return scaled(value<std::uint8_t>(i, k), 255);
      case Component::i16: return scaled(value<std::int16_t>(i, k), 32767);
      case Component::u16: return scaled(value<std::uint16_t>(i, k), 65535);
      case Component::u32: return static_cast<double>(value<std::uint32_t>(i, k));
      case Component::f32: return static_cast<double>(value<float>(i, k));
    }
    return 0;
  }
  std::uint32_t index(std::size_t i) const {
    switch (component) {
      case Component::u8: return value<std::uint8_t>(i);
      case Component::u16: return value<std::uint16_t>(i);
      default: return value<std::uint32_t>(i);
    }
  }
};

class GltfReader {
 public:
  explicit GltfReader(const std::filesystem::path& path)
      : path_(path), file_(read_file(path)), chunks_(split(path, file_)), json_(parse()) {
    require_version_2();
    reject_extensions();
  }

  std::vector<std::filesystem::path> buffer_files() const {
    std::vector<std::filesystem::path> files;
    for (const GltfMember& buffer : buffers_) {
      const std::optional<GltfMember> uri = buffer.find("uri");
      if (uri && !uri->text().starts_with("data:")) files.push_back(file_beside(*uri));
    }
    return files;
  }

  Table read_splats();

  MeshTable read() {
    add_scene();
    MeshTable mesh;
    mesh.vertices.rows = coordinates_[0].size();
    for (std::size_t axis = 0; axis < 3; ++axis)
      mesh.vertices.columns.push_back({std::string(1, "xyz"[axis]), std::move(coordinates_[axis])});
    mesh.faces.rows = triangles_.size() / 3;
    mesh.triangle_vertices = std::move(triangles_);
    return mesh;
  }

 private:
  GltfJson parse() const {
    try {
      return GltfJson::parse(chunks_.json);
    } catch (const GltfJson::exception& problem) {
      throw data_error({path_, {}, {}}, std::string("glTF: ") + problem.what());
    }
  }
  GltfMember root() const { return {path_, json_, ""}; }
  /// The elements of an array of the document; empty if it has none.
  std::vector<GltfMember> all(const char* key) const {
    const std::optional<GltfMember> found = root().find(key);
    return found ? found->elements() : std::vector<GltfMember>();
  }

  void require_version_2() const;
  void reject_extensions() const;
  std::filesystem::path file_beside(const GltfMember& uri) const;
  std::string read_buffer(const GltfMember& buffer, std::size_t number) const;
  std::string_view buffer_bytes(std::size_t number);
  Elements elements(const GltfMember& accessor, std::string_view type, std::size_t components);
  Elements located(const GltfMember& accessor, std::size_t components, Component component);
  static std::optional<GltfMember> splatting_of(const GltfMember& primitive);
  std::vector<std::vector<double>> attribute(const GltfMember& attributes, const char* name,
                                             std::size_t components);
  /// By component.
  struct SplatAttributes {
    std::vector<std::vector<double>> positions, scales, rotations, opacities, harmonics;
    bool is_linear = false;  ///< the colours
    std::size_t count() const { return positions[0].size(); }
    double norm(std::size_t i) const {
      const auto& q = rotations;
      return std::sqrt(q[0][i] * q[0][i] + q[1][i] * q[1][i] + q[2][i] * q[2][i] +
                       q[3][i] * q[3][i]);
    }
  };
  SplatAttributes splat_attributes(const GltfMember& primitive);
  void add_splats(const GltfMember& primitive, const AffineMap& world_from_mesh);
  void read_extras(const GltfMember& node);
  void add_own_attributes(const GltfMember& attributes, std::size_t before, std::size_t count);
  void add_scene();
  void add_tree(std::size_t root_node);
  void add_mesh(const GltfMember& mesh, const AffineMap& world_from_mesh);
  void add_vertices(const Elements& positions, const AffineMap& world_from_mesh);
  void add_triangles(const GltfMember& primitive, std::size_t first_vertex, std::size_t count);

  std::filesystem::path path_;
  std::string file_;
  Chunks chunks_;
  GltfJson json_;
  std::vector<GltfMember> buffers_ = all("buffers"), views_ = all("bufferViews"),
                          accessors_ = all("accessors"), meshes_ = all("meshes"),
                          nodes_ = all("nodes");
  std::vector<std::optional<std::string>> buffer_contents_ =
      std::vector<std::optional<std::string>>(buffers_.size());
  std::vector<bool> is_node_used_ = std::vector<bool>(nodes_.size());
  std::array<std::vector<double>, 3> coordinates_;
  std::vector<std::uint32_t> triangles_;
  bool wants_splats_ = false;                               ///< instead of triangles
  std::vector<std::vector<double>> splats_;                 ///< by kSplatColumns
  std::map<std::string, std::vector<double>> own_columns_;  ///< of application's attributes
  std::optional<Vec3d> origin_;
  std::vector<std::string> comments_;
};

void GltfReader::require_version_2() const {
  const GltfMember version = root()["asset"]["version"];
  if (!version.text().starts_with("2."))
    throw version.error("found " + version.text().substr(0, 20) + ", expected 2.0");
}

/// Section 3.12, required extensions. Those that affect only the appearance are ignored.
void GltfReader::reject_extensions() const {
  for (const GltfMember& required : all("extensionsRequired")) {
    const std::string& name = required.text();
    const bool looks = name == kSplatting || name.starts_with("KHR_materials_") ||
                       name.starts_with("KHR_texture_") || name.starts_with("EXT_texture_") ||
                       name == "KHR_lights_punctual";
    if (!looks)
      throw required.error("the extension " + name.substr(0, 60) +
                           " is not supported; export the mesh without it");
  }
}

/// Section 3.6.1: bytes of a file beside the document, of a data URI, or of the binary chunk.
std::string GltfReader::read_buffer(const GltfMember& buffer, std::size_t number) const {
  const std::optional<GltfMember> uri = buffer.find("uri");
  if (!uri) {
    if (number > 0 || chunks_.binary.empty())
      throw buffer.error("has no uri, and the file has no binary chunk for it");
    return std::string(chunks_.binary);
  }
  const std::string& text = uri->text();
  if (text.starts_with("data:")) {
    constexpr std::string_view kCoding = ";base64,";
    const std::size_t begin = text.find(kCoding);
    auto bytes = begin == std::string::npos
                     ? std::nullopt
                     : from_base64(std::string_view(text).substr(begin + kCoding.size()));
    if (!bytes) throw uri->error("is not base64 data");
    return std::move(*bytes);
  }
  return read_file(file_beside(*uri));
}

std::filesystem::path GltfReader::file_beside(const GltfMember& uri) const {
  const std::string& text = uri.text();
  const std::filesystem::path name = without_percents(text);
  if (name.empty() || name.is_absolute() || text.find("://") != std::string::npos ||
      text.find('\0') != std::string::npos)
    throw uri.error("is not a file relative to the document");
  return path_.parent_path() / name;
}

std::string_view GltfReader::buffer_bytes(std::size_t number) {
  const GltfMember& buffer = buffers_[number];
  std::optional<std::string>& content = buffer_contents_[number];
  if (!content) content = read_buffer(buffer, number);
  const std::uint64_t length = buffer["byteLength"].whole_number();
  if (length > content->size())
    throw buffer.error("has " + std::to_string(content->size()) + " bytes, expected " +
                       std::to_string(length));
  return std::string_view(*content).substr(0, static_cast<std::size_t>(length));
}

/// Section 3.6.2: `count` elements of `components` each, `byteStride` apart, within a view within a
/// buffer.
Elements GltfReader::elements(const GltfMember& accessor, std::string_view type,
                              std::size_t components) {
  if (accessor.find("sparse")) throw accessor.error("sparse accessors are not supported");
  if (accessor["type"].text() != type)
    throw accessor["type"].error("found " + accessor["type"].text().substr(0, 20) + ", expected " +
                                 std::string(type));
  const std::uint64_t component = accessor["componentType"].whole_number();
  const bool real = component == 5126,
             index = component == 5121 || component == 5123 || component == 5125;
  if (components > 1 ? !real : !index)
    throw accessor["componentType"].error("found " + std::to_string(component) + ", expected " +
                                          (components > 1 ? "5126 (float)" : "5121, 5123 or 5125"));
  return located(accessor, components, static_cast<Component>(component));
}

/// The same of any type.
Elements GltfReader::located(const GltfMember& accessor, std::size_t components,
                             Component component) {
  Elements result;
  result.component = component;
  const GltfMember& view = views_[accessor["bufferView"].index_below(views_.size())];
  const std::string_view buffer = buffer_bytes(view["buffer"].index_below(buffers_.size()));
  const std::uint64_t view_begin = whole_number_or(view.find("byteOffset"), 0);
  const std::uint64_t view_bytes = view["byteLength"].whole_number();
  if (view_begin > buffer.size() || view_bytes > buffer.size() - view_begin)
    throw view.error("extends beyond its buffer of " + std::to_string(buffer.size()) + " bytes");
  const std::size_t element_bytes = components * component_bytes(result.component);
  const std::uint64_t stride = whole_number_or(view.find("byteStride"), element_bytes);
  const std::uint64_t begin = whole_number_or(accessor.find("byteOffset"), 0);
  const std::uint64_t count = accessor["count"].whole_number();
  // Division instead of multiplication: no overflow.
  const bool fits = begin <= view_bytes && stride >= element_bytes &&
                    (count == 0 || (view_bytes - begin >= element_bytes &&
                                    count - 1 <= (view_bytes - begin - element_bytes) / stride));
  if (!fits) throw accessor.error("extends beyond its view " + view.pointer());
  result.begin = buffer.data() + view_begin + begin;
  result.count = static_cast<std::size_t>(count);
  result.stride_bytes = static_cast<std::size_t>(stride);
  return result;
}

/// Section 3.5: adds the nodes of the default scene, else of the first; without scenes, every mesh
/// once.
void GltfReader::add_scene() {
  const std::vector<GltfMember> scenes = all("scenes");
  if (scenes.empty()) {
    for (const GltfMember& mesh : meshes_) add_mesh(mesh, {});
    return;
  }
  const std::optional<GltfMember> chosen = root().find("scene");
  const GltfMember& scene = scenes[chosen ? chosen->index_below(scenes.size()) : 0];
  const std::optional<GltfMember> roots = scene.find("nodes");
  if (!roots) return;
  for (const GltfMember& node : roots->elements()) add_tree(node.index_below(nodes_.size()));
}

/// Section 3.5.3, "Transformations": a matrix by columns, or translation * rotation * scale.
AffineMap local_transform(const GltfMember& node) {
  if (const std::optional<GltfMember> matrix = node.find("matrix")) {
    const auto m = matrix->numbers<16>();
    return {{{{m[0], m[4], m[8]}, {m[1], m[5], m[9]}, {m[2], m[6], m[10]}}}, {m[12], m[13], m[14]}};
  }
  AffineMap map;
  if (const std::optional<GltfMember> rotation = node.find("rotation")) {
    const auto q = rotation->numbers<4>();  // x, y, z, w
    const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(std::fabs(norm - 1) <= 1e-3)) throw rotation->error("is not a unit quaternion");
    map.linear = rotation_from_quaternion(q[3] / norm, q[0] / norm, q[1] / norm, q[2] / norm);
  }
  if (const std::optional<GltfMember> scale = node.find("scale")) {
    const auto s = scale->numbers<3>();
    for (Vec3d& row : map.linear.rows) row = {row.x * s[0], row.y * s[1], row.z * s[2]};
  }
  if (const std::optional<GltfMember> translation = node.find("translation")) {
    const auto t = translation->numbers<3>();
    map.offset = {t[0], t[1], t[2]};
  }
  return map;
}

/// Adds a node and its descendants, without recursion, since files control the depth.
void GltfReader::add_tree(std::size_t root_node) {
  std::vector<std::pair<std::size_t, AffineMap>> waiting = {{root_node, {}}};
  while (!waiting.empty()) {
    const auto [number, world_from_parent] = waiting.back();
    waiting.pop_back();
    const GltfMember& node = nodes_[number];
    if (is_node_used_[number]) throw node.error("occurs twice in the scene");
    is_node_used_[number] = true;
    const AffineMap world_from_node = world_from_parent * local_transform(node);
    if (wants_splats_) read_extras(node);
    if (const std::optional<GltfMember> mesh = node.find("mesh"))
      add_mesh(meshes_[mesh->index_below(meshes_.size())], world_from_node);
    const std::optional<GltfMember> children = node.find("children");
    if (!children) continue;
    for (const GltfMember& child : children->elements())
      waiting.emplace_back(child.index_below(nodes_.size()), world_from_node);
  }
}

/// Section 3.7.2, "Meshes".
void GltfReader::add_mesh(const GltfMember& mesh, const AffineMap& world_from_mesh) {
  constexpr std::uint64_t kTriangles = 4, kFan = 6;
  for (const GltfMember& primitive : mesh["primitives"].elements()) {
    const std::uint64_t mode = whole_number_or(primitive.find("mode"), kTriangles);
    if (wants_splats_) {
      if (splatting_of(primitive)) {
        add_splats(primitive, world_from_mesh);
      } else if (mode >= kTriangles) {
        throw primitive.error("triangles beside Gaussians, which are no model; split the file");
      }
      continue;
    }
    if (mode < kTriangles) continue;  // points and lines
    if (mode > kFan)
      throw primitive.error("mode " + std::to_string(mode) + " does not exist in glTF");
    const std::optional<GltfMember> position = primitive["attributes"].find("POSITION");
    if (!position) continue;  // section 3.7.2.1: may be skipped
    const Elements positions =
        elements(accessors_[position->index_below(accessors_.size())], "VEC3", 3);
    const std::size_t first_vertex = coordinates_[0].size();
    if (positions.count > kMaxVertices - first_vertex)
      throw primitive.error("the scene has more than " + std::to_string(kMaxVertices) +
                            " vertices");
    add_vertices(positions, world_from_mesh);
    add_triangles(primitive, first_vertex, positions.count);
  }
}

void GltfReader::add_vertices(const Elements& positions, const AffineMap& world_from_mesh) {
  for (std::size_t i = 0; i < positions.count; ++i) {
    const Vec3d p = world_from_mesh * vec_cast<double>(Vec3f{positions.value<float>(i, 0),
                                                             positions.value<float>(i, 1),
                                                             positions.value<float>(i, 2)});
    coordinates_[0].push_back(p.z);
    coordinates_[1].push_back(p.x);
    coordinates_[2].push_back(p.y);
  }
}

void GltfReader::add_triangles(const GltfMember& primitive, std::size_t first_vertex,
                               std::size_t count) {
  const std::optional<GltfMember> indices = primitive.find("indices");
  Elements corners;
  if (indices) corners = elements(accessors_[indices->index_below(accessors_.size())], "SCALAR", 1);
  const std::size_t corner_count = indices ? corners.count : count;
  const auto corner = [&](std::size_t i) {
    const std::uint32_t index = indices ? corners.index(i) : static_cast<std::uint32_t>(i);
    if (index >= count)
      throw primitive.error("index " + std::to_string(i) + " is " + std::to_string(index) +
                            ", but there are " + std::to_string(count) + " vertices");
    return static_cast<std::uint32_t>(first_vertex + index);
  };
  const std::uint64_t mode = whole_number_or(primitive.find("mode"), 4);
  const std::size_t step = mode == 4 ? 3 : 1;
  if (mode == 4 && corner_count % 3 != 0)
    throw primitive.error(std::to_string(corner_count) + " corners, expected a multiple of 3");
  if (corner_count / step > kMaxTriangles - triangles_.size() / 3)
    throw primitive.error("the scene has more than " + std::to_string(kMaxTriangles) +
                          " triangles");
  for (std::size_t i = 0; i + 2 < corner_count; i += step) {
    const std::size_t first = mode == 6 ? 0 : i;
    for (const std::size_t k : {first, i + 1, i + 2}) triangles_.push_back(corner(k));
  }
}

std::optional<GltfMember> GltfReader::splatting_of(const GltfMember& primitive) {
  const std::optional<GltfMember> extensions = primitive.find("extensions");
  return extensions ? extensions->find(kSplatting) : std::nullopt;
}

/// The values of an attribute by component; none if the points do not have it.
std::vector<std::vector<double>> GltfReader::attribute(const GltfMember& attributes,
                                                       const char* name, std::size_t components) {
  constexpr std::array<std::string_view, 4> kTypes = {"SCALAR", "VEC2", "VEC3", "VEC4"};
  const std::optional<GltfMember> found = attributes.find(name);
  if (!found) return {};
  const GltfMember& accessor = accessors_[found->index_below(accessors_.size())];
  if (accessor.find("sparse")) throw accessor.error("sparse accessors are not supported");
  if (accessor["type"].text() != kTypes.at(components - 1))
    throw accessor["type"].error("found " + accessor["type"].text().substr(0, 20) + ", expected " +
                                 std::string(kTypes.at(components - 1)));
  const std::uint64_t component = accessor["componentType"].whole_number();
  if (component < 5120 || component > 5126 || component == 5124)
    throw accessor["componentType"].error("found " + std::to_string(component) +
                                          ", which does not exist in glTF");
  const Elements all = located(accessor, components, static_cast<Component>(component));
  if (all.count > kMaxSplats - splats_[0].size())
    throw accessor.error("the scene has more than " + std::to_string(kMaxSplats) + " splats");
  const std::optional<GltfMember> flag = accessor.find("normalized");
  const bool normalized = flag && flag->truth();
  std::vector<std::vector<double>> values(components);
  for (std::size_t k = 0; k < components; ++k) {
    values[k].reserve(all.count);
    for (std::size_t i = 0; i < all.count; ++i) values[k].push_back(all.number(i, k, normalized));
  }
  return values;
}

/// Linear light as sRGB (IEC 61966-2-1).
double srgb_of(double light) {
  return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

/// KHR_gaussian_splatting, "Ellipse Kernel": scales are linear and not negative, rotations x y z w.
GltfReader::SplatAttributes GltfReader::splat_attributes(const GltfMember& primitive) {
  const GltfMember splatting = *splatting_of(primitive);
  if (splatting["kernel"].text() != "ellipse")
    throw splatting["kernel"].error("found " + splatting["kernel"].text().substr(0, 40) +
                                    ", expected ellipse");
  if (const std::optional<GltfMember> more = splatting.find("extensions"))
    if (!more->keys().empty()) throw more->error("compressed or extended splats are not supported");
  const GltfMember attributes = primitive["attributes"];
  const std::string prefix = std::string(kSplatting) + ":";
  const auto needed = [&](const std::string& name, std::size_t components) {
    std::vector<std::vector<double>> values = attribute(attributes, name.c_str(), components);
    if (values.empty()) throw attributes.error("'" + name + "' is missing");
    return values;
  };
  SplatAttributes all = {needed("POSITION", 3), needed(prefix + "SCALE", 3),
                         needed(prefix + "ROTATION", 4), needed(prefix + "OPACITY", 1),
                         attribute(attributes, (prefix + "SH_DEGREE_0_COEF_0").c_str(), 3)};
  if (const std::optional<GltfMember> space = splatting.find("colorSpace"))
    all.is_linear = space->text().starts_with("lin_");
  const std::size_t count = all.count();
  for (const auto* values : {&all.scales, &all.rotations, &all.opacities, &all.harmonics})
    if (!values->empty() && values->front().size() != count)
      throw attributes.error("the attributes have different numbers of elements");
  for (std::size_t i = 0; i < count; ++i) {
    if (!(std::fabs(all.norm(i) - 1) < 0.1))
      throw attributes.error("rotation " + std::to_string(i) + " is not a unit quaternion");
    for (const auto& axis : all.scales)
      if (!(axis[i] >= 0) || !std::isfinite(axis[i]))
        throw attributes.error("scale " + std::to_string(i) +
                               " is negative or not finite; scales are linear");
    if (!(all.opacities[0][i] >= 0 && all.opacities[0][i] <= 1))
      throw attributes.error("opacity " + std::to_string(i) + " is not from 0 to 1");
  }
  return all;
}

void GltfReader::add_splats(const GltfMember& primitive, const AffineMap& world_from_mesh) {
  constexpr double kEven = 1e-3, kGrey = 0.72;
  const SplatAttributes all = splat_attributes(primitive);
  // glTF has y up and z forward; ours is z of glTF forward.
  const Mat3d ours_from_gltf = {{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}};
  Mat3d turn = ours_from_gltf * world_from_mesh.linear;
  const double scale = length(turn.rows[0]);
  for (Vec3d& row : turn.rows) row = row / scale;
  bool is_even = scale > 0 && std::isfinite(scale);
  for (int a = 0; a < 3 && is_even; ++a)
    for (int b = 0; b < 3; ++b)
      is_even = is_even && std::fabs(dot(turn.rows[a], turn.rows[b]) - (a == b ? 1 : 0)) < kEven;
  if (!is_even) throw primitive.error("its node scales Gaussians unevenly");
  const std::size_t before = splats_[0].size();
  for (std::size_t i = 0; i < all.count(); ++i) {
    const auto& q = all.rotations;
    const double norm = all.norm(i);
    const Mat3d axes =
        rotation_from_quaternion(q[3][i] / norm, q[0][i] / norm, q[1][i] / norm, q[2][i] / norm);
    const FlatGaussian flat = flat_gaussian(
        scale * Vec3d{all.scales[0][i], all.scales[1][i], all.scales[2][i]}, turn * axes);
    const Vec3d center =
        ours_from_gltf *
        (world_from_mesh * Vec3d{all.positions[0][i], all.positions[1][i], all.positions[2][i]});
    const auto color = [&](std::size_t k) {
      const double value = all.harmonics.empty() ? kGrey : 0.5 + kHarmonic0 * all.harmonics[k][i];
      const double bounded = std::clamp(value, 0.0, 1.0);
      return std::round(255 * (all.is_linear ? srgb_of(bounded) : bounded));
    };
    const std::array<double, kSplatColumns.size()> row = {
        center.x,      center.y,    center.z,     flat.normal.x,       flat.normal.y,
        flat.normal.z, flat.longer, flat.shorter, all.opacities[0][i], color(0),
        color(1),      color(2)};
    for (std::size_t k = 0; k < row.size(); ++k) splats_[k].push_back(row[k]);
  }
  add_own_attributes(primitive["attributes"], before, all.count());
}

/// Of the attributes that begin with an underscore those that all primitives have.
void GltfReader::add_own_attributes(const GltfMember& attributes, std::size_t before,
                                    std::size_t count) {
  std::map<std::string, std::vector<double>> own;
  for (const std::string& name : attributes.keys()) {
    if (!name.starts_with('_')) continue;
    const std::size_t index = attributes[name.c_str()].index_below(accessors_.size());
    if (accessors_[index]["type"].text() != "SCALAR") continue;
    std::vector<double> values = attribute(attributes, name.c_str(), 1).front();
    if (values.size() != count)
      throw attributes.error("the attributes have different numbers of elements");
    own.emplace(lower_case(name.substr(1)), std::move(values));
  }
  if (before == 0) {
    own_columns_ = std::move(own);
    return;
  }
  std::erase_if(own_columns_, [&](const auto& column) { return !own.contains(column.first); });
  for (auto& [name, values] : own_columns_) {
    const std::vector<double>& more = own.at(name);
    values.insert(values.end(), more.begin(), more.end());
  }
}

/// The origin and the comments that exports of splats have.
void GltfReader::read_extras(const GltfMember& node) {
  const std::optional<GltfMember> extras = node.find("extras");
  if (!extras || !extras->is_object()) return;
  if (const std::optional<GltfMember> origin = extras->find("origin"); origin && !origin_) {
    const auto o = origin->numbers<3>();
    origin_ = Vec3d{o[0], o[1], o[2]};
  }
  if (const std::optional<GltfMember> comments = extras->find("adasplats"))
    for (const GltfMember& comment : comments->elements()) comments_.push_back(comment.text());
}

Table GltfReader::read_splats() {
  wants_splats_ = true;
  splats_.resize(kSplatColumns.size());
  add_scene();
  Table table;
  table.rows = splats_[0].size();
  const Vec3d origin = origin_.value_or(Vec3d{});
  for (int axis = 0; axis < 3; ++axis)
    for (double& value : splats_[static_cast<std::size_t>(axis)]) value += origin[axis];
  for (std::size_t k = 0; k < kSplatColumns.size(); ++k)
    table.columns.push_back({kSplatColumns[k], std::move(splats_[k])});
  for (auto& [name, values] : own_columns_) table.columns.push_back({name, std::move(values)});
  table.comments = std::move(comments_);
  table.crs = crs_of_comments(path_, table.comments);
  return table;
}

}  // namespace

Table read_gltf_splats(const std::filesystem::path& path) { return GltfReader(path).read_splats(); }

bool has_gltf_splats(const std::filesystem::path& path) {
  constexpr std::size_t kHeaderBytes = 20;  // of the file and of the chunk of JSON
  InputFile file(path);
  const auto begin_of = [&](std::uint64_t bytes) {
    const auto all = static_cast<std::size_t>(std::min(bytes, file.size_bytes()));
    return std::string_view(reinterpret_cast<const char*>(file.peek(all).data()), all);
  };
  std::uint64_t bytes = file.size_bytes();
  if (const std::string_view header = begin_of(kHeaderBytes); header.starts_with("glTF"))
    bytes = kHeaderBytes + word_at(header, 12).value_or(0);
  return begin_of(bytes).find(std::string("\"") + kSplatting + "\"") != std::string_view::npos;
}

MeshTable read_gltf_mesh(const std::filesystem::path& path) { return GltfReader(path).read(); }

std::vector<std::filesystem::path> gltf_buffer_files(const std::filesystem::path& path) {
  return GltfReader(path).buffer_files();
}

bool is_gltf(const std::filesystem::path& path) {
  constexpr std::size_t kLookedAt = 64;
  std::string_view begin;
  InputFile file(path);
  const auto bytes =
      static_cast<std::size_t>(std::min<std::uint64_t>(kLookedAt, file.size_bytes()));
  begin = {reinterpret_cast<const char*>(file.peek(bytes).data()), bytes};
  if (begin.starts_with("glTF")) return true;
  const std::size_t first = begin.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos || begin[first] != '{') return false;
  return read_file(path).find("\"asset\"") != std::string::npos;
}

}  // namespace adasplats
