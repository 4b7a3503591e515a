// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "adasplats/jobs/compare/comparison_data.h"

namespace adasplats {
namespace {

using Json = nlohmann::ordered_json;

// All figures are from the paper's tables "Results on PC3D-Paris", "Results on
// SemanticKITTI", "Results on M-City", "Results of the LiDAR simulation on the PC3D-Paris ...
// without resampling" and "Cloud-to-Cloud distance (in cm) computed on PC3D-Paris for points that
// belong to classes of thin structures".

Json row(const char* title, const char* name, Json generate_s, double primitives, double render_hz,
         double lidar_hz, double c2c_m) {
  return {{"title", title},
          {"name", name},
          {"generate_s", std::move(generate_s)},
          {"primitives", primitives},
          {"render_hz", render_hz},
          {"lidar_hz", lidar_hz},
          {"c2c_m", c2c_m}};
}

void add_thin(Json& row, double fence_m, double pole_m, double sign_m) {
  row["thin"] = {{"fence", fence_m}, {"pole", pole_m}, {"traffic-sign", sign_m}};
}

Json pc3d_rows() {
  Json rows = {
      row("Mesh, Poisson", "poisson", 797, 5.20e6, 1000, 232, 0.023),
      row("Mesh, IMLS", "imls", 3216, 6.32e6, 920, 233, 0.020),
      row("Basic splats", "basic", 200, 5.40e6, 100, 135, 0.023),
      row("AdaSplats-Descr", "descriptors", 344, 3.90e6, 160, 181, 0.023),
      row("AdaSplats-KPConv", "kpconv", 1064, 1.75e6, 240, 203, 0.022),
      row("AdaSplats-GT", "semantic", 451, 1.72e6, 250, 205, 0.0197),
      row("AdaSplats-GT, no resampling", "semantic-no-resample", 169, 2.84e6, 0, 180, 0.0199)};
  rows.back()["render_hz"] = nullptr;  // not printed
  add_thin(rows[0], 0.059, 0.061, 0.067);
  add_thin(rows[1], 0.046, 0.035, 0.029);
  add_thin(rows[2], 0.047, 0.043, 0.034);
  add_thin(rows[3], 0.041, 0.037, 0.029);
  add_thin(rows[4], 0.055, 0.021, 0.011);
  add_thin(rows[5], 0.024, 0.023, 0.018);
  add_thin(rows[6], 0.025, 0.024, 0.018);
  return rows;
}

Json kitti_rows() {
  return {row("Mesh, Poisson", "poisson", 796, 5.97e6, 1050, 229, 0.026),
          row("Mesh, IMLS", "imls", 1380, 7.05e6, 1020, 222, 0.030),
          row("Basic splats", "basic", 185, 7.77e6, 170, 144, 0.026),
          row("AdaSplats-Descr", "descriptors", 416, 6.69e6, 200, 156, 0.022),
          row("AdaSplats-KPConv", "kpconv", 1166, 6.11e6, 220, 157, 0.022),
          row("AdaSplats-GT", "semantic", 544, 4.56e6, 240, 180, 0.020)};
}

Json mcity_rows() {
  return {row("Mesh, by hand", "manual", nullptr, 71.5e3, 1930, 259, 0.070),
          row("Basic splats", "basic", 199, 5.82e6, 140, 110, 0.017),
          row("AdaSplats-Descr", "descriptors", 480, 3.92e6, 290, 129, 0.016),
          row("AdaSplats-GT", "semantic", 513, 3.01e6, 440, 204, 0.015)};
}

}  // namespace

Json paper_figures(Preset preset) {
  const char* source = "Richa, Deschaud, Goulette, Dalmasso 2022; NVIDIA RTX 2070 SUPER";
  switch (preset) {
    case Preset::paper_kitti:
      return {{"table", "SemanticKITTI"}, {"source", source}, {"rows", kitti_rows()}};
    case Preset::paper_mcity:
      return {{"table", "M-City"}, {"source", source}, {"rows", mcity_rows()}};
    case Preset::paper_pc3d:
    case Preset::none: break;
  }
  return {{"table", "PC3D-Paris"}, {"source", source}, {"rows", pc3d_rows()}};
}

}  // namespace adasplats
