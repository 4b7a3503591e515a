// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Writes FOLDER/TARGET/N: what the fuzz targets begin with, made by the writers of the library and
// by what its tests put together.
// usage: adasplats_fuzz_seeds FOLDER

#include <filesystem>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include "adasplats/io/arrow/arrow_writer_test.h"
#include "adasplats/io/bags/recording_files_test.h"
#include "adasplats/io/bags/ros_values.h"
#include "adasplats/io/base/base64.h"
#include "adasplats/io/gaussians/spz_samples_test.h"
#include "adasplats/io/las/copc_file_test.h"
#include "adasplats/io/packets/capture_samples_test.h"
#include "adasplats/io/pickle/data_frame.h"
#include "adasplats/io/pickle/gzip.h"
#include "adasplats/io/pickle/pickle_samples_test.h"
#include "adasplats/io/small_files_test.h"
#include "adasplats/levels/level_file.h"
#include "adasplats/segment/network/network_text_test.h"
#include "adasplats/sensors/lidar_library.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/sensors/packet_encoder.h"
#include "adasplats/sensors/ray_drop_model.h"

namespace adasplats::fuzz {
namespace {

using bags_test::Said;
using io_test::bytes_of;

/// Seeds of one target after the other.
class Seeds {
 public:
  explicit Seeds(std::filesystem::path folder) : folder_(std::move(folder)) {}
  void add(const std::string& target, const std::vector<std::string>& contents) {
    for (const std::string& content : contents) {
      const auto folder = folder_ / target;
      std::filesystem::create_directories(folder);
      io_test::write_bytes(folder / ("seed-" + std::to_string(numbers_[target]++)), content);
    }
  }

 private:
  std::filesystem::path folder_;
  std::map<std::string, int> numbers_;
};

/// Files as targets with several split them.
std::string joined(const std::vector<std::string>& files) {
  std::string all;
  for (std::size_t k = 0; k < files.size(); ++k) all += (k == 0 ? "" : "\n%%\n") + files[k];
  return all;
}

void add_points(Seeds& seeds) {
  const std::map<std::string, std::string> targets = {{".bin", "kitti-bin"}};
  for (const io_test::Seed& seed : io_test::small_seeds()) {
    const std::string extension = std::filesystem::path(seed.name).extension().string();
    const auto other = targets.find(extension);
    seeds.add(other == targets.end() ? extension.substr(1) : other->second, {seed.content});
  }
  seeds.add("copc", {laz_test::CopcFile().bytes()});
  const std::string points = "1 2 3\n4 5.5 -6e3\n";
  for (const char* target : {"txt", "asc"}) seeds.add(target, {points, "// x y z i\n" + points});
  std::string rings;
  for (const float value : {1.0F, 2.0F, 3.0F, 17.0F, 5.0F, -1.0F, 2.0F, 3.0F, 255.0F, 31.0F})
    rings += bytes_of(value);
  seeds.add("nuscenes-bin", {rings});
  seeds.add("kitti-label", {bytes_of(0x00010028U) + bytes_of(30U)});
  seeds.add(
      "potree",
      {joined({bytes_of(100) + bytes_of(-3) + bytes_of(7) + bytes_of(2.5),
               R"({"points":1,"offset":[1000,2000,0],"scale":[0.001,0.001,0.01],"encoding":)"
               R"("DEFAULT","attributes":[{"name":"position","numElements":3,"type":"int32"},)"
               R"({"name":"gps-time","numElements":1,"type":"double"}],"projection":"a[b]"})"})});
  seeds.add("ept",
            {joined({R"({"dataType":"binary","points":1,"schema":[{"name":"X","type":"signed",)"
                     R"("size":4,"scale":0.01,"offset":5},{"name":"Y","type":"float","size":8},)"
                     R"({"name":"Z","type":"signed","size":4}],"srs":{"wkt":"LOCAL_CS[\"a\"]"}})",
                     bytes_of(100) + bytes_of(2.5) + bytes_of(-3)})});
  seeds.add("e57-xml",
            {"<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<e57Root type=\"Structure\" "
             "xmlns=\"http://www.astm.org/COMMIT/E57/2010-e57-v1.0\"><!-- c --><a b='&lt;1&#65;'>"
             "<![CDATA[x]]></a><data3D type=\"Vector\"><vectorChild type=\"Structure\"><points "
             "type=\"CompressedVector\" fileOffset=\"0\" recordCount=\"0\"><prototype "
             "type=\"Structure\"><cartesianX type=\"Float\"/><cartesianY type=\"Float\"/>"
             "<cartesianZ type=\"Float\"/></prototype></points></vectorChild></data3D></e57Root>"});
  seeds.add("wkt", {"PROJCS[\"a\",GEOGCS[\"b\",UNIT[\"degree\",0.0174]],UNIT[\"US survey foot\","
                    "0.3048006096],AXIS[\"x\",EAST]]",
                    "COMPD_CS[\"c\",PROJCS[\"a\",GEOGCS[\"b\"],UNIT[\"metre\",1]],VERT_CS[\"h\","
                    "UNIT[\"foot\",0.3048]]]",
                    "GEOGCRS[\"WGS 84\",CS[ellipsoidal,2],ANGLEUNIT[\"degree\",0.0174]]"});
  const std::vector<FrameColumn> columns = {{"x", std::vector<double>{1.5, -2}},
                                            {"d", std::vector<std::int64_t>{0, 1}},
                                            {"s", std::vector<std::string>{"a", "b"}},
                                            {"b", std::vector<bool>{true, false}}};
  const std::string frame = pickled_data_frame(columns);
  seeds.add("pickle",
            {frame, io_test::from_base64(io_test::kPandasFour),
             io_test::from_base64(io_test::kPandasFive), io_test::from_base64(io_test::kPandasOld),
             io_test::from_base64(io_test::kPandasMixed)});
  seeds.add("gzip", {gzipped(frame), gzipped("a") + gzipped("")});
}

/// A frame of zstd that holds 256 to 65535 bytes as they are (RFC 8878, 3.1.1).
std::string zstd_frame(const std::string& bytes) {
  const auto size = static_cast<std::uint32_t>(bytes.size());
  return bytes_of(0xFD2FB528U) + "\x60" + bytes_of(static_cast<std::uint16_t>(size - 256)) +
         bytes_of(size << 3 | 1).substr(0, 3) + bytes;
}

std::string bag_of_poses(bool cdr) {
  const std::vector<double> pose = {1, 2, 3, 0, 0, 0, 1}, later = {2, 2, 3, 0, 0, 0.6, 0.8};
  bags_test::CloudWords words;
  words.fields = {{"x", 0, 7}, {"y", 4, 7}, {"z", 8, 7}, {"t", 12, 6}};
  words.width = 2;
  words.step = 16;
  words.row_step = 32;
  words.points.assign(32, '\0');
  std::vector<Said> said;
  for (int k = 0; k < 3; ++k) {
    const std::int64_t time_ns = 1'000'000'000 + 100'000'000LL * k;
    const auto recorded_ns = static_cast<std::uint64_t>(time_ns);
    said.push_back(
        {"/tf", "tf2_msgs/msg/TFMessage", recorded_ns,
         bags_test::transforms_message(time_ns, "map", "lidar", k == 0 ? pose : later, cdr)});
    said.push_back({"/odom", "nav_msgs/msg/Odometry", recorded_ns,
                    bags_test::odometry_message(time_ns, "map", "base", pose, cdr)});
    words.stamp_ns = time_ns;
    if (k == 1)
      said.push_back({"/points", "sensor_msgs/msg/PointCloud2", recorded_ns,
                      bags_test::cloud_message(words, cdr)});
  }
  return bags_test::mcap_of(said);
}

/// A message of nebula_msgs/NebulaPackets.
std::string packets_message(bool cdr) {
  bags_test::MessageComposer message(cdr);
  message.header(5, "lidar").put(std::uint32_t{1}).put(std::uint32_t{5}).put(std::uint32_t{7});
  return message.raw("packet").get();
}

void add_recordings(Seeds& seeds) {
  const std::vector<Said> said = {{"/a", "pkg/msg/One", 5, "first"},
                                  {"/b", "pkg/msg/Two", 7, std::string(30, 'x')},
                                  {"/a", "pkg/msg/One", 9, ""}};
  const auto& [zstd, lz4, bz2] = bags_test::kPackedZeros;
  std::vector<std::string> topics;
  const std::string records = bags_test::mcap_records(said, topics);
  seeds.add("mcap", {bags_test::mcap_of(said), bags_test::mcap_file(records),
                     bags_test::mcap_file(bags_test::mcap_chunk("zstd", zstd.bytes, 1000)),
                     bags_test::mcap_file(bags_test::mcap_chunk("lz4", lz4.bytes, 1000))});
  seeds.add("bag", {bags_test::bag_of(said),
                    bags_test::bag_file(bags_test::bag_chunk("bz2", bz2.bytes, 1000)),
                    bags_test::bag_file(bags_test::bag_chunk("lz4", lz4.bytes, 1000))});
  seeds.add("mcap-zstd", {zstd_frame(bags_test::mcap_of(said))});
  seeds.add("db3", {bags_test::small_db3()});
  seeds.add("ros2-bag",
            {joined({"rosbag2_bagfile_information:\n  version: 5\n  relative_file_paths:\n    - "
                     "a.mcap\n  compression_format: \"\"\n  compression_mode: \"\"\n",
                     bags_test::mcap_of(said)})});
  const std::vector<double> pose = {1, 2, 3, 0, 0, 0, 1};
  bags_test::CloudWords words;
  words.fields = {{"x", 0, 7}, {"n", 4, 4, 2}, {"t", 8, 8}};
  words.width = 1;
  words.step = words.row_step = 16;
  words.points.assign(16, '\1');
  for (const bool cdr : {false, true}) {
    const auto choice = [&](int type) { return std::string(1, static_cast<char>(2 * type + cdr)); };
    seeds.add("ros-message",
              {choice(0) + bags_test::transforms_message(5, "map", "car", pose, cdr),
               choice(1) + bags_test::odometry_message(5, "map", "car", pose, cdr),
               choice(2) + bags_test::pose_message(5, "map", pose, cdr),
               choice(4) + bags_test::cloud_message(words, cdr), choice(6) + packets_message(cdr)});
  }
  seeds.add("unpack", {std::string(1, '\0') + zstd.bytes, "\1" + lz4.bytes, "\2" + bz2.bytes,
                       "\3" + zstd.bytes, "\4" + zstd.bytes});
  seeds.add("clouds",
            {bag_of_poses(true), bags_test::mcap_of({{"/packets", "nebula_msgs/msg/NebulaPackets",
                                                      5, packets_message(true)}})});
}

/// What a sensor sends of things 10 m away.
std::string packet_of(const char* name) {
  const PacketSensor sensor = packet_sensor(load_lidar_model(name));
  std::vector<PacketReturn> returns(sensor.lasers());
  for (PacketReturn& one : returns)
    one = {static_cast<std::uint32_t>(10 / sensor.facts.quantum_m), 99};
  std::vector<PacketColumn> columns;
  for (std::size_t k = 0; k < sensor.facts.columns; ++k)
    columns.push_back(
        {1'700'000'000'000'000'000ULL + 55'000 * k, static_cast<std::uint32_t>(k), 3, returns});
  return encode_packet(sensor, columns, 0);
}

void add_packets(Seeds& seeds) {
  using namespace capture_test;
  constexpr std::size_t kMost = 2000;
  int choice = 0;
  for (const char* name : {"velodyne-vlp-16", "velodyne-hdl-32e", "velodyne-hdl-64e-kitti",
                           "velodyne-vls-128", "ouster-os1-64", "ouster-os1-128"})
    seeds.add("packet",
              {std::string(1, static_cast<char>(choice++)) + packet_of(name).substr(0, kMost)});
  // Heads of Hesai's packets; the tails, of zeros but for the return mode, are added below.
  std::string pandar64("\xEE\xFF\x40\x06\0\x04", 6), xt32("\xEE\xFF\6\1\0\0\x20\x8\1\4\1\0", 12);
  pandar64.resize(1194);
  pandar64[1186] = 0x37;
  xt32.resize(1076);
  xt32[1062] = 0x39;
  seeds.add("packet", {static_cast<char>(choice) + pandar64, static_cast<char>(choice + 1) + xt32});
  std::string at128("\xEE\xFF\1\5\x80\3\3\1\2\4\0\0\0\0\0\2", 16);
  at128.resize(47176);
  for (std::size_t laser = 0; laser < 128; ++laser)  // elevations in steps of 0.02 degrees
    at128[16 + 24 + 4 * (128 + laser) + 1] = static_cast<char>(laser);
  seeds.add("sensor-dat", {at128});
  const std::string whole = udp_text(2368, "0123456789abcdef0123");
  const std::vector<FrameSample> frames = {
      {1'000'000'000, ip_frame(udp_text(2368, "one"), 1, 0)},
      {1'000'100'000, ip_frame(whole.substr(16), 2, 2, 1)},
      {1'000'200'000, ip_frame(whole.substr(0, 16), 2, 0x2000, 1)}};
  for (const bool big : {false, true})
    seeds.add("pcap", {pcap_of(frames, big, big), pcapng_of(frames, big)});
  const std::string packet = packet_of("velodyne-vlp-16");
  std::vector<FrameSample> sent;
  for (std::uint16_t k = 0; k < 2; ++k)
    sent.push_back(
        {1'700'000'000'000'000'000ULL + 1'300'000ULL * k, ip_frame(udp_text(2368, packet), k, 0)});
  seeds.add("capture", {pcap_of(sent, false, false)});
}

void add_meshes(Seeds& seeds) {
  seeds.add("obj",
            {"# o\nv 0 0 0\nv 1 0 0 1\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf -1/1 -2//2 \\\n-3/1/1 1\n"});
  const std::string head =
      "ply\nformat ascii 1.0\ncomment adasplats.labels semantickitti\nelement vertex 3\n"
      "property float x\nproperty float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nproperty ushort class\nend_header\n";
  seeds.add("mesh-ply", {head + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 40\n"});
  std::string bytes;
  for (const float value : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 2.F, 0.F, 0.F, 0.F, 3.F})
    bytes += bytes_of(value);
  bytes += std::string("\0\1\2\0\3\1", 6);
  const std::string json =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"children":[1],)"
      R"("scale":[1,2,1]},{"mesh":0,"translation":[1,2,3],"rotation":[0,0,0,1]}],"meshes":)"
      R"([{"primitives":[{"attributes":{"POSITION":0},"indices":1,"mode":4}]}],"accessors":)"
      R"([{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},{"bufferView":1,)"
      R"("componentType":5121,"count":6,"type":"SCALAR"}],"bufferViews":[{"buffer":0,)"
      R"("byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":6}],"buffers":)"
      R"([{"byteLength":54)";
  seeds.add("gltf", {json + R"(,"uri":"data:application/octet-stream;base64,)" + to_base64(bytes) +
                         R"("}]})",
                     joined({json + R"(,"uri":"b.bin"}]})", bytes})});
  std::string text = json + "}]}";
  while (text.size() % 4 != 0) text += ' ';
  bytes.resize(56);
  const auto chunk = [](const std::string& content, std::uint32_t type) {
    return bytes_of(static_cast<std::uint32_t>(content.size())) + bytes_of(type) + content;
  };
  const std::string chunks = chunk(text, 0x4e4f534a) + chunk(bytes, 0x004e4942);
  std::string gaussians;  // two: position, rotation, scale, opacity, harmonic, class
  for (int i = 0; i < 2; ++i)
    for (const float value :
         {1.F, 2.F, 3.F, 0.F, 0.F, 0.F, 1.F, 0.5F, 0.4F, 0.01F, 0.9F, 0.F, 1.F, -1.F, 40.F})
      gaussians += bytes_of(value);
  std::string accessors;
  for (const auto& [offset, type] : {std::pair(0, "VEC3"),
                                     {12, "VEC4"},
                                     {28, "VEC3"},
                                     {40, "SCALAR"},
                                     {44, "VEC3"},
                                     {56, "SCALAR"}})
    accessors += std::string(accessors.empty() ? "" : ",") + R"({"bufferView":0,"byteOffset":)" +
                 std::to_string(offset) + R"(,"componentType":5126,"count":2,"type":")" + type +
                 "\"}";
  std::string splats =
      R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_gaussian_splatting"],"scene":0,)"
      R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"scale":[2,2,2],"extras":{"origin":[1,2,3],)"
      R"("adasplats":["adasplats.method basic"]}}],"meshes":[{"primitives":[{"mode":0,"attributes":)"
      R"({"POSITION":0,"KHR_gaussian_splatting:ROTATION":1,"KHR_gaussian_splatting:SCALE":2,)"
      R"("KHR_gaussian_splatting:OPACITY":3,"KHR_gaussian_splatting:SH_DEGREE_0_COEF_0":4,)"
      R"("_CLASS":5},"extensions":{"KHR_gaussian_splatting":{"kernel":"ellipse"}}}]}],)"
      R"("accessors":[)" +
      accessors +
      R"(],"bufferViews":[{"buffer":0,"byteLength":120,"byteStride":60}],"buffers":)"
      R"([{"byteLength":120}]})";
  while (splats.size() % 4 != 0) splats += ' ';
  const auto glb = [](const std::string& content) {
    return "glTF" + bytes_of(2U) + bytes_of(static_cast<std::uint32_t>(12 + content.size())) +
           content;
  };
  seeds.add("glb", {glb(chunks)});
  seeds.add("glb", {glb(chunk(splats, 0x4e4f534a) + chunk(gaussians, 0x004e4942))});
}

void add_cities(Seeds& seeds) {
  seeds.add("city",
            {R"({"format":"adasplats city","version":1,"tile_m":24,"halo_m":8,"origin_m":[1,2,0],)"
             R"("tiles":[{"x":-1,"y":2,"points":9,"splats":2,"sha256":"ab","low_m":[0,0,0],)"
             R"("high_m":[1,2,3]},{"x":0,"y":2,"points":0,"splats":0,"sha256":"cd",)"
             R"("low_m":[0,0,0],"high_m":[0,0,0]}]})"});
  seeds.add("city-points",
            {R"({"origin_m":[1,2,0],"low_m":[0,0,0],"high_m":[5,6,7],"points_read":9,"rays":8,)"
             R"("empty_reach_m":40.5,"attributes":" sensor_positions classes",)"
             R"("tiles":[[-1,2,9,0,[0,1,2,3]],[0,2,0,4,[0,0,0,0]]]})"});
  LevelTable tree;
  tree.facts = {3, true, true, {0.25F, 0.5F}};
  tree.nodes = {
      {.high = {1, 2, 3}, .spacing_m = 0.5F, .first_child = 1, .child_count = 2, .count = 1},
      {.largest_radius_m = 0.1F, .count = 2, .level = 1},
      {.count = 1, .level = 1}};
  const std::string element(sizeof(LevelElement), '\1');
  std::string elements;
  for (int k = 0; k < 4; ++k) elements += element;
  LevelTable top = tree;
  top.parts = {{"levels/x0_y0.levels", 1, 0, 1, 99, "ab", "cd"},
               {"levels/x0_y1.levels", 2, 0, 1, 98, "ef", "gh"}};
  seeds.add("levels", {level_head(tree) + elements, level_head(top) + element});
}

void add_places(Seeds& seeds) {
  add_meshes(seeds);
  const std::string splats =
      "ply\nformat ascii 1.0\ncomment adasplats.splats 1\ncomment adasplats.labels semantickitti\n"
      "comment adasplats.method ours\ncomment adasplats.response_ranges_m 1 10\n"
      "comment adasplats.response_range_gains 1 0.5\ncomment adasplats.response_cosines 0 1\n"
      "comment adasplats.response_cosine_gains 0.5 1\n"
      "comment adasplats.calibration_range_offsets_m 0.01 -0.01\n"
      "comment adasplats.calibration_elevation_offsets_rad 0 0\n"
      "comment adasplats.calibration_mount 0 0 0.01 0 0 0.1\n"
      "comment adasplats.calibration_smooth_s 1\n"
      "comment adasplats.calibration_pose 1.5 0 0 0 0 0 0.01 0 0 0\n"
      "element vertex 2\nproperty double x\n"
      "property double y\nproperty double z\nproperty float nx\nproperty float ny\n"
      "property float nz\nproperty float radius\nproperty ushort class\nproperty uchar group\n"
      "property float intensity\nend_header\n";
  seeds.add("splats", {splats + "1 2 3 0 0 1 0.5 40 0 0.25\n4 5 6 1 0 0 0.1 50 1 0.5\n"});
  std::string trained = "ply\nformat ascii 1.0\ncomment adasplats.origin 1 2 3\nelement vertex 2\n";
  for (const char* name : {"x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0",
                           "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"})
    trained += "property float " + std::string(name) + "\n";
  seeds.add("splats", {trained + "end_header\n1 2 3 0 1 -1 2 -1 -2 -6 1 0 0 0\n"
                                 "4 5 6 0 1 -1 -9 -1 -2 -6 2 0 1 0\n"});
  std::string packed = "ply\nformat ascii 1.0\nelement chunk 1\n";
  for (const char* side : {"min_", "max_"}) {
    for (const char* name : {"x", "y", "z", "scale_x", "scale_y", "scale_z"})
      packed += "property float " + std::string(side) + name + "\n";
  }
  const std::string ranges = "-3 -3 -3 -3 -3 -3 5 5 5 1 1 1\n";
  packed += "element vertex 1\n";
  for (const char* name : {"position", "rotation", "scale", "color"})
    packed += "property uint packed_" + std::string(name) + "\n";
  seeds.add("splats", {packed + "end_header\n" + ranges + "1 2000000000 3000000000 255\n"});
  seeds.add("spz", {gzipped(spz_samples::version_2())});
  seeds.add("spz", {gzipped(spz_samples::version_3())});
  seeds.add("spz", {spz_samples::version_4()});
  seeds.add("world",
            {joined({"[[object]]\ngeometry = \"car.ply\"\nclass = \"car\"\ninstance = 7\n"
                     "position = [1, -3.5, 0]\nyaw_deg = 90\nscale = 2\ntrajectory = \"car.ply\"\n"
                     "present = \"during\"\nscan = 3\nname = \"t\"\n",
                     "ply"})});
  add_cities(seeds);
  seeds.add("network",
            {network_test::pole_network().text(), network_test::pole_network_of_8_bits().text(),
             network_test::network_of_all_layers().text()});
}

void add_poses(Seeds& seeds) {
  const std::string rows = "1 0 0 1 0 1 0 2 0 0 1 3\n1 0 0 2 0 1 0 2 0 0 1 3\n";
  const std::string calibration = "P0: 1 0 0 0 0 1 0 0 0 0 1 0\nTr: 0 -1 0 0 0 0 -1 0 1 0 0 0\n";
  seeds.add("poses-kitti", {rows, joined({rows, calibration, "0\n0.1\n"})});
  seeds.add("poses-csv",
            {"time,x,y,z,qw,qx,qy,qz\n1,0,0,0,1,0,0,0\n2,1,0,0,0.8,0,0,0.6\n",
             "#timestamp [ns]; p_RS_R_x [m]; p_RS_R_y [m]; p_RS_R_z [m]; q_RS_w []; q_RS_x []; "
             "q_RS_y []; q_RS_z []\n1000;0;0;0;1;0;0;0\n",
             "secs nsecs x y z qx qy qz qw\n1 5 0 0 0 0 0 0 1\n"});
  seeds.add("poses-tum", {"1 0 0 0 0 0 0 1\n1.5 1 0 0 0 0 0.6 0.8\n"});
  seeds.add(
      "poses-xosc",
      {"<OpenSCENARIO><Trajectory name=\"a\"><Shape><Polyline><Vertex time=\"0\"><Position>"
       "<WorldPosition x=\"1\" y=\"2\"/></Position></Vertex><Vertex time=\"1\"><Position>"
       "<WorldPosition x=\"1\" y=\"2\" z=\"3\" h=\"0.5\" p=\"0\" r=\"0\"/></Position></Vertex>"
       "</Polyline></Shape></Trajectory></OpenSCENARIO>"});
  seeds.add("scan-times", {"0\n0.1\n0.2\n"});
  std::string scan;
  for (const float value : {1.0F, 2.0F, 3.0F, 0.5F, -1.0F, 2.0F, 3.0F, 0.25F})
    scan += bytes_of(value);
  seeds.add("kitti", {joined({rows.substr(0, rows.find('\n')), calibration, "0\n", scan,
                              bytes_of(40U) + bytes_of(0x0001000AU)})});
}

void add_av2(Seeds& seeds) {
  using arrow_test::arrow_file;
  using arrow_test::numbers;
  const auto poses = [](arrow_test::ArrowColumn first, std::size_t rows) {
    std::vector<arrow_test::ArrowColumn> columns = {std::move(first),
                                                    numbers("qw", std::vector<double>(rows, 1))};
    for (const char* name : {"qx", "qy", "qz", "tx_m", "ty_m", "tz_m"})
      columns.push_back(numbers(name, std::vector<double>(rows, 0)));
    return arrow_file({columns});
  };
  const std::vector<std::int64_t> stamps = {315'966'265'259'836'000, 315'966'265'360'032'000};
  const std::string sweep = arrow_file(
      {{arrow_test::halves("x", {0x4900}), numbers<float>("y", {1}), numbers<double>("z", {0}),
        numbers<std::uint8_t>("intensity", {9}), numbers<std::uint8_t>("laser_number", {9}),
        numbers<std::int32_t>("offset_ns", {2'654'000})}});
  seeds.add("av2", {joined({poses(numbers("timestamp_ns", stamps), 2),
                            poses(arrow_test::texts("sensor_name", {"up_lidar", "down_lidar"}), 2),
                            sweep})});
  seeds.add(
      "arrow",
      {sweep, arrow_file({{arrow_test::texts("t", {"a", "bc"})}, {arrow_test::texts("t", {""})}})});
}

void add_av2_boxes(Seeds& seeds) {
  using arrow_test::numbers;
  using Doubles = std::vector<double>;
  const auto poses = [](std::size_t rows, const Doubles& x) {
    const std::vector<std::int64_t> stamps = {1'000'000'000, 1'100'000'000};
    std::vector<arrow_test::ArrowColumn> columns = {
        numbers("timestamp_ns", stamps), numbers("tx_m", x), numbers("qw", Doubles(rows, 1))};
    for (const char* name : {"qx", "qy", "qz", "ty_m", "tz_m"})
      columns.push_back(numbers(name, Doubles(rows, 0)));
    return columns;
  };
  std::vector<arrow_test::ArrowColumn> boxes = poses(2, {10, 12});
  for (const char* name : {"length_m", "width_m", "height_m"})
    boxes.push_back(numbers(name, Doubles{4, 4}));
  boxes.push_back(arrow_test::texts("track_uuid", {"a", "a"}));
  boxes.push_back(arrow_test::texts("category", {"BUS", "BUS"}));
  seeds.add(
      "boxes-av2",
      {joined({arrow_test::arrow_file({boxes}), arrow_test::arrow_file({poses(2, {0, 1})})})});
}

void add_boxes(Seeds& seeds) {
  seeds.add("boxes", {"time,id,stationary,x,y,z,size_x,size_y,size_z,yaw\n0,1,0,1,2,3,4,2,1.5,0.1\n"
                      "1,1,0,2,2,3,4,2,1.5,3.1\n0.5,2,1,0,0,0,1,1,1,0\n"});
  const std::string item =
      "<item><tx>9</tx><ty>2</ty><tz>-1.7</tz><rx>0</rx><ry>0</ry><rz>1.5</rz></item>";
  seeds.add("boxes-kitti",
            {"<?xml version=\"1.0\"?>\n<boost_serialization><tracklets><count>1</count>\n<item>"
             "<objectType>Car</objectType><h>1.5</h><w>2</w><l>4</l><first_frame>1</first_frame>"
             "<poses><count>2</count>" +
             item + item + "</poses></item></tracklets></boost_serialization>\n"});
  const std::vector<double> zeros(3, 0), ones(3, 1);
  const std::vector<FrameColumn> cuboids = {
      {"uuid", std::vector<std::string>{"a", "b", "c"}},
      {"label", std::vector<std::string>{"Car", "Car", "Bus"}},
      {"yaw", zeros},
      {"stationary", std::vector<bool>{false, false, true}},
      {"position.x", zeros},
      {"position.y", zeros},
      {"position.z", zeros},
      {"dimensions.x", ones},
      {"dimensions.y", ones},
      {"dimensions.z", ones},
      {"cuboids.sibling_id", std::vector<std::string>{"b", "a", ""}},
      {"cuboids.sensor_id", std::vector<std::int64_t>{0, 1, -1}}};
  seeds.add("boxes-pandaset", {joined({"[0.5]", gzipped(pickled_data_frame(cuboids))})});
  const std::string box = R"("instance_token":"i","size":[2,4,1.5],"rotation":[1,0,0,0],)";
  seeds.add("boxes-nuscenes",
            {joined({R"([{"token":"A","name":"scene-0001"}])",
                     R"([{"token":"s","scene_token":"A","timestamp":1500000000000000},)"
                     R"({"token":"t","scene_token":"A","timestamp":1500000000500000}])",
                     R"([{"sample_token":"s",)" + box + R"("translation":[1,2,3]},)" +
                         R"({"sample_token":"t",)" + box + R"("translation":[3,2,3]}])",
                     R"([{"token":"i","category_token":"c"}])",
                     R"([{"token":"c","name":"vehicle.car"}])"})});
  add_av2_boxes(seeds);
}

void add_drives(Seeds& seeds) {
  const std::string day = "2011-09-26 13:02:";
  seeds.add(
      "kitti-raw",
      {joined({"R: 1 0 0 0 1 0 0 0 1\nT: -0.8 0.3 -0.8\n",
               day + "20.000000000\n" + day + "20.100000000\n", "5 1 -1 0.25\n6.5 0 0 0\n",
               day + "20.05\n" + day + "20.09\n" + day + "20.15\n", "49 8.4 115.5 0 0 0.1 -1\n",
               "49 8.40001 115.5 0 0 0.11\n", "49 8.40002 115.5 0 0 0.12\n"})});
  const std::vector<FrameColumn> points = {
      {"x", std::vector<double>{1.5, -2, 3}},       {"y", std::vector<double>{0, 1, 2}},
      {"z", std::vector<double>{0, 1, 0.5}},        {"i", std::vector<double>{5, 6, 7}},
      {"t", std::vector<double>{0.01, 0.02, 0.03}}, {"d", std::vector<std::int64_t>{0, 1, 0}}};
  const std::vector<FrameColumn> classes = {{"class", std::vector<std::int64_t>{7, 8, 7}}};
  seeds.add("pandaset",
            {joined({R"([{"position":{"x":1,"y":2,"z":3},"heading":{"w":1,"x":0,"y":0,"z":0}}])",
                     "[0.05]", gzipped(pickled_data_frame(points)), R"({"7":"Road","8":"Car"})",
                     gzipped(pickled_data_frame(classes))})});
  add_av2(seeds);
  add_boxes(seeds);
  const std::string pose = R"("rotation":[1,0,0,0],"translation":[1,2,3]}])";
  seeds.add(
      "nuscenes",
      {joined({R"([{"token":"A","name":"scene-0001"}])", R"([{"token":"s","scene_token":"A"}])",
               R"([{"token":"d","sample_token":"s","ego_pose_token":"e",)"
               R"("calibrated_sensor_token":"c","timestamp":1500000000000000,"is_key_frame":true,)"
               R"("filename":"samples/LIDAR_TOP/0.pcd.bin"}])",
               R"([{"token":"l","channel":"LIDAR_TOP"}])",
               R"([{"token":"c","sensor_token":"l",)" + pose, R"([{"token":"e",)" + pose,
               R"([{"sample_data_token":"d","filename":"lidarseg/0.bin"}])",
               R"([{"name":"noise","index":0}])"})});
}

void add_cameras(Seeds& seeds) {
  const std::string lens = "width = 64\nheight = 48\nfx = 50.5\nfy = 51\ncx = 32\ncy = 24\n";
  seeds.add("camera-toml",
            {"[[camera]]\nname = \"a\"\n" + lens +
                 "model = \"brown_conrady\"\ncoefficients = [-0.3, 0.1, 0.001, -0.002, 0]\n"
                 "mount = [1, 0, 1.5]\nmount_rotation_deg = [90, 0, -5]\n",
             "[[camera]]\nname = \"a\"\n" + lens +
                 "model = \"fisheye\"\ncoefficients = [0.1, -0.02, 0.003, 0]\n"
                 "mount_quaternion = [0.5, -0.5, 0.5, -0.5]\n",
             "[[camera]]\nname = \"a\"\nfile = \"b.yaml\"\n"});
  seeds.add("camera-yaml",
            {"image_width: 64\nimage_height: 48\ncamera_name: a\ncamera_matrix:\n  rows: 3\n"
             "  data: [50, 0, 32, 0, 51, 24,\n    0, 0, 1]\ndistortion_model: plumb_bob\n"
             "distortion_coefficients:\n  data: [-0.3, 0.1, 0.001, 0, 0]  # k\n",
             "width: 64\nheight: 48\ndistortion_model: rational_polynomial\nd:\n- 0.1\n- -0.2\n"
             "- 0.001\n- 0\n- 0.3\n- 0.4\n- 0.1\n- 0\nk:\n- 50\n- 0\n- 32\n- 0\n- 50\n- 24\n"
             "- 0\n- 0\n- 1\n---\n"});
  seeds.add("camera-json", {R"({"width":64,"height":48,"distortion_model":"equidistant",)"
                            R"("D":[0.1,0.2,0.3,0.4],"K":[50,0,32,0,50,24,0,0,1]})"});
  const std::string rotation = "1 0 0 0 1 0 0 0 1";
  seeds.add("camera-kitti",
            {joined({"calib_time: 09-Jan-2012\nS_rect_02: 64 48\nR_rect_00: " + rotation +
                         "\nP_rect_02: 50 0 32 4 0 50 24 0.2 0 0 1 0.003\n",
                     "R: 0 -1 0 0 0 -1 1 0 0\nT: 0 -0.1 -0.3\n"})});
  seeds.add("camera-odometry",
            {joined({"P0: 50 0 32 4 0 50 24 0.2 0 0 1 0\nTr: 0 -1 0 0 0 0 -1 0 1 0 0 0\n",
                     std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x40\0\0\0\x30", 24)})});
  const std::string pose = R"("rotation":[0.5,-0.5,0.5,-0.5],"translation":[1.7,0,1.5],)";
  seeds.add(
      "camera-nuscenes",
      {joined({R"([{"token":"c","sensor_token":"f",)" + pose +
                   R"("camera_intrinsic":[[50,0,32],[0,51,24],[0,0,1]]},{"token":"l",)"
                   R"("sensor_token":"t","rotation":[1,0,0,0],"translation":[1,0,2]}])",
               R"([{"token":"f","channel":"CAM_FRONT","modality":"camera"},)"
               R"({"token":"t","channel":"LIDAR_TOP","modality":"lidar"}])",
               R"([{"calibrated_sensor_token":"c","sample_token":"s","width":64,)"
               R"("height":48},{"calibrated_sensor_token":"l","sample_token":"s"}])",
               R"([{"token":"A","name":"scene-0001"}])", R"([{"token":"s","scene_token":"A"}])"})});
}

void add_settings(Seeds& seeds) {
  seeds.add("rig",
            {"trajectory = \"p.csv\"\nbody = [[1, 0, 0.75, 4.5, 1.8, 1.5]]\n[[sensors]]\n"
             "name = \"a\"\ninput = \"a/\"\nsensor = \"velodyne-vlp-16\"\ntopic = \"/t\"\n"
             "mount = [1, -2, 0.5]\nmount_rotation_deg = [90, 5, 180]\ntime_offset_s = -0.02\n"
             "in_model = false\n[[sensors]]\nname = \"b\"\npoints_in = \"world\"\n"
             "sweep_points = \"measured\"\nbody = [[0, 0, 0, 1, 1, 1], [1, 2, 3, 4, 5, 6]]\n"
             "[[camera]]\nname = \"c\"\nwidth = 64\nheight = 48\nfx = 30\nfy = 30\ncx = 32\n"
             "cy = 24\nmodel = \"fisheye\"\ncoefficients = [0.1, 0.01, 0, 0]\nmount = [1, 0, 2]\n"
             "mount_rotation_deg = [90, 0, 0]\n"});
  for (const LibraryLidar& lidar : lidar_library())
    if (lidar.toml.size() < 1500) seeds.add("sensor-toml", {std::string(lidar.toml)});
  seeds.add("sensor-toml",
            {"like = \"velodyne-vlp-16\"\nname = \"u\"\nrange_offsets_m = [0.01, -0.01]\n"
             "rotation_hz = 20\n[body]\ncells = [[0, -10, 50, 1200, 3]]\n[drop]\n"
             "usual_reflectance = 0.3\nweights = [0, 0, 0, 0, 0, 0, 0, 0]\n"});
  seeds.add(
      "sensor-json",
      {R"({"beam_altitude_angles":[10,-10.5],"beam_azimuth_angles":[3,-1],"lidar_mode":)"
       R"("512x20","lidar_origin_to_beam_origin_mm":15,"lidar_to_sensor_transform":)"
       R"([-1,0,0,0,0,-1,0,0,0,0,1,36,0,0,0,1],"prod_line":"OS-0-2","prod_sn":"7"})",
       R"({"beam_intrinsics":{"beam_altitude_angles":[10,-10.5],"beam_azimuth_angles":[3,-1],)"
       R"("beam_to_lidar_transform":[1,0,0,15,0,1,0,0,0,0,1,0,0,0,0,1]},"config_params":)"
       R"({"lidar_mode":"512x20","udp_profile_lidar":"RNG19_RFL8_SIG16_NIR16_DUAL"},)"
       R"("sensor_info":{"prod_line":"OS-0-2"}})"});
  seeds.add("sensor-yaml",
            {"# mine\nlasers:\n- {dist_correction: 1.5, laser_id: 0, rot_correction: 0.1,\n"
             "  vert_correction: -0.2, vert_offset_correction: 0.19}\n- laser_id: 1\n"
             "  rot_correction: -0.05\n  vert_correction: 0.03 # up\nnum_lasers: 2\n"
             "distance_resolution: 0.002\n"});
  seeds.add("sensor-xml",
            {"<?xml version=\"1.0\"?>\n<boost_serialization><DB><distLSB_>0.2</distLSB_>"
             "<enabled_><item>1</item><item>1</item></enabled_>"
             "<points_><item><px><id_>0</id_><rotCorrection_>-5.3</rotCorrection_>"
             "<vertCorrection_>-7.1</vertCorrection_><distCorrection_>111</distCorrection_>"
             "<vertOffsetCorrection_>19.7</vertOffsetCorrection_>"
             "<horizOffsetCorrection_>2.6</horizOffsetCorrection_></px></item></points_></DB>"
             "</boost_serialization>"});
  std::string angles = "Channel,Elevation,Azimuth\r\n", times = "Channel,fire time(us)\n";
  std::string states = "Operational State,0,0,2\nAzimuth State,0,1,0\n";
  for (int k = 1; k <= 16; ++k) {
    const std::string number = std::to_string(k);
    angles += number + "," + std::to_string(17 - 2 * k) + ",-1.5\r\n";
    times += number + ",-" + number + "\n";
    states += number + (k == 1 ? ",-,18,46\n" : ",2,2,2\n");
  }
  seeds.add("sensor-csv", {angles, joined({angles, times}), joined({angles, states}),
                           "azimuth_deg,elevation_deg,time_s,ring\n0,1,0,0\n90,-1,0.01,1\n"});
  add_cameras(seeds);
  RayDropModel drop;
  drop.fitted_to = "s";
  drop.edge_runs = {0.5, 0.25};
  drop.blocked = {{0.1F, -1.0F, 1.5F}};
  seeds.add("ray-drop", {ray_drop_toml(drop)});
  seeds.add("labels",
            {"name = \"mine\"\n[[class]]\nid = 1\nname = \"pole\"\ngroup = \"linear\"\n"
             "mobility = \"movable\"\nrgb = [255, 240, 150]\n[[class]]\nid = 2\nname = \"r\"\n"
             "group = \"ground\"\n"});
  seeds.add("class-map", {"# c\nroad = 40 0 street\npole = 80\nunlabeled = 0 none\n"});
}

/// A masked frame, as browsers send them (RFC 6455, 5.2).
std::string frame(int first_byte, const std::string& payload) {
  std::string bytes = {static_cast<char>(first_byte), static_cast<char>(0x80 | payload.size())};
  const std::string mask = "abcd";
  bytes += mask;
  for (std::size_t k = 0; k < payload.size(); ++k)
    bytes += static_cast<char>(payload[k] ^ mask[k % 4]);
  return bytes;
}

void add_server(Seeds& seeds) {
  const std::string host = " HTTP/1.1\r\nHost: localhost:8123\r\n";
  seeds.add("http",
            {"GET /t/" + host + "\r\n", "GET /t/" + host + "\r\nHEAD /t/a%20b?q" + host + "\r\n",
             "GET /t/throw" + host + "Connection: close\r\n\r\n",
             "GET /t/live" + host +
                 "Upgrade: websocket\r\nConnection: Upgrade\r\nOrigin: http://localhost:8123\r\n"
                 "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n",
             "POST /t/" + host + "Content-Length: 3\r\n\r\nabc"});
  seeds.add("websocket", {frame(0x81, "{}"), frame(0x01, "a") + frame(0x80, "b") + frame(0x89, "p"),
                          frame(0x82, "x"), frame(0x88, std::string("\x03\xe8") + "bye"),
                          frame(0x81, "ok") + frame(0x88, "")});
  seeds.add("request", {"/t/a%20b?q\nx", "localhost:8123\n", "http://[::1]:8123\n[::1]:8123",
                        "192.168.1.2:8123\n"});
  seeds.add(
      "live-message",
      {R"({"type":"pose","pose":[1,2,3,0,0,0,1],"velocity_m_s":[4,5,6],"yaw_rate_rad_s":0.5})",
       R"({"type":"run","on":true})", R"({"type":"ready"})",
       R"({"type":"pick","id":77,"origin":[0,0,1],"direction":[0,0,-2]})",
       R"({"type":"sensor","name":"velodyne-vlp-16","settings":{"noise":false,)"
       R"("max_range_m":40.5,"sub_rays":7,"returns":2,"rolling_shutter":true,)"
       R"("fog_visibility_m":150,"rain_mm_h":0}})"});
}

}  // namespace
}  // namespace adasplats::fuzz

int main(int count, char** words) {
  if (count != 2) {
    std::cerr << "usage: adasplats_fuzz_seeds FOLDER\n";
    return 64;
  }
  namespace fuzz = adasplats::fuzz;
  fuzz::Seeds seeds(words[1]);
  fuzz::add_points(seeds);
  fuzz::add_recordings(seeds);
  fuzz::add_packets(seeds);
  fuzz::add_places(seeds);
  fuzz::add_poses(seeds);
  fuzz::add_drives(seeds);
  fuzz::add_settings(seeds);
  fuzz::add_server(seeds);
}
