// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/recipes/segment_points.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/cloud/load/cloud_inputs.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/cloud/sequence/pose_check.h"
#include "adasplats/core/error.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/pipeline/output/output_folder.h"
#include "adasplats/segment/network/matrix_product.h"
#include "adasplats/segment/network/network.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

bool is_finite_point(Vec3f p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

std::vector<std::uint16_t> ids_of(const Network& network, const fs::path& file) {
  std::vector<std::uint16_t> ids;
  for (const std::string& name : network.classes) {
    const SemanticClass* const found = semantickitti_labels().find(name);
    if (found == nullptr)
      throw Error(ErrorKind::data, file.string() + ": SemanticKITTI has no class '" + name + "'");
    ids.push_back(found->id);
  }
  return ids;
}

/// The scans of a sequence as one cloud, and where each scan's points are in it.
struct PlacedScans {
  struct Scan {
    fs::path file;
    std::vector<bool> has_place;  ///< of its points: those that the cloud has
  };
  PointCloud cloud;
  std::vector<Scan> scans;
};

class PointSegmenter {
 public:
  PointSegmenter(const SegmentJob& job, Session& session)
      : job_(job),
        session_(session),
        network_(job.network.empty() ? default_network() : read_network(job.network)) {
    ids_ = ids_of(network_, job.network);
    for (const std::string& name : network_.classes) result_.classes.push_back({name, 0});
  }

  SegmentResult run() {
    std::vector<fs::path> sequences;
    bool any_file = false;
    for (const fs::path& input : job_.inputs)
      for (const CloudInput& part : cloud_inputs(input)) {
        any_file = any_file || !part.is_sequence;
        if (part.is_sequence) sequences.push_back(part.path);
      }
    if (any_file && !sequences.empty())
      throw Error(ErrorKind::usage, "sequences and files of points have outputs of two kinds");
    if (any_file)
      segment_files();
    else
      segment_sequences(sequences);
    return std::move(result_);
  }

 private:
  void segment_files() {
    check_output_file(job_.output);
    LoadOptions load = job_.load;
    load.own_body_m = 0;
    load.driven_path_m = 0;
    const Stopwatch watch;
    auto [cloud, report] = load_cloud(job_.inputs, load, session_.executor, session_.progress);
    result_.load_seconds += watch.seconds();
    result_.points_unlabeled += report.points_read - cloud.size();
    cloud.classes = classes_of(cloud);
    save_cloud_ply(job_.output, cloud);
  }

  void segment_sequences(const std::vector<fs::path>& sequences) {
    nlohmann::ordered_json content;
    content["network"] = job_.network.empty() ? "default" : job_.network.filename().string();
    OutputFolder folder(job_.output, job_.overwrite, "segment", content);
    for (std::size_t k = 0; k < sequences.size(); ++k) {
      const std::string number = std::to_string(k);
      const fs::path labels = folder.path() / "sequences" /
                              (std::string(number.size() < 2 ? 1 : 0, '0') + number) / "labels";
      fs::create_directories(labels);
      segment_sequence(sequences[k], labels);
    }
    folder.commit();
  }

  void segment_sequence(const fs::path& sequence, const fs::path& labels) {
    const Stopwatch watch;
    PlacedScans placed = placed_scans(sequence);
    result_.load_seconds += watch.seconds();
    const std::vector<std::uint16_t> classes = classes_of(placed.cloud);
    std::size_t next = 0;
    for (const PlacedScans::Scan& scan : placed.scans) {
      std::vector<std::uint32_t> of_scan(scan.has_place.size(), 0);
      for (std::size_t i = 0; i < of_scan.size(); ++i)
        if (scan.has_place[i]) of_scan[i] = classes[next++];
      AtomicFile file(labels / scan.file.filename().replace_extension(".label"));
      file.write(of_scan.data(), of_scan.size() * sizeof(std::uint32_t));
      file.commit();
    }
  }

  PlacedScans placed_scans(const fs::path& folder) {
    const KittiSequence sequence = open_kitti_sequence(folder);
    require_poses_that_fit(sequence);
    const ScanRange range{job_.load.first_scan, job_.load.scan_count, job_.load.scan_stride};
    PlacedScans placed;
    session_.progress.begin_step("load", 0);
    for (const std::size_t index : chosen_scans(range, sequence.scans.size(), folder)) {
      const KittiScan scan = read_kitti_points(sequence, index);
      const RigidTransform pose = sequence.trajectory[index].world_from_sensor;
      if (placed.scans.empty()) placed.cloud.origin = pose.translation;
      PlacedScans::Scan& kept = placed.scans.emplace_back();
      kept.file = sequence.scans[index];
      for (std::size_t i = 0; i < scan.positions.size(); ++i) {
        kept.has_place.push_back(is_finite_point(scan.positions[i]));
        if (!kept.has_place.back()) {
          ++result_.points_unlabeled;
          continue;
        }
        placed.cloud.positions.push_back(
            vec_cast<float>(pose * vec_cast<double>(scan.positions[i]) - placed.cloud.origin));
        if (!scan.intensities.empty()) placed.cloud.intensities.push_back(scan.intensities[i]);
      }
    }
    session_.progress.end_step();
    return placed;
  }

  /// Numbers of the scheme.
  std::vector<std::uint16_t> classes_of(const PointCloud& cloud) {
    const Stopwatch watch;
    session_.progress.begin_step("segment", 0);
    const Segmentation found = segment_cloud(cloud, network_, job_.segment, session_.executor);
    session_.progress.end_step();
    std::vector<std::uint16_t> classes(cloud.size());
    for (std::size_t i = 0; i < classes.size(); ++i) {
      classes[i] = ids_[found.classes[i]];
      ++result_.classes[found.classes[i]].points;
    }
    result_.points += classes.size();
    result_.cells += found.cells;
    result_.tiles += found.tiles;
    result_.segment_seconds += watch.seconds();
    return classes;
  }

  const SegmentJob& job_;
  Session& session_;
  Network network_;
  std::vector<std::uint16_t> ids_;  ///< of the network's classes
  SegmentResult result_;
};

}  // namespace

SegmentResult run_segment(const SegmentJob& job, Session& session) {
  require_products();
  return PointSegmenter(job, session).run();
}

nlohmann::ordered_json to_json(const SegmentResult& result) {
  nlohmann::ordered_json json;
  json["points"] = result.points;
  json["points_unlabeled"] = result.points_unlabeled;
  json["cells"] = result.cells;
  json["tiles"] = result.tiles;
  for (const SegmentResult::ClassCount& count : result.classes)
    json["classes"][count.name] = count.points;
  json["seconds"] = {{"load", result.load_seconds}, {"segment", result.segment_seconds}};
  return json;
}

}  // namespace adasplats
