// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/paper/paper_steps.h"

#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/neighbors/point_index.h"
#include "adasplats/splats/model/cpu_backend.h"
#include "adasplats/splats/paper/paper_options.h"
#include "adasplats/splats/paper/paper_steps_on.h"
#include "adasplats/splats/paper/resample.h"

namespace adasplats {
namespace {

/// The CPU backend of the paper's methods.
class PaperOnCpu : public CpuBackend {
 public:
  using Generation = adasplats::Generation;
  using CpuBackend::CpuBackend;

  static const std::vector<SemanticGroup>& copied(const std::vector<SemanticGroup>& groups) {
    return groups;
  }
  BaseNeighborhoods base(const PointCloud& cloud, const BaseNeighborhoodOptions& options) const {
    const PointIndex index = PointIndex::from_sorted(cloud.positions, executor());
    return base_neighborhoods(cloud.positions, index, options, executor());
  }
  Generation generate(const PointCloud& cloud, const std::vector<SemanticGroup>& groups,
                      const PaperOptions& options, StepSink step) const {
    return generate_splats(cloud, groups, options, executor(), step);
  }
  ResampledCloud resample(const PointCloud& cloud, const Generation& first,
                          const PaperOptions& options) const {
    ResampledCloud made = adasplats::resample(cloud, first, options, executor());
    const std::vector<std::uint32_t> order = canonical_order(made.cloud, executor());
    made.cloud = gather(made.cloud, order);
    made.groups = gather(made.groups, order);
    return made;
  }
};

}  // namespace

std::unique_ptr<PaperSteps> make_cpu_paper_steps(const Executor& executor) {
  return std::make_unique<PaperStepsOn<PaperOnCpu>>(executor);
}

void check(const PaperOptions& paper) {
  check_settings(paper);
  std::vector<GroupScale> scales(paper.semantic_scales.begin(), paper.semantic_scales.end());
  scales.push_back(paper.planar_scale);
  for (const GroupScale& scale : scales)
    if (!(scale.neighbors > 0 && scale.radius > 0))
      throw Error(ErrorKind::usage, "the scales of neighbours and radius must be greater than 0");
}

}  // namespace adasplats
