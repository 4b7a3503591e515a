# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0

# OpenVDB::openvdb, sparse grids. OpenVDB's own module lies in a folder that every distribution
# chooses for itself and asks for all that OpenVDB can use; this one wants what its headers include
# (Boost, Imath, TBB). Installed with ours: a consumer of the static libraries has to link it too.
find_path(OpenVDB_INCLUDE_DIR openvdb/openvdb.h)
find_path(OpenVDB_BOOST_INCLUDE_DIR boost/numeric/conversion/conversion_traits.hpp)
find_library(OpenVDB_LIBRARY NAMES openvdb)
# Imath's own package file wants its Python library, too.
find_library(OpenVDB_IMATH_LIBRARY NAMES Imath-3_2 Imath-3_1 Imath-3_0 Imath)
find_package(TBB QUIET)
mark_as_advanced(OpenVDB_INCLUDE_DIR OpenVDB_BOOST_INCLUDE_DIR OpenVDB_LIBRARY
                 OpenVDB_IMATH_LIBRARY)

if(OpenVDB_INCLUDE_DIR)
  file(STRINGS ${OpenVDB_INCLUDE_DIR}/openvdb/version.h OpenVDB_version_lines
       REGEX "#define OPENVDB_LIBRARY_(MAJOR|MINOR|PATCH)_VERSION_NUMBER +[0-9]+")
  list(TRANSFORM OpenVDB_version_lines REPLACE ".*NUMBER +([0-9]+).*" "\\1")
  list(JOIN OpenVDB_version_lines "." OpenVDB_VERSION)
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(
  OpenVDB REQUIRED_VARS OpenVDB_LIBRARY OpenVDB_INCLUDE_DIR OpenVDB_BOOST_INCLUDE_DIR
  VERSION_VAR OpenVDB_VERSION)
if(OpenVDB_FOUND AND NOT TARGET OpenVDB::openvdb)
  add_library(OpenVDB::openvdb UNKNOWN IMPORTED)
  set_target_properties(
    OpenVDB::openvdb
    PROPERTIES IMPORTED_LOCATION ${OpenVDB_LIBRARY}
               INTERFACE_INCLUDE_DIRECTORIES "${OpenVDB_INCLUDE_DIR};${OpenVDB_BOOST_INCLUDE_DIR}"
               INTERFACE_LINK_LIBRARIES "TBB::tbb")
  if(OpenVDB_IMATH_LIBRARY)
    set_property(TARGET OpenVDB::openvdb APPEND PROPERTY INTERFACE_LINK_LIBRARIES
                                                         ${OpenVDB_IMATH_LIBRARY})
  endif()
endif()
