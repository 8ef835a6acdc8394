// SPDX-License-Identifier: BSD-3-Clause
#include <gaussmap/pcl/point_gaussian.h>

#include "pcl/headers_of_pcl.h"

#include "pcl/templates_of_gaussians.h"

int main() {
  return gaussmap::test::useTemplatesOfPcl();
}
