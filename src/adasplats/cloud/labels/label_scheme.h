// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace adasplats {

/// The four groups of paper section "Adaptive Splatting"; each has its own neighbourhood size and
/// error bound.
enum class SemanticGroup : std::uint8_t {
  ground,       ///< road, sidewalk
  surface,      ///< buildings and what locally resembles a surface
  linear,       ///< poles, traffic signs
  non_surface,  ///< vegetation, fences
};
inline constexpr int kSemanticGroups = 4;
std::string_view name_of(SemanticGroup group);

/// Whether objects of a class stay where they are.
enum class Mobility : std::uint8_t {
  fixed,    ///< part of the place
  movable,  ///< could move but does not now: a parked car
  moving,   ///< moves while it is measured
};

struct SemanticClass {
  std::uint16_t id;
  std::string name;
  SemanticGroup group;
  Mobility mobility;
  std::array<std::uint8_t, 3> rgb;
  bool is_noise = false;  ///< points that no object reflected; never modelled
};

/// What the numbers in label files mean.
class LabelScheme {
 public:
  /// Classes with distinct ids, in any order.
  LabelScheme(std::string name, std::vector<SemanticClass> classes);

  const std::string& name() const { return name_; }
  std::span<const SemanticClass> classes() const { return classes_; }  ///< by ascending id
  const SemanticClass* find(std::uint16_t id) const;                   ///< nullptr: unknown id
  const SemanticClass* find(std::string_view class_name) const;

 private:
  std::string name_;
  std::vector<SemanticClass> classes_;
};

/// SemanticKITTI (Behley et al. 2019): ids, names and colours of its semantic-kitti.yaml.
const LabelScheme& semantickitti_labels();
/// Paris-CARLA-3D (Deschaud et al. 2021), the 23 CARLA classes of its table 2.
const LabelScheme& paris_carla_3d_labels();
/// PandaSet (Xiao et al. 2021): the 42 classes of its semseg, and 0, which some of its points have.
const LabelScheme& pandaset_labels();
/// nuScenes-lidarseg (Fong et al. 2021): its 32 categories by their indices, and
/// kNuscenesUnlabeled, which no file of it has: points of sweeps, which have no labels.
const LabelScheme& nuscenes_labels();
inline constexpr std::uint16_t kNuscenesUnlabeled = 255;
/// ASPRS, "LAS specification 1.4 - R15", table 17: the standard classes of point formats 6 to 10,
/// which those of formats 0 to 5 are among; 23 to 63 (reserved) and 64 to 255 (defined by users)
/// count as surfaces.
const LabelScheme& asprs_labels();
/// All of these.
std::span<const LabelScheme* const> known_label_schemes();

/// The start of the comment that names the scheme of a PLY file of this program.
inline constexpr std::string_view kLabelsComment = "adasplats.labels ";

/// The name of one of known_label_schemes(), or the path of a TOML file:
///     name = "mine"
///     [[class]]
///     id = 1
///     name = "pole"
///     group = "linear"          # ground | surface | linear | non-surface
///     mobility = "fixed"        # fixed (default) | movable | moving
///     rgb = [255, 240, 150]     # optional
/// Errors: config with the line (unknown key, duplicate id), no_input.
LabelScheme load_label_scheme(const std::string& name_or_path);

}  // namespace adasplats
