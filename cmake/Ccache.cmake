# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0

# Compile through ccache where it is installed. Only when this is the top project: a project that
# includes us chooses its own launcher.
if(PROJECT_IS_TOP_LEVEL AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  find_program(ADASPLATS_CCACHE ccache)
  mark_as_advanced(ADASPLATS_CCACHE)
  if(ADASPLATS_CCACHE)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${ADASPLATS_CCACHE})
  endif()
endif()
