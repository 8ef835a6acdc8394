// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkRenderWindow.h>
#include <vtkSmartPointer.h>

namespace gaussmap {

/// Returns true if a window can be opened on the X server that DISPLAY names. (If not, VTK would end the program.)
bool hasDisplay();

/// Returns a window that is never visible: by EGL without a display, or else on the display.
/// Throws std::runtime_error, with a remedy, if there is neither.
vtkSmartPointer<vtkRenderWindow> makeOffScreenWindow();

}  // namespace gaussmap
