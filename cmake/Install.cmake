# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
include(CMakePackageConfigHelpers)

# Needs Open3D; installed in the folder of the program.
if(ADASPLATS_BUILD_APP AND Open3D_FOUND)
  add_subdirectory(apps/poisson)
endif()

install(DIRECTORY ${PROJECT_SOURCE_DIR}/src/adasplats DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        FILES_MATCHING PATTERN "*.h" PATTERN "*_test.h" EXCLUDE)
install(EXPORT adasplatsTargets NAMESPACE adasplats::
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/adasplats)
configure_package_config_file(
  ${CMAKE_CURRENT_LIST_DIR}/adasplatsConfig.cmake.in ${CMAKE_BINARY_DIR}/adasplatsConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/adasplats)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/adasplatsConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/adasplatsConfig.cmake
              ${CMAKE_BINARY_DIR}/adasplatsConfigVersion.cmake
              ${CMAKE_CURRENT_LIST_DIR}/FindLZ4.cmake
              ${CMAKE_CURRENT_LIST_DIR}/FindOpenBLAS.cmake
              ${CMAKE_CURRENT_LIST_DIR}/FindOpenVDB.cmake
              ${CMAKE_CURRENT_LIST_DIR}/FindWebP.cmake
              ${CMAKE_CURRENT_LIST_DIR}/FindZSTD.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/adasplats)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/CHANGELOG.md
              ${PROJECT_SOURCE_DIR}/packaging/copyright
        DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
