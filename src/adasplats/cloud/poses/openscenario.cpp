// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/poses/openscenario.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <pugixml.hpp>
#include <string_view>
#include <vector>

#include "adasplats/cloud/poses/rotation.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

constexpr std::string_view kExtension = ".xosc";

/// Reads one file.
class ScenarioReader {
 public:
  explicit ScenarioReader(const ScenarioPath& path) : path_(path), text_(read_file(path.file)) {
    const pugi::xml_parse_result parsed =
        document_.load_buffer(text_.data(), text_.size(), pugi::parse_default, pugi::encoding_utf8);
    if (!parsed)
      throw Error(ErrorKind::data, path_.file.string() + ":" + line_at(parsed.offset) +
                                       ": no well-formed XML: " + parsed.description());
    if (!document_.child("OpenSCENARIO"))
      throw Error(ErrorKind::data, path_.file.string() + ": has no element OpenSCENARIO");
  }

  Trajectory read() const {
    const pugi::xml_node trajectory = chosen();
    require_plain_times(trajectory);
    const pugi::xml_node polyline = trajectory.child("Shape").child("Polyline");
    if (!polyline) throw fault(trajectory, "its shape is no Polyline");
    Trajectory poses;
    bool has_headings = false;
    for (const pugi::xml_node vertex : polyline.children("Vertex")) {
      const pugi::xml_node position = vertex.child("Position").child("WorldPosition");
      if (!position)
        throw fault(vertex, "has no WorldPosition; other positions need a road network");
      const double time_s = number(vertex, "time", true);
      if (!poses.empty() && time_s <= poses.back().time_s)
        throw fault(vertex, "its time does not come after the one before");
      has_headings = has_headings || position.attribute("h");
      poses.push_back(
          {time_s,
           {rotation_from_yaw_pitch_roll(number(position, "h"), number(position, "p"),
                                         number(position, "r")),
            {number(position, "x", true), number(position, "y", true), number(position, "z")}}});
    }
    if (poses.empty()) throw fault(polyline, "has no Vertex");
    if (!has_headings) look_ahead(poses);
    return poses;
  }

 private:
  /// The trajectory of the name; errors list all.
  pugi::xml_node chosen() const {
    std::vector<pugi::xml_node> found;
    std::string names;
    for (const pugi::xpath_node& node : document_.select_nodes("//Trajectory")) {
      const std::string name = node.node().attribute("name").value();
      names += (names.empty() ? "" : ", ") + name;
      if (path_.name.empty() || path_.name == name) found.push_back(node.node());
    }
    if (found.size() == 1) return found.front();
    const std::string file = path_.file.string();
    if (names.empty()) throw Error(ErrorKind::data, file + ": has no Trajectory");
    if (found.empty())
      throw Error(ErrorKind::data, file + ": has no trajectory '" + path_.name + "', but " + names);
    throw Error(ErrorKind::data, file + ": has several trajectories, " + names +
                                     "; choose one as " + file + ":NAME");
  }

  void require_plain_times(const pugi::xml_node& trajectory) const {
    pugi::xml_node action = trajectory.parent();
    if (std::string_view(action.name()) == "TrajectoryRef") action = action.parent();
    const pugi::xml_node timing = action.child("TimeReference").child("Timing");
    if (!timing) return;
    if (number(timing, "scale", true) != 1 || number(timing, "offset", true) != 0)
      throw fault(timing,
                  "scales or shifts times, which is not supported; set them to 1 and 0, and "
                  "use speed_factor and delay_s of the world file");
  }

  static void look_ahead(Trajectory& poses) {
    double yaw_rad = 0;
    for (std::size_t k = 0; k < poses.size(); ++k) {
      const std::size_t from = k + 1 < poses.size() ? k : k - std::min<std::size_t>(k, 1);
      const std::size_t to = std::min(from + 1, poses.size() - 1);
      const Vec3d way =
          poses[to].world_from_sensor.translation - poses[from].world_from_sensor.translation;
      if (way.x != 0 || way.y != 0) yaw_rad = std::atan2(way.y, way.x);
      poses[k].world_from_sensor.rotation = rotation_from_yaw_pitch_roll(yaw_rad, 0, 0);
    }
  }

  std::string line_at(std::ptrdiff_t offset) const {
    const auto end = text_.begin() + std::clamp<std::ptrdiff_t>(offset, 0, std::ssize(text_));
    return std::to_string(1 + std::count(text_.begin(), end, '\n'));
  }
  Error fault(const pugi::xml_node& node, const std::string& what) const {
    return {ErrorKind::data, path_.file.string() + ":" + line_at(node.offset_debug()) + ": " +
                                 node.name() + " " + what};
  }
  double number(const pugi::xml_node& node, const char* name, bool is_required = false) const {
    const pugi::xml_attribute attribute = node.attribute(name);
    if (!attribute) {
      if (is_required) throw fault(node, "has no " + std::string(name));
      return 0;
    }
    const auto value = parse_number<double>(attribute.value());
    if (!value || !std::isfinite(*value))
      throw fault(node, std::string(name) + " '" + attribute.value() + "' is no finite number");
    return *value;
  }

  const ScenarioPath& path_;
  std::string text_;
  pugi::xml_document document_;
};

}  // namespace

std::optional<ScenarioPath> scenario_path(const std::filesystem::path& path) {
  const std::string text = path.string();
  if (lower_case(path.extension().string()) == kExtension) return ScenarioPath{path, {}};
  const std::size_t at = lower_case(text).rfind(std::string(kExtension) + ":");
  if (at == std::string::npos) return std::nullopt;
  const std::size_t colon = at + kExtension.size();
  return ScenarioPath{text.substr(0, colon), text.substr(colon + 1)};
}

Trajectory read_scenario(const ScenarioPath& path) { return ScenarioReader(path).read(); }

}  // namespace adasplats
