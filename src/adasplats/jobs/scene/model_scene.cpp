// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/scene/model_scene.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "adasplats/city/city_manifest.h"
#include "adasplats/core/error.h"
#include "adasplats/dataset/scan_values.h"
#include "adasplats/jobs/session/inputs.h"
#include "adasplats/simulate/image/point_colors.h"

namespace adasplats {

namespace {

/// Errors: usage (not accepted), config (without a model).
WorldFile read_scene_file(const std::filesystem::path& file, WorldFiles world_files) {
  if (world_files == WorldFiles::refused)
    throw Error(ErrorKind::usage,
                file.string() + ": a world file is not accepted here; use the model that it names");
  WorldFile world = read_world_file(file);
  if (world.model.empty())
    throw Error(ErrorKind::config,
                file.string() + ": has no model (add a line such as model = \"street.ply\")");
  return world;
}

}  // namespace

double scale_of_intensities(const ScanScene& scene) {
  return intensity_scale_for(double{scene.highest_intensity()});
}

ModelScene::ModelScene(const std::filesystem::path& file, const std::string& labels,
                       Session& session, WorldFiles world_files)
    : executor_(session.executor) {
  require_input(file);
  std::optional<WorldFile> world_file;
  if (file.extension() == ".toml") world_file = read_scene_file(file, world_files);
  if (!labels.empty()) labels_ = load_label_scheme(labels);
  session.progress.begin_step("load " + file.filename().string(), 0);
  model_ = load_any_model_or_city(world_file ? world_file->model : file);
  prepare(file.string(), session);
  if (world_file) {
    add_objects([&](World& world) {
      adasplats::add_objects(world, *world_file, labels_ ? *labels_ : LabelScheme("", {}));
    });
  }
  session.progress.end_step();
}

ModelScene::ModelScene(AnyModel model, std::optional<LabelScheme> labels, Session& session)
    : executor_(session.executor), model_(std::move(model)), labels_(std::move(labels)) {
  prepare(splats() != nullptr ? "the model" : "the mesh", session);
  session.progress.end_step();
}

void ModelScene::prepare(const std::string& name, Session& session) {
  if (view().primitive_count() == 0)
    throw Error(ErrorKind::data, name + ": no " + std::string(primitives_of(model_)));
  if (!labels_) labels_ = load_labels_of_model(label_scheme_of(model_), session.progress);
  session.progress.begin_step("build the ray index", 0);
  engine_ = make_engine(view(), session, &gpu_);
  attributes_ = model_attributes();
}

void ModelScene::add_objects(FunctionRef<void(World&)> fill) {
  world_.emplace(static_cast<std::uint32_t>(view().primitive_count()), origin());
  fill(*world_);
  attributes_ = world_->attributes(model_attributes());
  primitive_table_.reset();
}

World& ModelScene::objects() {
  if (!world_) throw std::logic_error("ModelScene: no objects");
  return *world_;
}

void ModelScene::move_object(std::size_t object, Trajectory trajectory) {
  objects().move_object(object, std::move(trajectory));
}

void ModelScene::set_object_present(std::size_t object, bool present) {
  objects().set_present(object, present);
}

std::size_t ModelScene::add_object(WorldObject object) {
  objects().add_object(std::move(object));
  const std::size_t number = world_->object_count() - 1;
  try {
    attributes_ = world_->attributes(model_attributes());
  } catch (...) {
    world_->set_present(number, false);  // it has no attributes
    throw;
  }
  primitive_table_.reset();
  return number;
}

std::shared_ptr<const PrimitiveTable> ModelScene::primitive_table() const {
  const std::lock_guard lock(table_mutex_);
  if (!primitive_table_)
    primitive_table_ =
        std::make_shared<PrimitiveTable>(adasplats::primitive_table(attributes_, executor_));
  return primitive_table_;
}

float ModelScene::highest_intensity() const {
  float highest = 0;
  for (const float value : attributes_.intensities)
    if (std::isfinite(value)) highest = std::max(highest, value);
  return highest;
}

/// Everything is in memory.
std::size_t ModelScene::prefetch(std::span<const ScanMotion> scans, double) const {
  return scans.size();
}

std::unique_ptr<SceneEngine> ModelScene::make_engine(const SceneView& scene, Session& session,
                                                     const GpuScene** gpu) const {
  std::unique_ptr<SceneEngine> engine;
  const bool on_gpu = try_on_gpu(session.device, session.progress, [&] {
    const bool use_optix = session.device.kind == DeviceKind::optix;
    auto made =
        make_gpu_scene(scene, origin(), use_optix ? TracingBackend::optix : TracingBackend::cuda,
                       session.device.gpu_numbers());
    *gpu = made.get();
    engine = std::move(made);
  });
  return on_gpu ? std::move(engine) : make_cpu_scene_engine(scene, origin(), executor_);
}

void ModelScene::show_at(double time_s, Session& session) {
  const World& world = objects();
  renderer_.reset();
  posed_engine_.reset();  // it looks into the scene of before
  posed_ = std::make_unique<PosedScene>(place(), world, time_s);
  const GpuScene* gpu = nullptr;
  posed_engine_ = make_engine(posed_->scene().view, session, &gpu);
}

PrimitiveAttributes ModelScene::model_attributes() const {
  PrimitiveAttributes attributes;
  attributes.classes = classes_of(model_);
  attributes.intensities = intensities_of(model_);
  attributes.view = view();
  if (const SplatModel* model = splats()) {
    attributes.drop_log_odds = model->drop_log_odds;
    if (!model->response.empty()) attributes.response = &model->response;
  }
  return attributes;
}

ImageScene ModelScene::image_scene() const { return posed_ ? posed_->scene() : place(); }

ImageScene ModelScene::place() const {
  ImageScene scene;
  scene.view = view();
  scene.attributes = model_attributes();
  if (const SplatModel* model = splats()) {
    scene.groups = model->groups;
    scene.colors = model->colors;
  }
  scene.labels = labels_ ? &*labels_ : nullptr;
  scene.origin = origin();
  return scene;
}

ImageColor ModelScene::default_color() const {
  const ImageScene scene = image_scene();
  if (!scene.colors.empty()) return ImageColor::rgb;
  if (const auto color = adasplats::default_color(scene.attributes.classes,
                                                  scene.attributes.intensities, scene.labels))
    return *color;
  return scene.groups.empty() ? ImageColor::height : ImageColor::semantic;
}

/// Kept for the next picture: a GPU's has a copy of the colours of the scene.
std::shared_ptr<ImageRenderer> ModelScene::renderer(const ImageOptions& options) const {
  const std::lock_guard lock(renderer_mutex_);
  if (!renderer_ || !(renderer_options_ == options)) {
    renderer_.reset();  // its memory is free before the next one needs some
    renderer_ = picture_engine().renderer(image_scene(), options);
    renderer_options_ = options;
  }
  return renderer_;
}

Image ModelScene::render(const Camera& camera, const ImageOptions& options) const {
  return renderer(options)->render(camera);
}

Image ModelScene::render(const Camera& camera, const ImageOptions& options,
                         std::span<const float> values) const {
  ImageScene scene = image_scene();
  scene.attributes.intensities = values;
  return picture_engine().renderer(scene, options)->render(camera);
}

std::pair<Vec3d, Vec3d> ModelScene::middle_box() const {
  return adasplats::middle_box(positions(), origin());
}

ShownPart ModelScene::shown_part() const { return adasplats::shown_part(positions(), origin()); }

std::vector<Vec3f> ModelScene::positions() const {
  if (const auto* mesh = std::get_if<MeshModel>(&model_)) return mesh->mesh.vertices;
  const auto& model = std::get<SplatModel>(model_);
  std::vector<Vec3f> centers;
  centers.reserve(model.size());
  for (const Disk& disk : model.disks) centers.push_back(disk.center);
  return centers;
}

}  // namespace adasplats
