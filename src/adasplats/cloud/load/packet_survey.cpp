// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/packet_survey.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/core/list_folder.h"
#include "adasplats/core/maths/median.h"
#include "adasplats/sensors/packet_layout.h"

namespace adasplats {

namespace {

constexpr std::size_t kMaxSources = 256;

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
      settings.packet_sensor.empty() ? topic_of_metadata(recording, settings.topic) : nullptr;
  if (metadata != nullptr)
    survey.decoder = decoder_of(ouster_lidar_model(metadata->metadata, metadata->topic.name));
  else
    survey.decoder = decoder_of_capture(survey.path, settings.packet_sensor);
  return surveyed(std::move(survey), progress);
}

bool is_read_by_packets(const RecordingSurvey& survey, const DriveSettings& settings,
                        bool may_lack_packets) {
  bool has_clouds = false, has_packets = false;
  for (const auto& [name, topic] : survey.topics) {
    if (!settings.topic.empty() && name != settings.topic) continue;
    has_clouds = has_clouds || topic.holds_clouds();
    has_packets = has_packets || !topic.packets.empty();
  }
  if (!settings.packet_sensor.empty() && !has_packets && !may_lack_packets)
    throw Error(ErrorKind::usage,
                survey.recording->path().string() + ": `packet_sensor` needs a topic of packets; " +
                    (settings.topic.empty() ? "there is none" : settings.topic + " is none"));
  return has_packets && (!has_clouds || !settings.packet_sensor.empty());
}

std::string sensor_of_capture(const std::filesystem::path& capture, const std::string& stated) {
  namespace fs = std::filesystem;
  if (!stated.empty()) return stated;
  std::error_code ignored;
  const fs::path folder = fs::absolute(capture, ignored).parent_path();
  const fs::path own = folder / (capture.stem().string() + ".json");
  if (fs::is_regular_file(own, ignored)) return own.string();
  std::vector<std::string> found;
  for (const fs::path& file : list_folder_if_any(folder)) {
    const std::string name = file.filename().string();
    const bool is_hesais = name.starts_with("correction") || name.starts_with("angle");
    if (name == "metadata.json" || (name.starts_with("calibration") && name.ends_with(".yaml")) ||
        (is_hesais && (name.ends_with(".csv") || name.ends_with(".dat"))))
      found.push_back(file.string());
  }
  if (found.size() > 1)
    throw Error(ErrorKind::usage, capture.string() + ": its folder contains " + found[0] + " and " +
                                      found[1] + "; choose one with `packet_sensor`");
  return found.empty() ? "" : found.front();
}

std::shared_ptr<const PacketDecoder> decoder_of_capture(const std::filesystem::path& capture,
                                                        const std::string& stated) {
  const std::string sensor = sensor_of_capture(capture, stated);
  if (sensor.empty()) return nullptr;
  return decoder_of(load_lidar_model(sensor));
}

}  // namespace adasplats
