// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkCamera.h>

#include <vector>

#include "viewer/viewer.h"

namespace gaussmap {

/// Places the camera to look at points (relative to the scene's origin). All points but the outermost lie within a
/// picture of this aspect (width / height).
void aim(vtkCamera& camera, const ViewPoint& view, const Vector<3>& up, const std::vector<Vector<3>>& points,
         const Vector<3>& origin, double aspect);

}  // namespace gaussmap
