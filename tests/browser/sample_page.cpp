// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Makes report.html and report.md in FOLDER: of FOLDER/compare.json where it is, else of made-up
// results with made-up pictures. usage: adasplats_report_page_sample FOLDER
#include <array>
#include <exception>
#include <fstream>
#include <iostream>
#include <vector>

#include "adasplats/io/arrays/png.h"
#include "adasplats/report/report_page.h"
#include "adasplats/report/sample_results_test.h"

namespace {

using adasplats::page::sample_results;

constexpr int kWidth = 320;
constexpr int kHeight = 180;

/// A gradient that differs from picture to picture.
void write_gradient(const std::filesystem::path& path, int seed) {
  std::vector<std::uint8_t> pixels;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      for (const int value : {x * 255 / kWidth, y * 255 / kHeight, seed * 47 % 256}) {
        pixels.push_back(static_cast<std::uint8_t>(value));
      }
    }
  }
  adasplats::write_png(path, kWidth, kHeight, pixels);
}

nlohmann::ordered_json made_up(const std::filesystem::path& folder) {
  nlohmann::ordered_json results = sample_results();
  results["scales"]["c2c"] = {{"colors", {"#30123b", "#28bceb", "#a4fc3c", "#fb7e21", "#7a0403"}},
                              {"from", "0 cm"},
                              {"to", "20 cm and more"}};
  std::filesystem::create_directories(folder / "pictures");
  int seed = 0;
  write_gradient(folder / results["original"]["picture"].get<std::string>(), seed);
  for (auto& competitor : results["competitors"]) {
    for (const char* step : {"render", "c2c", "resimulate"}) {
      if (!competitor.contains(step)) continue;
      write_gradient(folder / competitor[step]["picture"].get<std::string>(), ++seed);
    }
  }
  std::filesystem::remove(folder / "pictures/semantic-beams.png");  // one that is missing
  return results;
}

void make_pages(const std::filesystem::path& folder) {
  std::ifstream given(folder / "compare.json");
  const auto results = given ? nlohmann::ordered_json::parse(given) : made_up(folder);
  std::ofstream(folder / "report.html") << adasplats::report_html(results, folder);
  std::ofstream(folder / "report.md") << adasplats::report_markdown(results);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::cerr << "usage: adasplats_report_page_sample FOLDER\n";
    return 64;
  }
  try {
    make_pages(arguments[1]);
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 65;
  }
  return 0;
}
