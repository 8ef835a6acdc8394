# SPDX-License-Identifier: BSD-3-Clause
# How the targets of the project are made, the same for all of them.

# The standard headers that nearly every source includes, and Eigen.
set(gaussmap_precompiled <Eigen/Core> <Eigen/Geometry> <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <map>
                         <memory> <optional> <sstream> <stdexcept> <string> <unordered_map> <utility> <variant> <vector>)

# The public headers say what is exported (GAUSSMAP_API). Shared libraries also export internals: gaussmap::io, the
# commands and the tests use those of gaussmap::core. Nothing else leaves them.
set(gaussmap_visibility hidden)
if(BUILD_SHARED_LIBS)
  set(gaussmap_visibility default)
endif()

# gaussmap_fast_build(TARGET [HEADERS...]): precompiled headers and unity builds by folder, with GAUSSMAP_FAST_BUILD.
function(gaussmap_fast_build target)
  if(NOT GAUSSMAP_FAST_BUILD)
    return()
  endif()
  target_precompile_headers(${target} PRIVATE ${gaussmap_precompiled} ${ARGN})
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # g++ takes the anonymous namespaces of the sources that a unity source includes for those of headers.
  target_compile_options(${target} PRIVATE $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-subobject-linkage>)
  get_target_property(sources ${target} SOURCES)
  foreach(source ${sources})
    get_filename_component(folder ${source} ABSOLUTE)
    get_filename_component(folder ${folder} DIRECTORY)
    file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${folder})
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder})
  endforeach()
endfunction()

# gaussmap_add_library(NAME [STATIC] FOLDERS folder...): library gaussmap_NAME, alias gaussmap::NAME, from src/<folder>.
function(gaussmap_add_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "STATIC" "" "FOLDERS")
  set(sources)
  foreach(folder ${arg_FOLDERS})
    file(GLOB_RECURSE found CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${folder}/*.cpp)
    list(APPEND sources ${found})
  endforeach()
  set(kind)
  if(arg_STATIC)
    set(kind STATIC)
  endif()
  set(target gaussmap_${name})
  add_library(${target} ${kind} ${sources})
  add_library(gaussmap::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES
    EXPORT_NAME ${name} VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
    POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET ${gaussmap_visibility} VISIBILITY_INLINES_HIDDEN ON)
  target_include_directories(${target}
    PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:gaussmap_warnings>)
  # A fused multiply-add would make the lattice, the merges and so the map depend on the machine.
  target_compile_options(${target} PRIVATE -ffp-contract=off)
  gaussmap_fast_build(${target})
endfunction()
