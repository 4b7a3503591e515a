// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "adasplats/core/maths/vec3.h"
#include "adasplats/io/base/crs.h"
#include "adasplats/scene/scene.h"

namespace adasplats {

/// A place as triangles: a reconstruction of the paper's comparison, the true surface of the
/// procedural street, or any mesh of a user's.
struct MeshModel {
  Vec3d origin;              ///< world coordinates of the local origin, m
  Crs crs;                   ///< of the world coordinates
  TriangleMesh mesh;         ///< relative to `origin`
  std::string label_scheme;  ///< name or path as load_label_scheme takes it; may be empty
  std::string method;        ///< how it was made; may be empty

  std::size_t size() const { return mesh.triangles.size(); }
  SceneView view() const { return {{}, &mesh}; }
};

/// Writes a PLY: vertices, faces with the property `class` where the mesh has classes; the scheme,
/// the method and the coordinate system (crs_comments()) as comments. Atomic.
void save_mesh(const std::filesystem::path& path, const MeshModel& model);

/// Reads a triangle mesh: PLY (faces; classes from the face property class, label, semantic or
/// category, where there is one), glTF 2.0 (docs/worlds.md), or OBJ (v and f; faces of more than
/// three corners become fans; indices from the end are understood; materials, normals and texture
/// coordinates are skipped). The kind is known by the content. Triangles without area stay: no
/// ray hits them. Errors: no_input, io; data with line or offset (a vertex that is not finite or
/// not there, a face with fewer than three corners).
MeshModel load_mesh(const std::filesystem::path& path);

/// Whether load_mesh would take the file: an OBJ, or a PLY that declares faces.
bool is_mesh_file(const std::filesystem::path& path);

}  // namespace adasplats
