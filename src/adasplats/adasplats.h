// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// @mainpage
/// All that a program needs from points to evaluated scans is one include, adasplats/adasplats.h:
/// load_cloud(), make_model(), save_model() and load_model(), ModelScene (with its Tracer),
/// ScanSimulator, write_scan_ply() and make_scan_writer(), evaluate_clouds() and its like, and an
/// OwnSession to do it with. The command line and Python are made of the same functions. To be
/// included by name: meshes of other methods (baselines/), whole pieces of work with files in and
/// files out (jobs/), the viewer's server (view/). The library itself includes what it needs.

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/core/error.h"
#include "adasplats/dataset/scan_files.h"
#include "adasplats/dataset/scan_writer.h"
#include "adasplats/jobs/evaluate/evaluate_clouds.h"
#include "adasplats/jobs/evaluate/evaluate_echoes.h"
#include "adasplats/jobs/evaluate/evaluate_labels.h"
#include "adasplats/jobs/evaluate/evaluate_resimulation.h"
#include "adasplats/jobs/evaluate/evaluate_surface.h"
#include "adasplats/jobs/model/make_model.h"
#include "adasplats/jobs/scene/drive.h"
#include "adasplats/jobs/scene/model_scene.h"
#include "adasplats/jobs/scene/scan_simulator.h"
#include "adasplats/jobs/session/session.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/splats/model/splat_model.h"
