# SPDX-License-Identifier: BSD-3-Clause
# The viewer: VTK draws, EGL where there is no display, X11 tells whether there is one.
find_package(VTK 9.1 QUIET COMPONENTS CommonCore CommonDataModel IOImage InteractionStyle RenderingAnnotation RenderingCore
             RenderingFreeType RenderingOpenGL2 glew)
find_package(OpenGL QUIET COMPONENTS EGL)
find_package(X11 QUIET)
if(NOT VTK_FOUND OR NOT OpenGL_EGL_FOUND OR NOT X11_FOUND)
  message(STATUS "gaussmap: the viewer is not built, VTK 9.1, EGL or X11 is missing "
                 "(Debian: libvtk9-dev libegl-dev libx11-dev). All else is.")
  set(GAUSSMAP_BUILD_VIEWER OFF)
  return()
endif()

gaussmap_add_library(viewer STATIC FOLDERS viewer)  # into one program; not installed
target_link_libraries(gaussmap_viewer
  PUBLIC gaussmap::io
  PRIVATE VTK::CommonCore VTK::CommonDataModel VTK::IOImage VTK::InteractionStyle VTK::RenderingAnnotation
          VTK::RenderingCore VTK::RenderingFreeType VTK::RenderingOpenGL2 VTK::glew OpenGL::EGL X11::X11)
vtk_module_autoinit(TARGETS gaussmap_viewer MODULES VTK::InteractionStyle VTK::RenderingFreeType VTK::RenderingOpenGL2)
