// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/packet_drive.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <utility>

#include "adasplats/cloud/load/recording_poses.h"
#include "adasplats/cloud/load/sensor_drive.h"
#include "adasplats/core/error.h"
#include "adasplats/core/maths/median.h"
#include "adasplats/sensors/packet_layout.h"

namespace adasplats {

namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kHour_ns = 3600 * kSecond_ns;
constexpr std::int64_t kOwnClock_ns = 60 * kSecond_ns;  // PTP and UTC differ by less
constexpr std::size_t kMaxSources = 256;

/// The nearest multiple of an hour.
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
        clock_(decoder.traits().is_hourly),
        column_ns_(std::llround(decoder.column_s() * static_cast<double>(kSecond_ns))) {}

  void add(const SensorPacket& packet, const std::string& what) {
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
      if (begins_anew || (begins && decoder_.traits().has_frames))
        cut_step_ = cut_before(columns[k]);
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

 private:
  std::int64_t turn_ns() const {
    return static_cast<std::int64_t>(static_cast<double>(kSecond_ns) /
                                     decoder_.sensor().model.rotation_hz);
  }
  /// The step at which revolutions begin, if this column is the first.
  std::uint32_t cut_before(const MeasuredColumn& column) const {
    if (decoder_.traits().has_frames) return column.step;
    if (decoder_.traits().has_cut) return 0;
    // A quarter of a column earlier: azimuths are rounded.
    const std::uint32_t turn = decoder_.steps_per_turn();
    return (column.step + turn - turn / (4 * decoder_.sensor().model.columns)) % turn;
  }
  std::uint32_t since_cut(const MeasuredColumn& column) const {
    const std::uint32_t turn = decoder_.steps_per_turn();
    return (column.step + turn - cut_step_) % turn;
  }
  /// The head passed the end of a turn, or went back (packets are missing).
  bool begins_revolution(const MeasuredColumn& column) const {
    if (decoder_.traits().has_frames) return column.frame != last_.frame;
    const std::uint32_t back = decoder_.steps_per_turn() / 720;  // half a degree
    return since_cut(column) + back < since_cut(last_);
  }
  /// Counts numbered revolutions whose end contradicts the columns per revolution: by the time
  /// since the last column, another number of columns is missing up to this one.
  void check_turn(const MeasuredColumn& column, std::int64_t time_ns) {
    if (!decoder_.traits().has_frames || decoder_.traits().has_pauses) return;
    const std::uint32_t turn = decoder_.steps_per_turn();
    const double missing = (column.step + turn - last_.step) % turn;
    const double passed = static_cast<double>(time_ns - last_ns_) / static_cast<double>(column_ns_);
    if (std::fabs(std::remainder(passed - missing, turn)) < turn / 8.0) return;
    ++source_.odd_turns;
    if (!source_.contradiction.empty()) return;
    const LidarModel& model = decoder_.sensor().model;
    source_.contradiction = "end revolutions after column " + std::to_string(last_.step) +
                            ", but " + model.name + " has " + std::to_string(model.columns) +
                            " columns per revolution";
  }
  double share_of_turn(const MeasuredColumn& last) const {
    const double turn = decoder_.steps_per_turn();
    const double steps = static_cast<double>(since_cut(last)) - first_step_;
    return steps / turn + 1.0 / decoder_.sensor().model.columns;
  }
  void count_gap(const MeasuredColumn& column, std::int64_t time_ns, bool within_packet) {
    if (time_ns - last_ns_ < 3 * column_ns_ / 2 || is_pause(column, within_packet)) return;
    if (source_.packets == 1) return;
    const std::int64_t missing = (time_ns - last_ns_ + column_ns_ / 2) / column_ns_ - 1;
    const std::uint64_t lost = columns_of_window(missing);
    if (lost == 0) return;
    ++source_.gaps;
    source_.lost_columns += lost;
  }
  /// Whether the head passed angles at which the sensor is set not to measure: a jump within a
  /// packet, later one between packets at the same angles too.
  bool is_pause(const MeasuredColumn& column, bool within_packet) {
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
  /// How many of the columns after the last one are in the window of an Ouster.
  std::uint64_t columns_of_window(std::int64_t missing) const {
    const LidarModel& model = decoder_.sensor().model;
    const auto all = static_cast<std::uint64_t>(missing);
    if (!model.has_window() || !decoder_.traits().has_frames) return all;
    const auto fired_before = [&](std::uint64_t end) {
      std::uint64_t fired = 0;
      for (std::uint64_t k = 0; k < end; ++k)
        if (model.fires_in(static_cast<std::uint32_t>((last_.step + 1 + k) % model.columns)))
          ++fired;
      return fired;
    };
    return all / model.columns * fired_before(model.columns) + fired_before(all % model.columns);
  }

  const PacketDecoder& decoder_;
  PacketSource& source_;
  SensorClock clock_;
  std::int64_t column_ns_, last_ns_ = 0;
  std::uint32_t cut_step_ = 0, first_step_ = 0;
  std::optional<std::pair<std::uint32_t, std::uint32_t>> pause_;  ///< its ends, steps
  MeasuredColumn last_;
};

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

namespace {

std::shared_ptr<const PacketDecoder> decoder_of(const LidarModel& model) {
  return std::make_shared<const PacketDecoder>(packet_sensor(model));
}

/// The first datagrams of each source.
using FirstPackets = std::map<std::string, std::vector<std::string>>;

/// The median time between packets by the sensor's clock, and that of the model; 0: unknown.
struct PacketPace {
  double measured_us = 0, expected_us = 0;

  PacketPace(const PacketDecoder& decoder, const std::vector<std::string>& payloads) {
    constexpr std::size_t kMinSteps = 5;
    std::vector<double> steps_us;
    std::optional<std::int64_t> last_ns;
    for (const std::string& payload : payloads) {
      if (!decoder.accepts(payload)) continue;
      const std::vector<MeasuredColumn> columns = decoder.columns(payload);
      const std::int64_t time_ns = columns.front().time_ns;
      expected_us = 1e6 * decoder.column_s() * static_cast<double>(columns.size());
      if (last_ns) steps_us.push_back(1e-3 * static_cast<double>(time_ns - *last_ns));
      last_ns = time_ns;
    }
    if (steps_us.size() >= kMinSteps) measured_us = upper_median_of(steps_us);
  }
  bool fits() const {
    constexpr double kSamePace = 0.05;
    return measured_us > 0 && std::fabs(measured_us / expected_us - 1) < kSamePace;
  }
};

/// For the packets of VLP-16 of 2014, whose factory bytes are those of the HDL-32E (0x21).
std::shared_ptr<const PacketDecoder> early_vlp_16(PacketSensor sensor) {
  sensor.states_hdl_32e = true;
  return std::make_shared<const PacketDecoder>(std::move(sensor));
}

/// PacketSource::candidates.
std::vector<std::string> candidates_for(const std::vector<std::string>& payloads) {
  std::vector<std::string> names;
  for (const std::string& name : lidar_model_names()) {
    const LidarModel model = load_lidar_model(name);
    if (!model.packets) continue;
    const PacketDecoder decoder(packet_sensor(model));
    const auto accepted = static_cast<std::size_t>(std::ranges::count_if(
        payloads, [&](const std::string& payload) { return decoder.accepts(payload); }));
    if (2 * accepted > payloads.size()) names.push_back(name);
  }
  return names;
}

/// Judges the sensor by the first packets of each source. The HDL-32E in the factory bytes is
/// contradicted by packets as far apart as those of the VLP-16, which is then the only candidate.
void judge_sensor(const FirstPackets& first, PacketSurvey& survey) {
  const auto is_good = [](const auto& source) { return source.second.packets > 0; };
  const bool is_hdl_32e =
      survey.decoder && survey.decoder->sensor().format == PacketFormat::hdl_32e;
  if (survey.decoder && !is_hdl_32e && std::ranges::any_of(survey.sources, is_good)) return;
  const LidarModel vlp_16 = load_lidar_model("velodyne-vlp-16");
  const auto early = early_vlp_16(packet_sensor(vlp_16));
  for (const auto& [name, payloads] : first) {
    PacketSource& source = survey.sources.at(name);
    const PacketPace pace(*early, payloads);
    const PacketPace stated(survey.decoder ? *survey.decoder : *early, payloads);
    if (is_hdl_32e && source.packets > 0 && pace.fits() && !stated.fits()) {
      std::array<char, 160> text{};
      std::snprintf(text.data(), text.size(),
                    "are %.0f us apart, those of an HDL-32E %.0f us and of a VLP-16 %.0f us",
                    stated.measured_us, stated.expected_us, pace.expected_us);
      source.contradiction = text.data();
      source.contradictions = source.packets;
    }
    if (survey.decoder && source.packets > 0 && source.contradictions == 0) continue;
    source.candidates = candidates_for(payloads);
    if (pace.fits()) source.candidates = {vlp_16.name};
  }
}

/// The decoder for packets of an early VLP-16 if that is the survey's sensor; else null.
std::shared_ptr<const PacketDecoder> early_decoder(const FirstPackets& first,
                                                   const PacketSurvey& survey) {
  if (!survey.decoder) return nullptr;
  const PacketSensor& sensor = survey.decoder->sensor();
  if (sensor.format != PacketFormat::vlp_16 || sensor.states_hdl_32e) return nullptr;
  auto early = early_vlp_16(sensor);
  for (const auto& [name, payloads] : first)
    if (survey.sources.at(name).packets == 0 && PacketPace(*early, payloads).fits()) return early;
  return nullptr;
}

PacketSurvey surveyed(PacketSurvey survey, ProgressSink& progress) {
  constexpr std::size_t kFirst = 64;
  FirstPackets first;
  std::map<std::string, RevolutionFinder> finders;
  std::uint64_t done = 0;
  progress.begin_step("read " + survey.path.filename().string(), 0);
  survey.counts = survey.file->for_each([&](const SensorPacket& packet) {
    progress.advance(++done);
    const std::string name(packet.source);
    PacketSource& source = survey.sources[name];
    if (survey.sources.size() > kMaxSources)
      throw Error(ErrorKind::data, survey.path.string() + ": datagrams from more than " +
                                       std::to_string(kMaxSources) +
                                       " sources; this is not the capture of a sensor");
    ++source.datagrams;
    if (std::vector<std::string>& kept = first[name]; kept.size() < kFirst)
      kept.emplace_back(packet.bytes);
    if (!survey.decoder || !survey.decoder->has_size(packet.bytes)) return;
    if (const auto objection = survey.decoder->objection(packet.bytes)) {
      if (source.objection.empty()) source.objection = *objection;
      return;
    }
    if (const auto contradiction = survey.decoder->contradiction(packet.bytes)) {
      if (source.contradiction.empty()) source.contradiction = *contradiction;
      ++source.contradictions;
      return;
    }
    const auto [finder, is_new] =
        finders.try_emplace(name, RevolutionFinder(*survey.decoder, source));
    finder->second.add(packet, survey.path.string() + ": packet " +
                                   std::to_string(source.packets + 1) + " of " + name);
  });
  progress.end_step();
  if (auto early = early_decoder(first, survey)) {
    progress.warn(survey.path.string() +
                  ": its packets state an HDL-32E (0x21), but their times are those of " +
                  survey.decoder->sensor().model.name + "; they are read as of an early VLP-16");
    survey.decoder = std::move(early);
    survey.sources.clear();
    return surveyed(std::move(survey), progress);
  }
  judge_sensor(first, survey);
  return survey;
}

/// "/ouster" of "/ouster/lidar_packets".
std::string_view namespace_of(std::string_view topic) { return topic.substr(0, topic.rfind('/')); }

/// The topic with the metadata of the packets of `stated`, or of the only ones; null: none.
const TopicSurvey* topic_of_metadata(const RecordingSurvey& survey, const std::string& stated) {
  const TopicSurvey* chosen = nullptr;
  for (const auto& [name, topic] : survey.topics) {
    if (topic.metadata.empty()) continue;
    if (!stated.empty() && namespace_of(name) != namespace_of(stated)) continue;
    if (chosen != nullptr)
      throw Error(ErrorKind::usage, survey.recording->path().string() +
                                        ": has the metadata of several sensors (" +
                                        chosen->topic.name + ", " + name +
                                        "); choose the topic of the packets with `topic`");
    chosen = &topic;
  }
  return chosen;
}

}  // namespace

PacketSurvey survey_packets(const std::filesystem::path& path,
                            std::shared_ptr<const PacketDecoder> decoder, ProgressSink& progress) {
  return surveyed({path, packets_of_capture(path), nullptr, std::move(decoder), {}, {}}, progress);
}

PacketSurvey survey_packets(const RecordingSurvey& recording, const DriveSettings& settings,
                            ProgressSink& progress) {
  const auto shared = std::make_shared<const RecordingSurvey>(recording);
  PacketSurvey survey{
      recording.recording->path(), packets_of_recording(shared), shared, nullptr, {}, {}};
  const TopicSurvey* const metadata =
      settings.packets_of.empty() ? topic_of_metadata(recording, settings.topic) : nullptr;
  if (metadata != nullptr)
    survey.decoder = decoder_of(ouster_lidar_model(metadata->metadata, metadata->topic.name));
  else
    survey.decoder = decoder_of_capture(survey.path, settings.packets_of);
  return surveyed(std::move(survey), progress);
}

bool is_read_by_packets(const RecordingSurvey& survey, const DriveSettings& settings) {
  bool has_clouds = false, has_packets = false;
  for (const auto& [name, topic] : survey.topics) {
    if (!settings.topic.empty() && name != settings.topic) continue;
    has_clouds = has_clouds || topic.holds_clouds();
    has_packets = has_packets || !topic.packets.empty();
  }
  if (!settings.packets_of.empty() && !has_packets)
    throw Error(ErrorKind::usage,
                survey.recording->path().string() + ": `packet_sensor` needs a topic of packets; " +
                    (settings.topic.empty() ? "there is none" : settings.topic + " is none"));
  return has_packets && (!has_clouds || !settings.packets_of.empty());
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
    const bool is_hesais = name.starts_with("correction") || name.starts_with("angle");
    if (name == "metadata.json" || (name.starts_with("calibration") && name.ends_with(".yaml")) ||
        (is_hesais && (name.ends_with(".csv") || name.ends_with(".dat"))))
      found.push_back(entry->path().string());
  }
  std::ranges::sort(found);
  if (found.size() > 1)
    throw Error(ErrorKind::usage, capture.string() + ": its folder contains " + found[0] + " and " +
                                      found[1] + "; choose one with `packet_sensor`");
  return found.empty() ? "" : found.front();
}

namespace {

namespace fs = std::filesystem;

constexpr double kNanosecondsInOneSecond = 1e9;

double as_seconds(std::int64_t time_ns) {
  return static_cast<double>(time_ns) / kNanosecondsInOneSecond;
}

double middle_of(const Revolution& turn) {
  return as_seconds(turn.begin_ns) + 0.5 * as_seconds(turn.end_ns - turn.begin_ns);
}

/// Reads revolutions by generated names.
class PacketScans final : public ScanSource {
 public:
  PacketScans(std::shared_ptr<const PacketFile> file, std::shared_ptr<const PacketDecoder> decoder,
              std::string source, std::map<fs::path, Revolution> turns)
      : file_(std::move(file)),
        decoder_(std::move(decoder)),
        source_(std::move(source)),
        turns_(std::move(turns)) {}

  FileScan read(const fs::path& name) const override {
    const Revolution& turn = turns_.at(name);
    FileScan scan;
    std::size_t left = turn.columns, skip = turn.skipped;
    std::int64_t shift_ns = 0;
    std::int64_t last_ns = 0;
    bool is_first = true;
    file_->read_from(source_, turn.place, [&](const SensorPacket& packet) {
      if (!decoder_->accepts(packet.bytes)) return true;
      const std::vector<MeasuredColumn> columns = decoder_->columns(packet.bytes);
      for (std::size_t k = std::exchange(skip, 0); k < columns.size() && left > 0; ++k) {
        if (!columns[k].is_valid) continue;
        std::int64_t time_ns = columns[k].time_ns;
        if (std::exchange(is_first, false)) shift_ns = turn.begin_ns - time_ns;
        // A revolution may pass the full hour.
        if (time_ns + shift_ns < last_ns - kFullHour_ns / 2) shift_ns += kFullHour_ns;
        last_ns = time_ns += shift_ns;
        add_column(packet.bytes, k, columns[k], as_seconds(time_ns), scan);
        --left;
      }
      return left > 0;
    });
    return scan;
  }

 private:
  static constexpr std::int64_t kFullHour_ns = 3'600'000'000'000;

  void add_column(std::string_view payload, std::size_t k, const MeasuredColumn& column,
                  double time_s, FileScan& scan) const {
    PacketPoints points;
    decoder_->add_points(payload, k, column, points);
    scan.positions.insert(scan.positions.end(), points.positions.begin(), points.positions.end());
    for (const double late_s : points.late_s) scan.times.push_back(time_s + late_s);
    scan.intensities.insert(scan.intensities.end(), points.intensities.begin(),
                            points.intensities.end());
    scan.lasers.insert(scan.lasers.end(), points.rings.begin(), points.rings.end());
  }

  std::shared_ptr<const PacketFile> file_;
  std::shared_ptr<const PacketDecoder> decoder_;
  std::string source_;
  std::map<fs::path, Revolution> turns_;
};

std::string list_of_sources(const PacketSurvey& survey) {
  std::string list;
  for (const auto& [name, source] : survey.sources)
    list += (list.empty() ? "" : ", ") + name + " (" + std::to_string(source.datagrams) +
            " datagrams" +
            (source.packets > 0 ? ", " + std::to_string(source.packets) + " of the sensor" : "") +
            (source.objection.empty() ? "" : "; some " + source.objection) +
            (source.contradiction.empty() ? "" : "; some " + source.contradiction) + ")";
  return list.empty() ? "none" : list;
}

/// Whether the sensor's file is of another device or mode than the packets, rather than single
/// packets damaged.
bool contradicts_file(const PacketSource& source) {
  constexpr std::uint64_t kDamaged = 10;  // one in
  return source.contradictions > source.packets / kDamaged ||
         (source.odd_turns > 0 && 2 * source.odd_turns + 1 >= source.revolutions.size());
}

/// "; those of 10.0.0.1:2368 are of velodyne-vlp-16: give ... as `packet_sensor`", if known.
std::string advice_on_sensor(const PacketSurvey& survey) {
  for (const auto& [name, source] : survey.sources) {
    std::string list;
    for (const std::string& candidate : source.candidates)
      list += (list.empty() ? "" : " or ") + candidate;
    if (list.empty()) continue;
    const bool needs_file = list.starts_with("ouster");
    return "; those of " + name + " are of " + list + " by their format: give " +
           (needs_file ? "the metadata (JSON) of the device"
                       : "it, or the maker's file of the "
                         "device,") +
           " as `packet_sensor`";
  }
  return {};
}

Error wrong_file(const PacketSurvey& survey, const std::string& name, const PacketSource& source) {
  const std::string advice = advice_on_sensor(survey);
  return {ErrorKind::data,
          survey.path.string() + ": packets of " + name + " " + source.contradiction +
              (advice.empty() ? "; give the file of this sensor in this mode as `packet_sensor`"
                              : advice)};
}

/// The given source, else the only one.
const std::pair<const std::string, PacketSource>& source_of(const PacketSurvey& survey,
                                                            const std::string& stated) {
  const std::pair<const std::string, PacketSource>*chosen = nullptr, *wrong = nullptr;
  std::size_t count = 0;
  for (const auto& entry : survey.sources) {
    if (!stated.empty() && entry.first != stated) continue;
    if (contradicts_file(entry.second)) wrong = &entry;
    if (entry.second.packets == 0) continue;
    chosen = &entry;
    ++count;
  }
  const std::string sources = "; packets from: " + list_of_sources(survey);
  if (wrong != nullptr && (count == 0 || chosen == wrong))
    throw wrong_file(survey, wrong->first, wrong->second);
  if (count == 0)
    throw Error(stated.empty() ? ErrorKind::data : ErrorKind::usage,
                survey.path.string() + ": has no packets of " +
                    survey.decoder->sensor().model.name + " (" +
                    std::to_string(survey.decoder->sensor().payload_bytes()) + " bytes)" +
                    (stated.empty() ? "" : " from " + stated) + sources + advice_on_sensor(survey));
  if (count > 1)
    throw Error(ErrorKind::usage,
                survey.path.string() +
                    ": contains packets of several sensors; choose one with `topic`" + sources);
  return *chosen;
}

/// Warns of missing and skipped packets.
void warn_of_packets(const PacketSurvey& survey, const std::string& name,
                     const PacketSource& source, ProgressSink& progress) {
  const auto warn = [&](std::uint64_t count, const std::string& what) {
    if (count > 0) progress.warn(survey.path.string() + ": " + std::to_string(count) + " " + what);
  };
  warn(source.lost_columns,
       "columns of " + name + " are missing, in " + std::to_string(source.gaps) + " gaps");
  warn(survey.counts.torn, "datagrams lack fragments and are skipped");
  warn(survey.counts.cut, "frames are truncated and are skipped");
  warn(survey.counts.timeless, "frames have no time and are skipped");
  for (const std::string& fault : {source.objection, source.contradiction})
    if (!fault.empty())
      progress.warn(survey.path.string() + ": some packets of " + name + " " + fault +
                    " and are skipped");
  const PacketSensor& sensor = survey.decoder->sensor();
  const std::uint64_t serial = sensor.model.packets->serial;
  if (sensor.format == PacketFormat::ouster_legacy && serial != 0)
    progress.warn(survey.path.string() +
                  ": packets of profile LEGACY have no serial number; make sure that " +
                  sensor.model.name + " (" + std::to_string(serial) + ") is of this sensor");
}

/// The part of a turn that whole revolutions have: sensors set to part of the view never have full
/// ones.
double usual_share(const PacketSource& source, const LidarModel& model) {
  const std::vector<Revolution>& turns = source.revolutions;
  const double window = model.window_end - model.window_begin;  // of an Ouster
  double usual = turns.size() < 3 ? (window > 0 ? window : 1) : 0;
  for (const Revolution& turn : turns) usual = std::max(usual, turn.share);
  return usual;
}

/// Whether the start or end of the capture left next to nothing of a revolution.
bool is_rest(const PacketSource& source, const LidarModel& model, const Revolution& turn) {
  constexpr double kRest = 0.01;
  const bool is_end = &turn == &source.revolutions.front() || &turn == &source.revolutions.back();
  return is_end && source.revolutions.size() > 1 && turn.share < kRest * usual_share(source, model);
}

/// Warns of revolutions cut by the start or end of the capture.
void warn_of_partial_turns(const PacketSurvey& survey, const std::string& name,
                           const PacketSource& source, ProgressSink& progress) {
  constexpr double kWhole = 0.95;
  const LidarModel& model = survey.decoder->sensor().model;
  const std::vector<Revolution>& turns = source.revolutions;
  const auto warn = [&](const Revolution& turn, const std::string& what) {
    if (!turn.has_points || turn.share >= kWhole * usual_share(source, model)) return;
    const bool is_skipped = is_rest(source, model, turn);
    std::array<char, 32> percent{};
    std::snprintf(percent.data(), percent.size(), is_skipped ? "%.2f" : "%.0f", 100 * turn.share);
    progress.warn(survey.path.string() + ": " + what + " revolution of " + name + " is " +
                  percent.data() + " % of a turn, cut by the capture; it is " +
                  (is_skipped ? "skipped" : "still used as a scan"));
  };
  warn(turns.front(), "the first");
  if (turns.size() > 1) warn(turns.back(), "the last");
}

struct PacketDrive {
  SensorFrames frames;
  std::vector<double> middles_s;
};

/// The revolutions with points as scans.
PacketDrive scans_of_packets(const PacketSurvey& survey, const std::string& name,
                             const PacketSource& source, double offset_s, ProgressSink& progress) {
  PacketDrive drive;
  std::map<fs::path, Revolution> turns;
  std::size_t empty = 0;
  for (std::size_t k = 0; k < source.revolutions.size(); ++k) {
    const Revolution& turn = source.revolutions[k];
    if (!turn.has_points) ++empty;
    if (!turn.has_points || is_rest(source, survey.decoder->sensor().model, turn)) continue;
    std::array<char, 32> number{};
    std::snprintf(number.data(), number.size(), "%06zu", k);
    const fs::path scan = survey.path / number.data();
    turns.emplace(scan, turn);
    drive.frames.files.push_back(scan);
    drive.middles_s.push_back(middle_of(turn) + offset_s);
    drive.frames.spans_s.push_back(
        {as_seconds(turn.begin_ns) + offset_s, as_seconds(turn.end_ns) + offset_s});
  }
  if (turns.empty())
    throw Error(ErrorKind::data,
                survey.path.string() + ": the packets of " + name + " contain no returns");
  if (empty > 0)
    progress.warn(survey.path.string() + ": " + std::to_string(empty) + " revolutions of " + name +
                  " have no points and are skipped");
  drive.frames.source =
      std::make_shared<PacketScans>(survey.file, survey.decoder, name, std::move(turns));
  drive.frames.times = {PointTimes::Kind::absolute, 1, offset_s, true};
  return drive;
}

void require_options_of_packets(const DriveInput& drive, bool is_recorded) {
  const std::string path = drive.folder.string();
  if ((!drive.poses_topic.empty() && !is_recorded) || !drive.scan_times.empty())
    throw Error(ErrorKind::usage, path +
                                      ": packets have times and no poses; `poses_topic` and "
                                      "`scan_times` apply to recordings and folders");
  if (!drive.poses_topic.empty() && !drive.trajectory.empty())
    throw Error(
        ErrorKind::usage,
        path + ": `trajectory` and `poses_topic` both give the poses; give only one of them");
  if (drive.points_in == PointsIn::world)
    throw Error(
        ErrorKind::usage,
        path + ": packets are in the sensor frame; `points_in` world applies to folders of files");
  if (drive.trajectory.empty() && !is_recorded)
    throw Error(ErrorKind::usage,
                path + ": packets contain no poses; give the poses of the sensor as `trajectory`");
}

/// From the trajectory, or from the topics of the recording.
RecordedPoses poses_of_packets(const DriveInput& drive, const PacketSurvey& survey,
                               const std::string& topic, const std::vector<double>& middles_s) {
  if (drive.trajectory.empty())
    return poses_of_clouds(drive, *survey.recording, survey.recording->topics.at(topic), middles_s);
  return poses_of_trajectory(drive, middles_s, "revolutions", "in the middles of the revolutions");
}

}  // namespace

std::shared_ptr<const PacketDecoder> decoder_of_capture(const fs::path& capture,
                                                        const std::string& stated) {
  const std::string sensor = sensor_of_capture(capture, stated);
  if (sensor.empty()) return nullptr;
  return decoder_of(load_lidar_model(sensor));
}

namespace {

bool are_same(const SensorCones& a, const SensorCones& b) {
  constexpr double kMax_rad = 2e-4, kMax_m = 2e-3;  // files round angles to hundredths of a degree
  const auto same = [](const SensorCones::Cone& c, const SensorCones::Cone& d) {
    return std::fabs(c.elevation_rad - d.elevation_rad) < kMax_rad &&
           std::fabs(c.height_m - d.height_m) < kMax_m &&
           std::fabs(c.outward_m - d.outward_m) < kMax_m &&
           std::fabs(c.aside_m - d.aside_m) < kMax_m;
  };
  return std::ranges::equal(a.cones, b.cones, same);
}

/// The cones of the packets' sensor, named so that load_lidar_model() finds it: the sensor of the
/// library with these beams, else the file. Without cones if rings have none (mirrors).
SensorCones cones_of_packets(const PacketSurvey& survey, const DriveInput& drive) {
  LidarModel model = survey.decoder->sensor().model;
  model.window_begin = 0;
  model.window_end = 1;
  SensorCones cones = cones_of(model);
  if (survey.decoder->sensor().mirror() != nullptr || cones.cones.size() != model.rings())
    cones.cones.clear();
  if (std::ranges::count(lidar_model_names(), model.name) > 0) return cones;
  for (const SensorCones& known : library_cones()) {
    if (!cones.cones.empty() && are_same(cones, known)) cones.sensor = known.sensor;
    if (cones.sensor == known.sensor) return cones;
  }
  fs::path file = drive.packets_of;
  if (file.empty() && survey.recording == nullptr)
    file = survey.path.parent_path() / fs::path(sensor_of_capture(survey.path, "")).filename();
  if (file.has_filename()) cones.sensor = file.string();
  return cones;
}

}  // namespace

KittiSequence open_packet_drive(const DriveInput& given, const PacketSurvey& survey,
                                const Executor& executor, ProgressSink& progress) {
  DriveInput drive = given;
  if (!survey.decoder) {
    const std::string advice = advice_on_sensor(survey);
    throw Error(ErrorKind::usage,
                survey.path.string() + ": the sensor of its packets is unknown" +
                    (advice.empty() ? "; give `packet_sensor`, a sensor of the library or the "
                                      "maker's file (its folder contains none)"
                                    : advice));
  }
  const auto& [name, source] = source_of(survey, drive.topic);
  require_options_of_packets(drive, survey.recording != nullptr);
  warn_of_packets(survey, name, source, progress);
  warn_of_partial_turns(survey, name, source, progress);
  const LidarModel& model = survey.decoder->sensor().model;
  if (is_hesai(survey.decoder->sensor().format) &&
      std::ranges::count(lidar_model_names(), model.name) > 0)
    progress.warn(survey.path.string() + ": " + model.name +
                  " has the nominal angles of its model; the angle correction file of the device "
                  "as `packet_sensor` is more accurate");
  PacketDrive scans =
      scans_of_packets(survey, name, source, drive.time_offset_s.value_or(0), progress);
  SensorFrames& frames = scans.frames;
  frames.sensor = cones_of_packets(survey, drive);
  const RecordedPoses found = poses_of_packets(drive, survey, name, scans.middles_s);
  if (drive.trajectory.empty()) drive.trajectory = drive.folder;  // for messages about clocks
  const Track track = track_of(found.poses);
  std::size_t kept = 0;
  for (const std::size_t k :
       covered_scans(frames.spans_s, track, survey.path, "revolutions", progress)) {
    frames.files[kept] = frames.files[k];
    frames.spans_s[kept] = frames.spans_s[k];
    frames.poses.of_scans.push_back(
        {scans.middles_s[k], interpolate(track.poses, scans.middles_s[k])});
    ++kept;
  }
  frames.files.resize(kept);
  frames.spans_s.resize(kept);
  frames.poses.track = track.poses;
  frames.poses.by = found.by;
  frames.poses.has_times = true;
  if (drive.sweep_points == SweepPoints::found) drive.sweep_points = SweepPoints::measured;
  return open_sensor_frames(drive, frames,
                            "packets of " + survey.decoder->sensor().model.name + " from " + name +
                                (source.dual_packets > 0 ? ", two returns per firing" : ""),
                            executor, progress);
}

}  // namespace adasplats
