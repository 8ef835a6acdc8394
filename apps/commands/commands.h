// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace CLI {
class App;
}

namespace gaussmap::app {

// One function per command. main() calls each function once.
void addPcd2map(CLI::App& app);
void addScans(CLI::App& app);
void addRefine(CLI::App& app);
void addCompress(CLI::App& app);
void addRegister(CLI::App& app);
void addFinish(CLI::App& app);
void addTiles(CLI::App& app);
void addSimplify(CLI::App& app);
void addMerge(CLI::App& app);
void addTransform(CLI::App& app);
void addCrop(CLI::App& app);
void addDiff(CLI::App& app);
void addClean(CLI::App& app);
void addRestore(CLI::App& app);
void addInfo(CLI::App& app);
void addExport(CLI::App& app);
void addHausdorff(CLI::App& app);
void addSimulate(CLI::App& app);
void addDraw(CLI::App& app);
void addSegments(CLI::App& app);
void addView(CLI::App& app);
void addCompletion(CLI::App& app);
void addReference(CLI::App& app);

}  // namespace gaussmap::app
