// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/view/view_pages.h"

#include <algorithm>
#include <charconv>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "adasplats/view/page_files.h"
#include "adasplats/view/scan_packet.h"

namespace adasplats {
namespace {

/// Rows and columns of the range image of a recorded scan, which has no rings.
constexpr std::uint32_t kRecordedRings = 64;
constexpr std::uint32_t kRecordedColumns = 2048;

/// A whole number without sign or blanks.
std::optional<std::size_t> number_of(std::string_view text) {
  std::size_t number = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (failure != std::errc() || end != text.data() + text.size() || text.empty()) return {};
  return number;
}

/// "NUMBER.bin".
std::optional<std::size_t> binary_number(std::string_view name) {
  if (!name.ends_with(".bin")) return {};
  return number_of(name.substr(0, name.size() - 4));
}

SharedBytes shared(std::string bytes) {
  return std::make_shared<const std::string>(std::move(bytes));
}

/// Without a body: the server sends the same response as for a wrong token.
HttpReply not_found() {
  HttpReply reply;
  reply.status = 404;
  return reply;
}

HttpReply binary(SharedBytes bytes) {
  HttpReply reply;
  reply.body = std::move(bytes);
  return reply;
}

}  // namespace

ViewPages::ViewPages(const ViewScene& scene)
    : scene_(scene), scene_json_(shared(adasplats::scene_json(scene))) {}

HttpReply ViewPages::get(std::string_view path) const {
  if (path == "scene.json") return {200, "application/json", scene_json_};
  if (path.starts_with("layers/")) return layer(path.substr(7));
  if (path.starts_with("scans/")) return recorded_scan(path.substr(6));
  const std::string_view name = path.empty() ? "index.html" : path;
  for (const PageFile& file : page_files())
    if (file.name == name)
      return {200, std::string(file.content_type), shared(std::string(file.bytes))};
  return not_found();
}

/// Layers are numbered first, then the geometries of objects.
const ViewLayer* ViewPages::layer_of(std::string_view text) const {
  const auto number = number_of(text);
  const std::size_t layers = scene_.layers.size();
  if (!number || *number >= layers + scene_.geometries.size()) return nullptr;
  return *number < layers ? &scene_.layers[*number] : &scene_.geometries[*number - layers];
}

/// "L/table/B.bin" or "L/nodes/N.bin".
HttpReply ViewPages::layer(std::string_view path) const {
  const std::size_t slash = path.find('/');
  const ViewLayer* const found = layer_of(path.substr(0, slash));
  if (slash == std::string_view::npos || found == nullptr) return not_found();
  const std::string_view rest = path.substr(slash + 1);
  const bool is_table = rest.starts_with("table/");
  if (!is_table && !rest.starts_with("nodes/")) return not_found();
  const auto number = binary_number(rest.substr(6));
  const std::span<const LevelNode> nodes = nodes_of(*found);
  const std::size_t numbers =
      is_table ? (nodes.size() + kTableBlock - 1) / kTableBlock : nodes.size();
  if (!number || *number >= numbers) return not_found();
  if (!is_table) return binary(shared(node_bytes(*found, *number)));
  const std::size_t first = *number * kTableBlock;
  return binary(
      shared(nodes_bytes(nodes.subspan(first, std::min(kTableBlock, nodes.size() - first)))));
}

HttpReply ViewPages::recorded_scan(std::string_view name) const {
  const auto index = binary_number(name);
  if (!index) return not_found();
  std::size_t number = *index;  // in all sequences, then in its own
  for (const ViewSequence& sequence : scene_.sequences) {
    const KittiSequence& scans = sequence.scans;
    if (number >= scans.scans.size()) {
      number -= scans.scans.size();
      continue;
    }
    const KittiScan scan = read_kitti_scan(scans, number);
    ScanPacketHead head;
    head.number = static_cast<std::uint32_t>(*index);
    head.rings = kRecordedRings;
    head.columns = kRecordedColumns;
    head.max_range_m = 120;
    head.full_intensity = full_intensity_of(scan.intensities);
    head.local_origin = scene_.origin;
    return binary(recorded_scan_packet(scan, scans.trajectory[number].world_from_sensor, head));
  }
  return not_found();
}

}  // namespace adasplats
