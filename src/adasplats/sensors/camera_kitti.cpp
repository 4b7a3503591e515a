// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Rectified cameras of KITTI (Geiger et al. 2013, "Vision meets robotics: the KITTI dataset", and
// the readmes of the development kits). A point x of the LiDAR has the pixel P R_rect Tr x, where P
// is K [I | t]: the camera is at -t from the rectified first camera. calib.txt of the odometry has
// R_rect Tr as Tr.

#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/io/base/atomic_file.h"
#include "adasplats/sensors/camera_files.h"
#include "adasplats/sensors/text_fields.h"

namespace adasplats {

namespace {

namespace fs = std::filesystem;

/// The lines "KEY: numbers" of a file.
class KittiCalibration {
 public:
  KittiCalibration(std::string_view text, const fs::path& file) : file_(file) {
    while (!text.empty()) {
      std::string_view line = trimmed(take(text, '\n'));
      const std::string key(trimmed(take(line, ':')));
      lines_[key] = std::string(trimmed(line));
    }
  }

  bool has(const std::string& key) const { return lines_.contains(key); }

  std::vector<double> numbers(const std::string& key, std::size_t count) const {
    const auto found = lines_.find(key);
    if (found == lines_.end()) throw camera_fault(file_, "no line " + key + ":");
    std::vector<double> numbers;
    std::string_view rest = found->second;
    while (!(rest = trimmed(rest)).empty()) {
      const auto number = parse_number<double>(take(rest, ' '));
      if (!number || !std::isfinite(*number) || numbers.size() == count) {
        numbers.clear();
        break;
      }
      numbers.push_back(*number);
    }
    if (numbers.size() != count)
      throw camera_fault(file_, key + " is not " + std::to_string(count) + " finite numbers");
    return numbers;
  }

  /// A rotation from the numbers of a line, 9 by rows or in 12 of a transform.
  Mat3d rotation(const std::string& key, std::size_t count) const {
    const std::vector<double> n = numbers(key, count);
    const std::size_t row = count / 3;
    Mat3d r;
    for (std::size_t i = 0; i < 3; ++i) r.rows[i] = {n[i * row], n[i * row + 1], n[i * row + 2]};
    const Vec3d x = r.rows[0], y = r.rows[1];
    constexpr double kMaxError = 1e-3;
    const bool is_rotation =
        std::fabs(length(x) - 1) < kMaxError && std::fabs(length(y) - 1) < kMaxError &&
        std::fabs(dot(x, y)) < kMaxError && length(cross(x, y) - r.rows[2]) < kMaxError;
    if (!is_rotation) throw camera_fault(file_, key + " is not a rotation");
    r.rows[0] = normalized(x);  // the file has rounded numbers
    r.rows[1] = normalized(y - dot(y, r.rows[0]) * r.rows[0]);
    r.rows[2] = cross(r.rows[0], r.rows[1]);
    return r;
  }

 private:
  const fs::path& file_;
  std::map<std::string, std::string> lines_;
};

/// first_from_lidar of an odometry sequence.
RigidTransform odometry_mount(const KittiCalibration& calibration) {
  const std::vector<double> n = calibration.numbers("Tr", 12);
  return {calibration.rotation("Tr", 12), {n[3], n[7], n[11]}};
}

/// The same of raw data.
RigidTransform raw_mount(const KittiCalibration& calibration, const fs::path& file) {
  const fs::path lidar_file = file.parent_path() / "calib_velo_to_cam.txt";
  const std::string text = read_file(lidar_file);
  const KittiCalibration lidar(text, lidar_file);
  const std::vector<double> t = lidar.numbers("T", 3);
  const RigidTransform rectified{calibration.rotation("R_rect_00", 9), {}};
  return rectified * RigidTransform{lidar.rotation("R", 9), {t[0], t[1], t[2]}};
}

/// Width and height of the first PNG that KITTI has for a camera: image_2/000000.png of P2.
void read_picture_size(const fs::path& file, Lens& lens) {
  constexpr std::size_t kHeader = 24;
  constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
  std::error_code ignored;  // what cannot be looked at is not there
  if (!fs::is_regular_file(file, ignored)) return;
  const std::string bytes = read_file(file);
  if (bytes.size() < kHeader || !bytes.starts_with(kSignature))
    throw camera_fault(file, "is not a PNG");
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = at; i < at + 4; ++i) value = value << 8 | std::uint8_t(bytes[i]);
    return value < 1U << 16 ? static_cast<int>(value) : -1;
  };
  lens.width = number(16);
  lens.height = number(20);
}

}  // namespace

bool is_kitti_calibration(std::string_view text) {
  const auto has_line = [text](std::string_view key) {
    const std::string line = "\n" + std::string(key);
    return text.starts_with(key) || text.find(line) != std::string_view::npos;
  };
  return has_line("P0:") || has_line("P1:") || has_line("P2:") || has_line("P3:") ||
         has_line("Tr:") || has_line("P_rect_0");
}

FileCamera read_kitti_camera(std::string_view text, const fs::path& file,
                             const std::string& wanted) {
  const KittiCalibration calibration(text, file);
  const bool is_raw = text.find("P_rect_0") != std::string_view::npos;
  std::vector<std::string> names;
  for (int camera = 0; camera < 4; ++camera) {
    const std::string name = (is_raw ? "P_rect_0" : "P") + std::to_string(camera);
    if (calibration.has(name)) names.push_back(name);
  }
  if (names.empty()) throw camera_fault(file, "has no camera: it has none of the lines P0 to P3");
  FileCamera result;
  result.camera.name = names[choose_camera(names, wanted, file)];
  const char number = result.camera.name.back();
  const std::vector<double> p = calibration.numbers(result.camera.name, 12);
  Lens& lens = result.camera.lens;
  lens = pinhole_lens({p[0], p[1], p[2], p[4], p[5], p[6], p[8], p[9], p[10]},
                      file.string() + ": " + result.camera.name);
  if (is_raw) {
    const std::vector<double> size = calibration.numbers(std::string("S_rect_0") + number, 2);
    for (const double side : size)
      if (!(side >= 1 && side <= 1 << 15))
        throw camera_fault(file, std::string("S_rect_0") + number + " is no size of a picture");
    lens.width = static_cast<int>(size[0]);
    lens.height = static_cast<int>(size[1]);
  } else {
    read_picture_size(file.parent_path() / (std::string("image_") + number) / "000000.png", lens);
  }
  const Vec3d shift = {(p[3] - lens.cx * p[11]) / lens.fx, (p[7] - lens.cy * p[11]) / lens.fy,
                       p[11]};
  const RigidTransform first_from_lidar =
      is_raw ? raw_mount(calibration, file) : odometry_mount(calibration);
  const RigidTransform camera_from_lidar =
      RigidTransform{kCameraFromOptical, kCameraFromOptical * shift} * first_from_lidar;
  result.camera.vehicle_from_camera = camera_from_lidar.inverse();
  result.camera.lidar_from_camera = result.camera.vehicle_from_camera;
  return result;
}

}  // namespace adasplats
