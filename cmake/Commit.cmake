# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0

# The commit that reports name. Every build queries git (a few milliseconds) and rewrites the source
# only if the answer changed. Outside a clone the commit is the environment variable or cache entry
# ADASPLATS_COMMIT, or the content of the file COMMIT in the source folder.
#
# Included by the project, this file adds the source to the stage "jobs"; run as a script
# (cmake -D... -P), it writes the source.
if(NOT CMAKE_SCRIPT_MODE_FILE)
  set(ADASPLATS_COMMIT "" CACHE STRING "The commit, if the sources are not a git clone")
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

# git NAME ARGUMENTS...: sets NAME to git's output for the source folder, empty on failure.
function(git name)
  set(${name} "" PARENT_SCOPE)
  if(GIT)
    # Without the lock: a build must not block a commit.
    execute_process(COMMAND ${GIT} --no-optional-locks -C ${SOURCE} ${ARGN} OUTPUT_VARIABLE output
                    RESULT_VARIABLE failed ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
    if(failed EQUAL 0)
      set(${name} "${output}" PARENT_SCOPE)
    endif()
  endif()
endfunction()

set(commit "$ENV{ADASPLATS_COMMIT}")
if(NOT commit)
  set(commit "${GIVEN}")
endif()
if(NOT commit AND EXISTS ${SOURCE}/COMMIT)  # written by packaging/make_sdist.py
  file(STRINGS ${SOURCE}/COMMIT commit LIMIT_COUNT 1)
endif()
set(state unknown)
git(top rev-parse --show-toplevel)
file(REAL_PATH "${SOURCE}" source)
if(top STREQUAL source)  # not a folder within another project's clone
  git(commit rev-parse HEAD)
  # Documents and results do not change the program.
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
  message(FATAL_ERROR "ADASPLATS_COMMIT: '${commit}' is not a commit: use letters, digits, '.', '_' and '-'")
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
