// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/off_screen_window.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <X11/Xlib.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkRenderWindow.h>
#include <vtk_glew.h>

#include <stdexcept>

// X11 defines these as macros.
#undef None
#undef Status

namespace gaussmap {
namespace {

/// Debian's VTK can create only X contexts, but it draws into any context. This class creates an EGL context.
class EglWindow : public vtkGenericOpenGLRenderWindow {
 public:
  static EglWindow* New() {
    auto* const made = new EglWindow;
    made->InitializeObjectBase();
    return made;
  }

  /// Returns false if EGL has no desktop OpenGL 3.2 without a surface.
  bool createContext() {
    display_ = surfacelessDisplay();
    if (display_ == EGL_NO_DISPLAY || !eglInitialize(display_, nullptr, nullptr)) return false;
    const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglBindAPI(EGL_OPENGL_API) || !eglChooseConfig(display_, wanted, &config, 1, &count) || count < 1)
      return false;
    const EGLint version[] = {
        EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 2, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, version);
    return context_ != EGL_NO_CONTEXT && eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
  }

  void OpenGLInitContext() override {
    if (this->Initialized) return;
    // GLEW first loads OpenGL, then looks for GLX, which is missing and not needed.
    const GLenum loaded = glewInit();
    this->GlewInitValid = loaded == GLEW_OK || loaded == GLEW_ERROR_NO_GLX_DISPLAY;
    this->Initialized = true;
    this->ContextCreationTime.Modified();
  }
  void MakeCurrent() override { eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_); }
  bool IsCurrent() override { return context_ != EGL_NO_CONTEXT && eglGetCurrentContext() == context_; }

 protected:
  EglWindow() = default;
  ~EglWindow() override {
    if (IsCurrent()) this->Finalize();
    if (display_ == EGL_NO_DISPLAY) return;
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context_ != EGL_NO_CONTEXT) eglDestroyContext(display_, context_);
    context_ = EGL_NO_CONTEXT;
  }

 private:
  static EGLDisplay surfacelessDisplay() {
    const auto platform_display =
        reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
    if (platform_display == nullptr) return EGL_NO_DISPLAY;
    return platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  }

  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace

bool hasDisplay() {
  Display* const display = XOpenDisplay(nullptr);
  if (display != nullptr) XCloseDisplay(display);
  return display != nullptr;
}

vtkSmartPointer<vtkRenderWindow> makeOffScreenWindow() {
  const auto window = vtkSmartPointer<EglWindow>::New();
  vtkSmartPointer<vtkRenderWindow> made = window;
  if (!window->createContext()) {
    if (!hasDisplay())
      throw std::runtime_error(
          "cannot draw a picture: EGL has no OpenGL (Debian: libegl-mesa0) and there is no display (try xvfb-run "
          "-a)");
    made = vtkSmartPointer<vtkRenderWindow>::New();
  }
  made->OffScreenRenderingOn();
  return made;
}

}  // namespace gaussmap
