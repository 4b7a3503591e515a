# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0

find_package(TBB REQUIRED)
find_package(Threads REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(PNG REQUIRED)

# LAZ: LASzip is not in Debian 12; where it is missing the reader says what to install.
list(APPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR})
find_package(LASzip QUIET)
if(LASzip_FOUND)
  set(ADASPLATS_LASZIP_TARGET LASzip::LASzip)
  set(ADASPLATS_LASZIP_DEFINE ADASPLATS_HAVE_LASZIP)
endif()

# Meshes of the comparison. OpenVDB: grid and surface of IMLS. Open3D: screened Poisson, only in a
# program of its own (apps/poisson), as it brings hundreds of libraries.
find_package(OpenVDB 9 QUIET MODULE)
if(OpenVDB_FOUND)
  set(ADASPLATS_OPENVDB_TARGET OpenVDB::openvdb)
  set(ADASPLATS_OPENVDB_DEFINE ADASPLATS_HAVE_OPENVDB)
  if(ADASPLATS_SANITIZE)
    # With every check and debug information OpenVDB's templates compile for five minutes, like
    # this for one: addresses are checked, undefined behaviour is not.
    set_source_files_properties(
      ${PROJECT_SOURCE_DIR}/src/adasplats/baselines/imls.cpp
      PROPERTIES COMPILE_OPTIONS "-O1;-g0;-fno-sanitize=undefined")
  endif()
endif()
find_package(Open3D QUIET CONFIG)

# The viewer's server: Boost.Beast and Asio, headers alone.
find_package(Boost 1.74 QUIET)
if(Boost_FOUND)
  set(ADASPLATS_BOOST_TARGET Boost::headers)
  set(ADASPLATS_BOOST_DEFINE ADASPLATS_HAVE_BOOST)
endif()

# Embree 4 where it is, else 3. trace/embree.h hides the difference.
find_package(embree 4 QUIET CONFIG)
if(NOT embree_FOUND)
  find_package(embree 3 QUIET CONFIG)
endif()
if(NOT embree_FOUND)
  message(FATAL_ERROR "Embree 3 or 4 is needed: apt-get install libembree-dev")
endif()

function(adasplats_print_summary)
  set(found_lines "TBB ${TBB_VERSION}" "Embree ${embree_VERSION}" "PNG ${PNG_VERSION_STRING}")
  if(ADASPLATS_LASZIP_TARGET)
    list(APPEND found_lines "LASzip")
  else()
    list(APPEND found_lines "no LASzip (LAZ files are refused)")
  endif()
  if(OpenVDB_FOUND)
    list(APPEND found_lines "OpenVDB ${OpenVDB_VERSION}")
  else()
    list(APPEND found_lines "no OpenVDB (no IMLS meshes)")
  endif()
  if(Open3D_FOUND)
    list(APPEND found_lines "Open3D ${Open3D_VERSION}")
  else()
    list(APPEND found_lines "no Open3D (Poisson meshes need the program PoissonRecon)")
  endif()
  if(Boost_FOUND)
    list(APPEND found_lines "Boost ${Boost_VERSION_STRING}")
  else()
    list(APPEND found_lines "no Boost (no viewer)")
  endif()
  if(ADASPLATS_PAGE)
    list(APPEND found_lines "viewer page by ${ADASPLATS_NODE_VERSION}")
  else()
    list(APPEND found_lines "no viewer page (${ADASPLATS_PAGE_MISSING})")
  endif()
  if(ADASPLATS_CUDA)
    list(APPEND found_lines "CUDA ${CMAKE_CUDA_COMPILER_VERSION}")
  else()
    list(APPEND found_lines "no CUDA (--device cpu alone)")
  endif()
  string(JOIN ", " found_text ${found_lines})
  message(STATUS "adasplats ${PROJECT_VERSION}: ${found_text}")
endfunction()
