// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "adasplats/core/maths/vec3.h"
#include "adasplats/io/base/crs.h"
#include "adasplats/scene/scene.h"

namespace adasplats {

/// A scene of triangles: a reconstruction of the paper's comparison, the exact surface of the
/// procedural street, or any mesh that a user provides.
struct MeshModel {
  Vec3d origin;              ///< world coordinates of the local origin, m
  Crs crs;                   ///< of the world coordinates
  TriangleMesh mesh;         ///< relative to `origin`
  std::string label_scheme;  ///< name or path for load_label_scheme; may be empty
  std::string method;        ///< how it was made; may be empty

  std::size_t size() const { return mesh.triangles.size(); }
  SceneView view() const { return {{}, &mesh}; }
};

/// Writes a PLY file: vertices, and faces with the property `class` if the mesh has classes.
/// Comments hold the label scheme, the method and the coordinate system (crs_comments()). Atomic.
void save_mesh(const std::filesystem::path& path, const MeshModel& model);

/// Reads a triangle mesh: PLY (faces; classes from the face property class, label, semantic or
/// category, if there is one), glTF 2.0 (docs/worlds.md), or OBJ (v and f; faces with more than
/// three corners become fans; negative indices are supported; materials, normals and texture
/// coordinates are skipped). The content decides the format. Degenerate triangles are kept: no ray
/// hits them. Errors: no_input, io; data with line or offset (a vertex that is missing or not
/// finite, a face with fewer than three corners).
MeshModel load_mesh(const std::filesystem::path& path);

/// Whether load_mesh accepts the file: OBJ, glTF, or a PLY file that declares faces.
bool is_mesh_file(const std::filesystem::path& path);

}  // namespace adasplats
