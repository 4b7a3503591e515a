# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0

# Fuzz targets (tests/fuzz) need the whole library instrumented: with sanitizers and libFuzzer's counters,
# or with the counters of llvm-cov.
if(NOT ADASPLATS_BUILD_FUZZERS)
  return()
endif()
if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  message(FATAL_ERROR "ADASPLATS_BUILD_FUZZERS is ON, but the compiler is ${CMAKE_CXX_COMPILER_ID} "
                      "${CMAKE_CXX_COMPILER_VERSION}: libFuzzer comes with Clang "
                      "(cmake --preset fuzz, or -DCMAKE_CXX_COMPILER=clang++ in a new folder)")
endif()
if(ADASPLATS_FUZZ_COVERAGE)
  add_compile_options(-O1 -fprofile-instr-generate -fcoverage-mapping)
  add_link_options(-fprofile-instr-generate)
elseif(NOT ADASPLATS_SANITIZE)
  set(ADASPLATS_SANITIZE address,undefined,fuzzer-no-link)
  # Check vector indices against the size, not only the capacity.
  add_compile_definitions(_GLIBCXX_ASSERTIONS)
endif()
include(CheckCXXSourceCompiles)
set(CMAKE_REQUIRED_FLAGS -fsanitize=fuzzer,address)
check_cxx_source_compiles("
  #include <cstddef>
  #include <cstdint>
  extern \"C\" int LLVMFuzzerTestOneInput(const std::uint8_t*, std::size_t) { return 0; }"
  ADASPLATS_HAS_LIBFUZZER)
unset(CMAKE_REQUIRED_FLAGS)
if(NOT ADASPLATS_HAS_LIBFUZZER)
  message(FATAL_ERROR "ADASPLATS_BUILD_FUZZERS is ON, but ${CMAKE_CXX_COMPILER} does not link with "
                      "-fsanitize=fuzzer,address: its runtime is missing (apt-get install libclang-rt-dev)")
endif()
