// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "commands/info_job.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <unordered_set>

#include "adasplats/city/city_manifest.h"
#include "adasplats/cloud/load/data_tree.h"
#include "adasplats/cloud/load/open_drive.h"
#include "adasplats/cloud/load/packet_drive.h"
#include "adasplats/cloud/load/recording_drive.h"
#include "adasplats/cloud/load/rig.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/cloud/sequence/pose_check.h"
#include "adasplats/core/error.h"
#include "adasplats/io/bags/recording.h"
#include "adasplats/io/base/column_names.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/base/point_files.h"
#include "adasplats/jobs/model/make_model.h"
#include "adasplats/jobs/session/inputs.h"
#include "adasplats/jobs/session/scan_range.h"
#include "adasplats/splats/model/mesh_model.h"
#include "adasplats/splats/model/splat_model.h"
#include "cli/text_table.h"

namespace adasplats::app {
namespace {

namespace fs = std::filesystem;

/// Extents, density and labels of positions that come one by one.
class Survey {
 public:
  void add(Vec3d world) {
    if (!is_finite(world)) {
      ++not_finite_;
      return;
    }
    ++count_;
    low_ = min(low_, world);
    high_ = max(high_, world);
    // Cells of 1 m; 32 bits of each number are plenty for the earth.
    const auto cell = [](double v) {
      return static_cast<std::uint32_t>(
          static_cast<std::int64_t>(std::clamp(std::floor(v), -2e9, 2e9)));
    };
    cells_.insert(std::uint64_t{cell(world.x)} << 32 | cell(world.y));
  }
  void add_class(std::uint16_t id) { ++classes_[id]; }
  std::uint64_t not_finite() const { return not_finite_; }

  void describe(FileFacts& facts, const char* unit) const {
    facts.rows.emplace_back(unit, grouped(count_));
    facts.json[unit] = count_;
    if (not_finite_ > 0)
      facts.rows.emplace_back("missing returns or not finite", grouped(not_finite_));
    if (count_ == 0) return;
    for (int axis = 0; axis < 3; ++axis) {
      const std::string name(1, "xyz"[axis]);
      facts.rows.emplace_back(name, fixed(low_[axis], 3) + " .. " + fixed(high_[axis], 3) + " m (" +
                                        fixed(high_[axis] - low_[axis], 3) + " m)");
      facts.json["extent_m"][name] = {low_[axis], high_[axis]};
    }
    const double density = static_cast<double>(count_) / static_cast<double>(cells_.size());
    facts.rows.emplace_back("per m2 of occupied ground", fixed(density, 1));
    facts.json["per_m2"] = density;
  }
  void describe_classes(FileFacts& facts, const std::optional<LabelScheme>& scheme) const {
    for (const auto& [id, count] : classes_) {
      const SemanticClass* known = scheme ? scheme->find(id) : nullptr;
      facts.classes.emplace_back(std::to_string(id) + (known == nullptr ? "" : " " + known->name),
                                 count);
      facts.json["classes"][std::to_string(id)] = count;
    }
  }

 private:
  std::uint64_t count_ = 0;
  std::uint64_t not_finite_ = 0;
  Vec3d low_ = {1e300, 1e300, 1e300};
  Vec3d high_ = {-1e300, -1e300, -1e300};
  std::unordered_set<std::uint64_t> cells_;
  std::map<std::uint16_t, std::uint64_t> classes_;
};

const char* type_name(const Column& column) {
  constexpr std::array<const char*, 10> kNames = {"i8",  "u8",  "i16", "u16", "i32",
                                                  "u32", "i64", "u64", "f32", "f64"};
  return kNames[column.values.index()];
}

std::string fields_of(const Table& table) {
  std::string fields;
  for (const Column& column : table.columns) {
    fields += (fields.empty() ? "" : ", ") + column.name + " " + type_name(column);
  }
  return fields;
}

/// Which system, of what says one or not.
void describe_crs(const Crs& crs, FileFacts& facts) {
  const std::string name = crs.name();
  facts.rows.emplace_back("coordinate system", name.empty() ? "none in the file" : name);
  facts.json["crs"] = name;
  if (!crs.wkt.empty()) facts.json["crs_wkt"] = crs.wkt;
}

void describe_las(const LasFacts& las, FileFacts& facts) {
  const auto numbers = [](Vec3d v) {
    return exact_text(v.x) + ", " + exact_text(v.y) + ", " + exact_text(v.z) + " m";
  };
  facts.rows.emplace_back("format", "LAS " + las.version + ", point format " +
                                        std::to_string(las.point_format) +
                                        (las.software.empty() ? "" : ", by " + las.software));
  facts.rows.emplace_back("scale", numbers(las.scale));
  facts.rows.emplace_back("offset", numbers(las.offset));
  facts.json["las"] = {{"version", las.version},
                       {"point_format", las.point_format},
                       {"software", las.software},
                       {"scale", {las.scale.x, las.scale.y, las.scale.z}},
                       {"offset", {las.offset.x, las.offset.y, las.offset.z}}};
}

/// What a file says before its points are loaded. Returns the name of its column of intensities.
std::string describe_file(const fs::path& input, const LoadOptions& options, FileFacts& facts,
                          Session& session) {
  const Table table =
      read_points(input, {options.salvage, &session.executor, options.selection, true});
  if (is_las(input)) describe_las(read_las_facts(input), facts);
  const std::string fields = fields_of(table);
  facts.rows.emplace_back("fields", fields);
  facts.json["fields"] = fields;
  const Column* const intensity = find_column(table, PointColumn::intensity);
  return intensity == nullptr ? std::string() : intensity->name;
}

FileFacts cloud_facts(const fs::path& input, const std::optional<LabelScheme>& scheme,
                      const LoadOptions& options, Session& session) {
  FileFacts facts;
  facts.kind = "point cloud";
  std::string intensity;  // the name of its column, in one file
  if (fs::is_regular_file(input)) intensity = describe_file(input, options, facts, session);
  LoadOptions described = options;
  described.accept_sensor_frame = true;
  const auto [cloud, report] =
      load_cloud(std::span(&input, 1), described, session.executor, session.progress);
  if (!report.sensor_frames.empty()) {
    const std::string frame = "sensor's frame (" + report.sensor_frames.front().second + ")";
    facts.rows.emplace_back("points in the", frame);
    facts.json["points_in"] = frame;
  }
  describe_crs(cloud.crs, facts);
  Survey survey;
  for (std::size_t i = 0; i < cloud.size(); ++i) survey.add(cloud.world(i));
  for (const std::uint16_t id : cloud.classes) survey.add_class(id);
  survey.describe(facts, "points");
  if (report.no_returns > 0)
    facts.rows.emplace_back("dropped: missing returns", grouped(report.no_returns));
  facts.rows.emplace_back("dropped: not finite",
                          grouped(report.dropped_not_finite - report.no_returns));
  facts.rows.emplace_back("dropped: too far", grouped(report.dropped_far));
  facts.rows.emplace_back("dropped: the recording vehicle itself", grouped(report.own_body));
  facts.rows.emplace_back("dropped: where it drove", grouped(report.driven_path));
  if (report.unknown_intensities > 0)
    facts.rows.emplace_back("intensity not known", grouped(report.unknown_intensities));
  facts.rows.emplace_back("sensor positions", describe_origins(report.origins));
  if (report.timed) {
    facts.rows.emplace_back("by their times", report.timed->description());
    facts.json["timed_origins"] = to_json(*report.timed);
  }
  const bool has_intensities =
      std::ranges::any_of(cloud.intensities, [](float value) { return std::isfinite(value); });
  facts.rows.emplace_back("intensities", !has_intensities ? "no"
                                         : intensity.empty()
                                             ? "yes"
                                             : "yes, of column '" + intensity + "'");
  survey.describe_classes(facts, scheme);
  return facts;
}

FileFacts model_facts(const fs::path& input, std::optional<LabelScheme> scheme) {
  const SplatModel model = load_splats(input);
  FileFacts facts;
  facts.kind = "splat model";
  if (!model.method.empty()) facts.rows.emplace_back("method", model.method);
  if (!model.label_scheme.empty()) facts.rows.emplace_back("labels", model.label_scheme);
  if (!model.network_sha256.empty())
    facts.rows.emplace_back("SHA-256 of the network that gave classes", model.network_sha256);
  describe_crs(model.crs, facts);
  Survey survey;
  std::vector<float> radii;
  for (const Disk& disk : model.disks) {
    survey.add(model.origin + vec_cast<double>(disk.center));
    radii.push_back(disk.radius);
  }
  for (const std::uint16_t id : model.classes) survey.add_class(id);
  survey.describe(facts, "splats");
  if (!radii.empty()) {
    std::sort(radii.begin(), radii.end());
    const auto at = [&](std::size_t i) { return centimetres(static_cast<double>(radii[i])); };
    facts.rows.emplace_back("radius: minimum, median, maximum",
                            at(0) + ", " + at(radii.size() / 2) + ", " + at(radii.size() - 1));
  }
  if (!scheme && !model.label_scheme.empty()) scheme = load_label_scheme(model.label_scheme);
  survey.describe_classes(facts, scheme);
  return facts;
}

FileFacts city_facts(const fs::path& input, std::optional<LabelScheme> scheme) {
  const CityManifest city = load_city_manifest(input);
  FileFacts facts = model_facts(input, std::move(scheme));
  facts.kind = "city of splats";
  std::size_t most = 0;
  for (const CityTile& tile : city.tiles) most = std::max(most, tile.splats);
  const std::vector<std::pair<std::string, std::string>> rows = {
      {"tiles", grouped(city.tiles.size()) + " of " + fixed(city.grid.side_m, 0) +
                    " m, made with " + fixed(city.halo_m, 0) + " m around"},
      {"points", grouped(city.points())},
      {"splats of the largest tile", grouped(most)}};
  facts.rows.insert(facts.rows.begin(), rows.begin(), rows.end());
  facts.json["tiles"] = city.tiles.size();
  facts.json["tile_m"] = city.grid.side_m;
  facts.json["halo_m"] = city.halo_m;
  facts.json["points"] = city.points();
  return facts;
}

FileFacts mesh_facts(const fs::path& input, std::optional<LabelScheme> scheme) {
  const MeshModel model = load_mesh(input);
  const TriangleMesh& mesh = model.mesh;
  FileFacts facts;
  facts.kind = "mesh";
  describe_crs(model.crs, facts);
  if (!model.method.empty()) facts.rows.emplace_back("method", model.method);
  if (!model.label_scheme.empty()) facts.rows.emplace_back("labels", model.label_scheme);
  double area_m2 = 0;
  for (std::size_t i = 0; i < model.size(); ++i) {
    const Triangle t = mesh.triangle(i);
    area_m2 += 0.5 * length(vec_cast<double>(cross(t.b - t.a, t.c - t.a)));
  }
  facts.rows.emplace_back("triangles", grouped(model.size()));
  facts.rows.emplace_back("area", fixed(area_m2, 1) + " m2");
  facts.json["triangles"] = model.size();
  facts.json["area_m2"] = area_m2;
  Survey survey;
  for (const Vec3f vertex : mesh.vertices) survey.add(model.origin + vec_cast<double>(vertex));
  for (const std::uint16_t id : mesh.classes) survey.add_class(id);
  survey.describe(facts, "vertices");
  if (!scheme && !model.label_scheme.empty()) scheme = load_label_scheme(model.label_scheme);
  survey.describe_classes(facts, scheme);
  return facts;
}

/// From when to when, and how far scans are apart.
void describe_times(const KittiSequence& sequence, FileFacts& facts) {
  if (sequence.trajectory.size() < 2) return;
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < sequence.trajectory.size(); ++i)
    steps_s.push_back(sequence.trajectory[i].time_s - sequence.trajectory[i - 1].time_s);
  std::ranges::sort(steps_s);
  const double first_s = sequence.trajectory.front().time_s;
  const double last_s = sequence.trajectory.back().time_s;
  const double median_s = steps_s[steps_s.size() / 2];
  facts.rows.emplace_back("times", fixed(first_s, 3) + " .. " + fixed(last_s, 3) + " s, scans " +
                                       fixed(median_s, 3) + " s apart (maximum " +
                                       fixed(steps_s.back(), 3) + " s)");
  facts.json["times_s"] = {{"first", first_s},
                           {"last", last_s},
                           {"median_step", median_s},
                           {"longest_step", steps_s.back()}};
}

/// What the reader inferred about a drive; fields without a value are left out.
void describe_drive(const DriveFacts& drive, FileFacts& facts) {
  const auto add = [&facts](const char* name, const char* key, const std::string& text) {
    if (text.empty()) return;
    facts.rows.emplace_back(name, text);
    facts.json[key] = text;
  };
  add("points in the", "points_in", drive.points_in);
  add("poses of the scans", "poses", drive.poses);
  add("clocks", "clock", drive.clock);
  add("not checked", "unchecked", drive.unchecked);
  add("intensities", "intensities", drive.intensities);
  add("skipped", "left_out", drive.left_out);
  if (!drive.crs.empty()) describe_crs(drive.crs, facts);
}

/// The sensor, where its beams start, and its motion within a scan.
void describe_beams(const ScanBeams& beams, const std::string& motion, FileFacts& facts) {
  const std::string sensor = beams.sensor.empty() ? "not recognised" : beams.sensor;
  facts.rows.emplace_back("sensor", sensor);
  facts.rows.emplace_back("beams from", beams.description());
  const std::string known = !motion.empty()              ? motion
                            : !beams.sweeps_m.empty()    ? "already compensated in the points"
                            : !beams.raw_motions.empty() ? "points as measured, compensated"
                                                         : "unknown; the sensor is assumed to be "
                                                           "at rest during a scan";
  facts.rows.emplace_back("motion of a scan", known);
  facts.json["motion"] = known;
  facts.json["sensor"] = beams.sensor;
  facts.json["beams"] = beams.description();
}

FileFacts sequence_facts(const KittiSequence& sequence, const char* kind,
                         const std::optional<LabelScheme>& scheme, const LoadOptions& options,
                         Session& session) {
  const fs::path& input = sequence.folder;
  const std::vector<std::size_t> chosen = chosen_scans(
      {options.first_scan, options.scan_count, options.scan_stride}, sequence.scans.size(), input);
  FileFacts facts;
  facts.kind = kind;
  double driven_m = 0;
  for (std::size_t i = chosen.front() + 1; i <= chosen.back(); ++i) {
    driven_m += length(sequence.trajectory[i].world_from_sensor.translation -
                       sequence.trajectory[i - 1].world_from_sensor.translation);
  }
  const bool all = chosen.size() == sequence.scans.size();
  facts.rows.emplace_back(
      "scans", grouped(chosen.size()) + (all ? "" : " of " + grouped(sequence.scans.size())));
  const std::string& labels = sequence.facts.labels;
  facts.rows.emplace_back("labels", !labels.empty()           ? labels
                                    : sequence.labels.empty() ? "no"
                                                              : "yes");
  facts.rows.emplace_back("trajectory", fixed(driven_m, 1) + " m");
  facts.json["scans"] = chosen.size();
  if (!all) facts.json["scans_in_all"] = sequence.scans.size();
  facts.json["driven_m"] = driven_m;
  describe_times(sequence, facts);
  describe_drive(sequence.facts, facts);
  describe_beams(sequence.beams, sequence.facts.motion, facts);
  Survey survey;
  session.progress.begin_step("read " + input.filename().string(), chosen.size());
  std::size_t done = 0;
  // One scan at a time: sequences can be larger than memory.
  for (const std::size_t i : chosen) {
    const KittiScan scan = read_kitti_scan(sequence, i);
    const RigidTransform& pose = sequence.trajectory[i].world_from_sensor;
    for (const Vec3f p : scan.positions) survey.add(pose * vec_cast<double>(p));
    for (const std::uint16_t id : scan.classes) survey.add_class(id);
    if (options.strict && survey.not_finite() > 0) {
      throw Error(ErrorKind::data, sequence.scans[i].string() + ": has points that are not finite");
    }
    session.progress.advance(++done);
  }
  session.progress.end_step();
  survey.describe(facts, "points");
  survey.describe_classes(facts, scheme);
  return facts;
}

/// A drive of a data set, with the names of its LiDARs.
FileFacts tree_facts(const KittiSequence& sequence, const DataTree& tree,
                     const std::optional<LabelScheme>& scheme, const LoadOptions& options,
                     Session& session) {
  FileFacts facts = sequence_facts(sequence, tree.name, scheme, options, session);
  const bool is_rig = tree.is_rig != nullptr && tree.is_rig(sequence.folder);
  if (tree.sensors.empty() || (tree.is_rig != nullptr && !is_rig)) return facts;
  std::string names;
  for (const std::string_view name : tree.sensors) {
    (names += names.empty() ? "" : ", ") += name;
    facts.json["lidars"].push_back(name);
  }
  if (is_rig) names += "; these facts are of one, models are of all";
  facts.rows.emplace_back("LiDARs", names + " (choose one: --topic)");
  return facts;
}

/// The sources of packets in a capture or recording, and what is understood of it as a drive.
FileFacts packet_facts(const PacketSurvey& survey, const char* kind,
                       const std::optional<LabelScheme>& scheme, const LoadOptions& options,
                       Session& session) {
  FileFacts facts;
  try {
    facts = sequence_facts(open_packet_drive(drive_of(survey.path, options), survey,
                                             session.executor, session.progress),
                           kind, scheme, options, session);
  } catch (const Error& error) {
    facts = {};
    facts.kind = kind;
    facts.rows.emplace_back("no drive", error.what());
    facts.json["no_drive"] = error.what();
  }
  if (survey.decoder) {
    facts.rows.emplace_back("packets of", survey.decoder->sensor().model.name);
    facts.json["packet_sensor"] = survey.decoder->sensor().model.name;
  }
  facts.json["sources"] = nlohmann::ordered_json::array();
  for (const auto& [name, source] : survey.sources) {
    std::string text = grouped(source.datagrams) + " datagrams, " + grouped(source.packets) +
                       " packets of the sensor" +
                       (source.dual_packets == 0 ? ""
                        : source.dual_packets == source.packets
                            ? " with two returns a firing"
                            : ", " + grouped(source.dual_packets) + " with two returns a firing") +
                       ", " + grouped(source.revolutions.size()) + " revolutions";
    if (source.lost_columns > 0)
      text += ", " + grouped(source.lost_columns) + " columns missing in " + grouped(source.gaps) +
              " gaps";
    if (source.packets > 0)
      text += "; captured " + fixed(1e-9 * static_cast<double>(source.ahead_ns), 6) +
              " s after its own times";
    for (const std::string& fault : {source.objection, source.contradiction})
      if (!fault.empty()) text += "; some " + fault;
    facts.rows.emplace_back("from " + name, text);
    facts.json["sources"].push_back({{"name", name},
                                     {"datagrams", source.datagrams},
                                     {"packets", source.packets},
                                     {"dual_packets", source.dual_packets},
                                     {"revolutions", source.revolutions.size()},
                                     {"lost_columns", source.lost_columns},
                                     {"gaps", source.gaps},
                                     {"objection", source.objection},
                                     {"contradiction", source.contradiction}});
  }
  return facts;
}

/// What is understood of the clouds of a recording as a drive.
FileFacts cloud_topic_facts(const RecordingSurvey& survey, const std::optional<LabelScheme>& scheme,
                            const LoadOptions& options, Session& session) {
  try {
    return sequence_facts(open_recording_drive(drive_of(survey.recording->path(), options), survey,
                                               session.executor, session.progress),
                          "recording", scheme, options, session);
  } catch (const Error& error) {
    // The list of topics shows what to select.
    FileFacts facts;
    facts.kind = "recording";
    facts.rows.emplace_back("no drive", error.what());
    facts.json["no_drive"] = error.what();
    return facts;
  }
}

/// The topics of a recording, and what is understood of it as a drive.
FileFacts recording_facts(const fs::path& input, const std::optional<LabelScheme>& scheme,
                          const LoadOptions& options, Session& session) {
  const RecordingSurvey survey = survey_recording(input, session.progress);
  FileFacts facts;
  if (is_read_by_packets(survey, options)) {
    facts = packet_facts(survey_packets(survey, options, session.progress), "recording", scheme,
                         options, session);
  } else {
    facts = cloud_topic_facts(survey, scheme, options, session);
  }
  facts.json["topics"] = nlohmann::ordered_json::array();
  for (const auto& [name, topic] : survey.topics) {
    constexpr double kNanoseconds = 1e9;
    const double seconds = static_cast<double>(topic.last_ns - topic.first_ns) / kNanoseconds;
    facts.rows.emplace_back("topic " + name,
                            topic.topic.type + ", " + grouped(topic.messages) + " messages in " +
                                fixed(seconds, 3) + " s" +
                                (topic.frame.empty() ? "" : ", frame '" + topic.frame + "'"));
    facts.json["topics"].push_back({{"name", name},
                                    {"type", topic.topic.type},
                                    {"messages", topic.messages},
                                    {"seconds", seconds},
                                    {"frame", topic.frame}});
  }
  return facts;
}

/// What a capture holds of UDP, and what is understood of it as a drive.
FileFacts capture_facts(const fs::path& input, const std::optional<LabelScheme>& scheme,
                        const LoadOptions& options, Session& session) {
  const PacketSurvey survey =
      survey_packets(input, decoder_of_capture(input, options.packet_sensor), session.progress);
  FileFacts facts = packet_facts(survey, "capture", scheme, options, session);
  const DatagramCounts& counts = survey.counts;
  facts.rows.emplace_back("frames", grouped(counts.frames) + ", " + grouped(counts.others) +
                                        " of other protocols than UDP, " + grouped(counts.cut) +
                                        " not whole, " + grouped(counts.torn) +
                                        " datagrams of which parts are missing");
  facts.json["frames"] = {{"all", counts.frames},
                          {"others", counts.others},
                          {"cut", counts.cut},
                          {"timeless", counts.timeless},
                          {"torn", counts.torn}};
  return facts;
}

}  // namespace

std::vector<FileFacts> run_rig_info(const fs::path& rig_file, const std::string& labels,
                                    const LoadOptions& options, Session& session) {
  const Rig rig = read_rig(rig_file);
  require_no_settings(rig, options);
  const auto scheme = label_scheme_for(labels, std::span(&rig_file, 1));
  std::vector<FileFacts> sensors;
  for (std::size_t k = 0; k < rig.sensors.size(); ++k) {
    if (!options.topic.empty() && rig.index_of(options.topic) != k) continue;
    const RigSensor& sensor = rig.sensors[k];
    const KittiSequence drive = open_rig_sensor(sensor, session.executor, session.progress);
    sensors.push_back(sequence_facts(drive, "sensor of a rig", scheme, options, session));
    sensors.back().rows.emplace(sensors.back().rows.begin(), "sensor", sensor.name);
    sensors.back().json["name"] = sensor.name;
  }
  return sensors;
}

FileFacts run_info(const fs::path& input, const std::string& labels, const LoadOptions& options,
                   Session& session) {
  if (is_city(input)) return city_facts(input, label_scheme_for(labels, {}));
  if (is_capture(input))
    return capture_facts(input, label_scheme_for(labels, {}), options, session);
  if (is_recording(input))
    return recording_facts(input, label_scheme_for(labels, std::span(&input, 1)), options, session);
  const DataTree* const tree = data_tree_of(input);
  if (tree != nullptr || !options.trajectory.empty()) {
    const auto scheme = label_scheme_for(labels, std::span(&input, 1));
    const auto drive = open_drive(drive_of(input, options), session.executor, session.progress);
    if (drive && tree == nullptr)
      return sequence_facts(*drive, "folder of scans", scheme, options, session);
    if (drive) return tree_facts(*drive, *tree, scheme, options, session);
  }
  const fs::path resolved = resolve_cloud_input(input);
  const auto scheme = label_scheme_for(labels, std::span(&resolved, 1), options.label_field);
  if (is_kitti_sequence(resolved)) {
    KittiSequence sequence = open_kitti_sequence(resolved);
    sequence.facts.unchecked = verify_poses(sequence, session.executor);
    sequence.beams = recognize_beams(sequence, session.executor);
    return sequence_facts(sequence, "sequence", scheme, options, session);
  }
  if (fs::is_regular_file(resolved)) {
    if (is_mesh_file(resolved)) return mesh_facts(resolved, scheme);
    if (is_splat_model(resolved)) return model_facts(resolved, scheme);
  }
  return cloud_facts(resolved, scheme, options, session);
}

}  // namespace adasplats::app
