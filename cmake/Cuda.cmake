# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0

# CUDA is optional: it is used if nvcc is found (CUDACXX, PATH or its usual folder).

# The default of CMAKE_CUDA_ARCHITECTURES: the GPUs of this machine; without one, Turing (7.5). Newer GPUs
# work, too: their driver compiles the PTX on first use. Compile time grows with each architecture.
function(adasplats_cuda_architectures result)
  set(found "")
  find_program(smi nvidia-smi NO_CACHE)
  if(smi)
    execute_process(COMMAND ${smi} --query-gpu=compute_cap --format=csv,noheader
                    OUTPUT_VARIABLE found RESULT_VARIABLE status ERROR_QUIET)
    if(NOT status EQUAL 0)
      set(found "")
    endif()
  endif()
  string(REGEX MATCHALL "[0-9]+\\.[0-9]+" found "${found}")
  list(TRANSFORM found REPLACE "\\." "")
  list(REMOVE_DUPLICATES found)
  # Drop architectures that are too old or that this nvcc does not support.
  execute_process(COMMAND ${ADASPLATS_NVCC} --list-gpu-arch OUTPUT_VARIABLE known ERROR_QUIET)
  foreach(architecture IN LISTS found)
    if(architecture LESS 75 OR NOT known MATCHES "compute_${architecture}\n")
      list(REMOVE_ITEM found ${architecture})
    endif()
  endforeach()
  if(NOT found)
    set(found 75)  # machine code as well as PTX, so that the build runs the assembler
  endif()
  set(${result} ${found} PARENT_SCOPE)
endfunction()

set(missing "")
if(ADASPLATS_SANITIZE)
  set(missing "no CUDA with sanitizers")
elseif(ADASPLATS_USE_CUDA)
  find_program(ADASPLATS_NVCC nvcc HINTS ENV CUDA_PATH PATHS /usr/local/cuda PATH_SUFFIXES bin)
  mark_as_advanced(ADASPLATS_NVCC)
  if(NOT CMAKE_CUDA_COMPILER AND NOT DEFINED ENV{CUDACXX} AND ADASPLATS_NVCC)
    set(CMAKE_CUDA_COMPILER ${ADASPLATS_NVCC})
  endif()
  if(CMAKE_CUDA_COMPILER OR DEFINED ENV{CUDACXX})
    if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES)
      adasplats_cuda_architectures(CMAKE_CUDA_ARCHITECTURES)
    endif()
    enable_language(CUDA)
  endif()
  if(NOT CMAKE_CUDA_COMPILER)
    set(missing "no CUDA compiler (nvcc 12 or newer)")
  elseif(CMAKE_CUDA_COMPILER_VERSION VERSION_LESS 12)
    set(missing "no CUDA compiler of version 12 or newer (found ${CMAKE_CUDA_COMPILER_VERSION})")
  else()
    find_package(CUDAToolkit REQUIRED)
  endif()
endif()
string(REPLACE ";" ", " architectures "${CMAKE_CUDA_ARCHITECTURES}")
adasplats_part(ADASPLATS_USE_CUDA "CUDA" "${missing}"
               "${CMAKE_CUDA_COMPILER_VERSION}, code for ${architectures}" ADASPLATS_CUDA)
# The oldest supported GPU (75 means 7.5), which the library names when it rejects an older one.
if(ADASPLATS_CUDA)
  set(oldest_gpu ${CMAKE_CUDA_ARCHITECTURES})
  list(TRANSFORM oldest_gpu REPLACE "[^0-9].*" "")
  list(SORT oldest_gpu COMPARE NATURAL)
  list(GET oldest_gpu 0 oldest_gpu)
  if(NOT oldest_gpu)  # "native" and "all" are not numbers
    set(oldest_gpu 75)
  endif()
  set_source_files_properties(
    ${PROJECT_SOURCE_DIR}/src/adasplats/gpu/base/device.cpp
    PROPERTIES COMPILE_DEFINITIONS ADASPLATS_OLDEST_GPU=${oldest_gpu})
endif()

# CMake up to 3.25 does not know this option of newer compilers.
foreach(kind STANDARD EXTENSION)
  if(ADASPLATS_CUDA AND NOT CMAKE_CUDA20_${kind}_COMPILE_OPTION)
    set(CMAKE_CUDA20_${kind}_COMPILE_OPTION -std=c++20)
  endif()
endforeach()
set(CMAKE_CUDA_STANDARD 20)
set(CMAKE_CUDA_STANDARD_REQUIRED ON)
set(CMAKE_CUDA_RUNTIME_LIBRARY Static)

# CUDA files that a unity build joins; larger ones would keep one core busy for minutes.
set(ADASPLATS_CUDA_BATCH_SIZE 12)

# Options for a target with *.cu files. Device code does not contract a * b + c either, so that the maths
# of one element gives the same bits as on the CPU. Kernels call fmaf where only speed matters.
function(adasplats_use_cuda target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD_BATCH_SIZE ${ADASPLATS_CUDA_BATCH_SIZE})
  target_compile_definitions(${target} PRIVATE ADASPLATS_HAVE_CUDA)
  target_link_libraries(${target} PRIVATE CUDA::cudart_static)
  target_compile_options(
    ${target}
    PRIVATE $<$<COMPILE_LANGUAGE:CUDA>:--fmad=false>
            $<$<COMPILE_LANGUAGE:CUDA>:--expt-relaxed-constexpr>
            $<$<COMPILE_LANGUAGE:CUDA>:--extended-lambda>
            $<$<COMPILE_LANGUAGE:CUDA>:-Xcompiler=-ffp-contract=off,-Wall,-Wextra,-Wno-psabi>)
endfunction()

# The files to compile for the *.cu files of stage NAME. With CMAKE_UNITY_BUILD, several are joined into
# one, because parsing CUDA's headers takes longer than compiling a file (CMake 3.31 does this itself).
function(adasplats_cuda_unity result name)
  set(sources ${ARGN})
  if(CMAKE_UNITY_BUILD AND CMAKE_VERSION VERSION_LESS 3.31)
    set(size ${ADASPLATS_CUDA_BATCH_SIZE})
    set(together "")
    set(batch 0)
    while(sources)
      list(SUBLIST sources 0 ${size} part)
      list(REMOVE_ITEM sources ${part})
      list(TRANSFORM part REPLACE "(.+)" "#include \"\\1\"")
      list(JOIN part "\n" text)
      set(file ${CMAKE_BINARY_DIR}/unity/${name}_${batch}.cu)
      file(CONFIGURE OUTPUT ${file} CONTENT "${text}\n" @ONLY)
      list(APPEND together ${file})
      math(EXPR batch "${batch} + 1")
    endwhile()
    set(sources ${together})
  endif()
  set(${result} ${sources} PARENT_SCOPE)
endfunction()
