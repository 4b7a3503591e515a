# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0

# What `cpack` packs: the program alone (component "program"), as a package of Debian or Ubuntu.
# scripts/package.sh calls it. Sensors, the network and the viewer's page are within the program.
# The same commit, compiler and libraries give the same bytes where SOURCE_DATE_EPOCH is set.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME adasplats)
set(CPACK_PACKAGE_CONTACT "The adasplats authors <authors@adasplats.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_DESCRIPTION
    "Makes splat models of LiDAR point clouds, and simulates LiDAR scans and pictures in them.
Sensors, the network that tells classes apart and the viewer's page are within the program. An
NVIDIA GPU is used where the package is built for CUDA and a driver is installed; none is needed.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
set(CPACK_DEB_COMPONENT_INSTALL ON)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "bash-completion, man-db")
# The release that it is built on and for: libraries of another have other names.
set(system debian)
if(EXISTS /etc/os-release)
  file(STRINGS /etc/os-release lines REGEX "^(ID|VERSION_ID)=")
  list(TRANSFORM lines REPLACE "^[A-Z_]+=\"?([^\"]*)\"?" "\\1")
  list(SORT lines ORDER DESCENDING)  # the word before the number
  list(JOIN lines "" system)
endif()
set(CPACK_DEBIAN_PACKAGE_RELEASE "1~${system}")
include(CPack)
