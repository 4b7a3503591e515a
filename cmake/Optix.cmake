# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0

# OptiX programs (src/adasplats/gpu/optix/optix_programs.cu) are not kernels: nvcc compiles them to
# PTX for Turing and newer, the library contains that as an array of bytes, and the driver compiles it.
# The OptiX SDK is not needed.
if(NOT ADASPLATS_CUDA)
  return()
endif()
find_program(ADASPLATS_BIN2C bin2c HINTS ${CUDAToolkit_BIN_DIR} REQUIRED)
mark_as_advanced(ADASPLATS_BIN2C)

set(programs ${PROJECT_SOURCE_DIR}/src/adasplats/gpu/optix/optix_programs.cu)
set(embedded ${PROJECT_BINARY_DIR}/optix)
file(MAKE_DIRECTORY ${embedded})
add_custom_command(
  OUTPUT ${embedded}/optix_programs.inc
  COMMAND ${CMAKE_CUDA_COMPILER} --ptx -arch=compute_75 -rdc=true -std=c++20 -O3 --fmad=false
          --expt-relaxed-constexpr -I ${PROJECT_SOURCE_DIR}/src -MD -MF ${embedded}/programs.d
          -MT ${embedded}/optix_programs.inc -o ${embedded}/programs.code ${programs}
  COMMAND ${ADASPLATS_BIN2C} --const --padd 0 --name kOptixPrograms ${embedded}/programs.code >
          ${embedded}/optix_programs.inc
  DEPENDS ${programs}
  DEPFILE ${embedded}/programs.d
  COMMENT "Compiling the programs for OptiX"
  VERBATIM)
target_sources(adasplats_gpu PRIVATE ${embedded}/optix_programs.inc)
target_include_directories(adasplats_gpu PRIVATE ${embedded})
target_link_libraries(adasplats_gpu PRIVATE ${CMAKE_DL_LIBS})
