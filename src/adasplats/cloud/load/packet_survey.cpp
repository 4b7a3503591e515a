// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/packet_survey.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/sensors/packet_layout.h"

namespace adasplats {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kHour_ns = 3600 * kSecond_ns;
constexpr std::int64_t kOwnClock_ns = 60 * kSecond_ns;  // what PTP and UTC differ by is less
constexpr std::size_t kMaxSources = 256;

/// The multiple of an hour that is nearest.
std::int64_t whole_hours_ns(std::int64_t time_ns) {
  const std::int64_t half = time_ns >= 0 ? kHour_ns / 2 : -kHour_ns / 2;
  return (time_ns + half) / kHour_ns * kHour_ns;
}

/// Cuts the columns of one source into revolutions.
class RevolutionFinder {
 public:
  RevolutionFinder(const PacketDecoder& decoder, PacketSource& source)
      : decoder_(decoder),
        source_(source),
        clock_(!is_ouster(decoder.sensor().format)),
        column_ns_(std::llround(decoder.column_s() * static_cast<double>(kSecond_ns))) {}

  void add(const Datagram& datagram, const std::string& what) {
    const std::vector<MeasuredColumn> columns = decoder_.columns(datagram.payload);
    const std::int64_t first_ns = columns.front().time_ns;
    const std::int64_t begin_ns = clock_.time_ns(first_ns, datagram.time_ns, what);
    if (decoder_.is_dual(datagram.payload)) ++source_.dual_packets;
    if (source_.packets == 0)
      source_.ahead_ns = static_cast<std::int64_t>(datagram.time_ns) - begin_ns +
                         (is_ouster(decoder_.sensor().format) ? clock_.shift_ns() : 0);
    ++source_.packets;
    for (std::size_t k = 0; k < columns.size(); ++k) {
      if (!columns[k].is_valid) continue;
      const std::int64_t time_ns = begin_ns + columns[k].time_ns - first_ns;
      const bool begins_anew = source_.revolutions.empty() || time_ns - last_ns_ > turn_ns() / 2;
      if (begins_anew) cut_step_ = cut_before(columns[k]);
      if (begins_anew || begins_revolution(columns[k])) {
        source_.revolutions.push_back({datagram.place, k, 0, 0, time_ns, time_ns, false});
        first_step_ = since_cut(columns[k]);
      }
      count_gap(time_ns);
      Revolution& now = source_.revolutions.back();
      ++now.columns;
      now.share = share_of_turn(columns[k]);
      now.end_ns = time_ns + column_ns_;
      now.has_points = now.has_points || decoder_.has_returns(datagram.payload, k);
      last_ = columns[k];
      last_ns_ = time_ns;
    }
  }

 private:
  std::int64_t turn_ns() const {
    return static_cast<std::int64_t>(static_cast<double>(kSecond_ns) /
                                     decoder_.sensor().model.rotation_hz);
  }
  /// The step that revolutions begin at, when a column is the first of several.
  std::uint32_t cut_before(const MeasuredColumn& column) const {
    const LidarModel& model = decoder_.sensor().model;
    if (is_ouster(decoder_.sensor().format) || model.first_azimuth_rad != 0) return 0;
    // A quarter of a column before it: azimuths are rounded.
    const std::uint32_t turn = decoder_.steps_per_turn();
    return (column.step + turn - turn / (4 * model.columns)) % turn;
  }
  std::uint32_t since_cut(const MeasuredColumn& column) const {
    const std::uint32_t turn = decoder_.steps_per_turn();
    return (column.step + turn - cut_step_) % turn;
  }
  /// The head went on past the end of a turn, or went back (it was elsewhere meanwhile).
  bool begins_revolution(const MeasuredColumn& column) const {
    if (is_ouster(decoder_.sensor().format) && column.frame != last_.frame) return true;
    const std::uint32_t back = decoder_.steps_per_turn() / 720;  // half a degree
    return since_cut(column) + back < since_cut(last_);
  }
  double share_of_turn(const MeasuredColumn& last) const {
    const double turn = decoder_.steps_per_turn();
    const double steps = static_cast<double>(since_cut(last)) - first_step_;
    return steps / turn + 1.0 / decoder_.sensor().model.columns;
  }
  void count_gap(std::int64_t time_ns) {
    if (source_.packets == 1 || time_ns - last_ns_ < 3 * column_ns_ / 2) return;
    ++source_.gaps;
    source_.lost_columns +=
        static_cast<std::uint64_t>((time_ns - last_ns_ + column_ns_ / 2) / column_ns_ - 1);
  }

  const PacketDecoder& decoder_;
  PacketSource& source_;
  SensorClock clock_;
  std::int64_t column_ns_, last_ns_ = 0;
  std::uint32_t cut_step_ = 0, first_step_ = 0;
  MeasuredColumn last_;
};

}  // namespace

std::int64_t SensorClock::time_ns(std::int64_t sensor_ns, std::uint64_t captured_ns,
                                  const std::string& what) {
  constexpr std::uint64_t kLatest_ns = std::uint64_t{1} << 62U;  // in the year 2116
  if (captured_ns > kLatest_ns)
    throw Error(ErrorKind::data, what + ": was captured after the year 2116");
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
                      " s against that of the capture, as when it is set; cut the capture there");
  }
  has_begun_ = true;
  last_ns_ = time_ns;
  last_captured_ns_ = captured_ns;
  return time_ns;
}

PacketSurvey survey_packets(const std::filesystem::path& path,
                            std::shared_ptr<const PacketDecoder> decoder, ProgressSink& progress) {
  PacketSurvey survey{path, std::move(decoder), {}, {}};
  std::map<std::string, RevolutionFinder> finders;
  DatagramReader reader(path);
  progress.begin_step("read " + path.filename().string(), 0);
  while (const auto datagram = reader.next()) {
    progress.advance(reader.counts().datagrams);
    const std::string name = address_text(datagram->from) + ":" + std::to_string(datagram->to_port);
    PacketSource& source = survey.sources[name];
    if (survey.sources.size() > kMaxSources)
      throw Error(ErrorKind::data, path.string() + ": datagrams from more than " +
                                       std::to_string(kMaxSources) +
                                       " sources, which is no capture of a sensor's");
    ++source.datagrams;
    if (!survey.decoder || !survey.decoder->has_size(datagram->payload)) continue;
    if (const auto objection = survey.decoder->objection(datagram->payload)) {
      if (source.objection.empty()) source.objection = *objection;
      continue;
    }
    const auto [finder, is_new] =
        finders.try_emplace(name, RevolutionFinder(*survey.decoder, source));
    finder->second.add(*datagram, path.string() + ": packet " + std::to_string(source.packets + 1) +
                                      " of " + name);
  }
  progress.end_step();
  survey.counts = reader.counts();
  return survey;
}

std::string sensor_of_capture(const std::filesystem::path& capture, const std::string& stated) {
  namespace fs = std::filesystem;
  if (!stated.empty()) return stated;
  std::error_code ignored;
  const fs::path folder = fs::absolute(capture, ignored).parent_path();
  const fs::path own = folder / (capture.stem().string() + ".json");
  if (fs::is_regular_file(own, ignored)) return own.string();
  std::vector<std::string> found;
  for (fs::directory_iterator entry(folder, ignored), end; !ignored && entry != end;
       entry.increment(ignored)) {
    const std::string name = entry->path().filename().string();
    if (name == "metadata.json" || (name.starts_with("calibration") && name.ends_with(".yaml")))
      found.push_back(entry->path().string());
  }
  std::ranges::sort(found);
  if (found.size() > 1)
    throw Error(ErrorKind::usage, capture.string() + ": beside it are " + found[0] + " and " +
                                      found[1] + "; `packets_of` states which sensor sent it");
  return found.empty() ? "" : found.front();
}

}  // namespace adasplats
