// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/core/function_ref.h"
#include "adasplats/gpu/simulate/gpu_scene.h"
#include "adasplats/jobs/scene/scan_scene.h"
#include "adasplats/jobs/scene/shown_part.h"
#include "adasplats/jobs/session/session.h"
#include "adasplats/simulate/scan/scan_rules.h"
#include "adasplats/simulate/scene_engine.h"
#include "adasplats/simulate/world/world_file.h"
#include "adasplats/splats/model/any_model.h"

namespace adasplats {

/// Whether a world file (simulate/world/world_file.h) may stand in a model's place.
enum class WorldFiles : std::uint8_t { refused, taken };

/// A splat model or a triangle mesh from a file with what is needed to cast rays into it, on
/// the session's device. A world file: its place, and what was put there as `world`.
class ModelScene final : public ScanScene {
 public:
  /// `labels` as load_label_scheme takes it names the classes; empty: what the model's file says.
  /// Errors: usage (a world file where they are refused, or that names no model).
  ModelScene(const std::filesystem::path& file, const std::string& labels, Session& session,
             WorldFiles world_files = WorldFiles::refused);
  /// A model in memory; `labels`: what its classes mean.
  ModelScene(AnyModel place, std::optional<LabelScheme> labels, Session& session);
  ModelScene(const ModelScene&) = delete;  // the tracer and the views look into it
  ModelScene& operator=(const ModelScene&) = delete;

  /// Puts objects into the place, which has none yet; `fill` gets a world without any.
  void add_objects(FunctionRef<void(World&)> fill);

  /// Splats or triangles.
  SceneView view() const { return view_of(place_); }
  /// World coordinates of the view's local origin, m.
  Vec3d origin() const override { return origin_of(place_); }
  const Crs& crs() const { return crs_of(place_); }
  const Tracer& tracer() const { return engine_->tracer(); }
  /// Of the place without its objects.
  const SceneCaster& scan_caster() const override { return engine_->scan_caster(); }
  /// Of the place and, behind it, its objects.
  const PrimitiveAttributes& attributes() const { return attributes_; }
  /// The same, made when it is first asked for. It is shared by all sensors in the scene.
  std::shared_ptr<const PrimitiveTable> primitive_table() const override;
  float highest_intensity() const override;
  std::size_t prefetch(std::span<const ScanMotion> scans, double reach_m) const override;
  /// What was put into the place; null where nothing was.
  const World* world() const override { return world_ ? &*world_ : nullptr; }
  /// Gives an object of the world other poses (World::move_object()). Not while it is cast.
  void move_object(std::size_t object, Trajectory trajectory);
  const AnyModel& place() const { return place_; }
  /// Null where it is a mesh.
  const SplatModel* splats() const { return std::get_if<SplatModel>(&place_); }
  const Executor& executor() const { return executor_; }
  bool on_gpu() const { return gpu_ != nullptr; }
  /// Null where it is on the CPU.
  const GpuScene* gpu() const { return gpu_; }
  /// What the classes mean; null where that is not known.
  const LabelScheme* labels() const override { return labels_ ? &*labels_ : nullptr; }
  /// For pictures: geometry, attributes and the colours of the classes.
  ImageScene image_scene() const;
  /// By class where most of the model has one with a colour, else by intensity, by the paper's
  /// groups, by height: the first that it has.
  ImageColor default_color() const;
  /// A picture of image_scene().
  Image render(const Camera& camera, const ImageOptions& options) const;
  /// The same with other values (one a primitive) in the place of intensities.
  Image render(const Camera& camera, const ImageOptions& options,
               std::span<const float> values) const;
  /// World box of the middle 98 % of the splats or vertices along each axis: far outliers must not
  /// decide what a picture shows.
  std::pair<Vec3d, Vec3d> middle_box() const override;
  /// What a picture of it should show.
  ShownPart shown_part() const;

 private:
  void prepare(const std::string& name, Session& session);
  void make_engine(Session& session);
  std::shared_ptr<ImageRenderer> renderer(const ImageOptions& options) const;
  PrimitiveAttributes place_attributes() const;
  std::vector<Vec3f> disk_centers() const;

  const Executor& executor_;
  AnyModel place_;
  std::optional<LabelScheme> labels_;
  std::unique_ptr<SceneEngine> engine_;
  const GpuScene* gpu_ = nullptr;                    ///< `engine_`, if it is on a GPU
  mutable std::shared_ptr<ImageRenderer> renderer_;  ///< of the last options
  mutable ImageOptions renderer_options_;
  std::optional<World> world_;
  PrimitiveAttributes attributes_;
  mutable std::shared_ptr<const PrimitiveTable> primitive_table_;
  mutable std::mutex renderer_mutex_;  ///< of `renderer_` and its options
  mutable std::mutex table_mutex_;     ///< of `primitive_table_`
};

}  // namespace adasplats
