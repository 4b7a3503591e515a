// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>

#include "adasplats/gpu/base/device_memory.h"
#include "adasplats/gpu/optix/optix_api.h"
#include "adasplats/gpu/optix/optix_library.h"
#include "adasplats/gpu/optix/optix_params.h"

namespace adasplats::gpu {

/// Owns an object of OptiX.
template <class T>
struct OptixDelete {
  optix::Result (*destroy)(T*) = nullptr;
  void operator()(T* object) const { static_cast<void>(destroy(object)); }
};
template <class T>
using OptixHandle = std::unique_ptr<T, OptixDelete<T>>;

/// Private to gpu/: OptiX on the current device with our programs (optix_programs.cu), ready to
/// launch. The driver compiles them on first use and caches the result on disk.
class OptixPipeline {
 public:
  /// `stream` must outlive the pipeline.
  /// Errors: unavailable (no library, driver too old, programs rejected), with a remedy.
  explicit OptixPipeline(cudaStream_t stream);

  const OptixLibrary& library() const { return library_; }
  const optix::Functions& optix() const { return library_.functions(); }
  optix::Context context() const { return context_.get(); }

  /// Queues `rays` rays. `parameters` is device memory. `has_disks`: the first build input of the
  /// scene contains disks (triangles may follow); otherwise the scene has only triangles.
  void launch(OptixQuery query, bool has_disks, const OptixParams* parameters, std::size_t rays,
              cudaStream_t stream) const;

 private:
  void make_context();
  void make_module();
  void make_groups();
  void make_pipeline(OptixQuery query);
  void fill_records(cudaStream_t stream);

  /// The programs, in the order of their records in the shader binding table.
  enum Program : std::size_t {
    raygen_nearest,
    raygen_several,
    miss,
    nearest_disk,  // from here on in the order of OptiX: by build input, then by query
    several_disk,
    nearest_triangle,
    several_triangle,
  };
  static constexpr std::size_t kPrograms = several_triangle + 1;

  OptixLibrary library_;
  OptixHandle<optix::ContextObject> context_;
  OptixHandle<optix::ModuleObject> module_;
  std::array<OptixHandle<optix::ProgramGroupObject>, kPrograms> groups_;
  std::array<OptixHandle<optix::PipelineObject>, kOptixQueries> pipelines_;
  DeviceBuffer<optix::ProgramRecord> records_;
};

}  // namespace adasplats::gpu
