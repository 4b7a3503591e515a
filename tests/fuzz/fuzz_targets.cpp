// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "fuzz_readers.h"
#include "fuzz_target.h"

// THE list of fuzz targets: what reads anything that somebody else made has an entry here, and
// seeds in corpus/NAME. tools/check_fuzzers.py holds `sources` against the sources that open files
// or parse, and adasplats_fuzz --check the files against point_formats() and
// recording_extensions().
namespace adasplats::fuzz {
namespace {

constexpr std::size_t kKiB = 1024;
/// unpack_zstd_stream() allows 128 MiB, which Zstandard asks for with a little more.
constexpr std::size_t kZstdWindow_mb = 136;

constexpr FuzzTarget kTargets[] = {
    // Points
    {"ply", "a.ply", "io/ply io/point_format.cpp cloud/load/file_kind.cpp", &read_ply_file},
    {"pcd", "a.pcd", "io/pcd", &read_point_file},
    {"las", "a.las", "io/las", &read_point_file},
    {"laz", "a.laz", "io/las io/laz", &read_laz_file},
    {"copc", "a.copc.laz", "io/las", &read_copc_file},
    {"e57", "a.e57", "io/e57", &read_e57_file, 8 * kKiB},
    {"e57-xml", "a.e57", "io/e57/e57_content.cpp", &read_e57_xml},
    {"wkt", "", "io/base/wkt.cpp io/base/crs.cpp", &read_wkt},
    {"kitti-bin", "a.bin", "io/arrays/kitti_bin.cpp", &read_point_file},
    {"nuscenes-bin", "a.pcd.bin", "io/arrays/kitti_bin.cpp", &read_point_file},
    {"xyz", "a.xyz", "io/text/text_points.cpp io/base/line_reader.cpp", &read_text_file},
    {"txt", "a.txt", "io/text/text_points.cpp cloud/load/file_kind.cpp", &read_text_file},
    {"asc", "a.asc", "io/text/text_points.cpp", &read_text_file},
    {"csv", "a.csv", "io/text/text_points.cpp", &read_text_file},
    {"pts", "a.pts", "io/text/text_points.cpp", &read_text_file},
    {"ptx", "a.ptx", "io/text/ptx.cpp", &read_text_file},
    {"pickle", "", "io/pickle", &read_pickle},
    {"gzip", "", "io/pickle/gzip.cpp", &read_gzip},
    {"arrow", "", "io/arrow", &read_arrow, 4 * kKiB, kZstdWindow_mb},
    {"potree", "octree.bin metadata.json", "io/ept/potree_octree.cpp", &read_point_file},
    {"ept", "ept.json ept-data/0-0-0-0.bin", "io/ept", &read_ept, 4 * kKiB, kZstdWindow_mb},
    {"kitti-label", "a.label", "cloud/sequence/kitti_sequence.cpp", &read_label_file},
    // Recordings
    {"mcap", "a.mcap", "io/bags io/mcap/mcap_file.cpp", &read_recording, 4 * kKiB, kZstdWindow_mb},
    {"bag", "a.bag", "io/bags", &read_recording},
    {"db3", "a.db3", "io/bags", &read_recording, 8 * kKiB},
    {"mcap-zstd", "a.mcap.zstd", "io/bags", &read_recording, 4 * kKiB, kZstdWindow_mb},
    {"ros2-bag", "metadata.yaml a.mcap", "io/bags/recording.cpp", &read_bag_folder, 4 * kKiB,
     kZstdWindow_mb},
    {"ros-message", "", "io/bags/ros_values.cpp io/bags/ros_reader.h", &read_ros_message},
    {"unpack", "", "io/bags/unpack.cpp", &read_packed_bytes, 1 * kKiB, kZstdWindow_mb},
    {"clouds", "a.mcap", "cloud/load/recording_drive.cpp cloud/load/recording_poses.cpp",
     &survey_clouds, 4 * kKiB, kZstdWindow_mb},
    {"pcap", "a.pcap", "io/packets", &read_capture},
    {"packet", "",
     "sensors/packet_decoder.cpp sensors/ouster_parser.cpp sensors/velodyne_parser.cpp "
     "sensors/hesai_parser.cpp",
     &read_packet, 26 * kKiB},
    {"capture", "a.pcap",
     "cloud/load/packet_survey.cpp cloud/load/packet_revolutions.cpp cloud/load/packet_file.cpp",
     &survey_capture, 8 * kKiB},
    // Places
    {"obj", "a.obj", "io/text/obj.cpp splats/model/mesh_model.cpp", &read_mesh},
    {"mesh-ply", "a.ply", "splats/model/mesh_model.cpp io/ply", &read_mesh},
    {"gltf", "a.gltf b.bin", "io/text/gltf.cpp io/base/base64.cpp", &read_gltf},
    {"glb", "a.glb", "io/text/gltf.cpp", &read_gltf},
    {"splats", "a.ply", "splats/model/splat_model.cpp splats/model/gaussians.cpp",
     &read_splat_model},
    {"spz", "a.spz", "io/gaussians/spz_reader.cpp", &read_splat_model, 4 * kKiB, kZstdWindow_mb},
    {"world", "a.toml car.ply", "simulate/world/world_file.cpp", &read_world},
    {"city", "city.json", "city/city_manifest.cpp io/base/json_rows.cpp", &read_city},
    {"city-points", "points.json", "city/layer_facts.cpp", &read_layer_facts},
    {"levels", "a.levels", "levels/level_file.cpp", &read_level_file},
    {"network", "", "segment/network/network.cpp", &read_network_bytes},
    // Drives
    {"poses-kitti", "poses.txt calib.txt times.txt", "cloud/poses/trajectory_file.cpp",
     &read_pose_file},
    {"poses-csv", "a.csv", "cloud/poses/trajectory_file.cpp cloud/poses/pose_columns.cpp",
     &read_pose_file},
    {"poses-tum", "a.tum", "cloud/poses/trajectory_file.cpp", &read_pose_file},
    {"poses-xosc", "a.xosc", "cloud/poses/openscenario.cpp", &read_pose_file},
    {"scan-times", "a.txt", "cloud/load/scan_stamps.cpp", &read_times},
    {"boxes", "a.csv", "cloud/load/csv_boxes.cpp cloud/load/box_files.cpp", &read_boxes},
    {"boxes-kitti", "tracklet_labels.xml", "cloud/load/kitti_tracklets.cpp", &read_boxes},
    {"boxes-pandaset", "lidar/timestamps.json annotations/cuboids/00.pkl.gz",
     "cloud/load/pandaset_boxes.cpp", &read_box_folder, 8 * kKiB},
    {"boxes-av2", "annotations.feather city_SE3_egovehicle.feather", "cloud/load/av2_boxes.cpp",
     &read_box_folder, 8 * kKiB, kZstdWindow_mb},
    {"boxes-nuscenes",
     "v1.0-mini/scene.json v1.0-mini/sample.json v1.0-mini/sample_annotation.json "
     "v1.0-mini/instance.json v1.0-mini/category.json",
     "cloud/load/nuscenes_boxes.cpp", &read_box_folder},
    {"kitti", "poses.txt calib.txt times.txt velodyne/000000.bin labels/000000.label",
     "cloud/sequence/kitti_sequence.cpp", &open_kitti},
    {"kitti-raw",
     "calib_imu_to_velo.txt velodyne_points/timestamps.txt velodyne_points/data/0000000001.txt "
     "oxts/timestamps.txt oxts/data/0000000000.txt oxts/data/0000000001.txt "
     "oxts/data/0000000002.txt",
     "cloud/sequence/kitti_raw.cpp", &open_kitti_raw},
    {"pandaset",
     "lidar/poses.json lidar/timestamps.json lidar/00.pkl.gz annotations/semseg/classes.json "
     "annotations/semseg/00.pkl.gz",
     "cloud/load/pandaset_drive.cpp io/base/json_table.cpp", &open_pandaset, 8 * kKiB},
    {"av2",
     "city_SE3_egovehicle.feather calibration/egovehicle_SE3_sensor.feather "
     "sensors/lidar/315966265259836000.feather",
     "cloud/load/av2_drive.cpp io/arrow", &open_av2, 8 * kKiB, kZstdWindow_mb},
    {"nuscenes",
     "v1.0-mini/scene.json v1.0-mini/sample.json v1.0-mini/sample_data.json "
     "v1.0-mini/sensor.json v1.0-mini/calibrated_sensor.json v1.0-mini/ego_pose.json "
     "v1.0-mini/lidarseg.json v1.0-mini/category.json",
     "cloud/load/nuscenes_drive.cpp io/base/json_table.cpp", &open_nuscenes},
    {"rig", "a.toml", "cloud/load/rig.cpp", &read_rig_text},
    // Settings
    {"sensor-toml", "a.toml",
     "sensors/lidar_toml.cpp sensors/lidar_file.cpp sensors/toml_table.cpp", &read_lidar_file},
    {"sensor-json", "a.json", "sensors/lidar_ouster.cpp", &read_lidar_file},
    {"sensor-yaml", "a.yaml", "sensors/lidar_velodyne.cpp", &read_lidar_file},
    {"sensor-xml", "a.xml", "sensors/lidar_velodyne.cpp", &read_lidar_file},
    {"sensor-csv", "a_angle.csv a_firetime.csv", "sensors/lidar_csv.cpp sensors/lidar_hesai.cpp",
     &read_lidar_file},
    {"sensor-dat", "a.dat", "sensors/lidar_hesai_mirror.cpp", &read_lidar_file, 48 * kKiB},
    {"camera-toml", "a.toml", "sensors/camera_file.cpp", &read_camera_file},
    {"camera-yaml", "a.yaml", "sensors/camera_ros.cpp", &read_camera_file},
    {"camera-json", "a.json", "sensors/camera_ros.cpp", &read_camera_file},
    {"camera-kitti", "calib_cam_to_cam.txt calib_velo_to_cam.txt", "sensors/camera_kitti.cpp",
     &read_camera_file},
    {"camera-odometry", "calib.txt image_0/000000.png", "sensors/camera_kitti.cpp",
     &read_camera_file},
    {"camera-nuscenes",
     "calibrated_sensor.json sensor.json sample_data.json scene.json sample.json",
     "sensors/camera_nuscenes.cpp io/base/json_table.cpp", &read_nuscenes_camera_file},
    {"ray-drop", "a.toml", "sensors/ray_drop_model.cpp", &read_ray_drop},
    {"labels", "a.toml", "cloud/labels/label_scheme_file.cpp", &read_labels},
    {"class-map", "a.txt", "jobs/segment/output_classes.cpp", &read_classes_of_network},
    // The server
    {"http", "", "serve", &answer_http},
    {"websocket", "", "serve/websocket_connection.cpp", &answer_websocket},
    {"request", "", "serve/request_check.cpp", &check_request},
    {"live-message", "", "view/live_message.cpp", &read_live_message},
};

}  // namespace

std::span<const FuzzTarget> fuzz_targets() { return kTargets; }

}  // namespace adasplats::fuzz
