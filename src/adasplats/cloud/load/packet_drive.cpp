// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/packet_drive.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <utility>

#include "adasplats/cloud/load/recording_poses.h"
#include "adasplats/cloud/load/sensor_drive.h"
#include "adasplats/core/error.h"
#include "adasplats/sensors/packet_layout.h"

namespace adasplats {

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
  fs::path file = drive.packet_sensor;
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
