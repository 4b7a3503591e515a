# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0

# The page of `adasplats view` (viewer/): npm fetches what viewer/package-lock.json names, esbuild
# bundles it, and the library carries the files. Needed nowhere else; where there is no Node.js the
# program says so (src/adasplats/view/page_missing.cpp).
set(ADASPLATS_PAGE OFF)
if(NOT ADASPLATS_VIEWER)
  set(ADASPLATS_PAGE_MISSING "ADASPLATS_VIEWER is off")
  return()
endif()
find_program(ADASPLATS_NODE NAMES node nodejs)
find_program(ADASPLATS_NPM npm)
mark_as_advanced(ADASPLATS_NODE ADASPLATS_NPM)
if(NOT ADASPLATS_NODE OR NOT ADASPLATS_NPM)
  set(ADASPLATS_PAGE_MISSING "no Node.js with npm")
  return()
endif()
execute_process(COMMAND ${ADASPLATS_NODE} --version OUTPUT_VARIABLE ADASPLATS_NODE_VERSION
                OUTPUT_STRIP_TRAILING_WHITESPACE)
if(ADASPLATS_NODE_VERSION VERSION_LESS v18)
  set(ADASPLATS_PAGE_MISSING "Node.js ${ADASPLATS_NODE_VERSION} is older than 18")
  return()
endif()

# The packages are fetched when the build is configured, so that a machine without network says so
# at once; they stay in the build folder and are fetched again only where the lock file changed.
set(viewer ${PROJECT_SOURCE_DIR}/viewer)
set(page ${PROJECT_BINARY_DIR}/viewer)
file(MAKE_DIRECTORY ${page})
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${viewer}/package.json
                                       ${viewer}/package-lock.json)
file(SHA256 ${viewer}/package-lock.json lock_hash)
set(fetched "")
if(EXISTS ${page}/fetched)
  file(READ ${page}/fetched fetched)
endif()
if(NOT fetched STREQUAL lock_hash)
  message(STATUS "adasplats: fetching the packages of the viewer's page")
  file(COPY ${viewer}/package.json ${viewer}/package-lock.json ${viewer}/.npmrc DESTINATION ${page})
  # Without development packages, install scripts or a look at who needs money.
  execute_process(
    COMMAND ${ADASPLATS_NPM} ci --omit=dev --ignore-scripts --no-audit --no-fund --loglevel=error
    WORKING_DIRECTORY ${page} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output
    TIMEOUT 300)
  if(NOT result EQUAL 0)
    set(ADASPLATS_PAGE_MISSING "npm could not fetch its packages")
    message(STATUS "adasplats: ${output}")
    return()
  endif()
  file(WRITE ${page}/fetched ${lock_hash})
endif()

set(ADASPLATS_PAGE ON)
file(GLOB page_sources CONFIGURE_DEPENDS ${viewer}/src/*)
add_custom_command(
  OUTPUT ${page}/page_data.cpp
  # Packages are looked for beside the sources that import them.
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${page}/src ${page}/dist
  COMMAND ${CMAKE_COMMAND} -E copy_directory ${viewer}/src ${page}/src
  COMMAND ${CMAKE_COMMAND} -E copy ${viewer}/build.mjs ${page}
  COMMAND ${ADASPLATS_NODE} ${page}/build.mjs ${page}/dist
  COMMAND ${ADASPLATS_NODE} ${viewer}/embed.mjs ${page}/dist ${page}/page_data.cpp
  DEPENDS ${page_sources} ${viewer}/build.mjs ${viewer}/embed.mjs ${page}/fetched
  COMMENT "Bundling the viewer's page" VERBATIM)
target_sources(adasplats_view PRIVATE ${page}/page_data.cpp)
target_compile_definitions(adasplats_view PRIVATE ADASPLATS_HAVE_PAGE)
