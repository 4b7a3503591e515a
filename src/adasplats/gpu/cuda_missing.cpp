// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#if !defined(ADASPLATS_HAVE_CUDA)
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/gpu/base/device.h"
#include "adasplats/gpu/base/engines.h"
#include "adasplats/gpu/simulate/gpu_scene.h"

// The public functions of the stage in a build without CUDA.
namespace adasplats {
namespace {

[[noreturn]] void throw_missing(const std::string& doing) {
  throw Error(ErrorKind::unavailable, "cannot " + doing + " on a GPU: " + find_gpus().reason);
}

}  // namespace

GpuSearch find_gpus() {
  return {.devices = {},
          .driver = "",
          .reason = "this build has no CUDA; build it where CMake finds nvcc (CUDA 12 or newer)"};
}
std::size_t free_memory_bytes(int) { return 0; }
void limit_gpu_memory(int, std::size_t) {}
std::size_t gpu_memory_limit(int) { return 0; }
std::size_t usable_gpu_memory(int) { return 0; }
std::size_t peak_gpu_memory(int) { return 0; }
bool built_with_cuda() { return false; }

std::unique_ptr<ModelEngine> make_cuda_model_engine(int) { throw_missing("build models"); }
std::unique_ptr<CalibrationSteps> make_cuda_calibration_steps(int) { throw_missing("calibrate"); }
std::unique_ptr<SegmentEngine> make_cuda_segment_engine(int) { throw_missing("run networks"); }

std::unique_ptr<GpuScene> make_gpu_scene(const SceneView&, Vec3d, TracingBackend,
                                         const std::vector<int>&) {
  throw_missing("trace");
}
std::unique_ptr<GpuCity> make_gpu_city(std::span<const std::size_t>,
                                       std::span<const PrimitiveValues>, Vec3d,
                                       const std::vector<int>&) {
  throw_missing("trace");
}
void wait_for(const DeviceHits&) { throw_missing("trace"); }
std::vector<Hit> download(const DeviceHits&, int) { throw_missing("trace"); }

}  // namespace adasplats
#endif
