// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

// Synthetic results of `adasplats compare`, for tests and for trying the page.
namespace adasplats::page {

/// Share and error keys of `evaluate resimulate`, worse with growing `badness`.
inline nlohmann::ordered_json sample_accuracy(double badness, std::size_t rays) {
  const double within = 1 / (1 + badness);
  return {
      {"rays", rays},
      {"no_hit", 0.03 * badness},
      {"early_50cm", 0.02 * badness},
      {"late_50cm", 0.01 * badness},
      {"within",
       {{"0.02", 0.7 * within}, {"0.05", 0.8 * within}, {"0.10", 0.9 * within}, {"0.50", within}}},
      {"range_error_m",
       {{"median", 0.012 * badness}, {"mae", 0.2}, {"rmse", 1.5 * badness}, {"p90", 0.1}}}};
}

/// Groups, each worse than the one before.
inline nlohmann::ordered_json sample_groups(const std::vector<std::string>& names, double badness) {
  nlohmann::ordered_json groups = nlohmann::ordered_json::object();
  std::size_t rays = 400000;
  for (const std::string& name : names) {
    groups[name] = sample_accuracy(badness, rays);
    badness *= 1.4;
    rays /= 2;
  }
  return groups;
}

/// A finished competitor with every key of the schema.
inline nlohmann::ordered_json sample_competitor(const std::string& name, const std::string& title,
                                                double badness) {
  nlohmann::ordered_json c = {{"name", name}, {"title", title}, {"kind", "splats"}};
  c["state"] = "done";
  for (const char* step : {"generate", "render", "simulate", "c2c"}) {
    c["made_by"][step] = {{"version", "0.1.0"},
                          {"commit", "0123456789abcdef0123456789abcdef01234567"},
                          {"dirty", false},
                          {"date", "2026-01-31T12:00:00Z"}};
  }
  c["generate"] = {{"seconds", 23.04 * badness},
                   {"peak_memory_bytes", 1230000000},
                   {"primitives", 5124000 / badness},
                   {"points_used", 9100000},
                   {"command", "adasplats model mapping.ply -o " + name + ".ply"}};
  c["render"] = {{"images_per_second", 1.21 / badness}, {"picture", "pictures/" + name + ".png"}};
  c["simulate"] = {{"scans", 16},
                   {"rays", 2304000},
                   {"hits", 2100000},
                   {"scans_per_second",
                    {{"traced", 43.6 / badness}, {"assembled", 39.5 / badness}, {"written", 32.7}}},
                   {"sensor", "hdl-64-paper"}};
  c["c2c"] = {{"c2c_m", 0.0196 * badness},
              {"completeness_m", 0.18},
              {"chamfer_m", 0.1},
              {"chamfer_m2", 0.42},
              {"f_score", {{"0.05", 0.6 / badness}, {"0.10", 0.8 / badness}, {"0.224", 0.9}}},
              {"by_class", nlohmann::ordered_json::object()},
              {"picture", "pictures/" + name + "-c2c.png"}};
  double class_c2c_m = 0.021 * badness;
  for (const char* c_name : {"road", "building", "vegetation", "fence", "pole", "traffic-sign"}) {
    c["c2c"]["by_class"][c_name] = {{"c2c_m", class_c2c_m},
                                    {"c2c_to_all_m", class_c2c_m / 2},
                                    {"points", 68},
                                    {"original_points", 76563}};
    class_c2c_m *= 1.2;
  }
  c["c2c"]["by_class"]["moving-car"] = {
      {"c2c_m", nullptr}, {"c2c_to_all_m", nullptr}, {"points", 0}, {"original_points", 3254}};
  c["resimulate"] = sample_accuracy(badness, 945368);
  c["resimulate"]["by_range"] =
      sample_groups({"2.5-10 m", "10-20 m", "20-30 m", "30-40 m", "40-50 m"}, badness);
  c["resimulate"]["by_incidence"] =
      sample_groups({"0-30 deg", "30-60 deg", "60-75 deg", "75-90 deg"}, badness);
  c["resimulate"]["by_class"] = sample_groups({"road", "building", "pole"}, badness);
  c["resimulate"]["picture"] = "pictures/" + name + "-beams.png";
  const nlohmann::ordered_json distance = {
      {"mean", 0.03 * badness}, {"median", 0.01 * badness}, {"p95", 0.1}, {"rmse", 0.05}};
  c["truth"] = {{"rays", 945368},
                {"hole_share", 0.02 * badness},
                {"ghost_share", 0.01 * badness},
                {"bleeding_share", 0.015},
                {"surface_distance_m", distance},
                {"range", sample_accuracy(badness, 945368)},
                {"by_class", nlohmann::ordered_json::object()}};
  for (const char* c_name : {"road", "pole"}) {
    c["truth"]["by_class"][c_name] = {
        {"rays", 5000}, {"hole_share", 0.1 * badness}, {"surface_distance_m", distance}};
  }
  return c;
}

/// One failed competitor among four, and five rows of the paper, two of which match none of them.
inline nlohmann::ordered_json sample_results() {
  nlohmann::ordered_json results = {
      {"program", "adasplats"}, {"version", "0.1.0"}, {"schema", 1}, {"title", "sample <street>"}};
  results["data"] = {{"inputs", {"mapping & more.ply"}},
                     {"points", 9400000},
                     {"labels", "semantickitti"},
                     {"held_out", "sequences/01"},
                     {"truth", "mesh.ply"},
                     {"trajectory", "mapping_trajectory.csv"},
                     {"offset_m", {1, 1, -0.5}},
                     {"every", 8},
                     {"preset", "paper-pc3d"}};
  results["machine"] = {{"cpu", "Sample CPU"},
                        {"cores", 2},
                        {"memory_bytes", 24000000000},
                        {"system", "Debian GNU/Linux 12"}};
  results["limits"] = {{"seconds", 3600}, {"memory_bytes", 20000000000}};
  results["command"] = "adasplats compare mapping.ply -o out";
  results["original"] = {{"picture", "pictures/original.png"}};
  nlohmann::ordered_json poisson = {
      {"name", "poisson"},        {"title", "Mesh, Poisson"},  {"kind", "mesh"},
      {"state", "out of memory"}, {"failed_step", "generate"}, {"message", "limit | of 20 GB"}};
  results["competitors"] = {
      sample_competitor("basic", "Basic splats", 1.5), poisson,
      sample_competitor("semantic-no-resample", "Semantic, no resampling", 1.1),
      sample_competitor("semantic", "AdaSplats, semantic", 1)};
  const auto paper = [](const char* name, const char* title, int seconds, double c2c_m) {
    return nlohmann::ordered_json{
        {"name", name},          {"title", title},
        {"generate_s", seconds}, {"primitives", 5400000},
        {"render_hz", 100},      {"lidar_hz", 135},
        {"c2c_m", c2c_m},        {"thin", {{"fence", 0.047}, {"pole", 0.043}}}};
  };
  results["paper"] = {
      {"table", "PC3D-Paris"},
      {"rows",
       {paper("basic", "Basic Splats", 200, 0.023), paper("poisson", "Mesh-Poisson", 797, 0.023),
        paper("imls", "Mesh-IMLS", 3216, 0.020), paper("kpconv", "AdaSplats-KPConv", 1064, 0.022),
        paper("semantic", "AdaSplats-GT", 451, 0.0197)}}};
  results["paper"]["rows"][4]["thin"]["traffic-sign"] = 0.018;
  return results;
}

}  // namespace adasplats::page
