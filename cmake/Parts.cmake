# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0

# Optional parts of a build. Every configure searches again, so that newly installed packages are found,
# and prints the parts.

# adasplats_part_option(NAME HELP DEFAULT): a cache variable: ON (missing packages are an error), OFF, or
# AUTO (built if its packages are found).
function(adasplats_part_option name help default)
  # Before version 0.1 these were Booleans, and a default OFF stayed in the cache.
  get_property(type CACHE ${name} PROPERTY TYPE)
  get_property(kept_help CACHE ${name} PROPERTY HELPSTRING)
  if(type STREQUAL "BOOL" AND NOT kept_help MATCHES "command line")
    message(STATUS "adasplats: ignoring the cached ${name}=${${name}} of an earlier version "
                   "(to keep it: -D${name}=${${name}})")
    unset(${name} CACHE)
  endif()
  set(${name} ${default} CACHE STRING "${help}: AUTO (if its packages are found), ON or OFF")
  set_property(CACHE ${name} PROPERTY STRINGS AUTO ON OFF)
endfunction()

# adasplats_part(NAME LABEL MISSING DETAIL RESULT): sets RESULT to ON or OFF and adds the part to the
# summary. NAME: its option, or - for a part that is built whenever possible. MISSING: the missing
# packages, empty if none; DETAIL: the versions it is built with.
function(adasplats_part name label missing detail result)
  set(wanted AUTO)
  if(NOT name STREQUAL "-")
    string(TOUPPER "${${name}}" wanted)
    if(NOT wanted STREQUAL "AUTO")
      if(${name})
        set(wanted ON)
      else()
        set(wanted OFF)
        set(missing "${name} is ${${name}}")
      endif()
    endif()
  endif()
  if(wanted STREQUAL "ON" AND missing)
    message(FATAL_ERROR "${name} is ON, but cannot be built: ${missing}")
  endif()
  if(missing)
    set(${result} OFF PARENT_SCOPE)
    set(${result}_MISSING "${missing}" PARENT_SCOPE)
    set_property(GLOBAL APPEND PROPERTY ADASPLATS_PARTS "  without ${label}: ${missing}")
  else()
    set(${result} ON PARENT_SCOPE)
    set(${result}_MISSING "" PARENT_SCOPE)
    set_property(GLOBAL APPEND PROPERTY ADASPLATS_PARTS "  with    ${label}: ${detail}")
  endif()
endfunction()

function(adasplats_print_parts)
  message(STATUS "adasplats ${PROJECT_VERSION}, ${CMAKE_BUILD_TYPE}, will be built")
  get_property(parts GLOBAL PROPERTY ADASPLATS_PARTS)
  foreach(part IN LISTS parts)
    message(STATUS "${part}")
  endforeach()
endfunction()
