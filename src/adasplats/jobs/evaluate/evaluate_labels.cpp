// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/evaluate/evaluate_labels.h"

#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/jobs/session/inputs.h"

namespace adasplats {

LabelAgreementResult evaluate_labels(const LabelAgreementJob& job, Session& session) {
  const LabelScheme labels = load_label_scheme(job.labels);
  return compare_labels(open_kitti_sequence(resolve_cloud_input(job.simulated)),
                        open_kitti_sequence(resolve_cloud_input(job.original)), labels, job.options,
                        session.executor, session.progress);
}

}  // namespace adasplats
