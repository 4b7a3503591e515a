// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string_view>
#include <utility>

#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/words.h"
#include "adasplats/evaluate/panoramas/lidar4d_protocol.h"
#include "adasplats/jobs/scene/model_scene.h"
#include "adasplats/jobs/session/session.h"

namespace adasplats {

/// Measures of held-out scans as a publication has them.
enum class HeldOutProtocol : std::uint8_t {
  lidar4d  ///< Zheng et al., LiDAR4D, CVPR 2024
};
inline constexpr std::pair<std::string_view, HeldOutProtocol> kHeldOutProtocols[] = {
    {"lidar4d", HeldOutProtocol::lidar4d}};
inline Words<HeldOutProtocol> words_of(HeldOutProtocol) { return kHeldOutProtocols; }

/// A model by the protocol of LiDAR4D.
struct Lidar4dEvaluation : Lidar4dResult {
  /// How many of the scans the model was made of, by its calibration; nothing where that does not
  /// tell. Any such scan makes the figures no held-out figures.
  std::optional<std::size_t> scans_of_model;
};

/// How many scans have time and position of one that a calibration was estimated of, as the
/// recording gives them. Nothing where no calibration is there.
std::optional<std::size_t> scans_of_model(const ModelScene& scene, const KittiSequence& given);

/// Of scans as they are to be cast (calibrate_held_out); `of_model`: of these, as given. Warns
/// where the model was made of one of them.
Lidar4dEvaluation evaluate_lidar4d(const ModelScene& scene, const KittiSequence& sequence,
                                   std::optional<std::size_t> of_model, Session& session);

/// What its figures may be compared with, for reports and text, in words.
inline constexpr std::string_view kLidar4dComparable = "same protocol, other scene";
inline constexpr std::string_view kLidar4dDiffers[] = {
    "another recording than the paper's (KITTI-360)", "no LPIPS",
    "no dynamic scene: what moves is not in the model and counts against it",
    "a pixel returns where its ray hits; the paper foretells a probability with a network"};

nlohmann::ordered_json to_json(const Lidar4dEvaluation& result);

}  // namespace adasplats
