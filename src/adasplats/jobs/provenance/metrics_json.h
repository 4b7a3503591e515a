// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "adasplats/evaluate/cloud_metrics.h"
#include "adasplats/evaluate/labels/label_agreement.h"
#include "adasplats/evaluate/labels/segmentation.h"
#include "adasplats/evaluate/presence.h"
#include "adasplats/evaluate/resimulate.h"
#include "adasplats/evaluate/truth.h"

namespace adasplats {

/// The metrics by the keys of documentation, --report and Python; what is not known is null.
nlohmann::ordered_json to_json(const CloudDistance& distance);
nlohmann::ordered_json to_json(const BeamAccuracy& accuracy);
nlohmann::ordered_json to_json(const ResimulateResult& result);
nlohmann::ordered_json to_json(const TruthResult& result);
nlohmann::ordered_json to_json(const PresenceResult& result);
nlohmann::ordered_json to_json(const LabelAgreementResult& result);
nlohmann::ordered_json to_json(const SegmentationResult& result);

}  // namespace adasplats
