// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/recipes/demo.h"

#include <nlohmann/json.hpp>

#include "adasplats/evaluate/error_points.h"
#include "adasplats/io/arrays/png.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/pipeline/evaluate/evaluate_resimulation.h"
#include "adasplats/pipeline/output/output_folder.h"
#include "adasplats/pipeline/provenance/metrics_json.h"
#include "adasplats/recipes/demo_page.h"
#include "adasplats/recipes/pictures/mosaic.h"
#include "adasplats/recipes/pictures/panel.h"
#include "adasplats/recipes/pictures/render.h"
#include "adasplats/recipes/synth_street.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

/// Paper section "New Trajectory Simulation": the shift of the trajectory, m.
constexpr Vec3d kShift_m = {1, 1, -0.5};

/// The paper's thin structures among the classes of SemanticKITTI.
const std::vector<std::string>& thin_classes() {
  static const std::vector<std::string> names = {"fence", "pole", "traffic-sign"};
  return names;
}

ViewChoice street_view(const fs::path& folder, std::size_t poses, int width) {
  ViewChoice view;
  view.width = width;
  view.height = width * 9 / 16;
  view.trajectory = folder / "street" / "sequences" / "00";
  view.pose = poses / 2;
  return view;
}

/// What the demo is about in one picture: all methods by class, and below what the held-out beams
/// say of them, from the same place of the street.
class DemoMosaic {
 public:
  DemoMosaic(ViewChoice view, std::size_t methods)
      : view_(std::move(view)),
        picture_(blank_image(view_.width * static_cast<int>(methods), 2 * view_.height)) {}

  void add(const std::string& name, const fs::path& model, const ErrorPoints& errors,
           Session& session) {
    Panel panel(model, "", session);
    const Camera camera = camera_of(view_, panel.shown_part());
    for (int row = 0; row < 2; ++row) {
      if (row == 1) panel.show_errors(errors, name);
      SharedRange range;
      panel.prepare({}, range);
      Image part = panel.draw(camera, {}, session.executor);
      panel.write_captions(part, camera, row == 0 ? name : name + ": errors of held-out beams", {});
      paste(picture_, part, left_, view_.height * row);
    }
    left_ += view_.width;
  }

  const Image& picture() const { return picture_; }

 private:
  ViewChoice view_;
  Image picture_;
  int left_ = 0;
};

DemoRow run_method(const std::string& name, SplatMethod method, const fs::path& folder,
                   DemoMosaic& mosaic, Session& session) {
  const fs::path street = folder / "street";
  DemoRow row;
  row.method = name;

  ModelFileJob model;
  model.inputs = {street / "mapping.ply"};
  model.output = folder / (name + ".ply");
  model.labels = "semantickitti";
  model.build.recipe = RecipeChoice{.method = method}.recipe();
  row.model = run_model(model, session);

  SimulateJob simulation;
  simulation.model = model.output;
  simulation.drive.trajectory = street / "sequences" / "00";
  simulation.drive.offset_m = kShift_m;
  simulation.output = folder / (name + "-scans");
  row.simulation = run_simulate(simulation, session);

  const CloudPair clouds =
      load_clouds({simulation.output, street / "mapping.ply", model.labels}, session);
  row.comparison =
      evaluate_clouds(clouds.simulated, clouds.original, ByClass::own, &*clouds.labels, session);
  row.thin_c2c_m = c2c_of_classes(row.comparison, thin_classes());

  ResimulateOptions held_out;
  held_out.drop_movable = true;  // parked cars are not in the models
  KittiSequence scans = open_held_out({.sequence = simulation.drive.trajectory}, session);
  const ModelScene scene(model.output, "", session);
  row.held_out = evaluate_resimulation(scene, scans, model.labels, held_out, {}, session);
  const ErrorPoints errors =
      beam_points(scene.tracer(), scene.view(), scene.origin(), scans,
                  load_label_scheme(model.labels), held_out, session.executor, session.progress);
  // Of our own method for the viewer; of all they would be the larger part of the demo.
  if (method == SplatMethod::consistent)
    write_error_points(folder / (name + "-errors.ply"), errors);
  mosaic.add(name, model.output, errors, session);
  return row;
}

/// A street-level view from the middle of the drive and one from above.
std::vector<fs::path> draw(const std::string& name, std::size_t poses, const fs::path& folder,
                           Session& session) {
  RenderJob ahead;
  ahead.models = {folder / (name + ".ply")};
  ahead.output = folder / (name + "-street.png");
  ahead.view = street_view(folder, poses, 1280);
  run_render(ahead, session);
  RenderJob above;
  above.models = ahead.models;
  above.output = folder / (name + "-above.png");
  above.view.width = 1280;
  above.view.height = 720;
  above.view.birds_eye = true;
  run_render(above, session);
  return {ahead.output.filename(), above.output.filename()};
}

}  // namespace

DemoResult run_demo(const DemoJob& job, Session& session) {
  OutputFolder folder(job.output, job.overwrite, "demo",
                      {{"seed", session.seed}, {"points", job.points}});

  SynthJob synth;
  synth.output = folder.path() / "street";
  synth.scan.points = job.points;
  synth.scan.driving_spacing_m = job.driving_spacing_m;
  DemoResult result;
  result.street = run_synth_street(synth, session);
  DemoMosaic mosaic(street_view(folder.path(), result.street.driving_scans, 800),
                    std::size(kSplatMethods));
  for (const auto& [word, method] : kSplatMethods) {
    const std::string name(word);
    result.rows.push_back(run_method(name, method, folder.path(), mosaic, session));
    for (const fs::path& picture :
         draw(name, result.street.driving_scans, folder.path(), session)) {
      result.pictures.push_back(picture);
    }
  }
  result.picture = "demo.png";
  write_png(folder.path() / result.picture, mosaic.picture().width, mosaic.picture().height,
            mosaic.picture().pixels);
  result.page = "index.html";
  write_file(folder.path() / result.page, demo_page(result, folder.path(), job.output));
  folder.commit();
  return result;
}

nlohmann::ordered_json to_json(const DemoResult& result) {
  nlohmann::ordered_json json;
  json["street"] = to_json(result.street);
  for (const DemoRow& row : result.rows) {
    auto& method = json["methods"][row.method];
    method["model"] = to_json(row.model);
    method["simulate"] = to_json(row.simulation);
    method["c2c"] = to_json(row.comparison);
    method["thin_c2c_m"] = row.thin_c2c_m;
    method["resimulate"] = to_json(row.held_out);
  }
  json["picture"] = result.picture.string();
  json["page"] = result.page.string();
  for (const fs::path& picture : result.pictures) json["pictures"].push_back(picture.string());
  return json;
}

}  // namespace adasplats
