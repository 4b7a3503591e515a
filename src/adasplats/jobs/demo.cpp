// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/demo.h"

#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "adasplats/evaluate/error_points.h"
#include "adasplats/io/arrays/png.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/jobs/evaluate/evaluate_resimulation.h"
#include "adasplats/jobs/output/output_folder.h"
#include "adasplats/jobs/pictures/panel.h"
#include "adasplats/jobs/pictures/render.h"
#include "adasplats/jobs/scans/synth.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

/// Paper section "New Trajectory Simulation": the shift of the trajectory, m.
constexpr Vec3d kShift_m = {1, 1, -0.5};
constexpr const char* kDemoLabels = "semantickitti";

/// The paper's thin structures among the classes of SemanticKITTI.
const std::vector<std::string>& thin_classes() {
  static const std::vector<std::string> names = {"fence", "pole", "traffic-sign"};
  return names;
}

ViewChoice street_view(const fs::path& sequence, std::size_t poses, int width) {
  ViewChoice view;
  view.width = width;
  view.height = width * 9 / 16;
  view.trajectory = sequence;
  view.pose = poses / 2;
  return view;
}

/// The results in one picture: the models of all methods by class, and below each the errors of
/// held-out beams, seen from the same position.
class DemoMosaic {
 public:
  DemoMosaic(ViewChoice view, std::size_t methods)
      : view_(std::move(view)),
        picture_(blank_image(view_.width * static_cast<int>(methods), 2 * view_.height)) {}

  void add(const std::string& name, std::shared_ptr<const ModelScene> model,
           const ErrorPoints& errors, Session& session) {
    Panel panel(std::move(model));
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

/// The data that all methods share.
struct Drive {
  fs::path folder;         ///< of the demo
  KittiSequence held_out;  ///< scans that no model was made from
  std::size_t poses() const { return held_out.scans.size(); }
  fs::path mapping() const { return folder / "street" / "mapping.ply"; }
  fs::path sequence() const { return folder / "street" / "sequences" / "00"; }
};

/// Results of one method, with what is drawn: the model, loaded once, and the errors.
struct DemoMethod {
  DemoRow row;
  std::shared_ptr<const ModelScene> scene;
  ErrorPoints errors;  ///< of held-out beams
};

DemoMethod run_method(const std::string& name, SplatMethod method, const Drive& drive,
                      Session& session) {
  DemoMethod result;
  DemoRow& row = result.row;
  row.method = name;

  const std::filesystem::path model_file = drive.folder / (name + ".ply");
  ModelJob model;
  model.inputs = {drive.mapping()};
  model.labels = kDemoLabels;
  model.build.recipe = MethodChoice{.method = method}.recipe();
  row.model = run_model(model, model_file, session);
  result.scene = std::make_shared<const ModelScene>(model_file, "", session);

  SimulateJob simulation;
  simulation.model = model_file;
  simulation.drive.trajectory = drive.sequence();
  simulation.drive.offset_m = kShift_m;
  simulation.output = drive.folder / (name + "-scans");
  row.simulation = run_simulate(simulation, *result.scene, session);

  const CloudPair clouds = load_clouds({simulation.output, drive.mapping(), kDemoLabels}, session);
  row.comparison =
      evaluate_clouds(clouds.simulated, clouds.original, ByClass::own, &*clouds.labels, session);
  row.thin_c2c_m = c2c_of_classes(row.comparison, thin_classes());

  ResimulateOptions held_out;
  held_out.drop_movable = true;  // the models contain no parked cars
  KittiSequence scans = drive.held_out;
  row.held_out = evaluate_resimulation(*result.scene, scans, kDemoLabels, held_out,
                                       {.keep = KeepBeams::yes}, session);
  result.errors = beam_points(std::exchange(row.held_out.errors, {}), scans.trajectory,
                              result.scene->view().primitive_count());
  return result;
}

/// A street-level view from the middle of the drive and one from above.
std::vector<fs::path> draw(const DemoMethod& method, const Drive& drive, Session& session) {
  const std::string& name = method.row.method;
  RenderJob ahead;
  ahead.models = {drive.folder / (name + ".ply")};
  ahead.output = drive.folder / (name + "-street.png");
  ahead.view = street_view(drive.sequence(), drive.poses(), 1280);
  run_render(ahead, method.scene, session);
  RenderJob above;
  above.models = ahead.models;
  above.output = drive.folder / (name + "-above.png");
  above.view.width = 1280;
  above.view.height = 720;
  above.view.birds_eye = true;
  run_render(above, method.scene, session);
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
  Drive drive{folder.path(), {}};
  drive.held_out = open_held_out({.sequence = drive.sequence()}, session);
  DemoMosaic mosaic(street_view(drive.sequence(), drive.poses(), 800), std::size(kSplatMethods));
  for (const auto& [word, method] : kSplatMethods) {
    DemoMethod made = run_method(std::string(word), method, drive, session);
    // For the viewer. Only for our own method: files of all methods would dominate the demo's size.
    if (method == SplatMethod::consistent)
      write_error_points(folder.path() / (made.row.method + "-errors.ply"), made.errors);
    mosaic.add(made.row.method, made.scene, made.errors, session);
    for (const fs::path& picture : draw(made, drive, session)) result.pictures.push_back(picture);
    result.rows.push_back(std::move(made.row));
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
