// SPDX-License-Identifier: BSD-3-Clause
#include "table.h"

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace gaussmap::benchmark {
namespace {

using Json = nlohmann::ordered_json;

Json jsonOf(const Row& row) {
  return {{"part", row.part},
          {"input", row.input},
          {"threads", row.threads},
          {"seconds", row.seconds},
          {"megabytes", row.megabytes},
          {"peer", row.peer},
          {"peer_seconds", row.peer_seconds},
          {"peer_megabytes", row.peer_megabytes}};
}
Json jsonOf(const Figure& figure) {
  return {{"part", figure.part},
          {"input", figure.input},
          {"what", figure.what},
          {"unit", figure.unit},
          {"value", figure.value}};
}

}  // namespace

void Table::add(const Row& row) {
  rows.push_back(row);
  std::printf("%-24s %-32s %d thread%s %9.4f s %7.1f MB | %-26s %9.4f s %7.1f MB | %6.2f\n", row.part.c_str(),
              row.input.c_str(), row.threads, row.threads == 1 ? " " : "s", row.seconds, row.megabytes,
              row.peer.c_str(), row.peer_seconds, row.peer_megabytes, row.ratio());
  std::fflush(stdout);
}

void Table::add(const Figure& figure) {
  figures.push_back(figure);
  std::printf("%-24s %-32s %s: %.4g %s\n", figure.part.c_str(), figure.input.c_str(), figure.what.c_str(), figure.value,
              figure.unit.c_str());
  std::fflush(stdout);
}

void writeJson(const std::string& path, const Table& table) {
  Json rows = Json::array(), figures = Json::array();
  for (const Row& row : table.rows) rows.push_back(jsonOf(row));
  for (const Figure& figure : table.figures) figures.push_back(jsonOf(figure));
  std::ofstream file(path);
  file << Json{{"rows", rows}, {"figures", figures}}.dump(1) << '\n';
  if (!file.flush()) throw std::runtime_error(path + ": cannot be written");
}

void addJson(const std::string& path, Table& table) {
  std::ifstream file(path);
  const Json json = Json::parse(file);
  for (const Json& row : json.value("rows", Json::array()))
    table.add(Row{row.at("part"), row.at("input"), row.at("threads"), row.at("seconds"), row.at("megabytes"),
                  row.at("peer"), row.at("peer_seconds"), row.at("peer_megabytes")});
  for (const Json& figure : json.value("figures", Json::array()))
    table.add(Figure{figure.at("part"), figure.at("input"), figure.at("what"), figure.at("unit"), figure.at("value")});
}

}  // namespace gaussmap::benchmark
