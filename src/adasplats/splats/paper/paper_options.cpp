// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/paper/paper_options.h"

#include <vector>

#include "adasplats/core/error.h"

namespace adasplats {

void check(const PaperOptions& paper) {
  check_settings(paper);
  std::vector<GroupScale> scales(paper.semantic_scales.begin(), paper.semantic_scales.end());
  scales.push_back(paper.planar_scale);
  for (const GroupScale& scale : scales)
    if (!(scale.neighbors > 0 && scale.radius > 0))
      throw Error(ErrorKind::usage, "the scales of neighbours and radius must be greater than 0");
}

}  // namespace adasplats
