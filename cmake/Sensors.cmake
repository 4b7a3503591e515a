# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0

# The library contains the sensor files (sensors/*.toml) as text, so that an installed program needs no
# data folder.
file(GLOB sensor_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/sensors/*.toml)
list(SORT sensor_files)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${sensor_files})

set(entries "")
foreach(sensor_file IN LISTS sensor_files)
  cmake_path(GET sensor_file STEM LAST_ONLY name)
  file(READ ${sensor_file} text)
  string(APPEND entries "    {\"${name}\", R\"toml(${text})toml\"},\n")
endforeach()

set(folder ${PROJECT_BINARY_DIR}/sensors)
file(MAKE_DIRECTORY ${folder})
# Rewritten only if it changed, so that configuring again compiles nothing.
file(WRITE ${folder}/lidar_library_data.cpp.new
     "// Written by cmake/Sensors.cmake from sensors/*.toml.\n"
     "#include \"adasplats/sensors/lidar_library.h\"\n\n"
     "namespace adasplats {\n\n"
     "std::span<const LibraryLidar> lidar_library() {\n"
     "  static constexpr LibraryLidar kLibrary[] = {\n${entries}  };\n"
     "  return kLibrary;\n"
     "}\n\n"
     "}  // namespace adasplats\n")
file(COPY_FILE ${folder}/lidar_library_data.cpp.new ${folder}/lidar_library_data.cpp
     ONLY_IF_DIFFERENT)
target_sources(adasplats_sensors PRIVATE ${folder}/lidar_library_data.cpp)
