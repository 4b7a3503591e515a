// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>
#include <string>

#include "adasplats/cloud/load/file_kind.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/error.h"
#include "adasplats/io/arrow/arrow_file.h"
#include "adasplats/io/base/point_files.h"
#include "adasplats/io/base/wkt.h"
#include "adasplats/io/e57/e57_file_test.h"
#include "adasplats/io/ept/ept_tile.h"
#include "adasplats/io/pickle/data_frame.h"
#include "adasplats/io/pickle/gzip.h"
#include "adasplats/io/ply/ply.h"
#include "fuzz_readers.h"

namespace adasplats::fuzz {

void require_sound(const Table& table, std::size_t input_bytes) {
  for (const Column& column : table.columns)
    require(column.size() == table.rows, "columns as long as the table");
  require(table.rows <= 88 * input_bytes, "no more rows than the input has room for");
}

void require_sound(const MeshTable& mesh) {
  for (const Table* const table : {&mesh.vertices, &mesh.faces})
    for (const Column& column : table->columns)
      require(column.size() == table->rows, "columns as long as the table");
  require(mesh.triangle_vertices.size() == 3 * mesh.faces.rows, "three vertices a triangle");
  for (const std::uint32_t index : mesh.triangle_vertices)
    require(index < mesh.vertices.rows, "vertices that are there");
}

void read_point_file(const Input& input) {
  require_sound(read_points(input.file, {.salvage = input.bytes.size() % 2 == 0}),
                input.bytes.size());
}

void read_laz_file(const Input& input) {
  const Table table = read_points(input.file, {.salvage = input.bytes.size() % 2 == 0});
  for (const Column& column : table.columns)  // points that repeat take no byte
    require(column.size() == table.rows, "columns as long as the table");
}

void read_copc_file(const Input& input) {
  LasReadOptions options;
  options.selection.level = static_cast<std::uint32_t>(input.bytes.size() % 4);
  const LasFacts facts = read_las_facts(input.file);
  if (input.bytes.size() % 8 < 4)
    options.selection.extent = {facts.box_min, 0.5 * (facts.box_min + facts.box_max)};
  const Table table = read_points(input.file, options);
  for (const Column& column : table.columns)
    require(column.size() == table.rows, "columns as long as the table");
}

void read_ply_file(const Input& input) {
  kind_of_file(input.file);
  if (ply_has_faces(input.file)) require_sound(read_ply_mesh(input.file));
  read_point_file(input);
}

/// Also past the checksums of pages, which detect nearly all corruption.
void read_e57_file(const Input& input) {
  try {
    read_point_file(input);
    return;
  } catch (const Error&) {
  }
  const std::string sealed = io_test::sealed_e57(std::string(input.bytes));
  io_test::write_bytes(input.file, sealed);
  require_sound(read_points(input.file), sealed.size());
}

/// The input is the XML of a file without points.
void read_e57_xml(const Input& input) {
  io_test::write_bytes(input.file, io_test::E57Composer().file_of_xml(std::string(input.bytes)));
  read_points(input.file);
}

void read_wkt(const Input& input) {
  foreign_units_of_wkt(input.bytes);
  geographic_system_of_wkt(input.bytes);
  const Crs crs = crs_of_wkt(input.bytes);
  require(match(crs, crs) == CrsMatch::same, "a system is itself");
  require(crs_of_comments("a.ply", crs_comments(crs)).name() == crs.name(),
          "comments say the system");
}

void read_text_file(const Input& input) {
  kind_of_file(input.file);
  read_point_file(input);
}

void read_pickle(const Input& input) {
  const FrameTable table = frame_table_of("a.pkl", std::string(input.bytes));
  require_sound(table.numbers, input.bytes.size());
  for (const auto& [name, texts] : table.texts)
    require(texts.size() == table.numbers.rows, "a text a row");
}

void read_arrow(const Input& input) {
  const ArrowTable table = arrow_table_of("a.feather", input.bytes);
  for (const Column& column : table.numbers.columns)
    require(column.size() == table.numbers.rows, "columns as long as the table");
  for (const auto& [name, texts] : table.texts)
    require(texts.size() == table.numbers.rows, "columns as long as the table");
}

void read_ept(const Input& input) {
  const std::filesystem::path tile = input.folder / "ept-data" / "0-0-0-0.bin";
  require(is_ept_tile(tile), "a tile");
  const Table table = read_ept_tile(tile);
  require_sound(table, input.bytes.size());
  require(ept_tile_points(tile) == table.rows, "the points of the tile");
}

void read_gzip(const Input& input) {
  constexpr std::size_t kMost = std::size_t{16} << 20;
  require(gunzipped("a.gz", input.bytes, kMost).size() <= kMost, "no more than was asked for");
}

void read_label_file(const Input& input) {
  require(4 * read_kitti_labels(input.file).size() == input.bytes.size(), "four bytes a label");
}

}  // namespace adasplats::fuzz
