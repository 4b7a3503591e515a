// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/packet_writer.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/core/function_ref.h"
#include "adasplats/dataset/writer_with_poses.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/packets/capture_writer.h"
#include "adasplats/sensors/packet_encoder.h"

namespace adasplats {
namespace {

constexpr double kNanosecondsInSecond = 1e9;
constexpr std::uint64_t kNanosecondsInMicrosecond = 1000;
constexpr double kSecondsInHour = 3600;
constexpr double kMaxOverlap = 0.05;  // of a revolution: recorded poses are slightly irregular

UdpEndpoint everyone(std::uint16_t port) {
  return {{255, 255, 255, 255, 255, 255}, {255, 255, 255, 255}, port};
}

PacketSensor sensor_of(const PacketOptions& options) {
  if (options.sensor == nullptr)
    throw Error(
        ErrorKind::usage,
        "packets need the sensor that measured the scans; only a simulation can write them, "
        "not a conversion of scans");
  require_packets(*options.sensor, options);
  return written_sensor(*options.sensor);
}

class PacketWriter final : public WriterWithPoses {
 public:
  /// Without `sink`, the packets go to a capture.
  PacketWriter(std::filesystem::path folder, const PacketOptions& options, PacketSink sink)
      : WriterWithPoses(std::move(folder)),
        options_(options),
        shift_s_(options.shift_s.value_or(0)),
        stream_(options, sink ? std::move(sink) : capture_sink()) {}

  EncodedScan encode(std::size_t /*index*/, const ScanView& scan) const override {
    EncodedScan encoded;
    encoded.pose = {scan.time_s, scan.world_from_sensor};
    encoded.points = scan.size();
    encoded.packet_returns = stream_.returns_of(scan);
    return encoded;
  }

  void append(std::size_t index, const EncodedScan& scan) override {
    // A revolution around time 0 begins before it: all is an hour later then.
    if (index == 0 && !options_.shift_s && scan.pose.time_s + options_.begin_after_s < 0)
      shift_s_ = kSecondsInHour;
    const double begin_s = scan.pose.time_s + options_.begin_after_s + shift_s_;
    stream_.add(begin_s, scan.packet_returns);
    EncodedScan middle;
    middle.pose = {begin_s + 0.5 * stream_.turn_s() - options_.time_offset_s,
                   scan.pose.world_from_sensor};
    WriterWithPoses::append(index, middle);
  }

  std::string main_file(std::size_t /*index*/) const override { return ""; }

  void finish() override {
    stream_.flush();
    if (capture_) capture_->finish();
    const CalibrationFile calibration = calibration_file(stream_.sensor());
    write_file(folder() / calibration.name, calibration.text);
    WriterWithPoses::finish();
  }

 private:
  PacketSink capture_sink() {
    capture_.emplace(folder() / "drive.pcap");
    return [this](std::uint64_t time_us, const UdpEndpoint& from, const UdpEndpoint& to,
                  const std::string& payload) { capture_->add(time_us, from, to, payload); };
  }

  PacketOptions options_;
  std::optional<CaptureWriter> capture_;
  double shift_s_;  ///< added to all times
  PacketStream stream_;
};

/// Hesai's packets have no times of columns or beams and no origins; readers use those of the
/// model.
void require_hesai(const LidarModel& model, const PacketSensor& sensor,
                   FunctionRef<void(const std::string&)> reject) {
  constexpr double kMicroseconds = 1e6, kTolerance = 1e-3;
  const double step_s = written_column_s(sensor.format);
  if (std::fabs(sensor.column_s() / step_s - 1) > kTolerance)
    reject("they have a column every " + std::to_string(kMicroseconds * step_s) +
           " us, but the sensor every " + std::to_string(kMicroseconds * sensor.column_s()) +
           " us; change its columns or --rotation-rate");
  if (!model.beam_origins_m.empty() &&
      std::ranges::any_of(model.beam_origins_m, [](const Vec3d& at) { return at != Vec3d{}; }))
    reject("they hold no beam origins");
  if (!model.firing_times_s.empty() && std::ranges::min(model.firing_times_s) != 0)
    reject("columns begin with the first shot, so the least of its firing_times_us must be 0");
  calibration_file(sensor);  // throws if the file cannot represent the sensor
}

}  // namespace

void require_packets(const LidarModel& model, const PacketOptions& options) {
  const PacketSensor sensor = written_sensor(model);
  const auto reject = [&](const std::string& why) {
    throw Error(ErrorKind::usage, "cannot write packets of sensor '" + model.name + "': " + why);
  };
  if (options.returns > 1) reject("they hold one return per firing; use --returns 1");
  if (options.has_angular_noise && model.angular_noise_rad > 0)
    reject(
        "they do not hold beam angles, so angular noise would be lost; use --no-noise or a sensor "
        "without angular noise");
  if (!options.is_raw)
    reject("they hold points as measured, without motion compensation; use --points raw");
  const double max_m = sensor.facts.max_counts * sensor.facts.quantum_m;
  if (model.max_range_m > max_m)
    reject("they hold ranges up to " + std::to_string(max_m) +
           " m, but the sensor measures up to " + std::to_string(model.max_range_m) +
           " m; reduce --max-range");
  if (is_hesai(sensor.format)) require_hesai(model, sensor, reject);
  if (!is_ouster(sensor.format)) return;
  const std::string mode =
      std::to_string(model.columns) + "x" + std::to_string(std::lround(model.rotation_hz));
  constexpr const char* kModes[] = {"512x10", "512x20", "1024x10", "1024x20", "2048x10", "4096x5"};
  if (std::ranges::find(kModes, mode) == std::end(kModes) ||
      model.rotation_hz != std::round(model.rotation_hz))
    reject("its mode " + mode +
           " is not supported, expected 512x10, 512x20, 1024x10, 1024x20, 2048x10 or 4096x5");
  calibration_file(sensor);  // throws if the metadata cannot represent the sensor
}

PacketStream::PacketStream(const PacketOptions& options, PacketSink sink)
    : options_(options),
      sensor_(sensor_of(options)),
      sender_(options.sender.value_or(factory_sender(sensor_.facts.port))),
      sink_(std::move(sink)),
      turn_s_(1.0 / sensor_.model.rotation_hz),
      column_s_(turn_s_ / sensor_.model.columns),
      nothing_(sensor_.lasers()) {}

std::vector<PacketReturn> PacketStream::returns_of(const ScanView& scan) const {
  if (scan.rings.size() != scan.size() || scan.columns.size() != scan.size() ||
      scan.ranges_m.size() != scan.size())
    throw std::logic_error("packets need rings, columns and ranges of the scan");
  std::vector<PacketReturn> returns(sensor_.lasers() * sensor_.model.columns);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const std::size_t ring = scan.rings[i];
    const std::size_t place = scan.columns[i] * sensor_.lasers() + sensor_.laser_of_ring.at(ring);
    returns.at(place) = return_of(scan, i, sensor_.range_offsets_m[ring]);
  }
  return returns;
}

void PacketStream::add(double begin_s, std::span<const PacketReturn> returns) {
  require_time(begin_s);
  const bool goes_on = end_s_ && std::fabs(begin_s - *end_s_) < 0.5 * column_s_;
  if (!goes_on) flush();
  const std::size_t lasers = sensor_.lasers();
  for (std::uint32_t column = 0; column < sensor_.model.columns; ++column)
    add_column(begin_s, column, returns.subspan(column * lasers, lasers));
  end_s_ = begin_s + turn_s_;
  ++scans_;
}

/// A range of the beam as counts; what came back is at least one.
PacketReturn PacketStream::return_of(const ScanView& scan, std::size_t i, double offset_m) const {
  const double range_m = static_cast<double>(scan.ranges_m[i]) - offset_m;
  const double counts = std::clamp(std::round(range_m / sensor_.facts.quantum_m), 1.0,
                                   static_cast<double>(sensor_.facts.max_counts));
  double share = scan.intensities.empty() ? 0.0 : static_cast<double>(scan.intensities[i]);
  share = std::isnan(share) ? 0.0 : std::clamp(share / options_.full_intensity, 0.0, 1.0);
  return {static_cast<std::uint32_t>(counts),
          static_cast<std::uint16_t>(std::lround(65535 * share))};
}

void PacketStream::require_time(double begin_s) const {
  const std::string scan =
      "scan " + std::to_string(scans_) + " begins at " + std::to_string(begin_s) + " s";
  if (begin_s < 0)
    throw Error(ErrorKind::data, scan + ", before 1970, which packets cannot represent");
  if (end_s_ && *end_s_ - begin_s > kMaxOverlap * turn_s_)
    throw Error(ErrorKind::data, scan + ", before the last one ended at " +
                                     std::to_string(*end_s_) +
                                     " s; use fewer poses or a higher rotation rate");
}

void PacketStream::add_column(double begin_s, std::uint32_t column,
                              std::span<const PacketReturn> returns) {
  const double late_ns = kNanosecondsInSecond * column_s_ * column;
  const auto begin_ns = static_cast<std::uint64_t>(
      std::llround((begin_s - options_.time_offset_s) * kNanosecondsInSecond));
  columns_.push_back({begin_ns + static_cast<std::uint64_t>(std::llround(late_ns)),
                      column % sensor_.model.columns,
                      static_cast<std::uint16_t>(scans_),
                      {}});
  returns_.emplace_back(returns.begin(), returns.end());
  columns_.back().returns = returns_.back();
  if (columns_.size() == sensor_.facts.columns) send();
}

void PacketStream::send() {
  const auto column_ns = static_cast<std::uint64_t>(std::llround(column_s_ * kNanosecondsInSecond));
  const auto offset_ns =
      static_cast<std::uint64_t>(std::llround(options_.time_offset_s * kNanosecondsInSecond));
  const std::uint64_t sent_us =
      (columns_.back().time_ns + column_ns + offset_ns) / kNanosecondsInMicrosecond;
  sent_us_ = std::max(sent_us_, sent_us);
  // Packets outside the window of an Ouster are not sent.
  const bool is_sent =
      !is_ouster(sensor_.format) || std::ranges::any_of(columns_, [&](const PacketColumn& column) {
        return sensor_.model.fires_in(column.column);
      });
  if (is_sent)
    sink_(sent_us_, sender_, everyone(sender_.port), encode_packet(sensor_, columns_, packets_++));
  columns_.clear();
  returns_.clear();
}

void PacketStream::flush() {
  for (std::uint32_t more = 0; !columns_.empty(); ++more)
    add_column(*end_s_ - turn_s_, sensor_.model.columns + more, nothing_);
}

std::unique_ptr<ScanWriter> make_packet_writer(const std::filesystem::path& folder,
                                               const ScanWriterOptions& options) {
  return std::make_unique<PacketWriter>(folder, options.packets, nullptr);
}

std::unique_ptr<ScanWriter> make_packet_writer(const std::filesystem::path& folder,
                                               const ScanWriterOptions& options, PacketSink sink) {
  return std::make_unique<PacketWriter>(folder, options.packets, std::move(sink));
}

// Locally administered hardware address.
UdpEndpoint factory_sender(std::uint16_t port) {
  return {{2, 0, 0, 0, 0, 1}, {192, 168, 1, 201}, port};
}

}  // namespace adasplats
