# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0

# The .deb package: only the program (component "program"), which contains the sensors, the network and
# the viewer's page. scripts/package.sh builds it. With SOURCE_DATE_EPOCH set, the same commit, compiler
# and libraries give the same bytes.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME adasplats)
set(CPACK_PACKAGE_CONTACT "The adasplats authors <authors@adasplats.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_DESCRIPTION
    "Builds splat models from LiDAR point clouds and simulates LiDAR scans and pictures in them.
The program contains its sensor library, a segmentation network and the viewer's page. An NVIDIA GPU
is optional: it is used if the package was built with CUDA and a driver is installed.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
set(CPACK_DEB_COMPONENT_INSTALL ON)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "bash-completion, man-db")
# The release it is built on and for: other releases name libraries differently.
set(system debian)
if(EXISTS /etc/os-release)
  file(STRINGS /etc/os-release lines REGEX "^(ID|VERSION_ID)=")
  list(TRANSFORM lines REPLACE "^[A-Z_]+=\"?([^\"]*)\"?" "\\1")
  list(SORT lines ORDER DESCENDING)  # name before number
  list(JOIN lines "" system)
endif()
set(CPACK_DEBIAN_PACKAGE_RELEASE "1~${system}")
include(CPack)
