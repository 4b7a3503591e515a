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
#include "adasplats/simulate/image/posed_scene.h"
#include "adasplats/simulate/scan/scan_rules.h"
#include "adasplats/simulate/scene_engine.h"
#include "adasplats/simulate/world/world_file.h"
#include "adasplats/splats/model/any_model.h"

namespace adasplats {

/// Whether a world file (simulate/world/world_file.h) is accepted instead of a model.
enum class WorldFiles : std::uint8_t { refused, taken };

/// A splat model or a triangle mesh, and what is needed to cast rays into it on the session's
/// device. For a world file: its model, with its objects in world().
class ModelScene final : public ScanScene {
 public:
  /// `labels`: scheme of the classes, as for load_label_scheme; empty: the one in the model's file.
  /// Errors: usage (a world file that is not accepted), config (a world file without a model).
  ModelScene(const std::filesystem::path& file, const std::string& labels, Session& session,
             WorldFiles world_files = WorldFiles::refused);
  /// A model in memory; `labels`: the scheme of its classes.
  ModelScene(AnyModel model, std::optional<LabelScheme> labels, Session& session);
  ModelScene(const ModelScene&) = delete;  // the tracer and the views look into it
  ModelScene& operator=(const ModelScene&) = delete;

  /// Adds objects to a scene without any; `fill` gets an empty world.
  void add_objects(FunctionRef<void(World&)> fill);

  /// Splats or triangles.
  SceneView view() const { return view_of(model_); }
  /// World coordinates of the view's local origin, m.
  Vec3d origin() const override { return origin_of(model_); }
  const Crs& crs() const { return crs_of(model_); }
  const Tracer& tracer() const { return engine_->tracer(); }
  /// Casts rays into what pictures show.
  const Tracer& picture_tracer() const { return picture_engine().tracer(); }
  /// Casts rays into the model, without the objects.
  const SceneCaster& scan_caster() const override { return engine_->scan_caster(); }
  /// Of the model, followed by those of the objects.
  const PrimitiveAttributes& attributes() const { return attributes_; }
  /// The same, created on first use and shared by all sensors in the scene.
  std::shared_ptr<const PrimitiveTable> primitive_table() const override;
  bool has_opacities() const override { return !view().opacities.empty(); }
  float highest_intensity() const override;
  std::size_t prefetch(std::span<const ScanMotion> scans, double reach_m) const override;
  const World* world() const override { return world_ ? &*world_ : nullptr; }
  /// Gives an object other poses (World::move_object()). Not while rays are cast.
  void move_object(std::size_t object, Trajectory trajectory);
  /// Shows or hides an object (World::set_present()). Not while rays are cast.
  void set_object_present(std::size_t object, bool present);
  /// Adds an object of a geometry of the world and returns its number. The attributes change, so
  /// simulators must be made again. Errors: those of World::add_object().
  std::size_t add_object(WorldObject object);
  const AnyModel& model() const { return model_; }
  /// Centers of the splats or vertices of the mesh, relative to origin().
  std::vector<Vec3f> positions() const;
  /// Null if the model is a mesh.
  const SplatModel* splats() const { return std::get_if<SplatModel>(&model_); }
  const Executor& executor() const { return executor_; }
  bool on_gpu() const { return gpu_ != nullptr; }
  /// Null if the scene is on the CPU.
  const GpuScene* gpu() const { return gpu_; }
  const LabelScheme* labels() const override { return labels_ ? &*labels_ : nullptr; }
  /// Pictures from now on show the objects as they are at this time (without a call: no objects).
  /// Builds a tree of scene and objects. Not while pictures are made.
  void show_at(double time_s, Session& session);
  /// For pictures: geometry, attributes and the colours of the classes.
  ImageScene image_scene() const;
  /// The first that the model has: colours, classes with a colour for most of it, intensities, the
  /// paper's groups, heights.
  ImageColor default_color() const;
  /// A picture of image_scene().
  Image render(const Camera& camera, const ImageOptions& options) const;
  /// The same with other values (one a primitive) instead of intensities.
  Image render(const Camera& camera, const ImageOptions& options,
               std::span<const float> values) const;
  std::pair<Vec3d, Vec3d> middle_box() const override;
  /// The part that a picture of it should show.
  ShownPart shown_part() const;

 private:
  void prepare(const std::string& name, Session& session);
  std::unique_ptr<SceneEngine> make_engine(const SceneView& scene, Session& session,
                                           const GpuScene** gpu) const;
  ImageScene place() const;
  const SceneEngine& picture_engine() const { return posed_engine_ ? *posed_engine_ : *engine_; }
  std::shared_ptr<ImageRenderer> renderer(const ImageOptions& options) const;
  /// Errors: std::logic_error (no world).
  World& objects();
  PrimitiveAttributes model_attributes() const;

  const Executor& executor_;
  AnyModel model_;
  std::optional<LabelScheme> labels_;
  std::unique_ptr<SceneEngine> engine_;
  const GpuScene* gpu_ = nullptr;      ///< `engine_`, if it is on a GPU
  std::unique_ptr<PosedScene> posed_;  ///< of show_at()
  std::unique_ptr<SceneEngine> posed_engine_;
  mutable std::shared_ptr<ImageRenderer> renderer_;  ///< of the last options
  mutable ImageOptions renderer_options_;
  std::optional<World> world_;
  PrimitiveAttributes attributes_;
  mutable std::shared_ptr<const PrimitiveTable> primitive_table_;
  mutable std::mutex renderer_mutex_;  ///< of `renderer_` and its options
  mutable std::mutex table_mutex_;     ///< of `primitive_table_`
};

}  // namespace adasplats
