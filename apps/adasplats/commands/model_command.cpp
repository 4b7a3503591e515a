// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "adasplats/io/bags/recording.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/point_format.h"
#include "adasplats/jobs/city/city_addition.h"
#include "adasplats/jobs/city/city_task.h"
#include "adasplats/jobs/city/make_city.h"
#include "adasplats/jobs/city/tile_choice.h"
#include "adasplats/jobs/model/make_model.h"
#include "adasplats/jobs/model/make_traffic.h"
#include "adasplats/jobs/model/unused_settings.h"
#include "adasplats/jobs/output/output_check.h"
#include "adasplats/jobs/provenance/provenance.h"
#include "adasplats/jobs/session/inputs.h"
#include "adasplats/splats/consistent/origin_check.h"
#include "cli/commands.h"
#include "cli/options/option_types.h"
#include "cli/options/setting_options.h"
#include "cli/options/shared_options.h"
#include "cli/terminal.h"
#include "cli/text_table.h"
#include "commands/calibration_text.h"
#include "commands/task_lines.h"

namespace adasplats::app {
namespace {

constexpr const char* kModelExamples =
    "  adasplats model sequences/00 -o model.ply --scans 0:100:2 --remove moving\n"
    "  adasplats model cloud.laz -o model.ply --method semantic --segment\n"
    "  adasplats model strips/ -o city --tile 64 --segment --trajectory drive.csv\n"
    "  adasplats model a.laz b.laz -o city.ply --viewpoint 652000,6861000,60 --report city.json\n"
    "  adasplats model street/mapping.ply -o street.ply --method semantic --labels semantickitti\n"
    "  adasplats model strips/ -o city --tile 64 --plan --trajectory drive.csv > tasks\n";

std::string draft_text(const DraftFacts& draft) {
  const std::string what(draft.of);
  if (draft.every == 1) return "A draft: all " + what + "\n";
  return "A draft: 1 of " + std::to_string(draft.every) + " " + what + "\n";
}

/// How well the sensor positions explain the points; empty without evidence.
std::string origins_text(const std::optional<OriginCheck>& check) {
  if (!check || check->near_rise == 0) return {};
  const bool is_plausible = origin_objection(*check).empty() && origin_doubt(*check).empty();
  return std::string("Sensor positions are ") + (is_plausible ? "plausible" : "doubtful") +
         ": shifted ones make rays cross " + fixed(check->near_rise, 2) + " and " +
         fixed(check->far_rise, 2) + " times as many surfaces\n";
}

/// Splats that are not on the surface; empty without any.
std::string limited_text(const BuildReport& built) {
  const std::size_t limited = built.consistent->splats_limited;
  if (limited == 0) return {};
  const double share = static_cast<double>(limited) / static_cast<double>(built.primitives);
  return "; moved " + grouped(limited) + " splats (" + fixed(100 * share, 1) +
         " %) by the maximum towards their surface";
}

/// The figures of the method.
std::string figures_of(const BuildReport& built) {
  if (!built.consistent) {
    return grouped(built.points_noise) + " noisy points removed, " +
           grouped(built.points_resampled) + " resampled, R " + centimetres(built.radius_m) +
           ", E " + centimetres(built.error_m);
  }
  const ConsistentReport& report = *built.consistent;
  const std::string seeds = grouped(report.cells) + " cells, " + grouped(report.seeds) + " seeds";
  if (!report.checked)
    return seeds + ", no visibility check (no measured rays)" + limited_text(built);
  const std::string empty_beams =
      report.empty_beams == 0 ? ""
                              : " and " + grouped(report.empty_beams) + " beams without return";
  return seeds + "; removed " + grouped(report.seeds_removed) + " seeds that contradict " +
         grouped(report.rays) + " measured rays" + empty_beams + ", restored " +
         grouped(report.splats_filled) + " where rays missed all splats" + limited_text(built);
}

std::string segmentation_text(const SegmentReport& segmented) {
  constexpr std::size_t kDigits = 12;
  return "classified by the network " + segmented.network.name + " (SHA-256 " +
         segmented.network.sha256.substr(0, kDigits) + "...), " + grouped(segmented.classes.cells) +
         " cells in " + grouped(segmented.classes.tiles) + " tiles" +
         (segmented.replaced_labels ? "; labels in the input were replaced\n" : "\n");
}

class ModelCommand final : public Command {
 public:
  explicit ModelCommand(CLI::App& program)
      : Command(program, "model", "Turn point clouds and recordings into a splat model",
                kModelExamples) {
    OptionSet& app = options();
    require(add_paths(app, "INPUT", job_.inputs,
                      "Point files (" + point_format_names() +
                          "), SemanticKITTI sequence folders and recordings (" +
                          recording_format_names() + ", PCAP)"));
    require(writes(add_path(app, "-o,--output", job_.output,
                            "Model to write, PLY; with --tile or --traffic: a folder"),
                   {".ply", ""}));
    app.add_flag(
        "--traffic", traffic_,
        "Also model moving objects and their trajectories, from --boxes or detected automatically; "
        "the output is a folder with a world file");
    app.add_flag("--overwrite", job_.overwrite, "Replace an existing city or world");
    add_settings(app, job_.tiles);
    visit_settings(job_.memory, [&app](const Setting& setting, double& value) {
      add_memory(app, setting, value)->group(setting.group);
    });
    app.add_flag(
           "--keep-points", job_.keep_points,
           "With --tile: keep the points in the city's folder, so that more can be added later")
        ->group("Cities");
    add_path(app, "--add-to", job_.add_to,
             "Add the points to a city made with --keep-points; the output is a city of both, with "
             "the same tiles and options")
        ->group("Cities");
    add_settings(app, job_.addition);
    app.add_flag("--plan", plan_,
                 "With --tile: prepare the tiles and print one command per tile, to be run by many "
                 "processes or machines; the same command without --plan finishes the city")
        ->group("Cities");
    app.add_option_function<std::string>(
           "--only-tile", [this](const std::string& name) { only_tile_ = parse_tile(name); },
           "Model only this tile of a planned city, such as x3_y-2")
        ->type_name("TILE")
        ->group("Cities");
    add_labels_option(app, job_.labels, "semantickitti for sequence folders, else none");
    add_settings(app, job_.segment);
    add_settings(app, job_.draft);
    add_settings(app, recipe_);
    add_removal_option(app, job_.build.remove);
    add_switch(
        app, "--reflectance,!--no-reflectance", job_.build.reflectances,
        "Convert intensities to reflectances by removing the effects of range and incidence, "
        "which simulate applies again");
    add_settings(app, job_.calibration);
    add_load_options(app, job_.load);
    add_device_options();
  }

  void run(Session& session) override {
    for (const auto& list : {unused_settings(job_.draft, recipe_), unused_settings(recipe_),
                             unused_settings(job_.segment)}) {
      for (const UnusedSetting& unused : list)
        reject({option_of(unused.setting).c_str()}, unused.why);
    }
    job_.build.recipe = recipe_.recipe();
    job_.removal_is_asked = is_given("--remove");
    // OptiX only casts rays; models are made on CUDA.
    if (session.device.kind == DeviceKind::optix) session.device.kind = DeviceKind::cuda;
    if (job_.add_to.empty())
      reject({"--max-shift"}, "without --add-to");
    else if (is_given("--tile") && job_.tiles.tile_m == 0)
      reject({"--add-to"}, "with --tile 0");
    if (job_.draft.on)
      reject({"--traffic", "--tile", "--memory", "--only-tile", "--add-to"}, "in a draft");
    if (traffic_) {
      reject({"--tile", "--halo", "--plan", "--only-tile", "--keep-points", "--add-to", "--memory"},
             "with --traffic");
      require_folder_apart(job_.output, job_.inputs);
      run_traffic_of(session);
      return;
    }
    if (!job_.add_to.empty())
      take_tiles_of_city();
    else if (!is_given("--tile") && !only_tile_ && !job_.draft.on)
      choose_tiles(session);
    if (job_.tiles.tile_m > 0) {
      if (recipe_.consistent.refine) reject({"--refine"}, "in tiles, which are opaque");
      require_folder_apart(job_.output, job_.inputs);
      if (!job_.add_to.empty())
        require_folder_apart(job_.output, std::vector<std::filesystem::path>{job_.add_to});
      if (only_tile_)
        run_tile(session);
      else if (plan_)
        run_plan(session);
      else
        run_city(session);
      return;
    }
    if (job_.memory.memory_gb == 0 || is_given("--tile"))
      reject({"--halo", "--overwrite", "--plan", "--only-tile", "--keep-points"}, "without --tile");
    // If the output exists and is no regular file, run_model reports that instead.
    if (!std::filesystem::exists(job_.output) || std::filesystem::is_regular_file(job_.output))
      require_ending(job_.output, ".ply");
    const ModelResult result = run_model(job_, job_.output, session);
    session.report.update(to_json(result));
    TextTable table({"step", "seconds"});
    for (const StepTime& step : result.steps) table.add_row({step.name, fixed(step.seconds, 2)});
    table.add_row({"total", fixed(result.seconds, 2)});
    const BuildReport& built = result.built;
    print(table.text() + "\n" + job_.output.string() + ": " + grouped(built.primitives) +
          " splats from " + grouped(built.points_in) + " points, " + grouped(built.points_dynamic) +
          " of them removed by class" + text_of(built.removed_classes) + "\n" +
          (result.draft ? draft_text(*result.draft) : "") +
          (result.segmented ? segmentation_text(*result.segmented) : "") + figures_of(built) +
          "\n" + (built.consistent ? origins_text(built.consistent->origins) : "") +
          (result.calibrated ? calibration_text(*result.calibrated, result.calibration) : ""));
  }

 private:
  /// Chooses tiles if the inputs do not fit into memory.
  void choose_tiles(Session& session) {
    const bool can_be_tiles = std::holds_alternative<ConsistentOptions>(job_.build.recipe);
    const bool is_asked = is_given("--memory") || (can_be_tiles && is_given("--gpu-memory"));
    if (!can_be_tiles && !is_asked) return;
    for (const std::filesystem::path& input : job_.inputs) require_input(input);
    const TileAdvice advice = advise_tiles(job_, session);
    if (advice.tile_m == 0) {
      if (is_asked && job_.output.extension() != ".ply")
        throw Error(ErrorKind::usage,
                    "the points fit into the memory as one model; name a file (-o " +
                        job_.output.filename().string() +
                        ".ply), or use --tile 64 for a folder of tiles");
      return;
    }
    const auto gigabytes = [](double gb) { return fixed(gb, gb < 1 ? 4 : 1) + " GB"; };
    const std::string why = "about " + grouped(static_cast<std::size_t>(advice.points)) +
                            " points need about " + gigabytes(advice.need_gb) +
                            " as one model, more than the " + gigabytes(advice.memory_gb) +
                            (advice.of_gpu          ? " of the GPU"
                             : is_given("--memory") ? " of --memory"
                                                    : " of available memory");
    if (!can_be_tiles)
      throw Error(ErrorKind::usage, why + "; only the method consistent can model tiles");
    if (job_.output.extension() == ".ply")
      throw Error(ErrorKind::usage,
                  why + ": name a folder (-o " + job_.output.stem().string() +
                      ") for a model in tiles, or use --tile 0 for one model all the same");
    job_.tiles.tile_m = advice.tile_m;
    job_.memory.tiles_at_once = advice.at_once;
    session.report["tile_m"] = advice.tile_m;
    session.progress.warn(why + "; modelling in tiles of " + fixed(advice.tile_m, 0) + " m");
  }

  /// Uses the tile options of the city that points are added to, unless they are given.
  void take_tiles_of_city() {
    if (is_given("--tile") && is_given("--halo")) return;
    const TileChoice tiles = tiles_of_city(job_.add_to);
    if (!is_given("--tile")) job_.tiles.tile_m = tiles.tile_m;
    if (!is_given("--halo")) job_.tiles.halo_m = tiles.halo_m;
  }

  /// The command line, with the tiles that were chosen.
  std::vector<std::string> words_with_tiles() const {
    std::vector<std::string> words = own_arguments();
    if (!is_given("--tile")) words.insert(words.end(), {"--tile", decimal_text(job_.tiles.tile_m)});
    if (!is_given("--halo") && !job_.add_to.empty())
      words.insert(words.end(), {"--halo", decimal_text(job_.tiles.halo_m)});
    return words;
  }

  static TileKey parse_tile(const std::string& name) {
    const std::optional<TileKey> tile = tile_named(name);
    if (!tile)
      reject_value("--only-tile",
                   "expected the name of a tile such as x3_y-2, found '" + name + "'");
    return *tile;
  }

  void run_plan(Session& session) {
    const TaskLines lines(words_with_tiles(), false);
    std::string text;
    session.report["tasks"] = nlohmann::ordered_json::array();
    for (const TileKey tile : plan_city(job_, session)) {
      text += lines.task("--only-tile", name_of(tile));
      session.report["tasks"].push_back(name_of(tile));
    }
    print(text + lines.last());
  }

  void run_tile(Session& session) {
    reject({"--plan"}, "with --only-tile");
    const CityTaskResult result = make_city_tile(job_, *only_tile_, session);
    session.report["tile"] = name_of(*only_tile_);
    session.report["was_done"] = result.was_done;
    print(job_.output.string() + ": " + result.file +
          (result.was_done ? " already done\n" : " done\n"));
  }

  void run_traffic_of(Session& session) {
    const TrafficResult result = run_traffic(job_, job_.output, job_.overwrite, session);
    session.report.update(to_json(result));
    TextTable table({"object", "scans", "points", "splats", "shift of boxes"});
    for (const TrafficObject& object : result.objects)
      table.add_row({object.name, grouped(object.scans), grouped(object.points),
                     object.left_out.empty() ? grouped(object.splats) : object.left_out,
                     object.is_at_rest ? "at rest" : centimetres(object.aligned.median_shift_m)});
    std::size_t moving = 0, at_rest = 0, beams = 0, open_beams = 0;
    for (const TrafficObject& object : result.objects) {
      if (object.left_out.empty()) ++(object.is_at_rest ? at_rest : moving);
      beams += object.beams;
      open_beams += object.open_beams;
    }
    print((result.objects.empty() ? std::string() : table.text() + "\n") +
          (job_.output / "world.toml").string() + ": " + grouped(result.scene.built.primitives) +
          " splats, " + grouped(moving) + " moving objects and " + grouped(at_rest) + " at rest; " +
          grouped(result.objects.size() - moving - at_rest) + " left out\n" +
          (at_rest == 0
               ? std::string()
               : "Without those at rest, " + grouped(open_beams) + " of the " + grouped(beams) +
                     " beams on them hit nothing: no scan saw " + "what is behind\n"));
  }

  void run_city(Session& session) {
    const CityResult result = make_city(job_, session);
    session.report.update(to_json(result));
    TextTable table({"step", "seconds"});
    for (const StepTime& step : result.steps) table.add_row({step.name, fixed(step.seconds, 2)});
    table.add_row({"total", fixed(result.seconds, 2)});
    print(table.text() + "\n" + job_.output.string() + ": " + grouped(result.city.splats()) +
          " splats in " + grouped(result.city.tiles.size()) + " tiles of " +
          fixed(job_.tiles.tile_m, 0) + " m from " + grouped(result.city.points()) + " points" +
          (result.tiles_resumed == 0 ? std::string()
                                     : ", " + grouped(result.tiles_resumed) +
                                           " of the tiles were made by an earlier run") +
          "\n" + addition_text(result) +
          (result.segmented ? segmentation_text(*result.segmented) : "") +
          origins_text(result.origins));
  }

  /// How added points fit the city.
  std::string addition_text(const CityResult& result) const {
    if (!result.fit) return "";
    const PointFit& fit = *result.fit;
    std::string text = grouped(result.tiles_kept) + " tiles unchanged from " +
                       job_.add_to.string() + ", the others modelled again; ";
    if (result.alignment && result.alignment->aligned > 0)
      text += grouped(result.alignment->aligned) + " of " + grouped(result.alignment->groups) +
              " groups of ten scans aligned to it, shifted by " +
              centimetres(result.alignment->median_shift_m) + " (median) and up to " +
              centimetres(result.alignment->largest_shift_m) + "; ";
    if (fit.parts > 0)
      text += "new points are offset by " + centimetres(length(fit.shift_m)) +
              " from it, single tiles by up to " + centimetres(fit.part_shift_m);
    else
      text += "the new points hardly overlap with it";
    return text + "\n";
  }

  CityJob job_;
  MethodChoice recipe_;
  bool plan_ = false;
  bool traffic_ = false;
  std::optional<TileKey> only_tile_;
};

}  // namespace

std::unique_ptr<Command> make_model_command(CLI::App& program) {
  return std::make_unique<ModelCommand>(program);
}

}  // namespace adasplats::app
