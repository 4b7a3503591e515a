// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adasplats/io/base/byte_sink.h"
#include "adasplats/io/base/crs.h"
#include "adasplats/io/base/table.h"

namespace adasplats {

/// Reads the `vertex` element of a PLY file: ASCII or binary, either byte order, any scalar
/// properties; other elements are skipped by their layout. The coordinate system comes from
/// crs_comments() among the comments. Counts are checked against the size of the file before
/// allocation. Memory: binary 1x the file's size; ASCII at most 4x (doubles of one digit), usually
/// below 1x. Errors: no_input, io, data (with line or byte offset).
/// Gaussians in the compressed layout of PlayCanvas are returned unpacked (packed_ply.h).
/// `records`: only these, of a file with random access (else std::logic_error).
Table read_ply(const std::filesystem::path& path, const std::optional<RecordSpan>& records = {});

/// The number of vertices of a binary file with random access: no lists in vertices or the elements
/// before them; else nothing. Errors: as read_ply().
std::optional<std::uint64_t> ply_records_at_random(const std::filesystem::path& path);

/// Reads `vertex` and `face` (`vertex_indices` or `vertex_index` lists) of a PLY file. The comments
/// of the file are those of the vertices. Errors: as read_ply(); data (a face with fewer than 3
/// vertices or an invalid index).
MeshTable read_ply_mesh(const std::filesystem::path& path);

/// Whether the header declares a `face` element with records.
bool ply_has_faces(const std::filesystem::path& path);

/// The coordinate system in the comments. Errors: as read_ply().
Crs read_ply_crs(const std::filesystem::path& path);

/// The comments in the header, without "comment". Errors: as read_ply().
std::vector<std::string> read_ply_comments(const std::filesystem::path& path);

/// Writes one `vertex` element, binary little-endian, `rows` records. Atomic (see AtomicFile).
/// Columns may be i8..i32, u8..u32, f32, f64 (PLY has no 64-bit integers: std::logic_error).
void write_ply(const std::filesystem::path& path, std::size_t rows,
               std::span<const ColumnView> columns, std::span<const std::string> comments = {});

/// Writes the bytes of that file.
void put_ply(ByteSink& file, std::size_t rows, std::span<const ColumnView> columns,
             std::span<const std::string> comments = {});

/// Writes `vertex` and `face` elements; `triangle_vertices` has three indices for each face, below
/// `vertices` (else std::logic_error); `face_columns` have a row for each triangle.
void write_ply_mesh(const std::filesystem::path& path, std::size_t vertices,
                    std::span<const ColumnView> vertex_columns,
                    std::span<const std::uint32_t> triangle_vertices,
                    std::span<const ColumnView> face_columns,
                    std::span<const std::string> comments = {});

}  // namespace adasplats
