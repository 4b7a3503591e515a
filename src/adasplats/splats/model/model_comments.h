// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/table.h"
#include "adasplats/splats/model/splat_model.h"

namespace adasplats {

// Comments in the PLY files of splat models and meshes: "KEY VALUE". Private to splats/model.

inline constexpr const char* kMethodComment = "adasplats.method ";
// The version of the format.
inline constexpr const char* kSplatsComment = "adasplats.splats ";
inline constexpr const char* kMeshComment = "adasplats.mesh ";

/// The value of the first comment with this key; empty without one.
inline std::string comment_value(const Table& table, std::string_view key) {
  for (const std::string& comment : table.comments)
    if (comment.starts_with(key)) return comment.substr(key.size());
  return {};
}

/// Rejects a file whose comment `key` names another version of its format than 1. Files of other
/// programs have no such comment. Errors: data.
inline void require_version_1(const Table& table, std::string_view key,
                              const std::filesystem::path& path) {
  const std::string version = comment_value(table, key);
  if (!version.empty() && version != "1")
    throw data_error({path, {}, {}},
                     "the model has format version " + version + "; this program reads version 1");
}

/// What a splat model states beside its splats.
std::vector<std::string> comments_of(const SplatModel& model);

}  // namespace adasplats
