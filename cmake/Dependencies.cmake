# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0

find_package(TBB REQUIRED)
find_package(Threads REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(PNG REQUIRED)
find_package(ZLIB REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
find_package(pugixml REQUIRED)

list(APPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR})

# Matrix products of segmentation networks (stage segment).
find_package(OpenBLAS QUIET MODULE)
if(OpenBLAS_FOUND)
  set(ADASPLATS_OPENBLAS_TARGET OpenBLAS::OpenBLAS)
  set(ADASPLATS_OPENBLAS_DEFINE ADASPLATS_OPENBLAS)
endif()

# Compression of chunks in MCAP files and ROS bags, and SQLite files of ROS 2 bags (stage io).
find_package(ZSTD QUIET MODULE)
find_package(LZ4 QUIET MODULE)
find_package(BZip2 QUIET MODULE)
find_package(SQLite3 QUIET MODULE)
set(ADASPLATS_RECORDING_TARGETS "")
set(ADASPLATS_RECORDING_DEFINES "")
set(recording_libraries "")
foreach(library ZSTD LZ4 BZip2 SQLite3)
  if(${library}_FOUND)
    string(REPLACE "SQLite3::" "SQLite::" target ${library}::${library})
    string(TOUPPER ADASPLATS_HAVE_${library} define)
    list(APPEND ADASPLATS_RECORDING_TARGETS ${target})
    list(APPEND ADASPLATS_RECORDING_DEFINES ${define})
    list(APPEND recording_libraries ${library})
  endif()
endforeach()

# Animations (stage jobs).
find_package(WebP QUIET MODULE)
set(missing "")
if(WebP_FOUND)
  set(ADASPLATS_WEBP_TARGET WebP::mux)
  set(ADASPLATS_WEBP_DEFINE ADASPLATS_HAVE_WEBP)
else()
  set(missing "no libwebp (libwebp-dev); .mp4 needs the program ffmpeg")
endif()
adasplats_part(- "films as WebP" "${missing}" "libwebp" ADASPLATS_WEBP)

# Baseline meshes. OpenVDB: grid and surface extraction of IMLS. Open3D: screened Poisson, in a separate
# program (apps/poisson), because it links hundreds of libraries.
find_package(OpenVDB 9 QUIET MODULE)
if(OpenVDB_FOUND)
  set(ADASPLATS_OPENVDB_TARGET OpenVDB::openvdb)
  set(ADASPLATS_OPENVDB_DEFINE ADASPLATS_HAVE_OPENVDB)
  # OpenVDB's templates take half of -O3's time to compile with -O1. With sanitizers they take five
  # minutes, or one like this: addresses are checked, undefined behaviour is not.
  set(imls_options $<$<CONFIG:Release>:-O1>)
  if(ADASPLATS_SANITIZE)
    set(imls_options -O1 -g0 -fno-sanitize=undefined)
  endif()
  set_source_files_properties(${PROJECT_SOURCE_DIR}/src/adasplats/baselines/imls.cpp
                              PROPERTIES COMPILE_OPTIONS "${imls_options}")
endif()
find_package(Open3D QUIET CONFIG)

# The viewer's server: Boost.Beast and Asio, which are header-only.
find_package(Boost 1.74 QUIET)
if(Boost_FOUND)
  set(ADASPLATS_BOOST_TARGET Boost::headers)
  set(ADASPLATS_BOOST_DEFINE ADASPLATS_HAVE_BOOST)
endif()

# Embree 4 if available, else 3; trace/embree.h hides the difference.
find_package(embree 4 QUIET CONFIG)
if(NOT embree_FOUND)
  find_package(embree 3 QUIET CONFIG)
endif()
if(NOT embree_FOUND)
  message(FATAL_ERROR "Embree 3 or 4 is needed: apt-get install libembree-dev")
endif()

# Print which features the missing packages disable.
set(missing "")
if(NOT OpenBLAS_FOUND)
  set(missing "no OpenBLAS (libopenblas-dev)")
endif()
adasplats_part(- "segmentation" "${missing}" "OpenBLAS ${OpenBLAS_VERSION}" ADASPLATS_SEGMENTATION)

set(missing "")
if(NOT recording_libraries)
  set(missing "no zstd, lz4, bzip2, SQLite (libzstd-dev, liblz4-dev, libbz2-dev, libsqlite3-dev)")
endif()
string(REPLACE ";" ", " recording_libraries "${recording_libraries}")
adasplats_part(- "packed recordings" "${missing}" "${recording_libraries}" ADASPLATS_RECORDINGS)

set(missing "")
if(NOT OpenVDB_FOUND)
  set(missing "no OpenVDB (libopenvdb-dev)")
endif()
adasplats_part(- "IMLS meshes" "${missing}" "OpenVDB ${OpenVDB_VERSION}" ADASPLATS_IMLS)

set(missing "")
if(NOT Open3D_FOUND)
  set(missing "no Open3D (libopen3d-dev); 'mesh' uses the program PoissonRecon if it is installed")
endif()
adasplats_part(- "Poisson meshes" "${missing}" "Open3D ${Open3D_VERSION}" ADASPLATS_POISSON)

set(missing "")
if(NOT Boost_FOUND)
  set(missing "no Boost (libboost-dev)")
endif()
adasplats_part(- "the viewer's server" "${missing}" "Boost ${Boost_VERSION_STRING}" ADASPLATS_SERVER)

set(missing "")
if(ADASPLATS_BUILD_TESTS)
  find_package(GTest QUIET)
  if(NOT GTest_FOUND)
    set(missing "no GoogleTest (libgtest-dev)")
  endif()
endif()
adasplats_part(ADASPLATS_BUILD_TESTS "tests" "${missing}" "GoogleTest ${GTest_VERSION}"
               ADASPLATS_TESTS)
