// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/options/option_types.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <span>
#include <string_view>
#include <utility>

namespace adasplats::app {
namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

template <class T>
bool parse_whole(const std::string& text, T& number) {
  const char* end = text.data() + text.size();
  const auto [stop, failure] = std::from_chars(text.data(), end, number);
  return failure == std::errc() && stop == end;
}

std::string short_number(double number) {
  std::array<char, 32> text{};
  const auto [end, failure] = std::to_chars(text.data(), text.data() + text.size(), number);
  return {text.data(), end};
}

/// "1,2.5,-3": three finite numbers, the value of `option`.
std::array<double, 3> parse_three(const std::string& option, const std::string& text) {
  const std::vector<std::string> parts = split(text, ',');
  std::array<double, 3> numbers{};
  bool good = parts.size() == numbers.size();
  for (std::size_t i = 0; good && i < parts.size(); ++i) {
    good = parse_whole(parts[i], numbers[i]) && std::isfinite(numbers[i]);
  }
  if (!good) {
    reject_value(option, "expected three numbers with commas between them, found '" + text + "'");
  }
  return numbers;
}

/// "1,2", "1,2,3", "1,2,3,90" or "1,2,,90": finite numbers, a part of the value of `option`.
SensorPlace parse_place(const std::string& option, const std::string& text) {
  const std::vector<std::string> parts = split(text, ',');
  std::array<double, 4> numbers{};
  const bool has_z = parts.size() > 2 && !(parts.size() == 4 && parts[2].empty());
  bool good = parts.size() >= 2 && parts.size() <= numbers.size();
  for (std::size_t i = 0; good && i < parts.size(); ++i) {
    if (i == 2 && !has_z) continue;
    good = parse_whole(parts[i], numbers[i]) && std::isfinite(numbers[i]);
  }
  if (!good)
    reject_value(option, "expected X,Y, X,Y,Z, X,Y,Z,YAW or X,Y,,YAW, found '" + text + "'");
  SensorPlace place{numbers[0], numbers[1], {}, numbers[3]};
  if (has_z) place.z_m = numbers[2];
  return place;
}

}  // namespace

ScanRange parse_scan_range(const std::string& option, const std::string& text) {
  const std::vector<std::string> parts = split(text, ':');
  ScanRange range;
  bool good = parts.size() == 2 || parts.size() == 3;
  good = good && parse_whole(parts[0], range.first) && parse_whole(parts[1], range.count);
  if (good && parts.size() == 3) good = parse_whole(parts[2], range.stride);
  if (!good || range.count == 0 || range.stride == 0) {
    reject_value(option, "expected FIRST:COUNT[:STRIDE], found '" + text + "'");
  }
  return range;
}

Option* add_scan_range(OptionSet& app, const std::string& name, ScanRange& target,
                       const std::string& help) {
  return app
      .add_option_function<std::string>(
          name, [&target, name](const std::string& text) { target = parse_scan_range(name, text); },
          help)
      ->type_name("FIRST:COUNT[:STRIDE]");
}

Option* add_path(OptionSet& app, const std::string& name, std::filesystem::path& target,
                 const std::string& help) {
  return app
      .add_option_function<std::string>(
          name, [&target](const std::string& text) { target = text; }, help)
      ->type_name("PATH")
      ->default_str(target.string());
}

Option* add_paths(OptionSet& app, const std::string& name,
                  std::vector<std::filesystem::path>& target, const std::string& help) {
  return app
      .add_option_function<std::vector<std::string>>(
          name,
          [&target](const std::vector<std::string>& names) {
            target.assign(names.begin(), names.end());
          },
          help)
      ->type_name("PATH");
}

Option* add_vector(OptionSet& app, const std::string& name, std::optional<Vec3d>& target,
                   const std::string& help) {
  return app
      .add_option_function<std::string>(
          name,
          [&target, name](const std::string& text) {
            const std::array<double, 3> v = parse_three(name, text);
            target = Vec3d{v[0], v[1], v[2]};
          },
          help)
      ->type_name("X,Y,Z");
}

Option* add_vector(OptionSet& app, const std::string& name, Vec3d& target,
                   const std::string& help) {
  return app
      .add_option_function<std::string>(
          name,
          [&target, name](const std::string& text) {
            const std::array<double, 3> v = parse_three(name, text);
            target = {v[0], v[1], v[2]};
          },
          help)
      ->type_name("X,Y,Z")
      ->default_str(short_number(target.x) + "," + short_number(target.y) + "," +
                    short_number(target.z));
}

Option* add_extent(OptionSet& app, const std::string& name, std::optional<Extent>& target,
                   const std::string& help) {
  const auto take = [&target, name](const std::string& text) {
    const std::vector<std::string> parts = split(text, ',');
    std::array<double, 6> n{};
    bool good = parts.size() == 4 || parts.size() == n.size();
    for (std::size_t i = 0; good && i < parts.size(); ++i)
      good = parse_whole(parts[i], n[i]) && std::isfinite(n[i]);
    if (!good || n[0] > n[2] || n[1] > n[3] || n[4] > n[5])
      reject_value(name, "expected XMIN,YMIN,XMAX,YMAX or XMIN,YMIN,XMAX,YMAX,ZMIN,ZMAX, found '" +
                             text + "'");
    target = extent_of(std::span(n).first(parts.size()));
  };
  return app.add_option_function<std::string>(name, take, help)
      ->type_name("XMIN,YMIN,XMAX,YMAX[,ZMIN,ZMAX]");
}

Option* add_places(OptionSet& app, const std::string& name, std::vector<SensorPlace>& target,
                   const std::string& help) {
  const auto take = [&target, name](const std::vector<std::string>& texts) {
    target.clear();
    for (const std::string& text : texts) target.push_back(parse_place(name, text));
  };
  return app.add_option_function<std::vector<std::string>>(name, take, help)
      ->type_name("X,Y[,Z[,YAW]]")
      ->repeatable();
}

namespace {

/// Units that a number can end with, and their sizes. "km" comes before "m", which it ends with.
using Units = std::span<const std::pair<std::string_view, double>>;

/// A number with one of the units, or without.
Option* add_with_unit(OptionSet& app, const Setting& setting, double& target, Units units,
                      const std::string& unit, const std::string& examples) {
  const auto take = [&target, setting, units, unit, examples](const std::string& text) {
    for (const auto& [ending, size] : units) {
      if (!text.ends_with(ending)) continue;
      double number = 0;
      if (!parse_whole(text.substr(0, text.size() - ending.size()), number)) break;
      if (!is_in_range(setting, number * size))
        reject_value(option_of(setting),
                     "expected " + range_text(setting) + " (" + unit + "), found '" + text + "'");
      target = number * size;
      return;
    }
    reject_value(option_of(setting), "expected " + examples + ", found '" + text + "'");
  };
  return app.add_option_function<std::string>(option_of(setting), take, setting.help)
      ->type_name(setting.value);
}

}  // namespace

Option* add_length(OptionSet& app, const Setting& setting, double& target) {
  static constexpr std::pair<std::string_view, double> kUnits[] = {{"km", 1000}, {"m", 1}, {"", 1}};
  return add_with_unit(app, setting, target, kUnits, "m", "a length as 500, 500m or 10km")
      ->default_str(short_number(target));
}

Option* add_memory(OptionSet& app, const Setting& setting, double& target) {
  static constexpr std::pair<std::string_view, double> kUnits[] = {
      {"GB", 1}, {"G", 1}, {"MB", 1e-3}, {"M", 1e-3}, {"", 1}};
  return add_with_unit(app, setting, target, kUnits, "GB", "an amount as 8, 8G or 500M");
}

Option* add_corners(OptionSet& app, const std::string& name, std::vector<PathCorner>& target,
                    const std::string& help) {
  const auto take = [&target, name](const std::string& text) {
    target.clear();
    for (const std::string& corner : split(text, ';')) {
      const SensorPlace place = parse_place(name, corner);
      if (std::ranges::count(corner, ',') != 1)
        reject_value(name, "expected X,Y;X,Y;..., found '" + text + "'");
      target.push_back({place.x_m, place.y_m});
    }
  };
  return app.add_option_function<std::string>(name, take, help)->type_name("X,Y;X,Y;...");
}

Option* add_scale(OptionSet& app, const std::string& name, GroupScale& target,
                  const std::string& help) {
  return app
      .add_option_function<std::string>(
          name,
          [&target, name](const std::string& text) {
            const std::array<double, 3> v = parse_three(name, text);
            target = {v[0], v[1], v[2]};
          },
          help)
      ->type_name("K,R,E")
      ->default_str(short_number(target.neighbors) + "," + short_number(target.radius) + "," +
                    short_number(target.error));
}

Option* add_picture_width(OptionSet& app, int& width) {
  return app
      .add_option("--picture-width", width, "Picture width, pixels; the height is 9/16 of it")
      ->capture_default_str()
      ->range(64, 8192)
      ->type_name("N");
}

Option* add_switch(OptionSet& app, const std::string& names, bool& target,
                   const std::string& help) {
  return app.add_flag(names, target, help)->default_str(target ? "true" : "false");
}

}  // namespace adasplats::app
