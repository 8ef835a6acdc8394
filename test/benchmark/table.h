// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace gaussmap::benchmark {

/// One comparison: how much longer the peer takes for the same.
struct Row {
  std::string part, input;
  int threads = 1;         ///< ours; peers that can have one only
  double seconds = 0.0;    ///< ours
  double megabytes = 0.0;  ///< ours, 0: not measured
  std::string peer;
  double peer_seconds = 0.0;
  double peer_megabytes = 0.0;
  double wanted = 0.0;  ///< of the ratio, 0: nothing
  double ratio() const { return peer_seconds / seconds; }
};

/// A number that is no ratio of times.
struct Figure {
  std::string part, input, what, unit;
  double value = 0.0;
  double at_most = 0.0;  ///< 0: nothing wanted
};

struct Table {
  std::vector<Row> rows;
  std::vector<Figure> figures;

  void add(const Row& row);        ///< and prints it
  void add(const Figure& figure);  ///< and prints it
};

/// {"rows": [...], "figures": [...]}; throws std::runtime_error if it cannot be written.
void writeJson(const std::string& path, const Table& table);
/// Adds what another subcommand wrote in this form.
void addJson(const std::string& path, Table& table);

}  // namespace gaussmap::benchmark
