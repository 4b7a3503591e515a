// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/packet_drive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/mutator_test.h"
#include "adasplats/io/packets/capture_writer.h"
#include "adasplats/sensors/hesai_packets_test.h"
#include "adasplats/sensors/packet_encoder.h"

namespace adasplats {
namespace {

constexpr std::int64_t kDriveBegin_ns = (472'222LL * 3600 - 1) * 1'000'000'000;  // 1 s to the hour
constexpr std::uint8_t kSender = 201;

std::shared_ptr<const PacketDecoder> decoder_named(const std::string& name) {
  return std::make_shared<const PacketDecoder>(packet_sensor(load_lidar_model(name)));
}

/// What a sensor sends during some revolutions around which everything is 10 m away.
class SentDrive {
 public:
  SentDrive(const std::string& sensor, std::size_t columns)
      : SentDrive(load_lidar_model(sensor), columns) {}
  /// `fired`: the first columns of each revolution, in which a Velodyne is set to fire.
  SentDrive(const LidarModel& model, std::size_t columns, std::size_t fired = SIZE_MAX)
      : decoder_(std::make_shared<const PacketDecoder>(packet_sensor(model))),
        returns_(decoder_->sensor().lasers()) {
    const PacketSensor& sent = decoder_->sensor();
    for (PacketReturn& one : returns_)
      one = {static_cast<std::uint32_t>(std::lround(10 / sent.facts.quantum_m)), 257 * 9};
    std::vector<PacketColumn> packet;
    for (std::size_t k = 0; k < columns; ++k) {
      if (k % model.columns >= fired) continue;
      const auto late_ns = static_cast<std::int64_t>(
          std::llround(1e9 * decoder_->column_s() * static_cast<double>(k)));
      packet.push_back({static_cast<std::uint64_t>(kDriveBegin_ns + late_ns),
                        static_cast<std::uint32_t>(k % sent.model.columns),
                        static_cast<std::uint16_t>(k / sent.model.columns), returns_});
      if (packet.size() < sent.facts.columns) continue;
      const auto fires = [&](const PacketColumn& column) { return model.fires_in(column.column); };
      if (std::ranges::none_of(packet, fires)) packet.clear();  // an Ouster's window
      if (packet.empty()) continue;
      payloads.push_back(encode_packet(sent, packet, payloads.size()));
      times_ns.push_back(static_cast<std::int64_t>(packet.back().time_ns));
      packet.clear();
    }
  }

  const std::shared_ptr<const PacketDecoder>& decoder() const { return decoder_; }
  std::filesystem::path write(const TemporaryFolder& folder, std::int64_t captured_later_ns = 0,
                              std::uint8_t sender = kSender) const {
    std::filesystem::path path = folder.path() / "sent.pcap";
    CaptureWriter writer(path);
    add_to(writer, captured_later_ns, sender);
    writer.finish();
    return path;
  }
  void add_to(CaptureWriter& writer, std::int64_t captured_later_ns, std::uint8_t sender) const {
    const UdpEndpoint from{{}, {10, 0, 0, sender}, 2368}, to{{}, {10, 0, 0, 1}, 2368};
    for (std::size_t k = 0; k < payloads.size(); ++k)
      writer.add(static_cast<std::uint64_t>(times_ns[k] + captured_later_ns) / 1000, from, to,
                 payloads[k]);
  }
  PacketSurvey survey(const std::filesystem::path& path) const {
    ProgressSink quiet;
    return survey_packets(path, decoder_, quiet);
  }

  std::vector<std::string> payloads;
  std::vector<std::int64_t> times_ns;

 private:
  std::shared_ptr<const PacketDecoder> decoder_;
  std::vector<PacketReturn> returns_;
};

TEST(PacketDrive, RevolutionsAndTheirTimesAcrossTheHour) {
  for (const char* name :
       {"velodyne-vlp-16", "velodyne-hdl-64e-kitti", "velodyne-vls-128", "ouster-os1-64"}) {
    const TemporaryFolder folder;
    const std::size_t columns = decoder_named(name)->sensor().model.columns;
    const SentDrive drive(name, 15 * columns + columns / 2);
    const PacketSurvey survey = drive.survey(drive.write(folder));
    ASSERT_EQ(survey.sources.size(), 1U);
    const auto& [source_name, source] = *survey.sources.begin();
    EXPECT_EQ(source_name, "10.0.0.201:2368");
    EXPECT_EQ(source.packets, drive.payloads.size());
    EXPECT_EQ(source.lost_columns, 0U) << name;
    ASSERT_EQ(source.revolutions.size(), 16U) << name;
    const double turn_ns = 1e9 / decoder_named(name)->sensor().model.rotation_hz;
    for (std::size_t k = 0; k < 15; ++k) {
      const Revolution& turn = source.revolutions[k];
      EXPECT_EQ(turn.columns, columns);
      // Velodyne's times are whole microseconds.
      EXPECT_NEAR(static_cast<double>(turn.begin_ns - kDriveBegin_ns),
                  static_cast<double>(k) * turn_ns, 1100)
          << name;
      EXPECT_NEAR(static_cast<double>(turn.end_ns - turn.begin_ns), turn_ns, 2100) << name;
    }
  }
}

// Oracle: what was sent. KITTI's sensor begins at the rear; the calibration of an HDL-64E does not
// say so, and its azimuths begin ahead.
TEST(PacketDrive, RevolutionsBeginWhereTheCaptureDoes) {
  const TemporaryFolder folder;
  const std::size_t columns = decoder_named("velodyne-hdl-64e-kitti")->sensor().model.columns;
  for (const std::size_t sent : {columns, 3 * columns, 2 * columns + columns / 2}) {
    SCOPED_TRACE(sent);
    const SentDrive drive("velodyne-hdl-64e-kitti", sent / 6 * 6);
    LidarModel unsaid = drive.decoder()->sensor().model;
    unsaid.first_azimuth_rad = 0;
    ProgressSink quiet;
    const PacketSurvey survey = survey_packets(
        drive.write(folder), std::make_shared<const PacketDecoder>(packet_sensor(unsaid)), quiet);
    const std::vector<Revolution>& turns = survey.sources.begin()->second.revolutions;
    ASSERT_EQ(turns.size(), (sent + columns - 1) / columns);
    EXPECT_EQ(turns.front().begin_ns, kDriveBegin_ns);
    for (std::size_t k = 0; k < turns.size(); ++k) {
      const bool is_whole = (k + 1) * columns <= sent;
      EXPECT_NEAR(static_cast<double>(turns[k].columns),
                  static_cast<double>(columns) * (is_whole ? 1.0 : 0.5), 6);
      EXPECT_NEAR(turns[k].share, is_whole ? 1 : 0.5, 0.01);
    }
  }
}

TEST(PacketDrive, ClocksThatBeginElsewhere) {
  // An Ouster that counts since it was switched on is of the capture's time...
  const TemporaryFolder folder;
  const SentDrive ouster("ouster-os1-64", 3 * 1024);
  const std::int64_t later_ns = 1'000'000'000'000;
  EXPECT_NEAR(static_cast<double>(ouster.survey(ouster.write(folder, later_ns))
                                      .sources.begin()
                                      ->second.revolutions[0]
                                      .begin_ns -
                                  kDriveBegin_ns),
              static_cast<double>(later_ns), 2e6);
  // ...and one whose clock is some seconds off keeps its own.
  EXPECT_EQ(ouster.survey(ouster.write(folder, 37'000'000'000))
                .sources.begin()
                ->second.revolutions[0]
                .begin_ns,
            kDriveBegin_ns);
  // Velodyne's hour is that of the capture.
  const SentDrive velodyne("velodyne-vlp-16", 3 * 1808);
  EXPECT_NEAR(static_cast<double>(velodyne.survey(velodyne.write(folder, 7'200'000'000'000))
                                      .sources.begin()
                                      ->second.revolutions[0]
                                      .begin_ns -
                                  kDriveBegin_ns),
              7.2e12, 1000);
}

TEST(PacketDrive, MissingPacketsAndClocksThatAreSet) {
  const TemporaryFolder folder;
  SentDrive drive("velodyne-vlp-16", 4 * 1808);
  drive.payloads.erase(drive.payloads.begin() + 20, drive.payloads.begin() + 23);
  drive.times_ns.erase(drive.times_ns.begin() + 20, drive.times_ns.begin() + 23);
  const PacketSurvey survey = drive.survey(drive.write(folder));
  EXPECT_EQ(survey.sources.begin()->second.gaps, 1U);
  EXPECT_EQ(survey.sources.begin()->second.lost_columns, 3U * 24);
  std::uint32_t micros = 0;
  std::memcpy(&micros, drive.payloads[50].data() + 1200, 4);
  micros += 5'000'000;
  std::memcpy(drive.payloads[50].data() + 1200, &micros, 4);
  expect_error(ErrorKind::data, {"sent.pcap: packet 51 of 10.0.0.201:2368", "jumps by "},
               [&] { drive.survey(drive.write(folder)); });
}

// Packets continue after the pause of a sensor that is set to part of the view. Oracle: what was
// sent.
TEST(PacketDrive, PausesOfAVelodyneAreNotMissingColumns) {
  const LidarModel model = load_lidar_model("velodyne-vlp-16");
  for (const std::size_t fired : {450U, 1356U}) {  // a quarter of a turn, three quarters
    SCOPED_TRACE(fired);
    const TemporaryFolder folder;
    const SentDrive drive(model, 8 * std::size_t{model.columns}, fired);
    const PacketSurvey survey = drive.survey(drive.write(folder));
    const PacketSource& source = survey.sources.begin()->second;
    EXPECT_EQ(source.lost_columns, 0U);
    ASSERT_EQ(source.revolutions.size(), 8U);
    for (std::size_t k = 0; k < 8; ++k) {
      const Revolution& turn = source.revolutions[k];
      EXPECT_EQ(turn.columns, fired);
      EXPECT_NEAR(static_cast<double>(turn.begin_ns - kDriveBegin_ns), 1e8 * double(k), 1e5);
    }
    for (const std::string& payload : drive.payloads) {
      const auto columns = drive.decoder()->columns(payload);
      for (std::size_t k = 0; k < columns.size(); ++k) {
        PacketPoints points;
        drive.decoder()->add_points(payload, k, columns[k], points);
        for (const Vec3d& at : points.positions) {
          const double clockwise = std::fmod(2 * std::numbers::pi + 1e-3 - std::atan2(at.y, at.x),
                                             2 * std::numbers::pi) -
                                   1e-3;
          EXPECT_LT(clockwise, 2 * std::numbers::pi * double(fired) / model.columns + 1e-3);
        }
      }
    }
  }
}

TEST(PacketDrive, ColumnsOutsideTheWindowOfAnOusterAreNotMissing) {
  LidarModel model = load_lidar_model("ouster-os1-64");  // 1024 columns, 16 per packet
  for (const auto& [begin, end] : {std::pair{40, 1000}, {600, 100}}) {
    model.window_begin = begin / 1024.0;
    model.window_end = end / 1024.0;
    SentDrive drive(model, std::size_t{4} * 1024);
    const TemporaryFolder folder;
    PacketSurvey survey = drive.survey(drive.write(folder));
    EXPECT_EQ(survey.sources.begin()->second.lost_columns, 0U);
    EXPECT_EQ(survey.sources.begin()->second.gaps, 0U);
    drive.payloads.erase(drive.payloads.begin() + 80);
    drive.times_ns.erase(drive.times_ns.begin() + 80);
    survey = drive.survey(drive.write(folder));
    EXPECT_EQ(survey.sources.begin()->second.lost_columns, 16U);
  }
}

class OpenedCapture : public testing::Test {
 protected:
  class Listener : public ProgressSink {
   public:
    void warn(std::string_view message) override { warnings.emplace_back(message); }
    std::vector<std::string> warnings;
  };
  KittiSequence open(const SentDrive& sent, const std::string& topic = "",
                     std::vector<std::string>* warnings = nullptr) const {
    DriveInput drive;
    drive.folder = folder_.path() / "sent.pcap";
    drive.trajectory = folder_.write(
        "poses.csv", "time,x,y,z,qw,qx,qy,qz\n" + std::to_string(kDriveBegin_ns / 1e9 - 1) +
                         ",0,0,0,1,0,0,0\n" + std::to_string(kDriveBegin_ns / 1e9 + 1) +
                         ",0,0,0,1,0,0,0\n");
    drive.topic = topic;
    drive.points_in = PointsIn::sensor;
    Listener listener;
    KittiSequence sequence =
        open_packet_drive(drive, sent.survey(drive.folder), Executor(1), listener);
    if (warnings != nullptr) *warnings = listener.warnings;
    return sequence;
  }
  TemporaryFolder folder_;
};

TEST_F(OpenedCapture, PointsAreWhereTheBeamsEnd) {
  for (const char* name : {"velodyne-hdl-64e-s3", "ouster-os0-128"}) {
    const PacketSensor sensor = packet_sensor(load_lidar_model(name));
    const SentDrive sent(name, 3 * sensor.model.columns);
    sent.write(folder_);
    const KittiSequence sequence = open(sent);
    ASSERT_EQ(sequence.scans.size(), 3U);
    const KittiScan scan = read_kitti_scan(sequence, 1);
    const std::size_t all = sensor.lasers() * sensor.model.columns;
    EXPECT_NEAR(static_cast<double>(scan.positions.size()), static_cast<double>(all),
                static_cast<double>(16 * sensor.lasers()));
    for (std::size_t k = 0; k < scan.positions.size(); k += 97)
      EXPECT_NEAR(length(scan.positions[k]), 10, 0.25);  // origins are off the axis
    EXPECT_EQ(scan.intensities[0], 9);
  }
}

TEST_F(OpenedCapture, PartsOfRevolutionsAreSaid) {
  const SentDrive sent("velodyne-vlp-16", 3 * 1808 - 904);
  sent.write(folder_);
  std::vector<std::string> warnings;
  const KittiSequence sequence = open(sent, "", &warnings);
  EXPECT_EQ(sequence.scans.size(), 3U);
  const auto says = [](const std::string& text) {
    return [&text](const std::string& warning) { return warning.find(text) != std::string::npos; };
  };
  EXPECT_TRUE(std::ranges::any_of(
      warnings, says("the last revolution of 10.0.0.201:2368 is 50 % of a turn")));
  EXPECT_TRUE(std::ranges::none_of(warnings, says("the first revolution")));
}

TEST_F(OpenedCapture, ScansOfAWindowAreWhole) {
  LidarModel model = load_lidar_model("ouster-os1-64");
  model.window_begin = 1.0 / 1024;
  model.window_end = 512.0 / 1024;
  const SentDrive sent(model, 1024);
  sent.write(folder_);
  std::vector<std::string> warnings;
  EXPECT_EQ(open(sent, "", &warnings).scans.size(), 1U);
  EXPECT_TRUE(std::ranges::none_of(warnings, [](const std::string& warning) {
    return warning.find("cut by the capture") != std::string::npos;
  }));
}

TEST_F(OpenedCapture, RestsOfRevolutionsAreSkipped) {
  const SentDrive sent("velodyne-vlp-16", 2 * 1808 + 8);
  sent.write(folder_);
  std::vector<std::string> warnings;
  EXPECT_EQ(open(sent, "", &warnings).scans.size(), 2U);
  EXPECT_TRUE(std::ranges::any_of(warnings, [](const std::string& warning) {
    return warning.find(
               "the last revolution of 10.0.0.201:2368 is 0.44 % of a turn, cut by the "
               "capture; it is skipped") != std::string::npos;
  }));
}

TEST_F(OpenedCapture, SeveralSensorsAreToldApart) {
  const SentDrive sent("velodyne-vlp-16", 3 * 1808);
  const std::filesystem::path path = folder_.path() / "sent.pcap";
  CaptureWriter writer(path);
  sent.add_to(writer, 0, 201);
  sent.add_to(writer, 0, 202);
  writer.finish();
  expect_error(ErrorKind::usage, {"several sensors", "`topic`", "10.0.0.202:2368"},
               [&] { open(sent); });
  EXPECT_EQ(open(sent, "10.0.0.202:2368").scans.size(), 3U);
  expect_error(ErrorKind::usage, {"10.0.0.9:1", "10.0.0.201:2368"},
               [&] { open(sent, "10.0.0.9:1"); });
}

/// A sensor with other columns per revolution or rotation rate than the one that sent the packets.
std::shared_ptr<const PacketDecoder> decoder_of_mode(const char* name, std::uint32_t columns,
                                                     double rotation_hz) {
  LidarModel model = load_lidar_model(name);
  model.columns = columns;
  model.rotation_hz = rotation_hz;
  return std::make_shared<const PacketDecoder>(packet_sensor(model));
}

TEST_F(OpenedCapture, AFileOfAnotherModeIsRejected) {
  const SentDrive sent("ouster-os1-64", 3 * 1024);
  const std::filesystem::path path = sent.write(folder_);
  ProgressSink quiet;
  const auto opened = [&](std::uint32_t columns, double rotation_hz) {
    const PacketSurvey survey =
        survey_packets(path, decoder_of_mode("ouster-os1-64", columns, rotation_hz), quiet);
    DriveInput drive;
    drive.folder = path;
    drive.trajectory = folder_.write("poses.csv", "time,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n");
    open_packet_drive(drive, survey, Executor(1), quiet);
  };
  for (const auto& [columns, rotation_hz] :
       std::vector<std::pair<std::uint32_t, double>>{{512, 10}, {512, 20}, {1024, 20}, {2048, 10}})
    expect_error(ErrorKind::data, {"sent.pcap: packets of 10.0.0.201:2368", "`packet_sensor`"},
                 [&] { opened(columns, rotation_hz); });
}

TEST_F(OpenedCapture, BrokenPacketsEndInErrors) {
  io_test::Mutator mutator(11);
  std::size_t opened = 0, refused = 0;
  for (const char* name : {"velodyne-vlp-16", "velodyne-hdl-64e-s3", "ouster-os1-64"}) {
    const PacketSensor sensor = packet_sensor(load_lidar_model(name));
    const SentDrive whole(name, sensor.model.columns / 16);
    for (int round = 0; round < 10; ++round) {
      SentDrive sent = whole;
      for (std::size_t k = 0; k < sent.payloads.size(); k += 2) {
        const std::size_t bytes = sent.payloads[k].size();
        sent.payloads[k] = mutator.mutate(sent.payloads[k], sent.payloads[0]);
        if (round % 2 == 0) sent.payloads[k].resize(bytes, '\x55');
      }
      sent.write(folder_);
      try {
        const KittiSequence sequence = open(sent);
        for (std::size_t k = 0; k < sequence.scans.size(); ++k) read_kitti_scan(sequence, k);
        ++opened;
      } catch (const Error&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(opened, 2U);
  EXPECT_EQ(opened + refused, 30U);
}

/// Two turns of an XT32 from azimuth 90 degrees, at 1,700,000,000 s since 1970.
std::filesystem::path write_xt32(const TemporaryFolder& folder, bool with_pandar64) {
  std::filesystem::path path = folder.path() / "hesai.pcap";
  CaptureWriter writer(path);
  const UdpEndpoint from{{}, {10, 0, 0, kSender}, 2368}, to{{}, {10, 0, 0, 1}, 2368};
  for (unsigned k = 0; k < 500; ++k) {
    writer.add(1'700'000'000'000'000 + 400 * k, from, to, hesai_test::xt32_packet(k));
    if (with_pandar64)
      writer.add(1'700'000'000'000'000 + 400 * k, from, to,
                 std::string("\xEE\xFF\x40\6\0\4\0\0", 8) + std::string(1186, '\0'));
  }
  writer.finish();
  return path;
}

TEST(PacketDrive, RevolutionsOfAHesai) {
  const TemporaryFolder folder;
  for (const bool with_pandar64 : {false, true}) {
    ProgressSink quiet;
    const PacketSurvey survey = survey_packets(write_xt32(folder, with_pandar64),
                                               decoder_named("hesai-pandarxt-32"), quiet);
    ASSERT_EQ(survey.sources.size(), 1U);
    const PacketSource& source = survey.sources.begin()->second;
    EXPECT_EQ(source.packets, 500U);
    EXPECT_EQ(source.gaps, 0U);
    EXPECT_EQ(source.objection.find("Pandar64") != std::string::npos, with_pandar64);
    ASSERT_EQ(source.revolutions.size(), 2U);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_EQ(source.revolutions[k].columns, 2000U);
      EXPECT_NEAR(source.revolutions[k].share, 1, 1e-3);
      // The last of 8 columns begins 5.632 us after the packet's time, its first shot 0.368 later.
      EXPECT_EQ(source.revolutions[k].begin_ns,
                1'700'000'000'000'000'000 + static_cast<std::int64_t>(k) * 100'000'000 - 344'000);
    }
  }
}

// An AT128 measures during half of the time: frames of 60 degrees of its mirror, then pauses, here
// less than half a period, so that they are not gaps in the capture.
TEST(PacketDrive, FramesOfAnAt128) {
  const TemporaryFolder folder;
  const auto decoder = decoder_named(folder.write("my.dat", hesai_test::at128_angles()).string());
  const std::filesystem::path path = folder.path() / "hesai.pcap";
  CaptureWriter writer(path);
  const UdpEndpoint from{{}, {10, 0, 0, kSender}, 2368}, to{{}, {10, 0, 0, 1}, 2368};
  constexpr unsigned kFrames = 4, kPackets = 600, kInPause = 3, kPeriod_us = 95'000;
  for (unsigned frame = 0; frame < kFrames; ++frame)
    for (unsigned k = 0; k < kPackets + kInPause; ++k) {
      const unsigned column = 400 + 2400 * (frame % 3) + 2 * k + (k < kPackets ? 0 : 2);
      const auto late_us = kPeriod_us * frame + static_cast<unsigned>(std::lround(2 * 41.666 * k));
      writer.add(1'700'000'000'000'000 + late_us, from, to,
                 hesai_test::at128_packet(column, late_us));
    }
  writer.finish();
  ProgressSink quiet;
  const PacketSurvey survey = survey_packets(path, decoder, quiet);
  ASSERT_EQ(survey.sources.size(), 1U);
  const PacketSource& source = survey.sources.begin()->second;
  EXPECT_EQ(source.objection, "");
  EXPECT_EQ(source.contradiction, "");
  EXPECT_EQ(source.odd_turns, 0U);
  EXPECT_EQ(source.gaps, 0U);
  ASSERT_EQ(source.revolutions.size(), kFrames);
  for (std::size_t frame = 0; frame < kFrames; ++frame) {
    const Revolution& turn = source.revolutions[frame];
    EXPECT_EQ(turn.columns, 2 * kPackets) << frame;
    EXPECT_NEAR(turn.share, 1, 2e-3) << frame;
    EXPECT_TRUE(turn.has_points) << frame;
    // The second column begins 50.915 us before the packet's time.
    EXPECT_EQ(turn.begin_ns, 1'700'000'000'000'000'000 +
                                 static_cast<std::int64_t>(frame) * 1000 * kPeriod_us - 50'915 -
                                 41'666);
  }
}

// Oracle: the sensor that sent them. Recognition would find the library's, 0.06 degrees off.
TEST_F(OpenedCapture, TheFileOfThePacketsDefinesLasersAndOrigins) {
  LidarModel model = load_lidar_model("ouster-os1-64");
  model.name = "mine";
  for (std::size_t k = 0; k < model.elevations_rad.size(); ++k)
    model.elevations_rad[k] += k % 2 == 0 ? 1e-3 : -1e-3;
  const SentDrive nominal("ouster-os1-64", 2 * 1024);
  nominal.write(folder_);
  ProgressSink quiet;
  DriveInput drive;
  drive.folder = folder_.path() / "sent.pcap";
  drive.trajectory =
      folder_.write("poses.csv", "time,x,y,z,qw,qx,qy,qz\n" +
                                     std::to_string(kDriveBegin_ns / 1e9 - 1) + ",0,0,0,1,0,0,0\n" +
                                     std::to_string(kDriveBegin_ns / 1e9 + 1) + ",0,0,0,1,0,0,0\n");
  const auto decoder = std::make_shared<const PacketDecoder>(packet_sensor(model));
  const KittiSequence sequence =
      open_packet_drive(drive, survey_packets(drive.folder, decoder, quiet), Executor(1), quiet);
  EXPECT_EQ(sequence.beams.sensor, "mine");
  const KittiScan scan = read_kitti_scan(sequence, 0);
  ASSERT_EQ(scan.lasers.size(), scan.positions.size());
  for (std::size_t i = 0; i < scan.positions.size(); i += 97) {
    const Vec3d way = vec_cast<double>(scan.positions[i] - scan.origins[i]);
    EXPECT_NEAR(scan.origins[i].z, model.beam_origins_m[0].z, 1e-5);
    EXPECT_NEAR(std::asin(way.z / length(way)), model.elevations_rad[scan.lasers[i]], 1e-5);
  }
}

TEST_F(OpenedCapture, EarlyPacketsOfAVlp16AreJudgedByTheirTimes) {
  SentDrive sent("velodyne-vlp-16", 3 * 1808);
  for (std::string& payload : sent.payloads) payload[1205] = 0x21;  // the HDL-32E
  const std::filesystem::path path = sent.write(folder_);
  std::vector<std::string> warnings;
  EXPECT_EQ(open(sent, "", &warnings).scans.size(), 3U);
  Listener listener;
  const PacketSurvey survey = survey_packets(path, sent.decoder(), listener);
  ASSERT_EQ(listener.warnings.size(), 1U);
  EXPECT_NE(listener.warnings[0].find("state an HDL-32E (0x21)"), std::string::npos);
  const PacketSurvey other = survey_packets(path, decoder_named("velodyne-hdl-32e"), listener);
  const PacketSource& source = other.sources.begin()->second;
  EXPECT_NE(source.contradiction.find("1327 us apart"), std::string::npos) << source.contradiction;
  EXPECT_EQ(source.candidates, std::vector<std::string>{"velodyne-vlp-16"});
  DriveInput drive;
  drive.folder = path;
  drive.trajectory = folder_.path() / "poses.csv";
  expect_error(ErrorKind::data, {"1327 us apart", "are of velodyne-vlp-16"},
               [&] { open_packet_drive(drive, other, Executor(1), listener); });
}

TEST_F(OpenedCapture, ThePacketsOfAnUnknownSensorNameIt) {
  for (const char* name : {"velodyne-vlp-16", "velodyne-hdl-32e", "ouster-os1-64"}) {
    const std::filesystem::path path = SentDrive(name, 2048).write(folder_);
    ProgressSink quiet;
    const PacketSurvey survey = survey_packets(path, nullptr, quiet);
    const std::vector<std::string>& found = survey.sources.begin()->second.candidates;
    EXPECT_EQ(std::ranges::count(found, name), 1) << name;
    DriveInput drive;
    drive.folder = path;
    expect_error(ErrorKind::usage, {"10.0.0.201:2368 are of", name, "`packet_sensor`"},
                 [&] { open_packet_drive(drive, survey, Executor(1), quiet); });
  }
}

}  // namespace
}  // namespace adasplats
