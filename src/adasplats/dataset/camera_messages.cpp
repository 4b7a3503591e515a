// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/camera_messages.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "adasplats/dataset/cdr_writer.h"

namespace adasplats {
namespace {

struct RosLens {
  std::string_view model;
  std::vector<double> d;
};

RosLens ros_lens(const Lens& lens) {
  const auto& k = lens.k;
  if (lens.is_fisheye) return {"equidistant", {k[0], k[1], k[2], k[3]}};
  RosLens ros = {"plumb_bob", {k[0], k[1], lens.p1, lens.p2, k[2]}};
  if (k[3] != 0 || k[4] != 0 || k[5] != 0) {
    ros.model = "rational_polynomial";
    ros.d.insert(ros.d.end(), {k[3], k[4], k[5]});
  }
  return ros;
}

}  // namespace

std::string camera_info_definition() {
  std::string text =
      "std_msgs/Header header\n"
      "uint32 height\n"
      "uint32 width\n"
      "string distortion_model\n"
      "float64[] d\n"
      "float64[9] k\n"
      "float64[9] r\n"
      "float64[12] p\n"
      "uint32 binning_x\n"
      "uint32 binning_y\n"
      "RegionOfInterest roi\n";
  text.append(kRosSeparator).append(kRosHeader).append(kRosSeparator).append(kRosTime);
  return text.append(kRosSeparator)
      .append(
          "MSG: sensor_msgs/RegionOfInterest\n"
          "uint32 x_offset\n"
          "uint32 y_offset\n"
          "uint32 height\n"
          "uint32 width\n"
          "bool do_rectify\n");
}

std::string compressed_image_definition() {
  std::string text =
      "std_msgs/Header header\n"
      "string format\n"
      "uint8[] data\n";
  return text.append(kRosSeparator).append(kRosHeader).append(kRosSeparator).append(kRosTime);
}

std::string camera_info_message(const Lens& lens, double time_s, std::string_view frame) {
  constexpr std::size_t kBytes = 512;
  const RosLens ros = ros_lens(lens);
  CdrWriter message(kBytes);
  message.header(time_s, frame)
      .put(static_cast<std::uint32_t>(lens.height))
      .put(static_cast<std::uint32_t>(lens.width))
      .text(ros.model)
      .put(static_cast<std::uint32_t>(ros.d.size()));
  for (const double value : ros.d) message.put(value);
  const std::array<double, 9> k = {lens.fx, 0, lens.cx, 0, lens.fy, lens.cy, 0, 0, 1};
  for (const double value : k) message.put(value);
  for (const double value : {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}) message.put(value);
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) message.put(k[3 * row + column]);
    message.put(0.0);
  }
  for (int i = 0; i < 6; ++i) message.put(std::uint32_t{0});  // no binning, the whole image
  return message.put(std::uint8_t{0}).take();
}

std::string compressed_image_message(std::string_view png, double time_s, std::string_view frame) {
  constexpr std::size_t kHeadBytes = 256;
  CdrWriter message(png.size() + kHeadBytes);
  message.header(time_s, frame).text("png");
  std::ranges::copy(png, message.array(png.size()));
  return message.take();
}

}  // namespace adasplats
