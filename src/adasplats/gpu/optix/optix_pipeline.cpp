// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#if defined(ADASPLATS_HAVE_CUDA)
#include "adasplats/gpu/optix/optix_pipeline.h"

#include <string>

namespace adasplats::gpu {
namespace {

#include "optix_programs.inc"  // kOptixPrograms: made of optix_programs.cu by cmake/Optix.cmake

optix::PipelineOptions pipeline_options() {
  optix::PipelineOptions options;
  options.payload_values = 2;
  options.launch_parameters = "params";
  return options;
}

/// Buffer for the log of the OptiX compiler.
struct CompilerLog {
  std::string text = std::string(2048, '\0');
  std::size_t size = text.size();

  std::string written() const { return text.c_str(); }
};

optix::ProgramGroupDescription raygen(optix::Module module, const char* name) {
  optix::ProgramGroupDescription description;
  description.kind = optix::ProgramKind::raygen;
  description.entries.closest_hit = {module, name};  // its position in the union
  return description;
}

optix::ProgramGroupDescription intersection(optix::Module module, const char* name) {
  optix::ProgramGroupDescription description;
  description.kind = optix::ProgramKind::hit_group;
  description.entries.intersection = {module, name};
  return description;
}

}  // namespace

OptixPipeline::OptixPipeline(cudaStream_t stream) {
  make_context();
  make_module();
  make_groups();
  make_pipeline(OptixQuery::nearest);
  make_pipeline(OptixQuery::several);
  fill_records(stream);
}

void OptixPipeline::make_context() {
  cuda_check(cudaFree(nullptr), "start CUDA");  // OptiX uses the current context
  const optix::ContextOptions options;
  optix::Context context = nullptr;
  library_.check(optix().context_create(nullptr, &options, &context), "start");
  context_ = {context, {optix().context_destroy}};
}

void OptixPipeline::make_module() {
  const optix::ModuleOptions options;
  const optix::PipelineOptions pipeline = pipeline_options();
  CompilerLog log;
  optix::Module module = nullptr;
  const auto* code = reinterpret_cast<const char*>(kOptixPrograms);
  const optix::Result result =
      optix().module_create(context(), &options, &pipeline, code, sizeof kOptixPrograms,
                            log.text.data(), &log.size, &module);
  library_.check(result, "compile the programs", log.written());
  module_ = {module, {optix().module_destroy}};
}

void OptixPipeline::make_groups() {
  std::array<optix::ProgramGroupDescription, kPrograms> descriptions;
  optix::Module module = module_.get();
  descriptions[raygen_nearest] = raygen(module, "__raygen__nearest");
  descriptions[raygen_several] = raygen(module, "__raygen__several");
  descriptions[nearest_disk] = intersection(module, "__intersection__nearest_disk");
  descriptions[several_disk] = intersection(module, "__intersection__several_disk");
  descriptions[nearest_triangle] = intersection(module, "__intersection__nearest_triangle");
  descriptions[several_triangle] = intersection(module, "__intersection__several_triangle");
  const optix::ProgramGroupOptions options;
  std::array<optix::ProgramGroup, kPrograms> groups{};
  CompilerLog log;
  const optix::Result result =
      optix().program_group_create(context(), descriptions.data(), kPrograms, &options,
                                   log.text.data(), &log.size, groups.data());
  library_.check(result, "prepare the programs", log.written());
  for (std::size_t i = 0; i < kPrograms; ++i)
    groups_[i] = {groups[i], {optix().program_group_destroy}};
}

void OptixPipeline::make_pipeline(OptixQuery query) {
  const bool one = query == OptixQuery::nearest;
  const std::array groups = {groups_[one ? raygen_nearest : raygen_several].get(),
                             groups_[miss].get(), groups_[one ? nearest_disk : several_disk].get(),
                             groups_[one ? nearest_triangle : several_triangle].get()};
  const optix::PipelineOptions options = pipeline_options();
  const optix::LinkOptions link;
  CompilerLog log;
  optix::Pipeline pipeline = nullptr;
  const optix::Result result =
      optix().pipeline_create(context(), &options, &link, groups.data(), groups.size(),
                              log.text.data(), &log.size, &pipeline);
  library_.check(result, "link the programs", log.written());
  pipelines_[static_cast<std::size_t>(query)] = {pipeline, {optix().pipeline_destroy}};
}

void OptixPipeline::fill_records(cudaStream_t stream) {
  std::array<optix::ProgramRecord, kPrograms> records{};
  for (std::size_t i = 0; i < kPrograms; ++i)
    library_.check(optix().pack_record(groups_[i].get(), &records[i]), "prepare the programs");
  records_ = {std::span<const optix::ProgramRecord>(records), stream};
}

void OptixPipeline::launch(OptixQuery query, bool has_disks, const OptixParams* parameters,
                           std::size_t rays, cudaStream_t stream) const {
  const auto record = [this](Program program) {
    return reinterpret_cast<optix::DeviceAddress>(records_.data() + program);
  };
  constexpr unsigned kStride = sizeof(optix::ProgramRecord);
  optix::ShaderBindingTable table;
  table.raygen = record(query == OptixQuery::nearest ? raygen_nearest : raygen_several);
  table.miss = record(miss);
  table.miss_stride = kStride;
  table.miss_count = 1;
  const Program first = has_disks ? nearest_disk : nearest_triangle;
  table.hit_groups = record(first);
  table.hit_group_stride = kStride;
  table.hit_group_count = static_cast<unsigned>(kPrograms - first);
  const auto index = static_cast<std::size_t>(query);
  const optix::Result result = optix().launch(
      pipelines_[index].get(), stream, reinterpret_cast<optix::DeviceAddress>(parameters),
      sizeof(OptixParams), &table, static_cast<unsigned>(rays), 1, 1);
  library_.check(result, "cast rays");
}

}  // namespace adasplats::gpu
#endif
