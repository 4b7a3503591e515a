// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/packet_revolutions.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "adasplats/core/error.h"

namespace adasplats {

namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kHour_ns = 3600 * kSecond_ns;
constexpr std::int64_t kOwnClock_ns = 60 * kSecond_ns;  // PTP and UTC differ by less

/// The nearest multiple of an hour.
std::int64_t whole_hours_ns(std::int64_t time_ns) {
  const std::int64_t half = time_ns >= 0 ? kHour_ns / 2 : -kHour_ns / 2;
  return (time_ns + half) / kHour_ns * kHour_ns;
}

}  // namespace

std::int64_t SensorClock::time_ns(std::int64_t sensor_ns, std::uint64_t captured_ns,
                                  const std::string& what) {
  constexpr std::uint64_t kLatest_ns = std::uint64_t{1} << 62U;  // in the year 2116
  if (captured_ns > kLatest_ns)
    throw Error(ErrorKind::data, what + ": its capture time is after the year 2116");
  const auto captured = static_cast<std::int64_t>(captured_ns);
  if (!has_begun_) {
    const std::int64_t ahead_ns = captured - sensor_ns;
    if (is_hourly_) shift_ns_ = whole_hours_ns(ahead_ns);
    if (!is_hourly_ && std::abs(ahead_ns) > kOwnClock_ns) shift_ns_ = ahead_ns;
  }
  std::int64_t time_ns = sensor_ns + shift_ns_;
  if (has_begun_) {
    const std::int64_t expected_ns =
        last_ns_ + captured - static_cast<std::int64_t>(last_captured_ns_);
    if (is_hourly_) {
      shift_ns_ += whole_hours_ns(expected_ns - time_ns);
      time_ns = sensor_ns + shift_ns_;
    }
    if (std::abs(time_ns - expected_ns) > kSecond_ns)
      throw Error(ErrorKind::data,
                  what + ": the sensor's clock jumps by " +
                      std::to_string(static_cast<double>(time_ns - expected_ns) /
                                     static_cast<double>(kSecond_ns)) +
                      " s relative to the capture (was it set?); split the capture there");
  }
  has_begun_ = true;
  last_ns_ = time_ns;
  last_captured_ns_ = captured_ns;
  return time_ns;
}

RevolutionFinder::RevolutionFinder(const PacketDecoder& decoder, PacketSource& source)
    : decoder_(decoder),
      source_(source),
      clock_(decoder.traits().is_hourly),
      column_ns_(std::llround(decoder.column_s() * static_cast<double>(kSecond_ns))) {}

void RevolutionFinder::add(const SensorPacket& packet, const std::string& what) {
  const std::vector<MeasuredColumn> columns = decoder_.columns(packet.bytes);
  const std::int64_t first_ns = columns.front().time_ns;
  const std::int64_t begin_ns = clock_.time_ns(first_ns, packet.time_ns, what);
  if (decoder_.is_dual(packet.bytes)) ++source_.dual_packets;
  if (source_.packets == 0)
    source_.ahead_ns = static_cast<std::int64_t>(packet.time_ns) - begin_ns +
                       (decoder_.traits().is_hourly ? 0 : clock_.shift_ns());
  ++source_.packets;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (!columns[k].is_valid) continue;
    const std::int64_t time_ns = begin_ns + columns[k].time_ns - first_ns;
    const bool begins_anew = source_.revolutions.empty() || time_ns - last_ns_ > turn_ns() / 2;
    const bool begins = begins_anew || begins_revolution(columns[k]);
    if (begins_anew || (begins && decoder_.traits().has_frames)) cut_step_ = cut_before(columns[k]);
    if (begins) {
      if (!begins_anew) check_turn(columns[k], time_ns);
      source_.revolutions.push_back({packet.place, k, 0, 0, time_ns, time_ns, false});
      first_step_ = since_cut(columns[k]);
    }
    if (!begins || !decoder_.traits().has_pauses) count_gap(columns[k], time_ns, k > 0);
    Revolution& now = source_.revolutions.back();
    ++now.columns;
    now.share = share_of_turn(columns[k]);
    if (columns[k].lasts_ns != 0) column_ns_ = columns[k].lasts_ns;
    now.end_ns = time_ns + column_ns_;
    now.has_points = now.has_points || decoder_.has_returns(packet.bytes, k);
    last_ = columns[k];
    last_ns_ = time_ns;
  }
}

std::int64_t RevolutionFinder::turn_ns() const {
  return static_cast<std::int64_t>(static_cast<double>(kSecond_ns) /
                                   decoder_.sensor().model.rotation_hz);
}

std::uint32_t RevolutionFinder::cut_before(const MeasuredColumn& column) const {
  if (decoder_.traits().has_frames) return column.step;
  if (decoder_.traits().has_cut) return 0;
  // A quarter of a column earlier: azimuths are rounded.
  const std::uint32_t turn = decoder_.steps_per_turn();
  return (column.step + turn - turn / (4 * decoder_.sensor().model.columns)) % turn;
}

std::uint32_t RevolutionFinder::since_cut(const MeasuredColumn& column) const {
  const std::uint32_t turn = decoder_.steps_per_turn();
  return (column.step + turn - cut_step_) % turn;
}

bool RevolutionFinder::begins_revolution(const MeasuredColumn& column) const {
  if (decoder_.traits().has_frames) return column.frame != last_.frame;
  const std::uint32_t back = decoder_.steps_per_turn() / 720;  // half a degree
  return since_cut(column) + back < since_cut(last_);
}

void RevolutionFinder::check_turn(const MeasuredColumn& column, std::int64_t time_ns) {
  if (!decoder_.traits().has_frames || decoder_.traits().has_pauses) return;
  const std::uint32_t turn = decoder_.steps_per_turn();
  const double missing = (column.step + turn - last_.step) % turn;
  const double passed = static_cast<double>(time_ns - last_ns_) / static_cast<double>(column_ns_);
  if (std::fabs(std::remainder(passed - missing, turn)) < turn / 8.0) return;
  ++source_.odd_turns;
  if (!source_.contradiction.empty()) return;
  const LidarModel& model = decoder_.sensor().model;
  source_.contradiction = "end revolutions after column " + std::to_string(last_.step) + ", but " +
                          model.name + " has " + std::to_string(model.columns) +
                          " columns per revolution";
}

double RevolutionFinder::share_of_turn(const MeasuredColumn& last) const {
  const double turn = decoder_.steps_per_turn();
  const double steps = static_cast<double>(since_cut(last)) - first_step_;
  return steps / turn + 1.0 / decoder_.sensor().model.columns;
}

void RevolutionFinder::count_gap(const MeasuredColumn& column, std::int64_t time_ns,
                                 bool within_packet) {
  if (time_ns - last_ns_ < 3 * column_ns_ / 2 || is_pause(column, within_packet)) return;
  if (source_.packets == 1) return;
  const std::int64_t missing = (time_ns - last_ns_ + column_ns_ / 2) / column_ns_ - 1;
  const std::uint64_t lost = columns_of_window(missing);
  if (lost == 0) return;
  ++source_.gaps;
  source_.lost_columns += lost;
}

bool RevolutionFinder::is_pause(const MeasuredColumn& column, bool within_packet) {
  if (decoder_.traits().has_frames) return false;
  if (within_packet) {
    pause_ = {last_.step, column.step};
    return true;
  }
  const std::uint32_t turn = decoder_.steps_per_turn();
  const auto are_near = [&](std::uint32_t a, std::uint32_t b) {
    const std::uint32_t apart = (a + turn - b) % turn;
    return std::min(apart, turn - apart) <= turn / 360;
  };
  return pause_ && are_near(pause_->first, last_.step) && are_near(pause_->second, column.step);
}

std::uint64_t RevolutionFinder::columns_of_window(std::int64_t missing) const {
  const LidarModel& model = decoder_.sensor().model;
  const auto all = static_cast<std::uint64_t>(missing);
  if (!model.has_window() || !decoder_.traits().has_frames) return all;
  const auto fired_before = [&](std::uint64_t end) {
    std::uint64_t fired = 0;
    for (std::uint64_t k = 0; k < end; ++k)
      if (model.fires_in(static_cast<std::uint32_t>((last_.step + 1 + k) % model.columns))) ++fired;
    return fired;
  };
  return all / model.columns * fired_before(model.columns) + fired_before(all % model.columns);
}

}  // namespace adasplats
