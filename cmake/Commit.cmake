# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0

# The commit that reports name. Every build asks git (some milliseconds); the source is written, and
# the programs are linked again, only where the answer changed. Outside of a clone the environment
# variable or cache entry ADASPLATS_COMMIT tells the commit, or a file COMMIT beside the sources.
#
# Included by the project it adds the source to the stage "jobs"; as a script (cmake -D... -P) it
# writes the source.
if(NOT CMAKE_SCRIPT_MODE_FILE)
  set(ADASPLATS_COMMIT "" CACHE STRING "The commit, where the sources are no clone")
  find_program(ADASPLATS_GIT git)
  mark_as_advanced(ADASPLATS_GIT ADASPLATS_COMMIT)
  set(commit_source ${PROJECT_BINARY_DIR}/commit/build_commit.cpp)
  add_custom_target(
    adasplats_commit
    COMMAND ${CMAKE_COMMAND} -D GIT=${ADASPLATS_GIT} -D SOURCE=${PROJECT_SOURCE_DIR}
            -D GIVEN=${ADASPLATS_COMMIT} -D OUTPUT=${commit_source} -P
            ${CMAKE_CURRENT_LIST_DIR}/Commit.cmake
    BYPRODUCTS ${commit_source}
    COMMENT "Looking up the commit" VERBATIM)
  target_sources(adasplats_jobs PRIVATE ${commit_source})
  add_dependencies(adasplats_jobs adasplats_commit)
  return()
endif()

# git NAME ARGUMENTS...: what git says of the sources; an empty NAME where it fails.
function(git name)
  set(${name} "" PARENT_SCOPE)
  if(GIT)
    # Without the lock: a build must not hinder somebody who commits.
    execute_process(COMMAND ${GIT} --no-optional-locks -C ${SOURCE} ${ARGN} OUTPUT_VARIABLE said
                    RESULT_VARIABLE failed ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
    if(failed EQUAL 0)
      set(${name} "${said}" PARENT_SCOPE)
    endif()
  endif()
endfunction()

set(commit "$ENV{ADASPLATS_COMMIT}")
if(NOT commit)
  set(commit "${GIVEN}")
endif()
if(NOT commit AND EXISTS ${SOURCE}/COMMIT)  # sources that packaging/make_sdist.py packed
  file(STRINGS ${SOURCE}/COMMIT commit LIMIT_COUNT 1)
endif()
set(state unknown)
git(top rev-parse --show-toplevel)
file(REAL_PATH "${SOURCE}" source)
if(top STREQUAL source)  # a clone of its own, not a folder in somebody else's
  git(commit rev-parse HEAD)
  # Documents and results are no part of the program.
  git(changes status --porcelain -- . ":!docs" ":!bench/results" ":!*.md")
  if(changes)
    set(state dirty)
  else()
    set(state clean)
  endif()
endif()
if(NOT commit)
  set(commit unknown)
endif()
if(NOT commit MATCHES "^[0-9A-Za-z._-]+$")
  message(FATAL_ERROR "ADASPLATS_COMMIT: '${commit}' is no commit: letters, digits, '.', '_', '-'")
endif()
set(text "// Written by cmake/Commit.cmake.
#include \"adasplats/jobs/provenance/build_commit.h\"

const char* const adasplats::kBuildCommit = \"${commit}\";
const char* const adasplats::kBuildState = \"${state}\";
")
set(before "")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} before)
endif()
if(NOT text STREQUAL before)
  file(WRITE ${OUTPUT} "${text}")
endif()
