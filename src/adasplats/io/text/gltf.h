// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "adasplats/io/base/table.h"

namespace adasplats {

/// Reads the triangles of a glTF 2.0 file (Khronos Group, "glTF 2.0 Specification"; the source
/// names the sections): .gltf with buffers in separate files or as base64, or .glb. Uses the nodes
/// of the default scene with their transforms, and the triangles, strips and fans of each mesh.
/// Ignores materials, textures, normals, skins, morph targets, animations, points and lines. glTF
/// has y up and z forward; the result has x forward, y left, z up: its (x, y, z) is (z, x, y) of
/// the file. Metres. Memory: 40x the size of the JSON, twice the buffers, and the vertices and
/// triangles: at most 50 million and 100 million. Errors: no_input (a buffer's file is missing);
/// data: JSON that does not parse (with the byte), indices or ranges beyond their array or buffer,
/// a node with two parents, sparse accessors, required extensions that change the geometry
/// (compressed meshes).
MeshTable read_gltf_mesh(const std::filesystem::path& path);

/// Reads the Gaussian splats of a glTF file (KHR_gaussian_splatting, kernel "ellipse"), of all
/// nodes of the default scene, as flat ones. Columns: x y z, nx ny nz (the shortest axis),
/// deviation_0 and deviation_1 (the longer and the shorter of the two others, m), opacity (0 to 1),
/// red green blue (sRGB from the harmonic of degree 0) and, where all primitives have them,
/// application's attributes such as _CLASS as "class". World: x forward, y left, z up, plus
/// "origin" of a node's extras; the comments are the texts in "adasplats" of the extras, which give
/// the coordinate system, too. Errors: data, as read_gltf_mesh; compressed splats; a node that
/// scales unevenly; triangles beside the splats.
Table read_gltf_splats(const std::filesystem::path& path);

/// Whether the JSON of a glTF file names the extension of Gaussian splats.
bool has_gltf_splats(const std::filesystem::path& path);

/// The files with the buffers of a glTF file. Errors: those of read_gltf_mesh.
std::vector<std::filesystem::path> gltf_buffer_files(const std::filesystem::path& path);

/// Whether the content begins like a .glb file, or is JSON with the member "asset" of every glTF
/// file.
bool is_gltf(const std::filesystem::path& path);

}  // namespace adasplats
