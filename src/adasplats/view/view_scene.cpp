// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/view/view_scene.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "adasplats/core/error.h"
#include "adasplats/view/page_files.h"
#include "adasplats/view/scan_packet.h"

namespace adasplats {
namespace {

/// Rows and columns of the range image of a recorded scan, whose rings are not known.
constexpr std::uint32_t kRecordedRings = 64;
constexpr std::uint32_t kRecordedColumns = 2048;

/// Positions relative to another origin; `storage` holds them where they differ.
std::span<const Vec3f> relative_to_origin(std::span<const Vec3f> positions, Vec3d from, Vec3d to,
                                          std::vector<Vec3f>& storage) {
  const Vec3d shift = from - to;
  if (shift.x == 0 && shift.y == 0 && shift.z == 0) return positions;
  storage.reserve(positions.size());
  for (const Vec3f& p : positions) storage.push_back(vec_cast<float>(vec_cast<double>(p) + shift));
  return storage;
}

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

HttpReply not_found() {
  HttpReply reply;
  reply.status = 404;
  reply.content_type = "text/plain; charset=utf-8";
  reply.body = shared("not found\n");
  return reply;
}

HttpReply binary(SharedBytes bytes) {
  HttpReply reply;
  reply.body = std::move(bytes);
  return reply;
}

}  // namespace

ViewLayer splat_layer(std::string name, const SplatModel& model, Vec3d origin,
                      const Executor& executor) {
  std::vector<Disk> storage;
  LevelInput input{.disks = model.disks,
                   .positions = {},
                   .classes = model.classes,
                   .intensities = model.intensities,
                   .errors_m = {}};
  const Vec3d shift = model.origin - origin;
  if (shift.x != 0 || shift.y != 0 || shift.z != 0) {
    storage = model.disks;
    for (Disk& disk : storage) disk.center = vec_cast<float>(vec_cast<double>(disk.center) + shift);
    input.disks = storage;
  }
  return {std::move(name),
          true,
          !model.classes.empty(),
          !model.intensities.empty(),
          false,
          LevelTree(input, {}, executor)};
}

ViewLayer point_layer(std::string name, const PointCloud& cloud, std::span<const float> errors_m,
                      Vec3d origin, const Executor& executor) {
  std::vector<Vec3f> storage;
  const LevelInput input{
      .disks = {},
      .positions = relative_to_origin(cloud.positions, cloud.origin, origin, storage),
      .classes = cloud.classes,
      .intensities = cloud.intensities,
      .errors_m = errors_m};
  return {std::move(name),        false,
          !cloud.classes.empty(), !cloud.intensities.empty(),
          !errors_m.empty(),      LevelTree(input, {}, executor)};
}

RigidTransform start_pose_of(const ViewScene& scene, double mount_height_m,
                             const Executor& executor) {
  for (const ViewSequence& sequence : scene.sequences)
    if (!sequence.scans.trajectory.empty())
      return sequence.scans.trajectory.front().world_from_sensor;
  for (const auto& [name, poses] : scene.trajectories)
    if (!poses.empty()) return poses.front().world_from_sensor;
  const auto [low, high] = scene.middle_box;
  RigidTransform pose;
  pose.translation = 0.5 * (low + high);
  pose.translation.z = low.z + mount_height_m;
  if (scene.model == nullptr) return pose;
  // Straight down from above: the ground, or the roof of what stands there.
  const Vec3d above = {pose.translation.x, pose.translation.y, high.z + 1};
  const Ray ray = {vec_cast<float>(above - scene.model->origin()),
                   0,
                   {0, 0, -1},
                   static_cast<float>(2 * (high.z - low.z) + 100)};
  Hit hit;
  scene.model->tracer().nearest(std::span(&ray, 1), std::span(&hit, 1), executor);
  if (hit.valid()) pose.translation.z = above.z - static_cast<double>(hit.t) + mount_height_m;
  return pose;
}

ViewPages::ViewPages(const ViewScene& scene)
    : scene_(scene), scene_json_(shared(adasplats::scene_json(scene))) {
  for (const ViewLayer& layer : scene_.layers) nodes_.push_back(shared(layer.tree.nodes_bytes()));
}

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

/// "L/nodes.bin" or "L/nodes/N.bin".
HttpReply ViewPages::layer(std::string_view path) const {
  const std::size_t slash = path.find('/');
  if (slash == std::string_view::npos) return not_found();
  const auto number = number_of(path.substr(0, slash));
  if (!number || *number >= scene_.layers.size()) return not_found();
  const std::string_view rest = path.substr(slash + 1);
  if (rest == "nodes.bin") return binary(nodes_[*number]);
  if (!rest.starts_with("nodes/")) return not_found();
  const LevelTree& tree = scene_.layers[*number].tree;
  const auto node = binary_number(rest.substr(6));
  if (!node || *node >= tree.nodes().size()) return not_found();
  const auto bytes = std::as_bytes(tree.elements(*node));
  // Bytes as characters: what a reply's body is made of.
  return binary(shared(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size())));
}

HttpReply ViewPages::recorded_scan(std::string_view name) const {
  const auto asked = binary_number(name);
  if (!asked) return not_found();
  std::size_t number = *asked;  // among all sequences, then in its own
  for (const ViewSequence& sequence : scene_.sequences) {
    const KittiSequence& scans = sequence.scans;
    if (number >= scans.scans.size()) {
      number -= scans.scans.size();
      continue;
    }
    const KittiScan scan = read_kitti_scan(scans, number);
    ScanPacketHead head;
    head.number = static_cast<std::uint32_t>(*asked);
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
