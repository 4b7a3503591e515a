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
  string(JOIN ", " found_text ${found_lines})
  message(STATUS "adasplats ${PROJECT_VERSION}: ${found_text}")
endfunction()
