// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "adasplats/io/base/table.h"

namespace adasplats {

/// Reads the geometry of a Wavefront OBJ file: `v` (columns x, y, z as doubles; weights and colours
/// after them are skipped) and `f` (the vertex a of "a", "a/b", "a//c" or "a/b/c"; negative numbers
/// count back from the last vertex so far; more than three corners become a fan). A backslash
/// joins lines. All other statements are skipped. Memory: at most 8x the file's size.
/// Errors: no_input, io, data (with line: a vertex that is not finite, a face with fewer than three
/// corners or with a missing vertex).
MeshTable read_obj_mesh(const std::filesystem::path& path);

/// Whether the content is OBJ: a text whose first statement is one of OBJ.
bool is_obj(const std::filesystem::path& path);

}  // namespace adasplats
