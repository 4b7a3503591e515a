# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0

# Parts that a build may lack. What was found out is kept nowhere: every configure looks again, so a
# package that was installed since is used, and what the build has is printed each time.

# adasplats_part_option(NAME HELP DEFAULT): a cache variable of three values: ON (what is missing is
# an error), OFF, and AUTO (where all it needs is found).
function(adasplats_part_option name help default)
  # Up to version 0.1 these were Booleans, and an OFF that nobody had asked for stayed.
  get_property(type CACHE ${name} PROPERTY TYPE)
  get_property(kept_help CACHE ${name} PROPERTY HELPSTRING)
  if(type STREQUAL "BOOL" AND NOT kept_help MATCHES "command line")
    message(STATUS "adasplats: forgetting ${name}=${${name}}, which an earlier version kept here; "
                   "say -D${name}=${${name}} again if it was meant")
    unset(${name} CACHE)
  endif()
  set(${name} ${default} CACHE STRING "${help}: AUTO (where all it needs is found), ON or OFF")
  set_property(CACHE ${name} PROPERTY STRINGS AUTO ON OFF)
endfunction()

# adasplats_part(NAME LABEL MISSING DETAIL RESULT): decides about a part, notes it for the summary and
# sets RESULT to ON or OFF. MISSING: what it lacks, empty for nothing; DETAIL: with what it is built.
# NAME: its option, or - for a part that is taken wherever it is found.
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
    message(FATAL_ERROR "${name} is ON, but there is ${missing}")
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
  message(STATUS "adasplats ${PROJECT_VERSION}, ${CMAKE_BUILD_TYPE}, is built")
  get_property(parts GLOBAL PROPERTY ADASPLATS_PARTS)
  foreach(part IN LISTS parts)
    message(STATUS "${part}")
  endforeach()
endfunction()
