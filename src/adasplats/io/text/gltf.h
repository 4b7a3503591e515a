// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "adasplats/io/base/table.h"

namespace adasplats {

/// Reads the triangles of a glTF 2.0 file (Khronos Group, "glTF 2.0 Specification"; sections named
/// in the source): .gltf with its buffers beside it or as base64 within, or .glb. Takes the nodes
/// of the default scene with their transforms, and of each mesh the triangles, strips and fans;
/// materials, textures, normals, skins, morph targets, animations, points and lines are skipped.
/// glTF has y up and looks along z; the vertices are turned to x forward, y left, z up: (x, y, z)
/// of the result is (z, x, y) of the file. Metres, as glTF says.
/// Memory: 40x the size of the JSON, the buffers twice, and what the nodes place: 50 million
/// vertices and 100 million triangles at most.
/// Errors: no_input (a buffer's file is missing); data: JSON that does not parse (with the byte),
/// indices or ranges beyond their array or buffer, a node that stands under two others, sparse
/// accessors, extensions that are required and change the geometry (compressed meshes).
MeshTable read_gltf_mesh(const std::filesystem::path& path);

/// The files beside a glTF file that hold its buffers. Errors: those of read_gltf_mesh.
std::vector<std::filesystem::path> gltf_buffer_files(const std::filesystem::path& path);

/// Whether the content begins as a .glb, or is JSON with the member "asset" that every glTF has.
bool is_gltf(const std::filesystem::path& path);

}  // namespace adasplats
