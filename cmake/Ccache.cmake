# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0

# Compile through ccache where it is installed. Only when this is the top project: a project that
# includes us chooses its own launcher.
if(PROJECT_IS_TOP_LEVEL)
  find_program(ADASPLATS_CCACHE ccache)
  mark_as_advanced(ADASPLATS_CCACHE)
  if(ADASPLATS_CCACHE)
    # What ccache has to know, unless the environment says it: paths below the sources count as
    # relative, so that another clone finds the same objects; where there is debug information, which
    # holds the folder, only where that is the same.
    set(launcher ${ADASPLATS_CCACHE})
    if(NOT DEFINED ENV{CCACHE_BASEDIR})
      set(launcher ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR})
      if(CMAKE_BUILD_TYPE STREQUAL "Release")
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
