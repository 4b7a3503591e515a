# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0

# libwebp with its muxer: the target WebP::mux.
find_path(WebP_INCLUDE_DIR webp/mux.h)
find_library(WebP_LIBRARY webp)
find_library(WebP_MUX_LIBRARY webpmux)
mark_as_advanced(WebP_INCLUDE_DIR WebP_LIBRARY WebP_MUX_LIBRARY)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(WebP REQUIRED_VARS WebP_MUX_LIBRARY WebP_LIBRARY WebP_INCLUDE_DIR)
if(WebP_FOUND AND NOT TARGET WebP::mux)
  add_library(WebP::mux INTERFACE IMPORTED)
  target_include_directories(WebP::mux INTERFACE ${WebP_INCLUDE_DIR})
  target_link_libraries(WebP::mux INTERFACE ${WebP_MUX_LIBRARY} ${WebP_LIBRARY})
endif()
