// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/las/copc.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/io/base/records.h"

namespace adasplats {
namespace {

// "COPC specification 1.0": the info record comes first after the header.
constexpr std::size_t kInfoBytes = 160;
constexpr std::uint16_t kInfoRecordId = 1;
constexpr std::size_t kEntryBytes = 32;
// Level 30 divides a cube of the size of the earth into centimetres.
constexpr std::int32_t kMaxLevel = 30;

struct CopcInfo {
  Vec3d center;
  double half_m = 0;     ///< of the root's cube
  double spacing_m = 0;  ///< of the points of the root
  std::uint64_t root_page_bytes_at = 0, root_page_bytes = 0;
};

/// A node of the octree: its level from 0 and its index among the 2^level cubes of each axis.
struct NodeKey {
  std::int32_t level = 0;
  std::array<std::int32_t, 3> at = {};

  auto operator<=>(const NodeKey&) const = default;
  std::string text() const {
    return std::to_string(level) + "-" + std::to_string(at[0]) + "-" + std::to_string(at[1]) + "-" +
           std::to_string(at[2]);
  }
  bool is_valid() const {
    const auto is_there = [this](std::int32_t k) { return k >= 0 && k >> level == 0; };
    return level >= 0 && level <= kMaxLevel && std::ranges::all_of(at, is_there);
  }
  /// Whether it is `other` or inside it.
  bool is_in(const NodeKey& other) const {
    if (level < other.level) return false;
    for (std::size_t axis = 0; axis < at.size(); ++axis)
      if (at[axis] >> (level - other.level) != other.at[axis]) return false;
    return true;
  }
};

/// An entry of a hierarchy page.
struct Entry {
  NodeKey key;
  std::uint64_t offset_bytes = 0;
  std::int32_t bytes = 0;
  std::int32_t points = 0;  ///< kIsPage: the offset is that of a page
};
constexpr std::int32_t kIsPage = -1;

Entry entry_at(const std::byte* bytes) {
  Entry entry;
  entry.key.level = load_value<std::int32_t>(bytes);
  for (std::size_t axis = 0; axis < 3; ++axis)
    entry.key.at[axis] = load_value<std::int32_t>(bytes + 4 + 4 * axis);
  entry.offset_bytes = load_value<std::uint64_t>(bytes + 16);
  entry.bytes = load_value<std::int32_t>(bytes + 24);
  entry.points = load_value<std::int32_t>(bytes + 28);
  return entry;
}

/// Nothing if the file is not COPC.
std::optional<CopcInfo> read_info(const std::filesystem::path& path, const LasHeader& header) {
  InputFile file(path);
  file.skip(header.header_bytes);
  if (header.vlr_count == 0) return std::nullopt;
  const std::span<const std::byte> start = file.peek(kVlrHeaderBytes);
  const std::string_view user(reinterpret_cast<const char*>(start.data()) + 2, 16);
  const bool is_copc = user.starts_with(std::string_view("copc\0", 5)) &&
                       load_value<std::uint16_t>(&start[18]) == kInfoRecordId;
  if (!is_copc) return std::nullopt;
  const std::size_t length = load_value<std::uint16_t>(&start[20]);
  if (length != kInfoBytes)
    throw file.error_here("COPC: found a first record of " + std::to_string(length) +
                          " bytes, expected " + std::to_string(kInfoBytes));
  file.skip(kVlrHeaderBytes);
  const std::byte* const bytes = file.peek(kInfoBytes).data();
  CopcInfo info;
  for (int axis = 0; axis < 3; ++axis)
    info.center[axis] = load_value<double>(bytes + 8 * static_cast<std::size_t>(axis));
  info.half_m = load_value<double>(bytes + 24);
  info.spacing_m = load_value<double>(bytes + 32);
  info.root_page_bytes_at = load_value<std::uint64_t>(bytes + 40);
  info.root_page_bytes = load_value<std::uint64_t>(bytes + 48);
  constexpr double kLargest_m = 1e12;  // as for coordinates in LAS headers
  const auto is_length = [](double v) { return v > 0 && v <= kLargest_m; };
  const double farthest_m =
      std::max({std::fabs(info.center.x), std::fabs(info.center.y), std::fabs(info.center.z)});
  if (!is_finite(info.center) || farthest_m > kLargest_m || !is_length(info.half_m) ||
      !is_length(info.spacing_m))
    throw file.error_here("COPC: the cube or the spacing of its points is invalid");
  return info;
}

/// Traverses the octree as far as the selection needs.
class OctreeReader {
 public:
  OctreeReader(const std::filesystem::path& path, const CopcInfo& info,
               const PointSelection& selection, const LazLayout& layout)
      : path_(path),
        info_(info),
        extent_(selection.extent.value_or(Extent())),
        last_level_(last_level(info, selection)),
        layout_(layout),
        is_taken_(layout.chunks.size()) {}

  /// The chunks of the selected nodes, in file order.
  std::vector<LazChunk> read() {
    pages_.push_back({{}, info_.root_page_bytes_at, info_.root_page_bytes});
    while (!pages_.empty()) {
      const Page page = pages_.back();
      pages_.pop_back();
      read_page(page);
    }
    std::vector<LazChunk> chunks;
    for (std::size_t k = 0; k < is_taken_.size(); ++k)
      if (is_taken_[k]) chunks.push_back(layout_.chunks[k]);
    return chunks;
  }

 private:
  struct Page {
    NodeKey key;
    std::uint64_t offset_bytes = 0, bytes = 0;
  };

  static std::int32_t last_level(const CopcInfo& info, const PointSelection& selection) {
    std::int32_t level = kMaxLevel;
    if (selection.level)
      level = static_cast<std::int32_t>(
          std::min<std::uint32_t>(*selection.level, static_cast<std::uint32_t>(kMaxLevel)));
    if (!selection.resolution_m) return level;
    std::int32_t fine = 0;
    while (fine < level && std::ldexp(info.spacing_m, -fine) > *selection.resolution_m) ++fine;
    return fine;
  }

  Error error(std::uint64_t offset, const std::string& message) const {
    return data_error({path_, offset, {}}, "COPC: " + message);
  }

  Extent cube_of(const NodeKey& key) const {
    const double side_m = std::ldexp(2 * info_.half_m, -key.level);
    Extent cube;
    for (int axis = 0; axis < 3; ++axis) {
      cube.low[axis] =
          info_.center[axis] - info_.half_m + side_m * key.at[static_cast<std::size_t>(axis)];
      cube.high[axis] = cube.low[axis] + side_m;
    }
    return cube;
  }

  void read_page(const Page& page) {
    InputFile file(path_);
    if (page.bytes == 0 || page.bytes % kEntryBytes != 0 || page.offset_bytes > file.size_bytes() ||
        page.bytes > file.size_bytes() - page.offset_bytes)
      throw error(page.offset_bytes, "the page of node " + page.key.text() + " has " +
                                         std::to_string(page.bytes) +
                                         " bytes there, expected entries of " +
                                         std::to_string(kEntryBytes) + " bytes within the file");
    if (!read_pages_.insert(page.offset_bytes).second)
      throw error(page.offset_bytes, "the page of node " + page.key.text() + " occurs twice");
    file.skip(page.offset_bytes);
    for (std::uint64_t at = 0; at < page.bytes; at += kEntryBytes) {
      const Entry entry = entry_at(file.peek(kEntryBytes).data());
      check(page, entry, file.offset());
      file.skip(kEntryBytes);
      take(entry);
    }
  }

  void check(const Page& page, const Entry& entry, std::uint64_t offset) {
    const std::string name = "node " + entry.key.text();
    if (!entry.key.is_valid() || !entry.key.is_in(page.key))
      throw error(offset, name + " is invalid, or not in node " + page.key.text() + " of its page");
    if (entry.points < kIsPage || entry.bytes < 0)
      throw error(offset, name + " has " + std::to_string(entry.points) + " points in " +
                              std::to_string(entry.bytes) + " bytes");
    const bool is_new = entry.points == kIsPage ? page_keys_.insert(entry.key).second
                                                : nodes_.insert(entry.key).second;
    if (!is_new) throw error(offset, name + " occurs twice");
  }

  void take(const Entry& entry) {
    if (entry.points == 0 || entry.key.level > last_level_) return;
    if (!cube_of(entry.key).meets(extent_)) return;
    if (entry.points == kIsPage)
      pages_.push_back({entry.key, entry.offset_bytes, static_cast<std::uint64_t>(entry.bytes)});
    else
      take_chunk(entry);
  }

  /// The points of a node are one chunk, which the chunk table must confirm.
  void take_chunk(const Entry& entry) {
    const auto found =
        std::ranges::lower_bound(layout_.chunks, entry.offset_bytes, {}, &LazChunk::offset_bytes);
    const std::string name = "node " + entry.key.text();
    const auto points = static_cast<std::uint64_t>(entry.points);
    if (found == layout_.chunks.end() || found->offset_bytes != entry.offset_bytes ||
        found->bytes != static_cast<std::uint64_t>(entry.bytes) || found->points != points)
      throw error(entry.offset_bytes, name + " has " + std::to_string(points) + " points in " +
                                          std::to_string(entry.bytes) +
                                          " bytes there, but the chunk table has no such chunk");
    const auto k = static_cast<std::size_t>(found - layout_.chunks.begin());
    if (is_taken_[k]) throw error(entry.offset_bytes, name + " has the points of another node");
    is_taken_[k] = true;
  }

  const std::filesystem::path& path_;
  const CopcInfo& info_;
  Extent extent_;
  std::int32_t last_level_;
  const LazLayout& layout_;
  std::vector<bool> is_taken_;  ///< of the chunks
  std::vector<Page> pages_;     ///< still to read
  std::set<std::uint64_t> read_pages_;
  std::set<NodeKey> nodes_, page_keys_;
};

/// Whether all points are outside the extent by the header's box, which the reader checks the
/// points of LAZ against. A box of zeros was never set.
bool is_beyond(const LasHeader& header, const Extent& extent) {
  if (header.box_min == Vec3d{} && header.box_max == Vec3d{}) return false;
  return !Extent{header.plausible_low(), header.plausible_high()}.meets(extent);
}

}  // namespace

void choose_chunks(const std::filesystem::path& path, const PointSelection& selection,
                   LazLayout& layout) {
  if ((!selection.extent && !selection.has_levels()) || layout.header.points == 0) return;
  const std::optional<CopcInfo> info = read_info(path, layout.header);
  if (!info) {
    require_no_levels(path, selection);
    if (!selection.extent || !is_beyond(layout.header, *selection.extent)) return;
    layout.chunks.clear();
    layout.has_table = true;
    layout.header.points = 0;
    return;
  }
  layout.chunks = OctreeReader(path, *info, selection, layout).read();
  layout.header.points = 0;
  for (const LazChunk& chunk : layout.chunks) layout.header.points += chunk.points;
}

}  // namespace adasplats
