# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0

# CUDA is used where nvcc is found (on PATH, CUDACXX or in its usual folder), and needed nowhere.
set(ADASPLATS_CUDA OFF)
if(ADASPLATS_USE_CUDA AND NOT ADASPLATS_SANITIZE)
  include(CheckLanguage)
  if(NOT CMAKE_CUDA_COMPILER AND NOT DEFINED ENV{CUDACXX})
    find_program(ADASPLATS_NVCC nvcc HINTS ENV CUDA_PATH PATHS /usr/local/cuda PATH_SUFFIXES bin)
    if(ADASPLATS_NVCC)
      set(CMAKE_CUDA_COMPILER ${ADASPLATS_NVCC})
    endif()
  endif()
  # Code of the H100 and its like, and intermediate code that the driver compiles for any other
  # card from Turing on when it is first used; name your own for a start without that wait.
  if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES)
    set(CMAKE_CUDA_ARCHITECTURES 75-virtual 90-real)
  endif()
  if(CMAKE_CUDA_COMPILER OR DEFINED ENV{CUDACXX})
    enable_language(CUDA)
  endif()
  if(CMAKE_CUDA_COMPILER AND CMAKE_CUDA_COMPILER_VERSION VERSION_GREATER_EQUAL 12)
    find_package(CUDAToolkit REQUIRED)
    set(ADASPLATS_CUDA ON)
  endif()
endif()
# CMake up to 3.25 does not know how newer compilers spell it.
foreach(kind STANDARD EXTENSION)
  if(ADASPLATS_CUDA AND NOT CMAKE_CUDA20_${kind}_COMPILE_OPTION)
    set(CMAKE_CUDA20_${kind}_COMPILE_OPTION -std=c++20)
  endif()
endforeach()
set(CMAKE_CUDA_STANDARD 20)
set(CMAKE_CUDA_STANDARD_REQUIRED ON)
set(CMAKE_CUDA_RUNTIME_LIBRARY Static)

# What a target with *.cu needs. No contraction of a * b + c in device code either: the maths of one
# element gives the same bits as on the CPU; where only speed matters kernels say fmaf themselves.
function(adasplats_use_cuda target)
  target_compile_definitions(${target} PRIVATE ADASPLATS_HAVE_CUDA)
  target_link_libraries(${target} PRIVATE CUDA::cudart_static)
  target_compile_options(
    ${target}
    PRIVATE $<$<COMPILE_LANGUAGE:CUDA>:--fmad=false>
            $<$<COMPILE_LANGUAGE:CUDA>:--expt-relaxed-constexpr>
            $<$<COMPILE_LANGUAGE:CUDA>:--extended-lambda>
            $<$<COMPILE_LANGUAGE:CUDA>:-Xcompiler=-ffp-contract=off,-Wall,-Wextra,-Wno-psabi>)
endfunction()
