// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/view/scan_packet.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <initializer_list>
#include <stdexcept>
#include <vector>

#include "adasplats/cloud/poses/rotation.h"

namespace adasplats {
namespace {

static_assert(std::endian::native == std::endian::little);
constexpr double kPi = 3.14159265358979323846;

enum PacketFlags : std::uint32_t { has_classes = 1, has_intensities = 2, moved = 4, returns = 8 };

struct PacketHead {
  std::uint32_t magic = 0x4e435341;  // "ASCN"
  std::uint32_t version = 1;
  std::uint32_t number, points, rays, rings, columns, flags;
  float pose[7];
  float seconds, max_range_m;
  std::uint32_t unused[3] = {};
};
static_assert(sizeof(PacketHead) == 80);

struct PacketPoint {
  Vec3f position;
  std::uint16_t ring = 0;
  std::uint16_t class_id = 0;
  std::uint32_t column = 0;
  std::uint16_t intensity = 0;
  std::uint16_t return_index = 0;
};
static_assert(sizeof(PacketPoint) == 24);

std::uint16_t intensity_code(float intensity, float full) {
  const double share = static_cast<double>(intensity) / static_cast<double>(full);
  // Also rejects NaN.
  if (!(share > 0)) return 0;
  return static_cast<std::uint16_t>(std::lround(std::min(share, 1.0) * 65535));
}

void require_size(std::size_t points, std::initializer_list<std::size_t> attributes) {
  for (const std::size_t size : attributes)
    if (size != 0 && size != points)
      throw std::logic_error(
          "scan packet: the size of an attribute differs from the number of points");
}

/// Writes the head of a packet and then its points.
class PacketWriter {
 public:
  PacketWriter(const ScanPacketHead& head, const RigidTransform& world_from_sensor,
               std::size_t points, std::size_t rays, std::uint32_t flags)
      : bytes_(std::make_shared<std::string>(sizeof(PacketHead) + points * sizeof(PacketPoint),
                                             '\0')) {
    const Vec3d p = world_from_sensor.translation - head.local_origin;
    const Quaternion q = quaternion_from_rotation(world_from_sensor.rotation);
    PacketHead packet{};
    packet.number = head.number;
    packet.points = static_cast<std::uint32_t>(points);
    packet.rays = static_cast<std::uint32_t>(rays);
    packet.rings = head.rings;
    packet.columns = head.columns;
    packet.flags = flags | (head.moved ? PacketFlags::moved : 0U);
    const double pose[7] = {p.x, p.y, p.z, q.x, q.y, q.z, q.w};
    for (std::size_t k = 0; k < 7; ++k) packet.pose[k] = static_cast<float>(pose[k]);
    packet.seconds = static_cast<float>(head.seconds);
    packet.max_range_m = static_cast<float>(head.max_range_m);
    std::memcpy(bytes_->data(), &packet, sizeof(packet));
  }

  void add_point(const PacketPoint& point) {
    std::memcpy(bytes_->data() + offset_, &point, sizeof(point));
    offset_ += sizeof(point);
  }
  std::shared_ptr<const std::string> bytes() const { return bytes_; }

 private:
  std::shared_ptr<std::string> bytes_;
  std::size_t offset_ = sizeof(PacketHead);
};

double elevation_rad(Vec3f point) {
  const Vec3d p = vec_cast<double>(point);
  return std::atan2(p.z, std::hypot(p.x, p.y));
}

/// Rings and columns of directions.
class DirectionGrid {
 public:
  DirectionGrid(const KittiScan& scan, const std::vector<std::uint32_t>& points,
                const ScanPacketHead& head)
      : rings_(std::min(head.rings, 65536U)), columns_(head.columns) {
    std::vector<double> elevations;
    elevations.reserve(points.size());
    for (const std::uint32_t i : points) elevations.push_back(elevation_rad(scan.positions[i]));
    if (elevations.empty()) return;
    const auto permille = [&](std::size_t share) {
      const auto at =
          elevations.begin() + static_cast<std::ptrdiff_t>((elevations.size() - 1) * share / 1000);
      std::nth_element(elevations.begin(), at, elevations.end());
      return *at;
    };
    low_ = permille(5);
    high_ = permille(995);
  }

  std::uint16_t ring(Vec3f point) const {
    const double share = (high_ - elevation_rad(point)) / (high_ - low_);
    return static_cast<std::uint16_t>(step(share, rings_));
  }
  std::uint32_t column(Vec3f point) const {
    const double azimuth = std::atan2(static_cast<double>(point.y), static_cast<double>(point.x));
    return step((kPi - azimuth) / (2 * kPi), columns_);
  }

 private:
  static std::uint32_t step(double share, std::uint32_t steps) {
    if (steps == 0 || !(share > 0)) return 0;
    const double at = std::floor(share * steps);
    return at < steps ? static_cast<std::uint32_t>(at) : steps - 1;
  }

  std::uint32_t rings_, columns_;
  double low_ = 0, high_ = 0;
};

}  // namespace

std::shared_ptr<const std::string> scan_packet(const Scan& scan, const ScanPacketHead& head) {
  require_size(scan.size(), {scan.classes.size(), scan.intensities.size(), scan.rings.size(),
                             scan.columns.size(), scan.return_indices.size()});
  const std::uint32_t flags = (scan.classes.empty() ? 0U : PacketFlags::has_classes) |
                              (scan.intensities.empty() ? 0U : PacketFlags::has_intensities) |
                              (scan.return_indices.empty() ? 0U : PacketFlags::returns);
  PacketWriter writer(head, scan.world_from_sensor, scan.size(), scan.rays, flags);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    PacketPoint point{scan.positions[i]};
    if (!scan.rings.empty()) point.ring = scan.rings[i];
    if (!scan.classes.empty()) point.class_id = scan.classes[i];
    if (!scan.columns.empty()) point.column = scan.columns[i];
    if (!scan.intensities.empty())
      point.intensity = intensity_code(scan.intensities[i], head.full_intensity);
    if (!scan.return_indices.empty()) point.return_index = scan.return_indices[i];
    writer.add_point(point);
  }
  return writer.bytes();
}

std::shared_ptr<const std::string> recorded_scan_packet(const KittiScan& scan,
                                                        const RigidTransform& world_from_sensor,
                                                        const ScanPacketHead& head) {
  require_size(scan.positions.size(), {scan.classes.size(), scan.intensities.size()});
  std::vector<std::uint32_t> finite;
  for (std::size_t i = 0; i < scan.positions.size(); ++i)
    if (is_finite(scan.positions[i])) finite.push_back(static_cast<std::uint32_t>(i));
  const std::uint32_t flags = (scan.classes.empty() ? 0U : PacketFlags::has_classes) |
                              (scan.intensities.empty() ? 0U : PacketFlags::has_intensities);
  PacketWriter writer(head, world_from_sensor, finite.size(), finite.size(), flags);
  const DirectionGrid grid(scan, finite, head);
  for (const std::uint32_t i : finite) {
    PacketPoint point{scan.positions[i], grid.ring(scan.positions[i])};
    if (!scan.classes.empty()) point.class_id = scan.classes[i];
    point.column = grid.column(scan.positions[i]);
    if (!scan.intensities.empty())
      point.intensity = intensity_code(scan.intensities[i], head.full_intensity);
    writer.add_point(point);
  }
  return writer.bytes();
}

float full_intensity_of(std::span<const float> intensities) {
  float max = 0;
  for (const float intensity : intensities)
    if (std::isfinite(intensity)) max = std::max(max, intensity);
  for (const float full : {1.0F, 255.0F, 65535.0F})
    if (max <= full) return full;
  return max;
}

}  // namespace adasplats
