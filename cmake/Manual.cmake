# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0

# Manual pages and completions. The program writes them after linking, so they always match its options.
# Cross-compiled builds cannot run the program and have none.
set(ADASPLATS_ZSH_DIR ${CMAKE_INSTALL_DATADIR}/zsh/site-functions
    CACHE STRING "Install folder of zsh's completion; Debian's own packages use vendor-completions")
mark_as_advanced(ADASPLATS_ZSH_DIR)
if(CMAKE_CROSSCOMPILING)
  return()
endif()

set(manual ${PROJECT_BINARY_DIR}/manual)
file(MAKE_DIRECTORY ${manual})
add_custom_command(
  TARGET adasplats_program POST_BUILD
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${manual}/man1  # pages of removed commands
  COMMAND adasplats_program man -o ${manual}/man1
  COMMAND adasplats_program completion bash -o ${manual}/adasplats
  COMMAND adasplats_program completion zsh -o ${manual}/_adasplats
  COMMAND adasplats_program completion fish -o ${manual}/adasplats.fish
  COMMENT "Writing the manual pages and completions" VERBATIM)
install(DIRECTORY ${manual}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT program)
install(FILES ${manual}/adasplats COMPONENT program
        DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES ${manual}/_adasplats DESTINATION ${ADASPLATS_ZSH_DIR} COMPONENT program)
install(FILES ${manual}/adasplats.fish COMPONENT program
        DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
