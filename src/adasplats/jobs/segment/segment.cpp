// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/segment/segment.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <utility>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/cloud/load/cloud_inputs.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/cloud/sequence/pose_check.h"
#include "adasplats/core/error.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/dataset/semantickitti_writer.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/jobs/output/output_check.h"
#include "adasplats/jobs/output/output_folder.h"
#include "adasplats/jobs/segment/output_classes.h"
#include "adasplats/jobs/segment/point_classes.h"
#include "adasplats/jobs/session/inputs.h"
#include "adasplats/segment/network/network.h"
#include "adasplats/segment/network/run_network.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

OutputClasses outputs_of(const SegmentJob& job, const Network& network) {
  return job.class_map.empty() ? semantickitti_outputs(network.classes, job.network)
                               : read_class_map(job.class_map, network.classes);
}

/// The output for the points of a cloud.
struct FoundLabels {
  std::vector<std::uint16_t> labels;
  std::vector<float> confidences;    ///< of the labels, 0 to 1; empty: not asked for
  std::vector<float> probabilities;  ///< of each class, point by point; empty: not asked for
};

/// Columns of a network's output: `confidence`, and `probability_N` of each class number.
struct FoundColumns {
  std::vector<std::string> names;
  std::vector<ColumnView> columns;

  /// `found` must outlive it.
  FoundColumns(const FoundLabels& found, const OutputClasses& outputs) {
    if (!found.confidences.empty())
      columns.push_back({"confidence", ColumnType::f32, found.confidences.data(), sizeof(float)});
    if (found.probabilities.empty()) return;
    for (const OutputClasses::Class& each : outputs.classes)
      names.push_back("probability_" + std::to_string(each.id));
    for (std::size_t c = 0; c < names.size(); ++c)
      columns.push_back({names[c], ColumnType::f32, found.probabilities.data() + c,
                         names.size() * sizeof(float)});
  }
};

/// Numbers of 32 bits, little endian: labels as in SemanticKITTI's .label, or floats.
template <class T>
void save_numbers(const fs::path& path, const std::vector<T>& numbers) {
  static_assert(sizeof(T) == 4);
  AtomicFile file(path);
  file.write(numbers.data(), numbers.size() * sizeof(T));
  file.commit();
}

/// Makes `file` the same as `source`: a link, or a copy where the file system has no links.
void link_or_copy(const fs::path& source, const fs::path& file) {
  const fs::path target = fs::canonical(source);
  std::error_code problem;
  fs::create_hard_link(target, file, problem);
  if (problem) fs::create_symlink(target, file, problem);
  if (problem) write_file(file, read_file(target));
}

/// Completes the labels in `tree` to a sequence that other commands read: the scans and the files
/// of poses. Nothing for scans in text (KITTI's raw data, not synced).
void add_scans(const KittiSequence& sequence, const std::vector<std::size_t>& chosen,
               const fs::path& tree) {
  if (sequence.scans.front().extension() != ".bin") return;
  fs::create_directories(tree / "velodyne");
  for (const std::size_t index : chosen)
    link_or_copy(sequence.scans[index], tree / "velodyne" / sequence.scans[index].filename());
  if (is_kitti_raw_drive(sequence.folder)) {
    const SemanticKittiPoses poses = semantickitti_poses(sequence.trajectory);
    write_file(tree / "calib.txt", poses.calib);
    write_file(tree / "times.txt", poses.times);
    write_file(tree / "poses.txt", poses.poses);
    return;
  }
  for (const char* const name : {"calib.txt", "times.txt", "poses.txt"})
    if (fs::exists(sequence.folder / name))
      write_file(tree / name, read_file(sequence.folder / name));
}

/// Numbers of the points that have a place, in the order of the scan; `nothing` for the others.
template <class Out, class T>
std::vector<Out> spread_over(const std::vector<bool>& has_place, std::span<const T> values,
                             std::size_t width, Out nothing) {
  std::vector<Out> spread(has_place.size() * width, nothing);
  auto next = values.begin();
  for (std::size_t i = 0; i < has_place.size(); ++i) {
    if (!has_place[i]) continue;
    std::copy_n(next, width, spread.begin() + static_cast<std::ptrdiff_t>(i * width));
    next += static_cast<std::ptrdiff_t>(width);
  }
  return spread;
}

class PointSegmenter {
 public:
  PointSegmenter(const SegmentJob& job, Session& session)
      : job_(job),
        session_(session),
        network_(job.network.empty() ? default_network() : read_network(job.network)),
        outputs_(outputs_of(job, network_)) {
    for (const OutputClasses::Class& each : outputs_.classes)
      result_.classes.push_back({each.name, 0});
  }

  SegmentResult run() {
    std::vector<fs::path> sequences;
    std::vector<fs::path> files;
    for (const fs::path& input : job_.inputs)
      for (const CloudInput& part : cloud_inputs(input, SensorScans::taken))
        (part.is_sequence ? sequences : files).push_back(part.path);
    if (!files.empty() && !sequences.empty())
      throw Error(ErrorKind::usage, "sequences and files of points have outputs of two kinds");
    if (files.empty())
      segment_sequences(sequences);
    else
      segment_files(files);
    return std::move(result_);
  }

 private:
  /// All that is read.
  std::vector<fs::path> read_files() const {
    std::vector<fs::path> files = job_.inputs;
    for (const fs::path& file : {job_.network, job_.class_map, job_.load.trajectory})
      if (!file.empty()) files.push_back(file);
    return files;
  }

  void segment_files(const std::vector<fs::path>& files) {
    constexpr const char* kLabels = ".label";
    const std::vector<std::string> endings = {".ply", ".las", ".laz", kLabels};
    require_ending(job_.output, endings);
    require_no_input(job_.output, read_files());
    check_output_file(job_.output);
    const std::string ending = lower_case(job_.output.extension().string());
    if (ending == kLabels)
      segment_single_scan(files);
    else
      segment_cloud_of_files(ending != ".ply");
  }

  void segment_cloud_of_files(bool as_las) {
    LoadOptions load = job_.load;
    load.accept_sensor_frame = true;  // networks segment single scans, too
    load.own_body_m = 0;
    load.driven_path_m = 0;
    const Stopwatch watch;
    auto [cloud, report] = load_cloud(job_.inputs, load, session_.executor, session_.progress);
    result_.load_seconds += watch.seconds();
    if (cloud.empty()) throw Error(ErrorKind::data, job_.inputs.front().string() + ": no points");
    result_.points_unlabeled += report.points_read - cloud.size();
    session_.progress.begin_step("segment", 0);
    FoundLabels found = labels_of(cloud, cloud.size());
    session_.progress.end_step();
    cloud.classes = std::move(found.labels);
    if (job_.class_map.empty()) cloud.label_scheme = semantickitti_labels().name();
    (as_las ? save_cloud_las : save_cloud_ply)(job_.output, cloud,
                                               FoundColumns(found, outputs_).columns);
  }

  /// Labels of the very points of a file, in their order.
  void segment_single_scan(const std::vector<fs::path>& files) {
    if (files.size() != 1 || lower_case(files[0].extension().string()) != ".bin")
      throw Error(ErrorKind::usage, job_.output.string() +
                                        ": labels alone are those of one scan (.bin); write PLY, "
                                        "LAS or LAZ");
    if (job_.segment.confidences || job_.segment.probabilities)
      throw Error(
          ErrorKind::usage,
          job_.output.string() + ": has labels alone, no confidences; write PLY, LAS or LAZ");
    KittiSequence scan;
    scan.folder = files[0].parent_path();
    scan.scans = files;
    scan.trajectory.resize(1);
    segment_scans(scan, {0}, [this](const fs::path&) { return job_.output; });
  }

  void segment_sequences(const std::vector<fs::path>& sequences) {
    require_folder_apart(job_.output, read_files());
    OutputFolder folder(job_.output, job_.overwrite, "segment", content());
    for (std::size_t k = 0; k < sequences.size(); ++k) {
      const std::string number = std::to_string(k);
      const fs::path tree =
          folder.path() / "sequences" / (std::string(number.size() < 2 ? 1 : 0, '0') + number);
      for (const char* const name : kept_folders()) fs::create_directories(tree / name);
      KittiSequence sequence = open_kitti_sequence(sequences[k]);
      sequence.facts.unchecked = verify_poses(sequence, session_.executor);
      const ScanRange range{job_.load.first_scan, job_.load.scan_count, job_.load.scan_stride};
      const auto chosen = chosen_scans(range, sequence.scans.size(), sequences[k]);
      segment_scans(sequence, chosen, [&](const fs::path& scan) {
        return tree / "labels" / scan.filename().replace_extension(".label");
      });
      add_scans(sequence, chosen, tree);
    }
    folder.commit();
  }

  std::vector<const char*> kept_folders() const {
    std::vector<const char*> folders = {"labels"};
    if (job_.segment.confidences) folders.push_back("confidences");
    if (job_.segment.probabilities) folders.push_back("probabilities");
    return folders;
  }

  nlohmann::ordered_json content() const {
    nlohmann::ordered_json content;
    // A class map has numbers of its own.
    content["labels"]["name"] = job_.class_map.empty() ? semantickitti_labels().name() : "";
    content["network"] = job_.network.empty() ? "default" : job_.network.filename().string();
    content["classes"] = nlohmann::ordered_json::array();
    for (const OutputClasses::Class& each : outputs_.classes)
      content["classes"].push_back({{"id", each.id}, {"name", each.name}});
    content["unlabeled"] = outputs_.unlabeled;
    return content;
  }

  /// `labels_file` gives the place of the labels of a scan's file.
  template <class LabelsFile>
  void segment_scans(const KittiSequence& sequence, const std::vector<std::size_t>& chosen,
                     LabelsFile&& labels_file) {
    ScanWindows windows(sequence, chosen, job_.window, job_.load.max_distance_m);
    session_.progress.begin_step("segment", chosen.size());
    std::size_t done = 0;
    Stopwatch watch;
    while (const std::optional<ScanWindow> window = windows.next()) {
      result_.load_seconds += watch.seconds();
      ++result_.windows;
      const FoundLabels found = labels_of(window->cloud, window->points);
      std::size_t first = 0;
      for (const ScanWindow::Scan& scan : window->scans) {
        first = save_scan(scan, found, first, labels_file(sequence.scans[scan.index]));
        session_.progress.advance(++done);
      }
      watch = {};
    }
    session_.progress.end_step();
  }

  /// Saves what was found for a scan, whose points are those from `first` on; gives the first of
  /// the next scan.
  std::size_t save_scan(const ScanWindow::Scan& scan, const FoundLabels& found, std::size_t first,
                        const fs::path& labels_file) {
    const auto placed = static_cast<std::size_t>(std::ranges::count(scan.has_place, true));
    result_.points_unlabeled += scan.has_place.size() - placed;
    const auto part = [&]<class T>(const std::vector<T>& values, std::size_t width) {
      return std::span(values).subspan(first * width, placed * width);
    };
    save_numbers(labels_file, spread_over<std::uint32_t>(scan.has_place, part(found.labels, 1), 1,
                                                         std::uint32_t{outputs_.unlabeled}));
    const auto beside = [&](const char* folder) {
      return labels_file.parent_path().parent_path() / folder /
             labels_file.filename().replace_extension(".bin");
    };
    if (job_.segment.confidences)
      save_numbers(beside("confidences"),
                   spread_over(scan.has_place, part(found.confidences, 1), 1, 0.0F));
    const std::size_t classes = outputs_.classes.size();
    if (job_.segment.probabilities)
      save_numbers(beside("probabilities"),
                   spread_over(scan.has_place, part(found.probabilities, classes), classes, 0.0F));
    return first + placed;
  }

  /// Of the first `wanted` points; the others are their context.
  FoundLabels labels_of(const PointCloud& cloud, std::size_t wanted) {
    const Stopwatch watch;
    SegmentOptions options = job_.segment;
    options.wanted = wanted;
    // The confidence of a label is that of all classes that are written as it.
    const bool joins = outputs_.joins();
    options.probabilities = options.probabilities || (options.confidences && joins);
    Segmentation segmentation = segment_on_device(cloud, network_, options, session_);
    FoundLabels found;
    found.labels.resize(wanted);
    const std::size_t classes = outputs_.classes.size();
    std::vector<float> probabilities = std::move(segmentation.probabilities);
    if (joins && !probabilities.empty()) probabilities = outputs_.joined(probabilities);
    found.confidences = std::move(segmentation.confidences);
    for (std::size_t i = 0; i < wanted; ++i) {
      const std::size_t c = outputs_.of_network[segmentation.classes[i]];
      found.labels[i] = outputs_.classes[c].id;
      ++result_.classes[c].points;
      if (joins && job_.segment.confidences) found.confidences[i] = probabilities[i * classes + c];
    }
    if (job_.segment.probabilities) found.probabilities = std::move(probabilities);
    result_.points += wanted;
    result_.cells += segmentation.cells;
    result_.tiles += segmentation.tiles;
    result_.segment_seconds += watch.seconds();
    return found;
  }

  const SegmentJob& job_;
  Session& session_;
  Network network_;
  OutputClasses outputs_;
  SegmentResult result_;
};

}  // namespace

SegmentResult run_segment(const SegmentJob& job, Session& session) {
  for (const fs::path& input : job.inputs) require_input(input);
  require_products();
  return PointSegmenter(job, session).run();
}

nlohmann::ordered_json to_json(const SegmentResult& result) {
  nlohmann::ordered_json json;
  json["points"] = result.points;
  json["points_unlabeled"] = result.points_unlabeled;
  json["cells"] = result.cells;
  json["tiles"] = result.tiles;
  json["windows"] = result.windows;
  for (const SegmentResult::ClassCount& count : result.classes)
    json["classes"][count.name] = count.points;
  json["seconds"] = {{"load", result.load_seconds}, {"segment", result.segment_seconds}};
  return json;
}

}  // namespace adasplats
