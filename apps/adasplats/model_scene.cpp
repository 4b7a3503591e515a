// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "model_scene.h"

#include "adasplats/core/error.h"
#include "inputs.h"

namespace adasplats::app {

ModelScene::ModelScene(const std::filesystem::path& file, Session& session) {
  require_input(file);
  session.progress.begin_step("load " + file.filename().string(), 0);
  model_ = load_model(file);
  if (model_.size() == 0) throw Error(ErrorKind::data, file.string() + ": no splats");
  if (!model_.label_scheme.empty()) {
    try {
      labels_ = load_label_scheme(model_.label_scheme);
    } catch (const Error& error) {
      // The scheme only names and colours; geometry and class numbers are in the model.
      session.progress.warn(std::string("labels of the model: ") + error.what());
    }
  }
  session.progress.begin_step("build the ray index", 0);
  tracer_ = make_cpu_tracer(model_.view(), session.executor);
  session.progress.end_step();
}

PrimitiveAttributes ModelScene::attributes() const {
  PrimitiveAttributes attributes;
  attributes.classes = model_.classes;
  attributes.intensities = model_.intensities;
  return attributes;
}

ImageScene ModelScene::image_scene() const {
  ImageScene scene;
  scene.view = model_.view();
  scene.attributes = attributes();
  scene.groups = model_.groups;
  scene.labels = labels_ ? &*labels_ : nullptr;
  scene.origin = model_.origin;
  return scene;
}

}  // namespace adasplats::app
