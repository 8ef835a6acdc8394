// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace CLI {
class App;
}

// Each function adds one subcommand to the program. The subcommand runs while the arguments are parsed.
namespace gaussmap::benchmark {

void addTable(CLI::App& app);   // with PCL
void addGrowth(CLI::App& app);  // with PCL
void addRefinementTable(CLI::App& app);
void addRefinementSpeed(CLI::App& app);
void addMovingPoints(CLI::App& app);
void addFinishedSize(CLI::App& app);
void addSegments(CLI::App& app);
void addFormats(CLI::App& app);       // with PCL
void addRegistration(CLI::App& app);  // with PCL
void addNormals(CLI::App& app);       // with PCL
void addFilters(CLI::App& app);       // with PCL
void addSearch(CLI::App& app);        // with PCL
void addFrameTimes(CLI::App& app);    // with the viewer
void addDistances(CLI::App& app);
void addReference(CLI::App& app);
void addWideScans(CLI::App& app);
void addBoxLoad(CLI::App& app);
void addPoseCheck(CLI::App& app);
void addPlanar(CLI::App& app);
void addPapers(CLI::App& app);

}  // namespace gaussmap::benchmark
