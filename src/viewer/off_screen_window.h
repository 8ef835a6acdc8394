// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkRenderWindow.h>
#include <vtkSmartPointer.h>

namespace gaussmap {

/// Can a window be opened on the X server that DISPLAY names? (VTK ends the program where not.)
bool hasDisplay();

/// A window that is never seen: by EGL without a display, else on the display.
/// Throws std::runtime_error, with the way out, where there is neither.
vtkSmartPointer<vtkRenderWindow> makeOffScreenWindow();

}  // namespace gaussmap
