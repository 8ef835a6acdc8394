// SPDX-License-Identifier: BSD-3-Clause
// Finds the pose of a scan in a map, from a guess that is half a metre wrong.   Usage: 03_localise MAP.gmap SCAN.pcd
#include <gaussmap/gaussmap.h>

#include <cmath>
#include <cstdio>
#include <exception>

int main(int, char** argv) {
  try {
    const gaussmap::GaussianMapOctree map = gaussmap::load(argv[1]);
    const gaussmap::FoundScans found = gaussmap::findScans({argv[2]});
    const gaussmap::Scan scan = found.scans.read(0);

    gaussmap::Pose guess = scan.pose;
    guess.translation += Eigen::Vector3d(0.3, -0.4, 0.0);
    const gaussmap::RegistrationResult result = gaussmap::registerScan(scan.points, map, guess);
    const double off = (result.pose.translation - scan.pose.translation).norm();
    std::printf("%.3f %.3f %.3f +- %.4f m, %.1f cm from the pose in the file%s\n", result.pose.translation.x(),
                result.pose.translation.y(), result.pose.translation.z(), std::sqrt(result.covariance(0, 0)),
                100.0 * off, result.converged ? "" : ", not converged");
    return off < 0.1 ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
