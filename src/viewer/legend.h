// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkActor2D.h>
#include <vtkSmartPointer.h>

#include <string>
#include <vector>

#include "viewer/colouring.h"

namespace gaussmap {

enum class Corner { TopLeft, TopRight, BottomLeft };

/// Returns lines of text in a corner of a picture of this height [pixels].
vtkSmartPointer<vtkActor2D> textActor(const std::string& text, Corner corner, int height);

/// Returns the legend of the colours: a bar with numbers, or names on their colours.
std::vector<vtkSmartPointer<vtkActor2D>> colourBar(const Colouring& colouring, int height);

}  // namespace gaussmap
