// SPDX-License-Identifier: BSD-3-Clause
// Builds a map of PCD scans with poses, and adds Gaussians where they help.   Usage: 02_scans_to_map FOLDER OUT.gmap
#include <gaussmap/gaussmap.h>

#include <cstdio>
#include <exception>
#include <utility>

int main(int, char** argv) {
  try {
    const gaussmap::FoundScans found = gaussmap::findScans({argv[1]});
    for (const std::string& warning : found.warnings) std::fprintf(stderr, "%s\n", warning.c_str());

    gaussmap::PointCounts counts;
    gaussmap::GaussianMapOctree map = gaussmap::build(found.scans, {}, {}, &counts);
    const auto refined = gaussmap::refine(std::move(map), gaussmap::PerCell{4.0});
    gaussmap::SaveOptions replace;
    replace.overwrite = true;
    gaussmap::save(argv[2], refined, {}, replace);
    std::printf("%zu scans, %lld points, %zu Gaussians at the coarsest scale\n", found.scans.size(),
                static_cast<long long>(counts.accepted), refined.map.gaussianCount(refined.map.scales() - 1));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
