# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0

# Compile options of all our targets.
add_library(adasplats_options INTERFACE)
# Options for host code only; cmake/Cuda.cmake has those of nvcc.
function(adasplats_host_options)
  foreach(option ${ARGN})
    target_compile_options(adasplats_options INTERFACE $<$<COMPILE_LANGUAGE:CXX>:${option}>)
  endforeach()
endfunction()
adasplats_host_options(
  # No fused multiply-add: the same bits on every machine and backend.
  -ffp-contract=off
  # Do not change results; allow vectorising loops with sqrt and divisions.
  -fno-math-errno -fno-trapping-math
  -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor -Wold-style-cast
  -Woverloaded-virtual -Wno-missing-field-initializers)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  adasplats_host_options(-Wno-psabi)
  if(CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 13)
    # False positives of gcc 13 and 14: writes past the end in std::vector::insert, and vectors larger
    # than the address space.
    adasplats_host_options(-Wno-stringop-overflow -Wno-alloc-size-larger-than)
  else()
    # False positive of gcc 12 for "text" + std::string (gcc bug 105651).
    adasplats_host_options(-Wno-restrict)
  endif()
endif()
if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # gcc treats sources included in a unity source as headers and warns about their local types.
  adasplats_host_options(-Wno-subobject-linkage)
elseif(CMAKE_UNITY_BUILD)
  # Constants of other sources in the same unity source are visible, too.
  adasplats_host_options(-Wno-shadow)
endif()
if(ADASPLATS_WERROR)
  adasplats_host_options(-Werror)
endif()
if(ADASPLATS_SANITIZE)
  # Compiles in a third of the time of -O2 -g and finds the same errors; asserts are on. Sanitizer code
  # causes false -Wmaybe-uninitialized warnings in GCC; the release build has that check.
  adasplats_host_options(-Og -g1 -UNDEBUG)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    adasplats_host_options(-Wno-maybe-uninitialized)
  endif()
  adasplats_host_options(-fsanitize=${ADASPLATS_SANITIZE} -fno-sanitize-recover=all
                         -fno-omit-frame-pointer)
  # Checks that add a third to the compile time of tests. They stay on in the libraries, and
  # AddressSanitizer finds the same accesses in tests.
  adasplats_host_options($<$<BOOL:$<TARGET_PROPERTY:ADASPLATS_IS_TEST>>:-fno-sanitize=null,alignment,object-size,vptr>)
  target_link_options(adasplats_options INTERFACE -fsanitize=${ADASPLATS_SANITIZE})
  target_compile_definitions(adasplats_options INTERFACE ADASPLATS_SANITIZED)
endif()

# adasplats_cold(TARGET): for code that runs once per command or option. -O1 halves its compile time and
# gives the same values, because our options do not let the level change results.
function(adasplats_cold target)
  if(CMAKE_BUILD_TYPE STREQUAL "Release")
    target_compile_options(${target} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:-O1>)
  endif()
endfunction()

# adasplats_compiled_alone(files...): files of the calling folder that CMAKE_UNITY_BUILD must not join:
# they define the same names for different instruction sets, or take very long to compile.
function(adasplats_compiled_alone)
  set_property(SOURCE ${ARGN} PROPERTY SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# adasplats_embed(TARGET FILE NAME): lets sources of TARGET include the bytes of FILE as NAME.
function(adasplats_embed target file name)
  set(script ${PROJECT_SOURCE_DIR}/cmake/EmbedFile.cmake)
  set(output ${PROJECT_BINARY_DIR}/embedded/${target}/${name})
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DFROM=${file} -DTO=${output} -P ${script}
    DEPENDS ${file} ${script}
    COMMENT "Embedding ${file}"
    VERBATIM)
  target_sources(${target} PRIVATE ${output})
  target_include_directories(${target} PRIVATE ${PROJECT_BINARY_DIR}/embedded/${target})
endfunction()

set(ADASPLATS_STAGES "")

# adasplats_stage(NAME [COLD] [ROOMS rooms...] [DEPENDS stages...] [LINK PRIVATE|PUBLIC libs...]
#                 [DEFINE macros...] [ALONE sources...] [CUDA])
# The library of src/adasplats/NAME: its *.cpp files without *_test.cpp, which become its test program.
# COLD: adasplats_cold. ALONE: adasplats_compiled_alone, names without ".cpp".
# LINK: imported targets of packages, which adasplatsConfig.cmake finds again for consumers.
# DEFINE: macros for NAME's own sources. CUDA: also compile its *.cu files if CUDA is available.
# ROOMS: the folders of the stage. Each may use earlier ones, but not those joined to it by "|". "." is
# the stage's own folder, by default the last (tools/check_layers.py checks this).
function(adasplats_stage name)
  cmake_parse_arguments(ARG "CUDA;COLD" "" "ALONE;DEPENDS;LINK;DEFINE;ROOMS" ${ARGN})
  set(folder ${PROJECT_SOURCE_DIR}/src/adasplats/${name})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${folder}/*.cpp)
  file(GLOB_RECURSE tests CONFIGURE_DEPENDS ${folder}/*_test.cpp)
  if(tests)
    list(REMOVE_ITEM sources ${tests})
  endif()
  if(ARG_CUDA AND ADASPLATS_CUDA)
    file(GLOB_RECURSE cuda_sources CONFIGURE_DEPENDS ${folder}/*.cu)
    list(FILTER cuda_sources EXCLUDE REGEX "/optix_programs\\.cu$")  # cmake/Optix.cmake
    adasplats_cuda_unity(cuda_sources ${name} ${cuda_sources})
    list(APPEND sources ${cuda_sources})
  endif()
  set(target adasplats_${name})
  set(dependencies ${ARG_DEPENDS})
  list(TRANSFORM dependencies PREPEND adasplats_)
  if(sources)
    foreach(file IN LISTS ARG_ALONE)
      adasplats_compiled_alone(${folder}/${file}.cpp)
    endforeach()
    add_library(${target} STATIC ${sources})
    target_include_directories(
      ${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src>
                       $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    target_compile_features(${target} PUBLIC cxx_std_20)
    if(ARG_COLD)
      adasplats_cold(${target})
    endif()
    target_compile_definitions(${target} PRIVATE ${ARG_DEFINE})
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:adasplats_options>)
    if(ARG_LINK)
      target_link_libraries(${target} ${ARG_LINK})
    endif()
    target_link_libraries(${target} PUBLIC ${dependencies})
    if(ARG_CUDA AND ADASPLATS_CUDA)
      adasplats_use_cuda(${target})
    endif()
  else()
    add_library(${target} INTERFACE)
    target_include_directories(
      ${target} INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src>
                          $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    target_link_libraries(${target} INTERFACE ${dependencies})
  endif()
  add_library(adasplats::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  install(TARGETS ${target} EXPORT adasplatsTargets)
  set(ADASPLATS_STAGES ${ADASPLATS_STAGES} ${target} PARENT_SCOPE)
  if(tests AND ADASPLATS_TESTS)
    adasplats_test(${name} ${tests})
    if(ARG_CUDA AND ADASPLATS_CUDA)
      adasplats_use_cuda(adasplats_${name}_test)  # tests include private headers of the stage
    endif()
  endif()
endfunction()

if(ADASPLATS_TESTS)
  enable_testing()
endif()

# adasplats_absent_test(NAME REASON): a test that this build cannot run; it is reported as skipped with
# its reason (tools/check_skips.py).
function(adasplats_absent_test name reason)
  add_test(NAME ${name} COMMAND ${CMAKE_COMMAND} -E echo "skipped: not in this build, ${reason}")
  set_tests_properties(${name} PROPERTIES SKIP_REGULAR_EXPRESSION "^skipped: ")
endfunction()

# adasplats_test(NAME sources...): a GoogleTest program. Compiled at -O1: reference code may be slow.
function(adasplats_test name)
  set(target adasplats_${name}_test)
  add_executable(${target} ${ARGN})
  adasplats_cold(${target})
  set_target_properties(${target} PROPERTIES ADASPLATS_IS_TEST ON)
  # For presets with CMAKE_UNITY_BUILD. Smaller batches than the libraries': tests compile slower.
  set_target_properties(${target} PROPERTIES UNITY_BUILD_BATCH_SIZE 8)
  target_link_libraries(${target} PRIVATE adasplats_options GTest::gtest_main
                                          nlohmann_json::nlohmann_json
                                          tomlplusplus::tomlplusplus Threads::Threads)
  if(TARGET adasplats_${name})
    target_link_libraries(${target} PRIVATE adasplats_${name})
  else()
    target_link_libraries(${target} PRIVATE adasplats)
  endif()
  # Folder of real recordings for tests (src/adasplats/core/recordings_test.h).
  target_compile_definitions(${target} PRIVATE ADASPLATS_TEST_DATA="${ADASPLATS_TEST_DATA}")
  add_test(NAME ${name} COMMAND ${target})
  # The slowest takes five minutes with sanitizers and recordings, ten on busy cores.
  set_tests_properties(${name} PROPERTIES TIMEOUT 1800)
endfunction()
