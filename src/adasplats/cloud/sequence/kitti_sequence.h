// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/cloud/sequence/scan_beams.h"
#include "adasplats/io/base/crs.h"

namespace adasplats {

/// Files of a folder with an extension, by name; none where there is no such folder. Errors:
/// no_input (it cannot be listed).
std::vector<std::filesystem::path> files_by_name(const std::filesystem::path& folder,
                                                 const std::string& extension);

/// The number that a name such as 000123 is; nothing for other names.
std::optional<std::size_t> number_in_name(const std::filesystem::path& file);

struct KittiScan;
class MovingBoxes;

/// What was inferred about a drive, in words; empty: nothing to report.
struct DriveFacts {
  std::string points_in;           ///< the frame of the points in the files, and by what
  std::string poses;               ///< how scans got theirs
  std::string motion;              ///< of the sensor within a sweep
  bool is_motion_assumed = false;  ///< `motion` is undetermined
  std::string clock;               ///< whether points and poses share a clock, with the evidence
  bool is_clock_checked = true;    ///< or `clock` states why that is impossible
  std::string unchecked;           ///< of the poses (verify_poses())
  /// Of the tree of a data set: how intensities were scaled, which scans have labels, and which
  /// points of the files are of none of the scans.
  std::string intensities, labels, left_out;
  Crs crs;  ///< of the world, where files in it say theirs
};

/// Reads scans that are not in KITTI's layout.
class ScanReader {
 public:
  virtual ~ScanReader() = default;
  /// One of the sequence's `scans`.
  virtual KittiScan read(const std::filesystem::path& file) const = 0;
};

/// A SemanticKITTI sequence folder: velodyne/NNNNNN.bin, labels/NNNNNN.label (optional),
/// poses.txt, calib.txt, times.txt (optional).
struct KittiSequence {
  std::filesystem::path folder;
  std::vector<std::filesystem::path> scans;   ///< by name
  std::vector<std::filesystem::path> labels;  ///< empty, or one a scan
  Trajectory trajectory;                      ///< world_from_velodyne, one a scan
  bool has_times = true;                      ///< of the trajectory; else placeholders, 0.1 s apart
  Trajectory track;  ///< the same between scans too, in their clock; empty: not known
  ScanBeams beams;   ///< unless recognize_beams says more: from the frame's origin
  std::shared_ptr<const ScanReader> reader;  ///< null: the files are KITTI's
  DriveFacts facts;
  std::shared_ptr<const MovingBoxes> boxes;  ///< of annotated moving objects; null: none
  std::string rig_sensor;                    ///< its name in the rig; empty: no rig
};

/// True for a folder with a `velodyne` folder in it, and for a drive of KITTI's raw data
/// (is_kitti_raw_drive()).
bool is_kitti_sequence(const std::filesystem::path& folder);

/// Whether a folder has a `velodyne` folder but no poses.txt: its poses are those of another file.
bool lacks_poses(const std::filesystem::path& folder);

/// Lists a sequence and reads its poses; scans are not read. Errors: no_input, data (poses of
/// another count than scans, labels of another count), those of open_kitti_raw_drive.
KittiSequence open_kitti_sequence(const std::filesystem::path& folder);

/// One scan in the sensor frame.
struct KittiScan {
  std::vector<Vec3f> positions;  ///< sensor frame, m
  std::vector<float> intensities;
  std::vector<std::uint16_t> classes;    ///< low 16 bits of the label; empty without labels
  std::vector<std::uint16_t> instances;  ///< high 16 bits
  /// Where each beam began, sensor frame, m, and its laser; empty: the sequence's beams say.
  std::vector<Vec3f> origins;
  std::vector<std::uint16_t> lasers;
  /// When each point was measured, s in the clock of the poses; empty: unknown.
  std::vector<double> times_s;
  /// The annotated moving object that each point is on (MovingBoxes::object_at()); empty: none.
  std::vector<std::uint16_t> in_boxes;
};

/// The drive with some of its scans, by ascending number. Without KittiSequence::track and laser
/// offsets.
KittiSequence with_scans(const KittiSequence& all, std::span<const std::size_t> scans);

/// When point `i` of a scan was measured: its own time if that is known, else that of the pose.
double time_of_point(const KittiScan& scan, const TimedPose& pose, std::size_t i);

/// The beam that measured point `i` of scan number `index`, in the scan's frame, corrected by the
/// offsets of the sequence's beams.
MeasuredBeam beam_of(const KittiSequence& sequence, std::size_t index, const KittiScan& scan,
                     std::size_t i);

/// The labels of a file such as labels/000000.label, the class in the low 16 bits and the instance
/// in the high ones. Errors: data (not four bytes a label), no_input, io.
std::vector<std::uint32_t> read_kitti_labels(const std::filesystem::path& path);

/// Reads scan number `index` without the points in boxes of moving objects. Points that are not
/// finite are kept here (the caller counts them). Errors: data (the label file has another number
/// of entries).
KittiScan read_kitti_scan(const KittiSequence& sequence, std::size_t index);

/// The same without labels.
KittiScan read_kitti_points(const KittiSequence& sequence, std::size_t index);

/// All points with their labels and with KittiScan::in_boxes: beams into boxes returned, too.
KittiScan read_all_returns(const KittiSequence& sequence, std::size_t index);

/// read_kitti_points(); nothing if the scan is absent or damaged: for checks of scans that the user
/// may not have selected. Errors: no_input (it cannot be opened), io.
std::optional<KittiScan> try_kitti_points(const KittiSequence& sequence, std::size_t index);

/// True for a drive as KITTI's raw data have it: folders `velodyne_points/data` and `oxts/data`.
bool is_kitti_raw_drive(const std::filesystem::path& folder);

/// Opens a drive of KITTI's raw data (Geiger et al., "Vision meets robotics: the KITTI dataset",
/// 2013, and its devkit's readme), synced (`_sync`, .bin) or not (`_extract`, .txt). Poses are
/// those of the GPS/IMU unit at the scans' own times (velodyne_points/timestamps.txt, when the
/// laser pointed forward), interpolated between the records of oxts and brought to the LiDAR by
/// calib_imu_to_velo.txt, of the folder or of the one above. World: metres from the first scan, x
/// east, y north, z up (Mercator, scaled by the latitude of the first record, as the devkit has
/// it). Times are seconds since 1970 of the clock in the files. Errors: no_input (nothing is
/// there), data (calibration, stamps or records that are missing or no numbers; scans whose time is
/// farther than 0.1 s before or behind all records, or in a gap of them).
KittiSequence open_kitti_raw_drive(const std::filesystem::path& folder);

}  // namespace adasplats
