// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "adasplats/jobs/scene/city_scene.h"
#include "adasplats/jobs/scene/model_scene.h"
#include "adasplats/view/city_picker.h"
#include "adasplats/view/view_scene.h"
#include "commands/view_job.h"

namespace adasplats::app {

/// What the page is shown, and the model that it is simulated in.
struct LoadedView {
  std::unique_ptr<ModelScene> model;   ///< null: a city, or points alone
  std::unique_ptr<CityScene> city;     ///< null: not one that stays on disk
  std::unique_ptr<CityPicker> picker;  ///< likewise
  ViewScene scene;                     ///< looks into these
};

/// Finds out what the inputs are and loads them. Errors: usage (a folder with several models or
/// nothing to show, a world file as a layer), those of loading.
LoadedView load_view(const ViewJob& job, Session& session);

}  // namespace adasplats::app
