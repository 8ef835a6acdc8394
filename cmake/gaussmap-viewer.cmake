# SPDX-License-Identifier: BSD-3-Clause
# The viewer: VTK draws, EGL where there is no display, X11 tells whether there is one.
find_package(VTK 9.1 QUIET COMPONENTS CommonCore CommonDataModel IOImage InteractionStyle RenderingAnnotation RenderingCore
             RenderingFreeType RenderingOpenGL2 glew)
find_package(OpenGL QUIET COMPONENTS EGL)
find_package(X11 QUIET)
if(NOT VTK_FOUND OR NOT OpenGL_EGL_FOUND OR NOT X11_FOUND)
  message(FATAL_ERROR "The viewer needs VTK 9.1, EGL and X11 (Debian: libvtk9-dev libegl-dev libx11-dev). "
                      "Without it: -DGAUSSMAP_BUILD_VIEWER=OFF builds everything but `gaussmap view`.")
endif()

file(GLOB viewer_sources CONFIGURE_DEPENDS src/viewer/*.cpp)
add_library(gaussmap_viewer STATIC ${viewer_sources})  # into one program; not installed
add_library(gaussmap::viewer ALIAS gaussmap_viewer)
set_target_properties(gaussmap_viewer PROPERTIES EXPORT_NAME viewer)
target_include_directories(gaussmap_viewer PRIVATE src)
target_link_libraries(gaussmap_viewer
  PUBLIC gaussmap::core
  PRIVATE $<BUILD_INTERFACE:gaussmap_warnings> VTK::CommonCore VTK::CommonDataModel VTK::IOImage VTK::InteractionStyle
          VTK::RenderingAnnotation VTK::RenderingCore VTK::RenderingFreeType VTK::RenderingOpenGL2 VTK::glew OpenGL::EGL
          X11::X11)
vtk_module_autoinit(TARGETS gaussmap_viewer MODULES VTK::InteractionStyle VTK::RenderingFreeType VTK::RenderingOpenGL2)
