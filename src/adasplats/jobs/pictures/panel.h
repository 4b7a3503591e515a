// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/evaluate/error_points.h"
#include "adasplats/jobs/scene/model_scene.h"
#include "adasplats/jobs/session/session.h"
#include "adasplats/simulate/image/image.h"
#include "adasplats/simulate/image/point_image.h"

namespace adasplats {

/// How the panels of a picture are drawn.
struct PanelLook {
  std::optional<ImageColor> color;  ///< default: chosen for each panel
  int samples_per_axis = 2;
  bool relief = true;    ///< as ImageOptions has it
  bool captions = true;  ///< title, legend, scale and north
};

/// Values at the ends of each colour scale, in world coordinates. Panels of one picture with the
/// same colouring share them.
using SharedRange = std::map<ImageColor, ValueRange>;

/// Whether a file is a splat model, a mesh or a world file; other inputs are points.
bool is_model_file(const std::filesystem::path& input);

/// One part of a picture: a model, points, or points with errors.
class Panel {
 public:
  /// `labels` as load_label_scheme takes it; empty: what the input says. Errors: those of the
  /// input; data (no points).
  Panel(const std::filesystem::path& input, const std::string& labels, Session& session);
  /// Of a model that is loaded already.
  explicit Panel(std::shared_ptr<const ModelScene> model) : model_(std::move(model)) {}

  /// Colours the splats of a model by what held-out beams say of them (evaluate resimulate
  /// --errors); beams that fell through it become dots. Errors: usage (no splat model); data (the
  /// errors are of another model).
  void show_errors(const std::filesystem::path& errors);
  /// The same of errors in memory; `name`: of them in messages.
  void show_errors(const ErrorPoints& errors, const std::filesystem::path& name);

  /// Shows the objects of a world file at this time, or without one when the first begins to move.
  /// Does nothing for others.
  void show_at(std::optional<double> time_s, Session& session);

  ShownPart shown_part() const;
  /// Chooses what the panel shows and its scale: that of `range`, which else gets the panel's own.
  void prepare(const PanelLook& look, SharedRange& range);
  /// Without captions.
  Image draw(const Camera& camera, const PanelLook& look, const Executor& executor) const;
  /// `title`: may be empty. `middle`: where the scale holds; none is drawn without.
  void write_captions(Image& image, const Camera& camera, const std::string& title,
                      std::optional<Vec3d> middle) const;
  /// Title, scale and north alone.
  void write_place(Image& image, const Camera& camera, const std::string& title,
                   std::optional<Vec3d> middle) const;
  /// Null where it is no model.
  const ModelScene* model() const { return model_.get(); }

 private:
  Image draw_model(const Camera& camera, const PanelLook& look) const;
  Image draw_cloud(const Camera& camera, const PanelLook& look, const Executor& executor) const;
  void mark_holes(Image& image, const Camera& camera) const;
  void write_legend(Image& image) const;
  double origin_z() const;
  const Crs& crs() const { return model_ ? model_->crs() : cloud_.crs; }

  std::shared_ptr<const ModelScene> model_;
  std::shared_ptr<ModelScene> world_;  ///< the same, if it has objects
  std::optional<double> shown_s_;      ///< time of show_at()
  PointCloud cloud_;
  std::optional<LabelScheme> labels_;  ///< of the cloud
  std::vector<float> point_errors_m_;  ///< of the cloud's points, where it has them
  std::vector<float> splat_errors_m_;  ///< of the model's splats; NaN: no beam hit it
  std::vector<Vec3d> holes_;           ///< world: measured where beams hit nothing
  ImageColor color_ = ImageColor::shading;
  std::optional<ValueRange> range_;  ///< in the panel's own coordinates
};

/// A black picture.
Image blank_image(int width, int height);

/// Copies `part`, which must fit, into `picture` with its top left corner at (left, top).
void paste(Image& picture, const Image& part, int left, int top);

/// The colours of a picture by class and their names, the most frequent first: at most 14, each of
/// at least 0.1 %. Groups if the scene has no classes.
using ClassLegend = std::vector<std::pair<Rgb, std::string>>;
ClassLegend legend_of(const ImageScene& scene);
ClassLegend legend_of(std::span<const std::uint16_t> classes, const LabelScheme* labels);

}  // namespace adasplats
