// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkCamera.h>

#include <vector>

#include "viewer/viewer.h"

namespace gaussmap {

/// Looks at points (about the scene's origin) so that all but the outermost lie in a picture of this width / height.
void aim(vtkCamera& camera, const ViewPoint& view, const Vector<3>& up, const std::vector<Vector<3>>& points,
         const Vector<3>& origin, double aspect);

}  // namespace gaussmap
