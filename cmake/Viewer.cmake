# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0

# The page of `adasplats view` (viewer/): npm fetches the packages of viewer/package-lock.json, esbuild
# bundles them, and the library contains the result. Without Node.js `adasplats view` reports an error
# (src/adasplats/view/page_missing.cpp).

# Fetches the page's packages into `page`; sets `result` to the reason of a failure, empty on success.
function(adasplats_fetch_page_packages viewer page result)
  file(SHA256 ${viewer}/package-lock.json lock_hash)
  set(fetched "")
  if(EXISTS ${page}/fetched)
    file(READ ${page}/fetched fetched)
  endif()
  set(${result} "" PARENT_SCOPE)
  if(fetched STREQUAL lock_hash)
    return()
  endif()
  message(STATUS "adasplats: fetching the packages of the viewer's page")
  file(COPY ${viewer}/package.json ${viewer}/package-lock.json ${viewer}/.npmrc DESTINATION ${page})
  # No development packages, install scripts, audits or funding messages.
  execute_process(
    COMMAND ${ADASPLATS_NPM} ci --omit=dev --ignore-scripts --no-audit --no-fund --loglevel=error
    WORKING_DIRECTORY ${page} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output
    TIMEOUT 300)
  if(NOT status EQUAL 0)
    message(STATUS "adasplats: ${output}")
    set(${result} "npm could not fetch its packages (see npm's output above)" PARENT_SCOPE)
    return()
  endif()
  file(WRITE ${page}/fetched ${lock_hash})
endfunction()

set(viewer ${PROJECT_SOURCE_DIR}/viewer)
set(page ${PROJECT_BINARY_DIR}/viewer)
set(missing "")
set(ADASPLATS_NODE_VERSION "")
if(ADASPLATS_VIEWER)
  find_program(ADASPLATS_NODE NAMES node nodejs)
  find_program(ADASPLATS_NPM npm)
  mark_as_advanced(ADASPLATS_NODE ADASPLATS_NPM)
  if(NOT ADASPLATS_NODE OR NOT ADASPLATS_NPM)
    set(missing "no Node.js with npm (nodejs, npm)")
  else()
    execute_process(COMMAND ${ADASPLATS_NODE} --version OUTPUT_VARIABLE ADASPLATS_NODE_VERSION
                    OUTPUT_STRIP_TRAILING_WHITESPACE)
    # VERSION_LESS needs a number without the leading v.
    string(REGEX REPLACE "^v" "" node_version "${ADASPLATS_NODE_VERSION}")
    if(node_version VERSION_LESS 18)
      set(missing "no Node.js 18 or newer (found ${ADASPLATS_NODE_VERSION})")
    else()
      # Fetch at configure time, so that a missing network is reported at once. The packages stay in the
      # build folder until the lock file changes.
      file(MAKE_DIRECTORY ${page})
      set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${viewer}/package.json
                                             ${viewer}/package-lock.json)
      adasplats_fetch_page_packages(${viewer} ${page} missing)
    endif()
  endif()
endif()
adasplats_part(ADASPLATS_VIEWER "the viewer's page" "${missing}" "Node.js ${ADASPLATS_NODE_VERSION}"
               ADASPLATS_PAGE)
if(NOT ADASPLATS_PAGE)
  return()
endif()

file(GLOB_RECURSE page_sources CONFIGURE_DEPENDS ${viewer}/src/*)
add_custom_command(
  OUTPUT ${page}/page_data.cpp
  # esbuild resolves packages from the folder of the importing source.
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${page}/src ${page}/dist
  COMMAND ${CMAKE_COMMAND} -E copy_directory ${viewer}/src ${page}/src
  COMMAND ${CMAKE_COMMAND} -E copy ${viewer}/build.mjs ${page}
  COMMAND ${ADASPLATS_NODE} ${page}/build.mjs ${page}/dist
  COMMAND ${ADASPLATS_NODE} ${viewer}/embed.mjs ${page}/dist ${page}/page_data.cpp
  DEPENDS ${page_sources} ${viewer}/build.mjs ${viewer}/embed.mjs ${page}/fetched
  COMMENT "Bundling the viewer's page" VERBATIM)
target_sources(adasplats_view PRIVATE ${page}/page_data.cpp)
target_compile_definitions(adasplats_view PRIVATE ADASPLATS_HAVE_PAGE)
