// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/export.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/city/city_manifest.h"
#include "adasplats/cloud/points/cloud_glb.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/error.h"
#include "adasplats/dataset/mcap_writer.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/jobs/output/output_check.h"
#include "adasplats/jobs/output/output_folder.h"
#include "adasplats/jobs/session/inputs.h"
#include "adasplats/jobs/session/scan_range.h"
#include "adasplats/simulate/image/point_colors.h"
#include "adasplats/splats/model/gaussian_ply.h"
#include "adasplats/splats/model/mesh_model.h"
#include "adasplats/splats/model/splat_model.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

enum class InputKind : std::uint8_t { model, cloud, sequence };

/// What an input can become, the first of an ending being what the ending means.
struct KindFormats {
  const char* name;
  std::vector<ExportFormat> formats;
};

KindFormats formats_of(InputKind kind) {
  using enum ExportFormat;
  switch (kind) {
    case InputKind::model: return {"a splat model", {gaussian_3d, gaussian_2d, glb}};
    case InputKind::cloud: return {"a point cloud", {glb, ply, las, laz}};
    case InputKind::sequence: return {"a sequence of scans", {mcap, glb, ply, las, laz}};
  }
  return {};
}

std::string_view name_of(ExportFormat format) {
  constexpr std::array<std::string_view, 7> kNames = {"gaussian-3d", "gaussian-2d", "glb", "ply",
                                                      "las",         "laz",         "mcap"};
  return kNames[static_cast<std::size_t>(format)];
}

std::string_view ending_of(ExportFormat format) {
  const bool gaussian = format == ExportFormat::gaussian_3d || format == ExportFormat::gaussian_2d;
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

InputKind kind_of(const fs::path& input) {
  if (is_splat_model(input)) return InputKind::model;
  if (fs::is_directory(input)) {
    return is_kitti_sequence(input) ? InputKind::sequence : InputKind::cloud;
  }
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
      require_ending(job.output, "." + std::string(ending_of(*job.format)));
      return *job.format;
    }
    throw Error(ErrorKind::usage, can_be + ", not as " + std::string(name_of(*job.format)));
  }
  std::string ending = lower_case(job.output.extension().string());
  if (!ending.empty()) ending.erase(0, 1);
  std::vector<ExportFormat> meant;
  std::ranges::copy_if(possible, std::back_inserter(meant),
                       [&ending](ExportFormat format) { return ending_of(format) == ending; });
  if (meant.size() == 1) return meant.front();
  const std::string of_ending =
      ending.empty() ? "a name without an ending" : "the ending ." + ending;
  throw Error(ErrorKind::usage, can_be + "; " + of_ending +
                                    (meant.empty() ? " is none of them" : " is ambiguous") +
                                    ": give the format");
}

bool has_colors(ExportFormat format) { return format <= ExportFormat::glb; }

std::vector<Rgb> colors_by_height(PointCloud& cloud) {
  // Heights are what point_colors() shows of positions alone.
  PointCloud bare;
  bare.positions.swap(cloud.positions);
  std::vector<Rgb> colors = point_colors(bare, nullptr, std::nullopt, {});
  bare.positions.swap(cloud.positions);
  return colors;
}

std::vector<Rgb> colors_of(PointCloud& cloud, const LabelScheme* labels,
                           std::optional<ExportColor> color) {
  if (!color) return point_colors(cloud, labels, std::nullopt, {});
  switch (*color) {
    case ExportColor::semantic: return point_colors(cloud, labels, ImageColor::semantic, {});
    case ExportColor::intensity:
      if (cloud.intensities.empty() && !cloud.empty())
        throw Error(ErrorKind::usage, "color by intensity: the input has no intensities");
      return point_colors(cloud, labels, ImageColor::intensity, {});
    case ExportColor::height: return colors_by_height(cloud);
    case ExportColor::rgb: return point_colors(cloud, labels, ImageColor::rgb, {});
  }
  return {};
}

PointCloud centers_of(SplatModel& model) {
  PointCloud cloud;
  cloud.origin = model.origin;
  cloud.crs = model.crs;
  cloud.positions.reserve(model.size());
  for (const Disk& disk : model.disks) cloud.positions.push_back(disk.center);
  cloud.classes = std::move(model.classes);
  cloud.intensities = std::move(model.intensities);
  return cloud;
}

ExportResult export_model(const ExportJob& job, ExportFormat format, Session& session) {
  SplatModel model = load_splats(job.input);
  const std::optional<LabelScheme> labels =
      job.labels.empty() ? load_labels_of_model(model.label_scheme, session.progress)
                         : load_label_scheme(job.labels);
  PointCloud centers = centers_of(model);
  const std::vector<Rgb> colors = colors_of(centers, labels ? &*labels : nullptr, job.color);
  if (format == ExportFormat::glb) {
    save_cloud_glb(job.output, centers, colors);
  } else {
    write_gaussian_ply(
        job.output, model, colors,
        format == ExportFormat::gaussian_3d ? GaussianKind::volumes : GaussianKind::surfels);
  }
  return {model.size(), "splats"};
}

/// Warns of the columns of a file that glTF has no field for.
void warn_of_dropped(const fs::path& output, const PointCloud& cloud, ProgressSink& progress) {
  std::vector<std::string> names;
  const bool has_colors = !file_colors(cloud).empty();
  for (const Column& column : cloud.others.columns) {
    const bool is_color = column.name == "red" || column.name == "green" || column.name == "blue";
    if (!has_colors || !is_color) names.push_back(column.name);
  }
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  if (!list.empty())
    progress.warn(output.string() + ": glTF has no fields for " + list +
                  ", which are dropped (.ply, .las and .laz keep them)");
}

ExportResult export_cloud(const ExportJob& job, ExportFormat format, Session& session) {
  const std::span inputs(&job.input, 1);
  LoadOptions load = job.load;
  load.other_columns = KeptColumns::all;
  const std::optional<LabelScheme> labels =
      label_scheme_for(job.labels, inputs, job.load.label_field);
  auto [cloud, report] = load_cloud(inputs, load, session.executor, session.progress);
  if (labels) cloud.label_scheme = scheme_reference(job.labels, *labels);
  if (!report.drives.empty() && !report.timed && !is_kitti_sequence(job.input))
    session.progress.warn(
        job.input.string() +
        ": of the points of a drive, positions, sensor positions, intensities, classes, instances, "
        "lasers and scan numbers are exported; times and other fields are dropped");
  if (format == ExportFormat::glb) {
    warn_of_dropped(job.output, cloud, session.progress);
    const std::vector<Rgb> colors = colors_of(cloud, labels ? &*labels : nullptr, job.color);
    save_cloud_glb(job.output, cloud, colors);
  } else {
    (format == ExportFormat::ply ? save_cloud_ply : save_cloud_las)(job.output, cloud, {});
  }
  return {cloud.size(), "points", report.dropped_not_finite + report.dropped_far};
}

/// A scan of a file as a simulated one; points that are not finite are left out and counted.
Scan scan_of(KittiScan&& kitti, const TimedPose& pose, std::size_t& dropped) {
  Scan scan;
  scan.world_from_sensor = pose.world_from_sensor;
  scan.time_s = pose.time_s;
  scan.positions = std::move(kitti.positions);
  scan.intensities = std::move(kitti.intensities);
  scan.classes = std::move(kitti.classes);
  scan.instances = std::move(kitti.instances);
  scan.rays = scan.size();
  std::vector<std::uint8_t> keep(scan.size(), 1);
  for (std::size_t i = 0; i < scan.size(); ++i) keep[i] = is_finite(scan.positions[i]) ? 1 : 0;
  const auto bad = static_cast<std::size_t>(std::ranges::count(keep, 0));
  dropped += bad;
  return bad == 0 ? scan : kept_points(scan, keep);
}

ExportResult export_scans(const ExportJob& job, Session& session) {
  const KittiSequence sequence = open_kitti_sequence(job.input);
  const std::vector<std::size_t> chosen =
      chosen_scans({job.load.first_scan, job.load.scan_count, job.load.scan_stride},
                   sequence.scans.size(), job.input);
  ExportResult result{0, "scans"};
  const std::optional<LabelScheme> labels = label_scheme_for({}, std::span(&job.input, 1));
  McapWriter writer(job.output, 0, labels ? labels->name() : std::string());
  session.progress.begin_step("writing scans", chosen.size());
  for (const std::size_t index : chosen) {
    const std::size_t dropped_before = result.dropped;
    writer.write(
        scan_of(read_kitti_scan(sequence, index), sequence.trajectory[index], result.dropped));
    if (job.load.strict && result.dropped > dropped_before) {
      throw Error(ErrorKind::data, sequence.scans[index].string() + ": has " +
                                       std::to_string(result.dropped) +
                                       " points that are not finite");
    }
    session.progress.advance(++result.count);
  }
  writer.finish();
  session.progress.end_step();
  return result;
}

ExportResult write_export(const ExportJob& job, Session& session) {
  const InputKind kind = kind_of(job.input);
  const ExportFormat format = format_of(job, kind);
  if (job.color && !has_colors(format)) {
    throw Error(ErrorKind::usage,
                "color has no effect on " + std::string(name_of(format)) +
                    ", which stores classes and intensities; it is for gaussian-3d, "
                    "gaussian-2d and glb");
  }
  if (!job.labels.empty() && !has_colors(format)) {
    throw Error(ErrorKind::usage, "labels have no effect on " + std::string(name_of(format)) +
                                      ", which holds the numbers of classes as they are");
  }
  constexpr std::array<std::string_view, 5> kOfScans = {"scans", "strict", "first_scan",
                                                        "scan_count", "scan_stride"};
  const bool scans = format == ExportFormat::mcap && std::find(kOfScans.begin(), kOfScans.end(),
                                                               job.cloud_option) != kOfScans.end();
  if (!job.cloud_option.empty() && !scans &&
      (kind == InputKind::model || format == ExportFormat::mcap)) {
    throw Error(
        ErrorKind::usage,
        "`" + job.cloud_option + "` has no effect on " +
            (kind == InputKind::model ? "a splat model" : "scans, which are written as they are"));
  }
  check_output_file(job.output);
  if (kind == InputKind::model) return export_model(job, format, session);
  if (format == ExportFormat::mcap) return export_scans(job, session);
  return export_cloud(job, format, session);
}

}  // namespace

ExportResult run_export(const ExportJob& job, Session& session) {
  ExportJob resolved = job;
  if (!is_splat_model(job.input)) resolved.input = resolve_cloud_input(job.input);
  ExportResult result = write_export(resolved, session);
  result.written_bytes = fs::file_size(resolved.output);
  return result;
}

}  // namespace adasplats
