// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "adasplats/cloud/load/box_collector.h"
#include "adasplats/cloud/load/box_files.h"
#include "adasplats/cloud/load/pandaset_drive.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/pickle/data_frame.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

constexpr int kBothLidars = -1;

/// A row of annotations/cuboids/NN.pkl.gz.
struct Cuboid {
  std::string uuid, sibling, label;
  int lidar = kBothLidars;  ///< whose points it encloses: index in kPandaSetSensors
  bool moves = false;
  std::size_t frame = 0, row = 0;
  TimedBox box;
};

/// Reads the cuboids of one frame.
class CuboidFrame {
 public:
  explicit CuboidFrame(fs::path file) : file_(std::move(file)), table_(read_frame_table(file_)) {}

  std::vector<Cuboid> cuboids(std::size_t frame, double time_s) const {
    const std::size_t rows = table_.numbers.rows;
    std::vector<Cuboid> cuboids(rows);
    if (rows == 0) return cuboids;  // pandas gives empty columns any type
    const bool has_siblings = table_.texts.contains("cuboids.sibling_id");
    for (std::size_t row = 0; row < rows; ++row) {
      Cuboid& one = cuboids[row];
      one.frame = frame;
      one.row = row;
      one.uuid = texts("uuid")[row];
      one.label = texts("label")[row];
      if (one.uuid.empty()) throw fault(row, "has no uuid");
      if (has_siblings) one.sibling = texts("cuboids.sibling_id")[row];
      one.lidar = lidar_of(row);
      one.moves = number("stationary", row) == 0;
      one.box = {time_s, vector("position", row), 0.5 * vector("dimensions", row),
                 number("yaw", row)};
    }
    return cuboids;
  }

 private:
  Error fault(std::size_t row, const std::string& what) const {
    return {ErrorKind::data,
            file_.string() + ": cuboid " + std::to_string(row) + " (from 0): " + what};
  }

  const std::vector<std::string>& texts(std::string_view name) const {
    const auto column = table_.texts.find(name);
    if (column == table_.texts.end())
      throw Error(ErrorKind::data,
                  file_.string() + ": has no column of texts '" + std::string(name) + "'");
    return column->second;
  }

  double number(std::string_view name, std::size_t row) const {
    const Column* const column = table_.numbers.find(name);
    if (column == nullptr)
      throw Error(ErrorKind::data,
                  file_.string() + ": has no column of numbers '" + std::string(name) + "'");
    return column->as_double(row);
  }

  Vec3d vector(const std::string& name, std::size_t row) const {
    return {number(name + ".x", row), number(name + ".y", row), number(name + ".z", row)};
  }

  int lidar_of(std::size_t row) const {
    if (table_.numbers.find("cuboids.sensor_id") == nullptr) return kBothLidars;
    const double id = number("cuboids.sensor_id", row);
    if (id == kBothLidars || id == 0 || id == 1) return static_cast<int>(id);
    throw fault(row, "cuboids.sensor_id is " + exact_text(id) + ", expected -1, 0 or 1");
  }

  fs::path file_;
  FrameTable table_;
};

/// Groups cuboids that are siblings in any frame.
class Siblings {
 public:
  explicit Siblings(const std::vector<Cuboid>& cuboids) {
    for (const Cuboid& one : cuboids) parents_.emplace(one.uuid, one.uuid);
    for (const Cuboid& one : cuboids)
      if (one.lidar != kBothLidars && parents_.contains(one.sibling))
        parents_[first_of(one.sibling)] = first_of(one.uuid);
    // Two cuboids of one LiDAR in one frame are two objects.
    std::map<std::tuple<std::string, std::size_t, int>, std::string> seen;
    for (const Cuboid& one : cuboids) {
      const std::string first = first_of(one.uuid);
      const auto [twin, is_new] = seen.emplace(std::tuple(first, one.frame, one.lidar), one.uuid);
      if (!is_new && twin->second != one.uuid) apart_.insert(first);
    }
  }

  /// The identifier of a cuboid's object.
  std::string object_of(const Cuboid& one) const {
    const std::string first = first_of(one.uuid);
    return apart_.contains(first) ? one.uuid : first;
  }

 private:
  std::string first_of(std::string uuid) const {
    for (auto parent = parents_.find(uuid); parent->second != uuid; parent = parents_.find(uuid))
      uuid = parent->second;
    return uuid;
  }

  std::map<std::string, std::string> parents_;  ///< a root is its own parent
  std::set<std::string> apart_;                 ///< groups that are not one object
};

/// The times of the frames of a sequence, and their file.
std::pair<fs::path, std::vector<double>> times_of_frames(const fs::path& cuboids) {
  // A trailing slash makes the last part of a path empty.
  const fs::path sequence =
      fs::absolute(cuboids / ".").lexically_normal().parent_path().parent_path().parent_path();
  for (const char* folder : {"lidar", "meta"}) {
    const fs::path file = sequence / folder / "timestamps.json";
    std::error_code ignored;
    if (fs::exists(file, ignored)) return {file, pandaset_times(file)};
  }
  throw Error(ErrorKind::no_input, cuboids.string() + ": the times of its frames are missing: " +
                                       (sequence / "lidar" / "timestamps.json").string());
}

/// The files of the frames, one for each time.
std::vector<fs::path> files_of_times(const fs::path& cuboids) {
  const auto [times_file, times_s] = times_of_frames(cuboids);
  const std::map<std::size_t, fs::path> frames = pandaset_frames(cuboids);
  const std::string has = times_file.string() + " has " + std::to_string(times_s.size()) + " times";
  std::vector<fs::path> files;
  for (const auto& [number, file] : frames) {
    if (number >= times_s.size())
      throw Error(ErrorKind::data, file.string() + ": this frame has no time; " + has);
    if (number != files.size()) break;
    files.push_back(file);
  }
  if (files.size() < times_s.size())
    throw Error(ErrorKind::data, cuboids.string() + ": frame " + std::to_string(files.size()) +
                                     " is missing; " + has);
  return files;
}

/// 0: of this LiDAR, 1: of both, 2: of the other.
int rank_of(const Cuboid& one, int lidar) {
  if (one.lidar == lidar) return 0;
  return one.lidar == kBothLidars ? 1 : 2;
}

}  // namespace

BoxContent read_pandaset_boxes(const fs::path& folder, const std::string& lidar) {
  const std::vector<fs::path> files = files_of_times(folder);
  const std::vector<double> times_s = times_of_frames(folder).second;
  std::vector<Cuboid> cuboids;
  for (std::size_t k = 0; k < files.size(); ++k) {
    const std::vector<Cuboid> more = CuboidFrame(files[k]).cuboids(k, times_s[k]);
    cuboids.insert(cuboids.end(), more.begin(), more.end());
  }
  const Siblings siblings(cuboids);
  BoxCollector boxes(folder);
  std::map<std::uint64_t, bool> moves;
  std::map<std::pair<std::uint64_t, std::size_t>, int> best_rank;  // by object and frame
  const int own = lidar == kPandaSetSensors[1] ? 1 : 0;
  for (const Cuboid& one : cuboids) {
    const std::uint64_t id = boxes.number_of(siblings.object_of(one));
    moves[id] = moves[id] || one.moves;
    const int rank = rank_of(one, own);
    int& best = best_rank.emplace(std::pair(id, one.frame), rank).first->second;
    best = std::min(best, rank);
  }
  for (const Cuboid& one : cuboids) {
    const std::uint64_t id = boxes.number_of(siblings.object_of(one));
    if (rank_of(one, own) > best_rank.at({id, one.frame})) continue;
    boxes.add(id, one.label, one.box, moves.at(id), [&] {
      return files[one.frame].string() + ": cuboid " + std::to_string(one.row) +
             " (from 0), uuid " + one.uuid + ": ";
    });
  }
  return boxes.take(true);
}

}  // namespace adasplats
