// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

struct CUctx_st;
struct CUstream_st;

/// Private to gpu/: our own declarations of the used part of the binary interface of the OptiX
/// library of the NVIDIA driver. The numbers are those of ABI 87 (OptiX 8.0) and 105 (9.0), which
/// differ here only in the length of the function table.
namespace adasplats::optix {

using Result = int;  ///< 0: success
using DeviceAddress = std::uint64_t;
using Traversable = std::uint64_t;

// Objects of the library.
using Context = struct ContextObject*;
using Module = struct ModuleObject*;
using ProgramGroup = struct ProgramGroupObject*;
using Pipeline = struct PipelineObject*;

struct ContextOptions {
  void (*log)(unsigned level, const char* tag, const char* message, void* data) = nullptr;
  void* log_data = nullptr;
  int log_level = 0;
  int validation = 0;  ///< 0: off, -1: all
};
static_assert(sizeof(ContextOptions) == 24);

struct ModuleOptions {
  int max_registers = 0;  ///< 0: the library chooses
  int optimization = 0;   ///< 0: full
  int debug = 0x2350;     ///< none
  const void* bound_values = nullptr;
  unsigned bound_value_count = 0;
  unsigned payload_type_count = 0;
  const void* payload_types = nullptr;
};
static_assert(sizeof(ModuleOptions) == 40 && offsetof(ModuleOptions, bound_values) == 16);

struct PipelineOptions {
  int motion_blur = 0;
  unsigned graph = 1;  ///< 1: one geometry structure, no instances
  int payload_values = 0;
  int attribute_values = 0;
  unsigned exceptions = 0;
  const char* launch_parameters = nullptr;  ///< name of the variable
  unsigned primitive_types = 1;             ///< 1: custom primitives alone
  int opacity_micromaps = 0;
  int clustered_geometry = 0;  ///< since ABI 105; ignored by older libraries
};
static_assert(sizeof(PipelineOptions) == 48 && offsetof(PipelineOptions, launch_parameters) == 24);

struct LinkOptions {
  unsigned max_trace_depth = 1;
};
static_assert(sizeof(LinkOptions) == 4);

enum class ProgramKind : int { raygen = 0x2421, miss = 0x2422, hit_group = 0x2424 };

struct ProgramEntry {
  Module module = nullptr;
  const char* name = nullptr;
};

struct HitGroupEntries {
  ProgramEntry closest_hit, any_hit, intersection;
};

struct ProgramGroupDescription {
  ProgramKind kind = ProgramKind::miss;
  unsigned flags = 0;
  HitGroupEntries entries;  ///< a union in the library; raygen and miss have the first alone
};
static_assert(sizeof(ProgramGroupDescription) == 56 &&
              offsetof(ProgramGroupDescription, entries) == 8 &&
              offsetof(HitGroupEntries, intersection) == 32);

struct ProgramGroupOptions {
  const void* payload_type = nullptr;
};
static_assert(sizeof(ProgramGroupOptions) == 8);

/// Record of a program in the shader binding table: the library's header, without data of ours.
struct alignas(16) ProgramRecord {
  std::array<std::byte, 32> header;
};
static_assert(sizeof(ProgramRecord) == 32);

struct ShaderBindingTable {
  DeviceAddress raygen = 0;
  DeviceAddress exception = 0;
  DeviceAddress miss = 0;
  unsigned miss_stride = 0;
  unsigned miss_count = 0;
  DeviceAddress hit_groups = 0;
  unsigned hit_group_stride = 0;
  unsigned hit_group_count = 0;
  DeviceAddress callables = 0;
  unsigned callable_stride = 0;
  unsigned callable_count = 0;
};
static_assert(sizeof(ShaderBindingTable) == 64 && offsetof(ShaderBindingTable, hit_groups) == 32);

/// Box of a custom primitive.
struct Box {
  float low[3], high[3];
};
static_assert(sizeof(Box) == 24);

struct CustomPrimitives {
  const DeviceAddress* boxes = nullptr;  ///< one address (a list is for moving primitives)
  unsigned count = 0;
  unsigned stride = 0;              ///< 0: boxes are contiguous
  const unsigned* flags = nullptr;  ///< one for each record of the shader binding table
  unsigned records = 1;             ///< records of the shader binding table
  DeviceAddress record_of_primitive = 0;
  unsigned record_bytes = 0;
  unsigned record_stride = 0;
  unsigned first_index = 0;  ///< added to the index passed to programs
};
static_assert(sizeof(CustomPrimitives) == 56 && offsetof(CustomPrimitives, flags) == 16 &&
              offsetof(CustomPrimitives, first_index) == 48);

struct BuildInput {
  static constexpr int kCustomPrimitives = 0x2142;
  int type = kCustomPrimitives;
  CustomPrimitives primitives;  ///< a union in the library
  std::array<std::byte, 1024 - sizeof(CustomPrimitives)> reserved{};
};
static_assert(sizeof(BuildInput) == 1032 && offsetof(BuildInput, primitives) == 8);

struct BuildOptions {
  static constexpr unsigned kAllowCompaction = 2, kPreferFastTrace = 4;
  unsigned flags = kAllowCompaction | kPreferFastTrace;
  int operation = 0x2161;  ///< build
  std::uint16_t motion_keys = 0;
  std::uint16_t motion_flags = 0;
  float motion_begin = 0;
  float motion_end = 0;
};
static_assert(sizeof(BuildOptions) == 20);

struct BuildSizes {
  std::size_t output = 0;
  std::size_t temporary = 0;
  std::size_t temporary_of_update = 0;
};
static_assert(sizeof(BuildSizes) == 24);

struct EmittedProperty {
  static constexpr int kCompactedSize = 0x2181;
  DeviceAddress result = 0;
  int type = kCompactedSize;
};
static_assert(sizeof(EmittedProperty) == 16);

inline constexpr std::size_t kBufferAlignment = 128;
inline constexpr std::size_t kMaxPrimitives = std::size_t{1} << 29U;
inline constexpr std::size_t kMaxLaunch = std::size_t{1} << 30U;

/// The library's functions.
struct Functions {
  const char* (*error_name)(Result) = nullptr;
  const char* (*error_string)(Result) = nullptr;
  Result (*context_create)(CUctx_st*, const ContextOptions*, Context*) = nullptr;
  Result (*context_destroy)(Context) = nullptr;
  Result (*module_create)(Context, const ModuleOptions*, const PipelineOptions*, const char* code,
                          std::size_t bytes, char* log, std::size_t* log_size, Module*) = nullptr;
  Result (*module_destroy)(Module) = nullptr;
  Result (*program_group_create)(Context, const ProgramGroupDescription*, unsigned count,
                                 const ProgramGroupOptions*, char* log, std::size_t* log_size,
                                 ProgramGroup*) = nullptr;
  Result (*program_group_destroy)(ProgramGroup) = nullptr;
  Result (*pipeline_create)(Context, const PipelineOptions*, const LinkOptions*,
                            const ProgramGroup*, unsigned count, char* log, std::size_t* log_size,
                            Pipeline*) = nullptr;
  Result (*pipeline_destroy)(Pipeline) = nullptr;
  Result (*build_sizes)(Context, const BuildOptions*, const BuildInput*, unsigned count,
                        BuildSizes*) = nullptr;
  Result (*build)(Context, CUstream_st*, const BuildOptions*, const BuildInput*, unsigned count,
                  DeviceAddress temporary, std::size_t temporary_bytes, DeviceAddress output,
                  std::size_t output_bytes, Traversable*, const EmittedProperty*,
                  unsigned property_count) = nullptr;
  Result (*compact)(Context, CUstream_st*, Traversable, DeviceAddress output,
                    std::size_t output_bytes, Traversable*) = nullptr;
  Result (*pack_record)(ProgramGroup, void* record) = nullptr;
  Result (*launch)(Pipeline, CUstream_st*, DeviceAddress parameters, std::size_t parameter_bytes,
                   const ShaderBindingTable*, unsigned width, unsigned height,
                   unsigned depth) = nullptr;
};

/// The library's only exported function: fills `table` with the functions of an ABI.
using QueryFunctionTable = Result (*)(int abi, unsigned option_count, void* options,
                                      const void** option_values, void* table,
                                      std::size_t table_bytes);

}  // namespace adasplats::optix
