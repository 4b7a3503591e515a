// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "adasplats/io/base/input_file.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/base/point_files.h"
#include "adasplats/io/ply/ply.h"

namespace adasplats {
namespace {

enum class PointFormat : std::uint8_t { ply, pcd, las, e57, kitti_bin, text };

struct Extension {
  std::string_view text;
  PointFormat format;
};

constexpr std::array<Extension, 12> kExtensions = {{{".ply", PointFormat::ply},
                                                    {".pcd", PointFormat::pcd},
                                                    {".las", PointFormat::las},
                                                    {".laz", PointFormat::las},
                                                    {".e57", PointFormat::e57},
                                                    {".bin", PointFormat::kitti_bin},
                                                    {".xyz", PointFormat::text},
                                                    {".txt", PointFormat::text},
                                                    {".asc", PointFormat::text},
                                                    {".csv", PointFormat::text},
                                                    {".pts", PointFormat::text},
                                                    {".ptx", PointFormat::text}}};

std::optional<PointFormat> format_of_extension(const std::filesystem::path& path) {
  const std::string extension = lower_case(path.extension().string());
  for (const Extension& known : kExtensions)
    if (known.text == extension) return known.format;
  return std::nullopt;
}

std::optional<PointFormat> format_of_first_bytes(const std::filesystem::path& path) {
  InputFile file(path);
  const std::size_t count = static_cast<std::size_t>(std::min<std::uint64_t>(8, file.size_bytes()));
  const std::string_view start(reinterpret_cast<const char*>(file.peek(count).data()), count);
  if (start.starts_with("ply\n") || start.starts_with("ply\r")) return PointFormat::ply;
  if (start.starts_with("LASF")) return PointFormat::las;
  if (start.starts_with("# .PCD")) return PointFormat::pcd;
  if (start.starts_with("ASTM-E57")) return PointFormat::e57;
  return std::nullopt;
}

std::string_view name_of(PointFormat format) {
  switch (format) {
    case PointFormat::ply: return "PLY";
    case PointFormat::pcd: return "PCD";
    case PointFormat::las: return "LAS or LAZ";
    case PointFormat::e57: return "E57";
    case PointFormat::kitti_bin: return "KITTI bin";
    case PointFormat::text: return "text";
  }
  return "unknown";
}

PointFormat format_of(const std::filesystem::path& path) {
  const std::optional<PointFormat> by_bytes = format_of_first_bytes(path);
  const std::optional<PointFormat> by_extension = format_of_extension(path);
  if (by_bytes && by_extension && by_bytes != by_extension) {
    throw data_error({path, 0, {}}, "begins like " + std::string(name_of(*by_bytes)) +
                                        ", its extension says " +
                                        std::string(name_of(*by_extension)));
  }
  if (by_extension) return *by_extension;
  if (by_bytes) return *by_bytes;
  throw data_error({path, {}, {}}, "unknown format " + shown(path.extension().string()) +
                                       ", understood are .ply, .pcd, .las, .laz, .bin (KITTI; "
                                       "*.pcd.bin: nuScenes), .xyz, .txt, .asc, "
                                       ".csv, .pts and .ptx");
}

}  // namespace

Table read_points(const std::filesystem::path& path, const LasReadOptions& options) {
  switch (format_of(path)) {
    case PointFormat::ply: return read_ply(path);
    case PointFormat::pcd: return read_pcd(path);
    case PointFormat::las: return read_las(path, options);
    case PointFormat::kitti_bin: return read_bin(path);
    case PointFormat::text: return read_text_points(path);
    case PointFormat::e57: break;
  }
  throw data_error({path, {}, {}},
                   "E57 is not supported: convert the file to LAS or PLY, with CloudCompare or "
                   "'pdal translate', say");
}

}  // namespace adasplats
