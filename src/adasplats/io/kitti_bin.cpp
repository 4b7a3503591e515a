// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/point_files.h"
#include "adasplats/io/records.h"

namespace adasplats {

Table read_kitti_bin(const std::filesystem::path& path) {
  constexpr std::size_t kRecordBytes = 4 * sizeof(float);
  InputFile file(path);
  if (file.size_bytes() % kRecordBytes != 0) {
    throw data_error({path, file.size_bytes(), {}},
                     "a KITTI scan has 16 bytes a point (float32 x, y, z, intensity), found " +
                         std::to_string(file.size_bytes() % kRecordBytes) +
                         " bytes after the last whole point");
  }
  Table table;
  table.rows = static_cast<std::size_t>(file.size_bytes() / kRecordBytes);
  table.columns = read_records(file, table.rows, kRecordBytes,
                               {{"x", ColumnType::f32, 0},
                                {"y", ColumnType::f32, 4},
                                {"z", ColumnType::f32, 8},
                                {"intensity", ColumnType::f32, 12}},
                               false);
  return table;
}

}  // namespace adasplats
