// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gaussmap/io/scans/file_scans.h"

namespace gaussmap::app {

/// Prints a note on stderr if the scans have intensities or colours, which a map does not hold.
void noteDroppedFields(const FileScans& scans);

}  // namespace gaussmap::app
