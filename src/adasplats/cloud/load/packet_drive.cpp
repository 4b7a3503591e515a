// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/packet_drive.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include "adasplats/cloud/load/covered_scans.h"
#include "adasplats/cloud/load/recording_poses.h"
#include "adasplats/cloud/load/sensor_drive.h"
#include "adasplats/core/error.h"

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

/// Reads revolutions by names that are made up for them.
class PacketScans final : public ScanSource {
 public:
  PacketScans(fs::path capture, std::shared_ptr<const PacketDecoder> decoder, std::string source,
              std::map<fs::path, Revolution> turns)
      : capture_(std::move(capture)),
        decoder_(std::move(decoder)),
        source_(std::move(source)),
        turns_(std::move(turns)) {}

  FileScan read(const fs::path& name) const override {
    const Revolution& turn = turns_.at(name);
    DatagramReader reader(capture_, turn.place);
    FileScan scan;
    std::size_t left = turn.columns, skip = turn.skipped;
    std::int64_t shift_ns = 0;
    std::int64_t last_ns = 0;
    bool is_first = true;
    while (left > 0) {
      const auto datagram = reader.next();
      if (!datagram) throw Error(ErrorKind::io, capture_.string() + ": changed while it was read");
      if (!is_of_source(*datagram)) continue;
      const std::vector<MeasuredColumn> columns = decoder_->columns(datagram->payload);
      for (std::size_t k = std::exchange(skip, 0); k < columns.size() && left > 0; ++k) {
        if (!columns[k].is_valid) continue;
        std::int64_t time_ns = columns[k].time_ns;
        if (std::exchange(is_first, false)) shift_ns = turn.begin_ns - time_ns;
        // A revolution may last beyond the full hour.
        if (time_ns + shift_ns < last_ns - kFullHour_ns / 2) shift_ns += kFullHour_ns;
        last_ns = time_ns += shift_ns;
        add_column(*datagram, k, columns[k], as_seconds(time_ns), scan);
        --left;
      }
    }
    return scan;
  }

 private:
  static constexpr std::int64_t kFullHour_ns = 3'600'000'000'000;

  bool is_of_source(const Datagram& datagram) const {
    return decoder_->has_size(datagram.payload) &&
           source_ == address_text(datagram.from) + ":" + std::to_string(datagram.to_port) &&
           !decoder_->objection(datagram.payload);
  }
  void add_column(const Datagram& datagram, std::size_t k, const MeasuredColumn& column,
                  double time_s, FileScan& scan) const {
    PacketPoints points;
    decoder_->add_points(datagram.payload, k, column, points);
    scan.positions.insert(scan.positions.end(), points.positions.begin(), points.positions.end());
    for (const double late_s : points.late_s) scan.times.push_back(time_s + late_s);
    scan.intensities.insert(scan.intensities.end(), points.intensities.begin(),
                            points.intensities.end());
  }

  fs::path capture_;
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
            (source.objection.empty() ? "" : "; some " + source.objection) + ")";
  return list.empty() ? "none" : list;
}

/// The stated source, else the only one.
const std::pair<const std::string, PacketSource>& source_of(const PacketSurvey& survey,
                                                            const std::string& stated) {
  const std::pair<const std::string, PacketSource>* chosen = nullptr;
  std::size_t count = 0;
  for (const auto& entry : survey.sources) {
    if (entry.second.packets == 0 || (!stated.empty() && entry.first != stated)) continue;
    chosen = &entry;
    ++count;
  }
  const std::string sources = "; UDP from: " + list_of_sources(survey);
  if (count == 0)
    throw Error(stated.empty() ? ErrorKind::data : ErrorKind::usage,
                survey.path.string() + ": has no packets of " +
                    survey.decoder->sensor().model.name + " (" +
                    std::to_string(survey.decoder->sensor().payload_bytes()) + " bytes)" +
                    (stated.empty() ? "" : " from " + stated) + sources);
  if (count > 1)
    throw Error(ErrorKind::usage, survey.path.string() +
                                      ": several sensors sent packets; `topic` " + "states which" +
                                      sources);
  return *chosen;
}

/// What is left out and what is missing.
void tell_of_packets(const PacketSurvey& survey, const std::string& name,
                     const PacketSource& source, ProgressSink& progress) {
  const auto tell = [&](std::uint64_t count, const std::string& what) {
    if (count > 0) progress.warn(survey.path.string() + ": " + std::to_string(count) + " " + what);
  };
  tell(source.lost_columns,
       "columns of " + name + " are missing, in " + std::to_string(source.gaps) + " gaps");
  tell(survey.counts.torn, "datagrams lack some of their parts, left out");
  tell(survey.counts.cut, "frames hold less than was sent, left out");
  tell(survey.counts.timeless, "frames have no time, left out");
  if (!source.objection.empty())
    progress.warn(survey.path.string() + ": some packets of " + name + " " + source.objection +
                  ", left out");
}

/// Of revolutions that a capture begins or ends within.
void tell_of_parts(const PacketSurvey& survey, const std::string& name, const PacketSource& source,
                   ProgressSink& progress) {
  constexpr double kWhole = 0.95;
  const std::vector<Revolution>& turns = source.revolutions;
  // Sensors that are set to a part of the view have no more of any.
  double usual = turns.size() < 3 ? 1 : 0;
  for (const Revolution& turn : turns) usual = std::max(usual, turn.share);
  const auto tell = [&](const Revolution& turn, const std::string& what) {
    if (!turn.has_points || turn.share >= kWhole * usual) return;
    progress.warn(survey.path.string() + ": " + what + " revolution of " + name + " is " +
                  std::to_string(std::lround(100 * turn.share)) +
                  " % of a turn, since the capture does not hold all of it; it is a scan all the "
                  "same");
  };
  tell(turns.front(), "the first");
  if (turns.size() > 1) tell(turns.back(), "the last");
}

struct PacketDrive {
  SensorFrames frames;
  std::vector<double> middles_s;
};

/// Scans of the revolutions with points.
PacketDrive scans_of_packets(const PacketSurvey& survey, const std::string& name,
                             const PacketSource& source, double offset_s, ProgressSink& progress) {
  PacketDrive drive;
  std::map<fs::path, Revolution> turns;
  for (std::size_t k = 0; k < source.revolutions.size(); ++k) {
    const Revolution& turn = source.revolutions[k];
    if (!turn.has_points) continue;
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
    throw Error(ErrorKind::data, survey.path.string() + ": in the packets of " + name +
                                     " nothing came back: no points");
  const std::size_t empty = source.revolutions.size() - turns.size();
  if (empty > 0)
    progress.warn(survey.path.string() + ": " + std::to_string(empty) + " revolutions of " + name +
                  " have no points, left out");
  drive.frames.source =
      std::make_shared<PacketScans>(survey.path, survey.decoder, name, std::move(turns));
  drive.frames.times = {PointTimes::Kind::absolute, 1, offset_s, true};
  return drive;
}

void require_options_of_captures(const FrameDrive& drive) {
  const std::string path = drive.folder.string();
  if (!drive.poses_topic.empty() || !drive.scan_times.empty())
    throw Error(ErrorKind::usage,
                path +
                    ": packets have times of their own and no poses; `poses_topic` and "
                    "`scan_times` are for recordings and folders");
  if (drive.points_in == PointsIn::world)
    throw Error(ErrorKind::usage,
                path +
                    ": packets are in the frame of their sensor; `points_in` world is for "
                    "folders of files");
  if (drive.trajectory.empty())
    throw Error(ErrorKind::usage,
                path + ": packets do not say where the sensor was; `trajectory` gives its poses");
}

}  // namespace

std::shared_ptr<const PacketDecoder> decoder_of_capture(const fs::path& capture,
                                                        const std::string& stated) {
  const std::string sensor = sensor_of_capture(capture, stated);
  if (sensor.empty()) return nullptr;
  return std::make_shared<const PacketDecoder>(packet_sensor(load_lidar_model(sensor)));
}

KittiSequence open_packet_drive(const FrameDrive& given, const PacketSurvey& survey,
                                const Executor& executor, ProgressSink& progress) {
  FrameDrive drive = given;
  if (!survey.decoder)
    throw Error(ErrorKind::usage,
                survey.path.string() +
                    ": which sensor sent its packets is not said: `packets_of` names one of the "
                    "library or the maker's file (none is beside it)");
  require_options_of_captures(drive);
  const auto& [name, source] = source_of(survey, drive.topic);
  tell_of_packets(survey, name, source, progress);
  tell_of_parts(survey, name, source, progress);
  PacketDrive scans =
      scans_of_packets(survey, name, source, drive.time_offset_s.value_or(0), progress);
  SensorFrames& frames = scans.frames;
  const RecordedPoses found = poses_of_trajectory(drive, scans.middles_s, "revolutions",
                                                  "in the middles of the revolutions");
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
                                (source.dual_packets > 0 ? ", two returns a firing" : ""),
                            executor, progress);
}

}  // namespace adasplats
