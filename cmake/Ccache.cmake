# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0

# Compile through ccache if it is installed and this is the top project: a parent project chooses its own
# launcher.
if(PROJECT_IS_TOP_LEVEL)
  find_program(ADASPLATS_CCACHE ccache)
  mark_as_advanced(ADASPLATS_CCACHE)
  if(ADASPLATS_CCACHE)
    # Unless the environment sets CCACHE_BASEDIR, make paths below the sources relative, so that clones
    # share objects. Debug information then names the folder that compiled first, so only builds for
    # debuggers keep objects to their folder.
    set(launcher ${ADASPLATS_CCACHE})
    if(NOT DEFINED ENV{CCACHE_BASEDIR})
      set(launcher ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR})
      if(NOT CMAKE_BUILD_TYPE STREQUAL "Debug")
        list(APPEND launcher CCACHE_NOHASHDIR=1)
      endif()
      list(APPEND launcher ${ADASPLATS_CCACHE})
    endif()
    foreach(language CXX CUDA)
      if(NOT DEFINED CMAKE_${language}_COMPILER_LAUNCHER)
        set(CMAKE_${language}_COMPILER_LAUNCHER ${launcher})
      endif()
    endforeach()
  endif()
endif()
