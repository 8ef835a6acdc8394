# SPDX-License-Identifier: BSD-3-Clause
# The viewer: VTK draws the pictures, EGL is used if there is no display, and X11 checks whether there is a display.
find_package(VTK 9.1 QUIET COMPONENTS CommonCore CommonDataModel IOImage InteractionStyle RenderingAnnotation RenderingCore
             RenderingFreeType RenderingOpenGL2 glew)
find_package(OpenGL QUIET COMPONENTS EGL)
find_package(X11 QUIET)
if(NOT VTK_FOUND OR NOT OpenGL_EGL_FOUND OR NOT X11_FOUND)
  message(STATUS "gaussmap: VTK 9.1, EGL or X11 is missing (Debian: libvtk9-dev libegl-dev libx11-dev), "
                 "so everything except the viewer is built")
  set(GAUSSMAP_BUILD_VIEWER OFF)
  return()
endif()

gaussmap_add_library(viewer STATIC FOLDERS viewer)  # linked into one program only, not installed
target_link_libraries(gaussmap_viewer
  PUBLIC gaussmap::io
  PRIVATE VTK::CommonCore VTK::CommonDataModel VTK::IOImage VTK::InteractionStyle VTK::RenderingAnnotation
          VTK::RenderingCore VTK::RenderingFreeType VTK::RenderingOpenGL2 VTK::glew OpenGL::EGL X11::X11)
vtk_module_autoinit(TARGETS gaussmap_viewer MODULES VTK::InteractionStyle VTK::RenderingFreeType VTK::RenderingOpenGL2)
