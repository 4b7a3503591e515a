// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "adasplats/evaluate/labels/label_agreement.h"
#include "adasplats/jobs/session/session.h"

namespace adasplats {

struct LabelAgreementJob {
  std::filesystem::path simulated;  ///< sequence folder with labels
  std::filesystem::path original;   ///< the sequence that it was made from
  std::string labels = "semantickitti";
  LabelAgreementOptions options;
};

/// How many simulated points have the class of the nearest measured one.
LabelAgreementResult evaluate_labels(const LabelAgreementJob& job, Session& session);

}  // namespace adasplats
