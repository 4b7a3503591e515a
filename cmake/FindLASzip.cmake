# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0

# LASzip::LASzip, the library that unpacks LAZ. It ships no CMake package, so this module is
# installed with ours: a consumer of the static libraries has to link it too.
find_path(LASzip_INCLUDE_DIR laszip/laszip_api.h)
find_library(LASzip_LIBRARY NAMES laszip)
mark_as_advanced(LASzip_INCLUDE_DIR LASzip_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(LASzip REQUIRED_VARS LASzip_LIBRARY LASzip_INCLUDE_DIR)
if(LASzip_FOUND AND NOT TARGET LASzip::LASzip)
  add_library(LASzip::LASzip UNKNOWN IMPORTED)
  set_target_properties(
    LASzip::LASzip PROPERTIES IMPORTED_LOCATION ${LASzip_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES
                                                                  ${LASzip_INCLUDE_DIR})
endif()
