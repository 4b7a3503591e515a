// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fuzz_target.h"

// The bodies of the fuzz targets: each calls one reader as the library does, and looks at what
// cannot be in what comes out.
namespace adasplats::fuzz {

// points.cpp
void read_point_file(const Input& input);
void read_copc_file(const Input& input);
void read_laz_file(const Input& input);
void read_ply_file(const Input& input);
void read_e57_file(const Input& input);
void read_e57_xml(const Input& input);
void read_wkt(const Input& input);
void read_text_file(const Input& input);
void read_pickle(const Input& input);
void read_arrow(const Input& input);
void read_ept(const Input& input);
void read_gzip(const Input& input);
void read_label_file(const Input& input);

// recordings.cpp
void read_recording(const Input& input);
void read_bag_folder(const Input& input);
void read_ros_message(const Input& input);
void read_packed_bytes(const Input& input);
void survey_clouds(const Input& input);
void read_capture(const Input& input);
void read_packet(const Input& input);
void survey_capture(const Input& input);

// places.cpp
void read_mesh(const Input& input);
void read_gltf(const Input& input);
void read_splat_model(const Input& input);
void read_world(const Input& input);
void read_city(const Input& input);
void read_layer_facts(const Input& input);
void read_level_file(const Input& input);
void read_network_bytes(const Input& input);

// drives.cpp
void read_pose_file(const Input& input);
void read_times(const Input& input);
void read_boxes(const Input& input);
void read_box_folder(const Input& input);
void open_kitti(const Input& input);
void open_kitti_raw(const Input& input);
void open_pandaset(const Input& input);
void open_av2(const Input& input);
void open_nuscenes(const Input& input);
void read_rig_text(const Input& input);

// settings.cpp
void read_lidar_file(const Input& input);
void read_camera_file(const Input& input);
void read_nuscenes_camera_file(const Input& input);
void read_ray_drop(const Input& input);
void read_labels(const Input& input);
void read_classes_of_network(const Input& input);

// server.cpp
void answer_http(const Input& input);
void answer_websocket(const Input& input);
void check_request(const Input& input);
void read_live_message(const Input& input);

}  // namespace adasplats::fuzz
