// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/recipes/demo.h"

#include <nlohmann/json.hpp>

#include "adasplats/pipeline/evaluate/evaluate_resimulation.h"
#include "adasplats/pipeline/output/output_folder.h"
#include "adasplats/pipeline/provenance/metrics_json.h"
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

DemoRow run_method(const std::string& name, SplatMethod method, const fs::path& folder,
                   Session& session) {
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
  row.held_out = evaluate_resimulation(ModelScene(model.output, "", session), scans, model.labels,
                                       held_out, {}, session);
  return row;
}

/// A street-level view from the middle of the drive and one from above.
std::vector<fs::path> draw(const std::string& name, std::size_t poses, const fs::path& folder,
                           Session& session) {
  RenderJob ahead;
  ahead.models = {folder / (name + ".ply")};
  ahead.output = folder / (name + "-street.png");
  ahead.view.trajectory = folder / "street" / "sequences" / "00";
  ahead.view.pose = poses / 2;
  run_render(ahead, session);
  RenderJob above;
  above.models = ahead.models;
  above.output = folder / (name + "-above.png");
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
  for (const auto& [word, method] : kSplatMethods) {
    const std::string name(word);
    result.rows.push_back(run_method(name, method, folder.path(), session));
    for (const fs::path& picture :
         draw(name, result.street.driving_scans, folder.path(), session)) {
      result.pictures.push_back(picture);
    }
  }
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
  for (const fs::path& picture : result.pictures) json["pictures"].push_back(picture.string());
  return json;
}

}  // namespace adasplats
