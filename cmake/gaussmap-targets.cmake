# SPDX-License-Identifier: BSD-3-Clause
# Functions and settings that all targets of the project share.

# Precompiled headers: Eigen, and the standard headers that nearly every source includes.
set(gaussmap_precompiled <Eigen/Core> <Eigen/Geometry> <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <map>
                         <memory> <optional> <sstream> <stdexcept> <string> <unordered_map> <utility> <variant> <vector>)

# Shared libraries export only what GAUSSMAP_API marks: the public interface, and the few internals that gaussmap::io or the
# programs use. The tests look at more internals, so a build with tests exports everything.
set(gaussmap_visibility hidden)
if(BUILD_SHARED_LIBS AND GAUSSMAP_BUILD_TESTS)
  set(gaussmap_visibility default)
endif()

# gaussmap_fast_build(TARGET [HEADERS...]): if GAUSSMAP_FAST_BUILD is on, uses precompiled headers and one unity source
# per folder.
function(gaussmap_fast_build target)
  if(NOT GAUSSMAP_FAST_BUILD)
    return()
  endif()
  target_precompile_headers(${target} PRIVATE ${gaussmap_precompiled} ${ARGN})
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # In a unity source, g++ warns of anonymous namespaces as if the included sources were headers.
  target_compile_options(${target} PRIVATE $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-subobject-linkage>)
  get_target_property(sources ${target} SOURCES)
  foreach(source ${sources})
    get_filename_component(folder ${source} ABSOLUTE)
    get_filename_component(folder ${folder} DIRECTORY)
    file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${folder})
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder})
  endforeach()
endfunction()

# gaussmap_define_alignment(TARGET): defines GAUSSMAP_PCL_EIGEN_ALIGNMENT, Eigen's alignment with the flags of this build,
# for the target and its users. version.h compares it with the alignment that a program has.
function(gaussmap_define_alignment target)
  set(source ${PROJECT_BINARY_DIR}/eigen_alignment.cpp)
  file(WRITE ${source} "#include <Eigen/Core>\nalignment EIGEN_MAX_ALIGN_BYTES\n")
  string(TOUPPER "${CMAKE_BUILD_TYPE}" config)
  separate_arguments(flags UNIX_COMMAND "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${config}}")
  get_target_property(folders Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
  list(TRANSFORM folders PREPEND -I)
  execute_process(COMMAND ${CMAKE_CXX_COMPILER} ${flags} ${folders} -E -P ${source} OUTPUT_VARIABLE output ERROR_VARIABLE error)
  if(NOT output MATCHES "alignment ([0-9]+)")
    message(FATAL_ERROR "cannot find out EIGEN_MAX_ALIGN_BYTES: ${error}")
  endif()
  target_compile_definitions(${target} PUBLIC GAUSSMAP_PCL_EIGEN_ALIGNMENT=${CMAKE_MATCH_1})
endfunction()

# gaussmap_add_library(NAME [STATIC] FOLDERS folder...): adds the library gaussmap_NAME (alias gaussmap::NAME) with the
# sources of src/FOLDER.
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
    INSTALL_RPATH $ORIGIN  # one shared library finds the others in the same folder
    POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET ${gaussmap_visibility} VISIBILITY_INLINES_HIDDEN ON)
  target_include_directories(${target}
    PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:gaussmap_warnings>)
  # With fused multiply-add, roundings and therefore maps would depend on the machine.
  target_compile_options(${target} PRIVATE -ffp-contract=off)
  gaussmap_fast_build(${target})
endfunction()
