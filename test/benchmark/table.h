// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace gaussmap::benchmark {

/// One comparison: the times of gaussmap and of a peer for the same task.
struct Row {
  std::string part, input;
  int threads = 1;         ///< of gaussmap; a peer that has no threads uses one
  double seconds = 0.0;    ///< of gaussmap
  double megabytes = 0.0;  ///< of gaussmap, 0: not measured
  std::string peer;
  double peer_seconds = 0.0;
  double peer_megabytes = 0.0;
  double ratio() const { return peer_seconds / seconds; }
};

/// A figure that is not a ratio of times.
struct Figure {
  std::string part, input, what, unit;
  double value = 0.0;
};

struct Table {
  std::vector<Row> rows;
  std::vector<Figure> figures;

  void add(const Row& row);        ///< adds a row and prints it
  void add(const Figure& figure);  ///< adds a figure and prints it
};

/// Writes {"rows": [...], "figures": [...]}. Throws std::runtime_error if the file cannot be written.
void writeJson(const std::string& path, const Table& table);
/// Adds the rows and figures that another subcommand wrote in this form.
void addJson(const std::string& path, Table& table);

}  // namespace gaussmap::benchmark
