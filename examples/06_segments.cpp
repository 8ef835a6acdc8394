// SPDX-License-Identifier: BSD-3-Clause
// Builds a map of linked line segments from scans of a planar laser.   Usage: 06_segments FOLDER OUT.geojson
#include <gaussmap/gaussmap.h>

#include <cstdio>
#include <exception>
#include <memory>

int main(int, char** argv) {
  try {
    const gaussmap::FoundScans found = gaussmap::findScans({argv[1]});
    gaussmap::SegmentFitter fitter;  // the paper as printed: SegmentFitter(SegmentFitterOptions::leal2000(), utility)
    for (const gaussmap::LaserScan& scan : gaussmap::planarScans(found.scans)) fitter.add(scan);

    const gaussmap::SegmentMap map = fitter.map();
    gaussmap::saveSegmentsGeoJson(argv[2], map);
    std::printf("%zu scans, %zu segments in %zu chains, %.1f m\n", fitter.scans(), map.segments.size(),
                map.chains.size(), map.totalLength());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
