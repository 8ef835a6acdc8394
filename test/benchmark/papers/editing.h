// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "papers/report.h"
#include "papers/sequences.h"

namespace gaussmap::papers {

/// A merged, simplified or compressed map.
struct EditedRow {
  std::string step;    ///< "merged, scale 1"
  std::string method;  ///< "as printed", "default", or what the result is compared with
  std::size_t gaussians = 0;
  DistanceSummary distances;  ///< of samples from the truth
  double seconds = 0.0;       ///< of processor time
};

/// Merges maps of the two halves of a sequence, simplifies a refined map, and compresses it: as printed in Yguel 2009
/// sec. 5.4 and by eq. (6), and with the defaults of the library.
std::vector<EditedRow> runEditing(const Sequence<3>& sequence);

/// Adds the table and the claims to the report.
void reportEditing(const std::vector<std::pair<std::string, std::vector<EditedRow>>>& data, Report& report);

}  // namespace gaussmap::papers
