// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/io/base/table.h"
#include "adasplats/splats/model/splat_model.h"

namespace adasplats {

// Comments in the PLY files of splat models and meshes: "KEY VALUE". Private to splats/model.

inline constexpr const char* kMethodComment = "adasplats.method ";

/// The value of the first comment with this key; empty without one.
inline std::string comment_value(const Table& table, std::string_view key) {
  for (const std::string& comment : table.comments)
    if (comment.starts_with(key)) return comment.substr(key.size());
  return {};
}

/// What a splat model states beside its splats.
std::vector<std::string> comments_of(const SplatModel& model);

}  // namespace adasplats
