// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "adasplats/simulate/image.h"
#include "adasplats/splats/splat_model.h"
#include "adasplats/trace/tracer.h"
#include "session.h"

namespace adasplats::app {

/// A splat model from a file with what is needed to cast rays into it.
class ModelScene {
 public:
  ModelScene(const std::filesystem::path& file, Session& session);

  const SplatModel& model() const { return model_; }
  const Tracer& tracer() const { return *tracer_; }
  PrimitiveAttributes attributes() const;
  /// For pictures: geometry, attributes and the colours of the classes.
  ImageScene image_scene() const;

 private:
  SplatModel model_;
  std::optional<LabelScheme> labels_;
  std::unique_ptr<Tracer> tracer_;
};

}  // namespace adasplats::app
