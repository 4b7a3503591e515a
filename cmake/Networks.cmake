# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0

# The library contains the default network of 'segment'.
set(network ${PROJECT_SOURCE_DIR}/networks/default.network)
set_source_files_properties(
  ${PROJECT_SOURCE_DIR}/src/adasplats/segment/network/default_network.cpp
  PROPERTIES OBJECT_DEPENDS ${network} COMPILE_DEFINITIONS "ADASPLATS_DEFAULT_NETWORK=\"${network}\"")
