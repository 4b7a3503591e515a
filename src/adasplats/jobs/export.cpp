// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/export.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/city/city_manifest.h"
#include "adasplats/cloud/load/open_drive.h"
#include "adasplats/cloud/points/cloud_glb.h"
#include "adasplats/cloud/points/laser_offsets.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/error.h"
#include "adasplats/core/list_folder.h"
#include "adasplats/core/words.h"
#include "adasplats/dataset/mcap_writer.h"
#include "adasplats/dataset/scan_values.h"
#include "adasplats/dataset/scan_writer.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/jobs/output/output_check.h"
#include "adasplats/jobs/output/output_folder.h"
#include "adasplats/jobs/session/inputs.h"
#include "adasplats/jobs/session/scan_range.h"
#include "adasplats/jobs/tileset.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/simulate/image/point_colors.h"
#include "adasplats/splats/model/gaussian_glb.h"
#include "adasplats/splats/model/gaussian_ply.h"
#include "adasplats/splats/model/gaussian_usd.h"
#include "adasplats/splats/model/mesh_model.h"
#include "adasplats/splats/model/splat_model.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

enum class InputKind : std::uint8_t { model, cloud, drive };

/// What an input can become, the first of an ending being what the ending means.
struct KindFormats {
  const char* name;
  std::vector<ExportFormat> formats;
};

KindFormats formats_of(InputKind kind) {
  using enum ExportFormat;
  switch (kind) {
    case InputKind::model: return {"a splat model", {gaussian_3d, gaussian_2d, glb, usd, tiles_3d}};
    case InputKind::cloud: return {"a point cloud", {glb, ply, las, laz, pcd, csv}};
    case InputKind::drive:
      return {"a sequence of scans",
              {mcap, glb, ply, las, laz, pcd, csv, semantickitti, kitti_raw, nuscenes, pandaset,
               argoverse2}};
  }
  return {};
}

std::string_view name_of(ExportFormat format) {
  return kExportFormats[static_cast<std::size_t>(format)].first;
}

/// Whether the output is a folder.
bool is_folder(ExportFormat format) {
  return format == ExportFormat::tiles_3d || format >= ExportFormat::semantickitti;
}
/// Whether scans are written, each in its sensor frame.
bool has_scans(ExportFormat format) { return format >= ExportFormat::mcap; }

/// Whether the format holds the times of points.
bool has_times(ExportFormat format) {
  return format == ExportFormat::mcap || format == ExportFormat::pandaset ||
         format == ExportFormat::argoverse2;
}
/// Whether the format holds the rings of points.
bool has_rings(ExportFormat format) {
  return format == ExportFormat::nuscenes || format == ExportFormat::argoverse2;
}

/// Whether the format holds the classes of points.
bool has_classes(ExportFormat format) {
  return format != ExportFormat::kitti_raw && format != ExportFormat::argoverse2;
}
/// Whether the format holds the instances of points.
bool has_instances(ExportFormat format) {
  return format == ExportFormat::mcap || format == ExportFormat::semantickitti;
}

/// Empty for folders.
std::string_view ending_of(ExportFormat format) {
  if (is_folder(format)) return {};
  const bool gaussian = format == ExportFormat::gaussian_3d || format == ExportFormat::gaussian_2d;
  if (format == ExportFormat::usd) return "usda";
  return gaussian ? "ply" : name_of(format);
}

std::string joined_names(const std::vector<ExportFormat>& formats) {
  std::string names;
  for (std::size_t i = 0; i < formats.size(); ++i) {
    if (i > 0) names += i + 1 < formats.size() ? ", " : " or ";
    names += name_of(formats[i]);
  }
  return names;
}

InputKind kind_of(const fs::path& input, const LoadOptions& load) {
  if (is_splat_model(input)) return InputKind::model;
  if (is_kitti_sequence(input) || is_self_contained_drive(input)) return InputKind::drive;
  if (fs::is_directory(input)) return load.trajectory.empty() ? InputKind::cloud : InputKind::drive;
  if (is_mesh_file(input)) {
    throw Error(ErrorKind::usage, input.string() +
                                      ": is a triangle mesh, which other programs open as it is; "
                                      "splat models, point clouds and sequences are exported");
  }
  return InputKind::cloud;
}

/// The format asked for, or else the only one with the output's ending.
ExportFormat format_of(const ExportJob& job, InputKind kind) {
  const auto [kind_name, possible] = formats_of(kind);
  const std::string can_be =
      job.input.string() + ": " + kind_name + " can be exported as " + joined_names(possible);
  if (job.format) {
    if (std::ranges::find(possible, *job.format) != possible.end()) {
      if (!is_folder(*job.format))
        require_ending(job.output, "." + std::string(ending_of(*job.format)));
      return *job.format;
    }
    throw Error(ErrorKind::usage, can_be + ", not as " + std::string(name_of(*job.format)) +
                                      (kind == InputKind::cloud && has_scans(*job.format)
                                           ? ", which needs scans with poses (`trajectory`)"
                                           : ""));
  }
  std::string ending = lower_case(job.output.extension().string());
  if (!ending.empty()) ending.erase(0, 1);
  std::vector<ExportFormat> meant;
  std::ranges::copy_if(possible, std::back_inserter(meant), [&ending](ExportFormat format) {
    return !is_folder(format) && ending_of(format) == ending;
  });
  if (meant.size() == 1) return meant.front();
  const std::string of_ending =
      ending.empty() ? "a name without an ending" : "the ending ." + ending;
  throw Error(ErrorKind::usage, can_be + "; " + of_ending +
                                    (meant.empty() ? " is none of them" : " is ambiguous") +
                                    ": give the format");
}

bool has_colors(ExportFormat format) { return format <= ExportFormat::glb; }

/// Nothing: default_color(). Errors: usage (no intensities).
std::optional<ImageColor> shown_color(const PointCloud& cloud, std::optional<ExportColor> color) {
  if (!color) return std::nullopt;
  switch (*color) {
    case ExportColor::semantic: return ImageColor::semantic;
    case ExportColor::intensity:
      if (cloud.intensities.empty() && !cloud.empty())
        throw Error(ErrorKind::usage, "color by intensity: the input has no intensities");
      return ImageColor::intensity;
    case ExportColor::height: return ImageColor::height;
    case ExportColor::rgb: return ImageColor::rgb;
  }
  return std::nullopt;
}

std::vector<Rgb> colors_of(const PointCloud& cloud, const LabelScheme* labels,
                           std::optional<ExportColor> color) {
  return point_colors(cloud, labels, shown_color(cloud, color), {});
}

/// The centers of every `every`-th splat, with what colours show.
PointCloud centers_of(const SplatModel& model, std::size_t every = 1) {
  PointCloud cloud;
  cloud.origin = model.origin;
  cloud.crs = model.crs;
  std::array<std::vector<std::uint8_t>, 3> rgb;
  for (std::size_t i = 0; i < model.size(); i += every) {
    cloud.positions.push_back(model.disks[i].center);
    if (!model.classes.empty()) cloud.classes.push_back(model.classes[i]);
    if (!model.intensities.empty()) cloud.intensities.push_back(model.intensities[i]);
    for (std::size_t k = 0; !model.colors.empty() && k < rgb.size(); ++k)
      rgb[k].push_back(model.colors[i][k]);
  }
  for (std::size_t k = 0; !model.colors.empty() && k < rgb.size(); ++k)
    cloud.others.columns.push_back({kRgbColumns[k], std::move(rgb[k])});
  return cloud;
}

std::optional<LabelScheme> labels_of(const ExportJob& job, const std::string& scheme,
                                     ProgressSink& progress) {
  return job.labels.empty() ? load_labels_of_model(scheme, progress)
                            : load_label_scheme(job.labels);
}

ExportResult export_model(const ExportJob& job, ExportFormat format, Session& session) {
  const SplatModel model = load_splats(job.input);
  const std::optional<LabelScheme> labels = labels_of(job, model.label_scheme, session.progress);
  const std::vector<Rgb> colors =
      colors_of(centers_of(model), labels ? &*labels : nullptr, job.color);
  if (format == ExportFormat::usd) {
    write_gaussian_usd(job.output, model, colors, labels ? &*labels : nullptr);
  } else if (format == ExportFormat::glb) {
    write_gaussian_glb(job.output, model, colors);
  } else {
    write_gaussian_ply(
        job.output, model, colors,
        format == ExportFormat::gaussian_3d ? GaussianKind::volumes : GaussianKind::surfels);
  }
  return {model.size(), "splats"};
}

/// A model, or a city tile by tile, as 3D Tiles.
class TilesetExport {
 public:
  TilesetExport(const ExportJob& job, Session& session) : job_(job), session_(session) {
    if (is_city(job.input)) {
      city_ = load_city_manifest(job.input);
      common_ = load_model(job.input / kCityCommonFile);
      common_.origin = city_->origin;
      for (std::size_t k = 0; k < city_->tiles.size(); ++k)
        if (city_->tiles[k].splats > 0) tiles_.push_back(k);
    } else {
      common_ = opaque(load_model(job.input));
      if (common_.size() > 0) tiles_.push_back(0);
    }
    if (tiles_.empty())
      throw Error(ErrorKind::data, job.input.string() + ": has no splats, which tiles need");
  }

  ExportResult run() {
    OutputFolder folder(job_.output, false, "export", {{"format", "3d-tiles"}});
    choose_colors();
    TilesetParts parts{common_.origin, common_.crs, {}};
    for (const std::size_t k : tiles_)
      parts.keys.push_back(city_ ? city_->tiles[k].key : TileKey{});
    ExportResult result{city_ ? city_->splats() : common_.size(), "splats"};
    result.place = write_tileset(
        folder.path(), parts, [this](std::size_t k) { return part(k); }, session_);
    folder.commit();
    return result;
  }

 private:
  SplatModel model_of(std::size_t k) const {
    return city_ ? load_city_tile(job_.input, *city_, tiles_[k]) : common_;
  }

  /// The same meaning and range of colours for all tiles.
  void choose_colors() {
    constexpr std::size_t kMaxSurveyed = 8'000'000;
    labels_ = labels_of(job_, common_.label_scheme, session_.progress);
    const std::size_t every = city_ ? 1 + city_->splats() / kMaxSurveyed : 1;
    PointCloud survey;
    SameAttributes attributes;
    for (std::size_t k = 0; k < tiles_.size(); ++k) {
      const SplatModel model = model_of(k);
      if (city_) attributes.check(job_.input, city_->tiles[tiles_[k]], model);
      append(survey, centers_of(model, every));
    }
    color_ = shown_color(survey, job_.color)
                 .value_or(default_color(survey, labels_ ? &*labels_ : nullptr));
    range_ = shown_range(survey, color_);
  }

  ColoredDisks part(std::size_t k) const {
    SplatModel model = model_of(k);
    std::vector<Rgb> colors =
        point_colors(centers_of(model), labels_ ? &*labels_ : nullptr, color_, {}, range_);
    return {std::move(model.disks), std::move(colors)};
  }

  const ExportJob& job_;
  Session& session_;
  std::optional<CityManifest> city_;
  SplatModel common_;               ///< the model; of a city what its tiles share
  std::vector<std::size_t> tiles_;  ///< those with splats
  std::optional<LabelScheme> labels_;
  ImageColor color_ = ImageColor::height;
  ValueRange range_;
};

/// Warns of the columns of a file that glTF has no field for.
void warn_of_dropped(const fs::path& output, const PointCloud& cloud, ProgressSink& progress) {
  std::vector<std::string> names;
  const bool has_colors = !file_colors(cloud).empty();
  for (const Column& column : cloud.others.columns) {
    const bool is_color = std::ranges::count(kRgbColumns, column.name) > 0;
    if (!has_colors || !is_color) names.push_back(column.name);
  }
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  if (!list.empty())
    progress.warn(output.string() + ": glTF has no fields for " + list +
                  ", which are dropped (.ply, .las, .laz, .pcd and .csv keep them)");
}

void save_cloud(ExportFormat format, const fs::path& output, const PointCloud& cloud) {
  switch (format) {
    case ExportFormat::ply: return save_cloud_ply(output, cloud);
    case ExportFormat::pcd: return save_cloud_pcd(output, cloud);
    case ExportFormat::csv: return save_cloud_csv(output, cloud);
    default: return save_cloud_las(output, cloud);
  }
}

ExportResult export_cloud(const ExportJob& job, ExportFormat format, Session& session) {
  const std::span inputs(&job.input, 1);
  LoadOptions load = job.load;
  load.other_columns = KeptColumns::all;
  const std::optional<LabelScheme> labels =
      label_scheme_for(job.labels, inputs, job.load.label_field);
  auto [cloud, report] = load_cloud(inputs, load, session.executor, session.progress);
  if (labels) cloud.label_scheme = scheme_reference(job.labels, *labels);
  if (!report.drives.empty() && !report.timed && !is_kitti_sequence(job.input)) {
    const bool has_times = !cloud.others.columns.empty();
    session.progress.warn(
        job.input.string() +
        ": of the points of a drive, positions, sensor positions, intensities, classes, instances, "
        "lasers, scan numbers" +
        (has_times ? " and times are exported; other" : " and no times are exported; other") +
        " fields are dropped");
  }
  if (format == ExportFormat::glb) {
    warn_of_dropped(job.output, cloud, session.progress);
    const std::vector<Rgb> colors = colors_of(cloud, labels ? &*labels : nullptr, job.color);
    save_cloud_glb(job.output, cloud, colors);
  } else {
    save_cloud(format, job.output, cloud);
  }
  return {cloud.size(), "points", report.dropped_not_finite + report.dropped_far};
}

/// The scans of a drive for the formats of scans.
class ScanExport {
 public:
  ScanExport(const ExportJob& job, ExportFormat format, Session& session)
      : job_(job), format_(format), session_(session), sequence_(opened()) {
    if (format_ == ExportFormat::argoverse2 && !sequence_.has_times)
      throw Error(ErrorKind::data, job_.input.string() +
                                       ": has no times of scans (times.txt), by which argoverse2 "
                                       "names its files");
    chosen_ = chosen_scans({job.load.first_scan, job.load.scan_count, job.load.scan_stride},
                           sequence_.scans.size(), job.input);
    labels_ = label_scheme_for(job.labels, std::span(&job.input, 1));
  }

  ExportResult run() {
    if (format_ == ExportFormat::mcap) {
      McapWriter writer(job_.output,
                        {0, labels_ ? labels_->name() : std::string_view(), {}, {}, {}});
      write_scans([&writer](std::size_t, const Scan& scan) { writer.write(scan); });
      writer.finish();
      warn_of_lost(false);
    } else {
      write_folder();
    }
    return result_;
  }

 private:
  KittiSequence opened() const {
    if (is_kitti_sequence(job_.input) && !lacks_poses(job_.input)) {
      KittiSequence sequence = open_kitti_sequence(job_.input);
      if (has_rings(format_)) sequence.beams = recognize_beams(sequence, session_.executor);
      return sequence;
    }
    auto drive = open_drive(drive_of(job_.input, job_.load), session_.executor, session_.progress);
    if (drive) return std::move(*drive);
    throw Error(ErrorKind::data, job_.input.string() + ": contains no scans with poses, which " +
                                     std::string(name_of(format_)) +
                                     " needs; as a point cloud it can be exported as " +
                                     joined_names(formats_of(InputKind::cloud).formats));
  }

  template <class Write>
  void write_scans(Write&& write) {
    session_.progress.begin_step("writing scans", chosen_.size());
    for (const std::size_t index : chosen_) {
      const std::size_t dropped_before = result_.dropped;
      write(result_.count, scan(index));
      if (job_.load.strict && result_.dropped > dropped_before) {
        throw Error(ErrorKind::data, sequence_.scans[index].string() + ": has " +
                                         std::to_string(result_.dropped) +
                                         " points that are not finite");
      }
      session_.progress.advance(++result_.count);
    }
    session_.progress.end_step();
  }

  /// A scan as a simulated one; points that are not finite are left out and counted.
  Scan scan(std::size_t index) {
    // Objects that move are part of a scan.
    KittiScan kitti = sequence_.labels.empty() ? read_all_returns(sequence_, index)
                                               : read_kitti_scan(sequence_, index);
    const TimedPose& pose = sequence_.trajectory[index];
    Scan scan;
    if (has_rings(format_)) scan.rings = rings_of(kitti, index);
    scan.world_from_sensor = pose.world_from_sensor;
    scan.time_s = pose.time_s;
    scan.positions = std::move(kitti.positions);
    scan.intensities = std::move(kitti.intensities);
    scan.classes = std::move(kitti.classes);
    scan.instances = std::move(kitti.instances);
    scan.rays = scan.size();
    if (has_times(format_)) set_times(kitti.times_s, scan);
    std::vector<std::uint8_t> keep(scan.size(), 1);
    for (std::size_t i = 0; i < scan.size(); ++i) keep[i] = is_finite(scan.positions[i]) ? 1 : 0;
    const auto bad = static_cast<std::size_t>(std::ranges::count(keep, 0));
    result_.dropped += bad;
    return bad == 0 ? scan : kept_points(scan, keep);
  }

  /// Sets the times of points, and the motion of the sensor while it measured them. The points are
  /// in the frame of the scan's pose.
  void set_times(const std::vector<double>& times_s, Scan& scan) {
    double half_s = 0;
    bool are_known = times_s.size() == scan.size() && !sequence_.track.empty();
    for (std::size_t i = 0; are_known && i < scan.size(); ++i) {
      if (!is_finite(scan.positions[i])) continue;
      are_known = std::isfinite(times_s[i]);
      half_s = std::max(half_s, std::fabs(times_s[i] - scan.time_s));
    }
    has_times_ = has_times_ && are_known;
    if (!are_known || half_s == 0) return;
    scan.frame = PointFrame::deskewed;
    scan.duration_s = 2 * half_s;
    constexpr int kKnots = 9;
    for (int k = 0; k < kKnots; ++k)
      scan.knots.push_back(
          interpolate(sequence_.track, scan.time_s + half_s * (2.0 * k / (kKnots - 1) - 1)));
    for (const double time_s : times_s)
      scan.times_s.push_back(static_cast<float>(time_s - scan.time_s + half_s));
  }

  /// The laser of each point, topmost 0; empty if one is unknown.
  std::vector<std::uint16_t> rings_of(const KittiScan& scan, std::size_t index) {
    std::vector<std::uint16_t> rings;
    for (std::size_t i = 0; i < scan.positions.size(); ++i)  // beams without a return are left out
      rings.push_back(is_finite(scan.positions[i]) ? beam_of(sequence_, index, scan, i).laser
                                                   : std::uint16_t{0});
    if (std::ranges::find(rings, kNoLaser) != rings.end()) {
      has_rings_ = false;
      rings.clear();
    }
    return rings;
  }

  void write_folder() {
    auto content = nlohmann::ordered_json::object();
    if (labels_) content["labels"] = {{"name", scheme_reference(job_.labels, *labels_)}};
    OutputFolder folder(job_.output, false, "export", content);
    ScanWriterOptions options;
    options.labels = labels_ ? &*labels_ : nullptr;
    options.order = PointOrder::firing;  // that of the input
    options.drive = {chosen_.size(),
                     [this](std::size_t i) { return sequence_.trajectory[chosen_[i]].time_s; }};
    const std::string& sensor = sequence_.beams.sensor;
    if (!sensor.empty()) options.image_size.rings = load_lidar_model(sensor).rings();
    if (format_ == ExportFormat::argoverse2)
      options.full_intensity = intensity_scale_for(highest_intensity());
    const auto writer =
        make_scan_writer(folder.path(), value_of(name_of(format_), kScanFormats), options);
    bool with_classes = false;
    write_scans([&](std::size_t k, const Scan& scan) {
      with_classes = with_classes || !scan.classes.empty();
      if (format_ == ExportFormat::argoverse2)
        clipped_ += static_cast<std::size_t>(std::ranges::count_if(
            scan.intensities, [&](float value) { return value > options.full_intensity; }));
      if (has_classes(format_)) require_classes(k, scan);
      writer->write(k, scan);
    });
    writer->finish();
    warn_of_lost(with_classes);
    folder.commit();
  }

  /// Of the first, middle and last scan.
  double highest_intensity() const {
    float highest = 0;
    for (const std::size_t k : {std::size_t{0}, chosen_.size() / 2, chosen_.size() - 1})
      for (const float value : read_kitti_points(sequence_, chosen_[k]).intensities)
        if (value > highest) highest = value;
    return highest;
  }

  /// Either all scans have classes or none.
  void require_classes(std::size_t k, const Scan& scan) {
    if (scan.size() == 0) return;
    if (!has_classes_) has_classes_ = !scan.classes.empty();
    if (*has_classes_ != scan.classes.empty()) return;
    throw Error(ErrorKind::data, sequence_.scans[chosen_[k]].string() + ": has " +
                                     (*has_classes_ ? "no " : "") +
                                     "classes, unlike the scans before");
  }

  /// The fields of points that are exported, in words.
  std::string kept_fields() const {
    std::vector<std::string> kept = {"positions", "intensities"};
    if (has_times(format_) && has_times_) kept.emplace_back("times");
    if (has_rings(format_) && has_rings_) kept.emplace_back("rings");
    if (has_classes(format_)) kept.emplace_back("classes");
    if (has_instances(format_)) kept.emplace_back("instances");
    std::string text;
    for (std::size_t k = 0; k < kept.size(); ++k)
      text += (k == 0 ? "" : k + 1 < kept.size() ? ", " : " and ") + kept[k];
    return text;
  }

  /// In one line what is dropped.
  void warn_of_lost(bool with_classes) {
    std::string lost;
    const auto add = [&lost](const std::string& what) {
      lost += (lost.empty() ? "" : ", ") + what;
    };
    if (!is_kitti_sequence(job_.input))
      add("fields of the points other than " + kept_fields());
    else if (with_classes && !has_instances(format_) && format_ != ExportFormat::nuscenes)
      add(has_classes(format_) ? "instances" : "classes and instances");
    if (with_classes && !labels_ && format_ == ExportFormat::pandaset)
      add("names of classes (their scheme is unknown: give --labels)");
    if (clipped_ > 0) add(std::to_string(clipped_) + " intensities above the scale");
    if (with_classes && format_ == ExportFormat::nuscenes)
      add(labels_ ? "classes of the scans between samples, their own numbers and instances"
                  : "classes (their scheme is unknown: give --labels)");
    if (has_rings(format_) && !has_rings_)
      session_.progress.warn(job_.output.string() +
                             ": the sensor is not recognised; the ring of all points of its scans "
                             "is 0");
    if (!lost.empty()) session_.progress.warn(job_.output.string() + ": not exported: " + lost);
  }

  const ExportJob& job_;
  ExportFormat format_;
  Session& session_;
  KittiSequence sequence_;
  std::vector<std::size_t> chosen_;
  std::optional<LabelScheme> labels_;
  std::optional<bool> has_classes_;
  bool has_rings_ = true;
  bool has_times_ = true;    ///< of the points of all scans
  std::size_t clipped_ = 0;  ///< intensities that become 255
  ExportResult result_{0, "scans"};
};

/// Whether an option of inputs applies to scans: of a drive all that concern its reading, of a
/// sequence folder only the choice of scans.
bool applies_to_scans(const std::string& option, bool is_sequence_folder) {
  constexpr std::array<std::string_view, 19> kOptions = {
      "scans",         "strict",    "first_scan",     "scan_count",         "scan_stride",
      "trajectory",    "mount",     "mount_rotation", "mount_rotation_deg", "time_offset",
      "time_offset_s", "points_in", "sweep_points",   "scan_times",         "topic",
      "poses_topic",   "scene",     "packet_sensor",  "beams_from_poses"};
  constexpr std::size_t kOfFolders = 5;
  const auto found = std::ranges::find(kOptions, option) - kOptions.begin();
  return static_cast<std::size_t>(found) < (is_sequence_folder ? kOfFolders : kOptions.size());
}

ExportResult write_export(const ExportJob& job, Session& session) {
  const InputKind kind = kind_of(job.input, job.load);
  const ExportFormat format = format_of(job, kind);
  if (job.color && !has_colors(format)) {
    throw Error(ErrorKind::usage,
                "color has no effect on " + std::string(name_of(format)) +
                    "; it is for gaussian-3d, gaussian-2d, 3d-tiles, usd and glb");
  }
  const bool states_scheme = is_folder(format) && has_classes(format);
  if (!job.labels.empty() && !has_colors(format) && !states_scheme) {
    throw Error(ErrorKind::usage,
                "labels have no effect on " + std::string(name_of(format)) +
                    (!has_classes(format) ? ", which has no classes"
                                          : ", which holds the numbers of classes as they are"));
  }
  if (!job.cloud_option.empty() &&
      (kind == InputKind::model ||
       (has_scans(format) && !applies_to_scans(job.cloud_option, is_kitti_sequence(job.input))))) {
    throw Error(
        ErrorKind::usage,
        "`" + job.cloud_option + "` has no effect on " +
            (kind == InputKind::model ? "a splat model" : "scans, which are written as they are"));
  }
  std::vector<fs::path> read = {job.input};
  for (const fs::path& file : {job.load.trajectory, job.load.boxes, job.load.scan_times})
    if (!file.empty()) read.push_back(file);
  if (is_folder(format)) {
    require_folder_apart(job.output, read);
  } else {
    require_no_input(job.output, read);
    check_output_file(job.output);
  }
  if (format == ExportFormat::tiles_3d) return TilesetExport(job, session).run();
  if (kind == InputKind::model) return export_model(job, format, session);
  if (has_scans(format)) return ScanExport(job, format, session).run();
  return export_cloud(job, format, session);
}

/// Of a file, or of all files in a folder.
std::uint64_t bytes_of(const fs::path& output) {
  if (!fs::is_directory(output)) return fs::file_size(output);
  std::uint64_t bytes = 0;
  for (const fs::path& file : files_below(output)) bytes += fs::file_size(file);
  return bytes;
}

}  // namespace

ExportResult run_export(const ExportJob& job, Session& session) {
  ExportJob resolved = job;
  if (!is_splat_model(job.input)) resolved.input = resolve_cloud_input(job.input);
  ExportResult result = write_export(resolved, session);
  result.written_bytes = bytes_of(resolved.output);
  return result;
}

}  // namespace adasplats
