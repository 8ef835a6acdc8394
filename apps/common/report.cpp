// SPDX-License-Identifier: BSD-3-Clause
#include "common/report.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <iterator>
#include <sstream>

#include "io/files/atomic_file.h"

namespace gaussmap::app {

void warn(const std::string& text) {
  std::cerr << "gaussmap: warning: " << text << '\n';
}

void note(const std::string& text) {
  std::cerr << "gaussmap: note: " << text << '\n';
}

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string secondsText(double seconds) {
  std::ostringstream text;
  text << std::round(seconds * 100.0) / 100.0;
  return text.str();
}

std::string humanBytes(std::uintmax_t bytes) {
  const char* units[] = {"B", "kB", "MB", "GB", "TB"};
  auto value = static_cast<double>(bytes);
  std::size_t unit = 0;
  for (; value >= 1000.0 && unit + 1 < std::size(units); ++unit) value /= 1000.0;
  return formatted(unit == 0 ? "%.0f " : "%.1f ", value) + units[unit];
}

std::string formatted(const char* pattern, double value) {
  char text[64];
  std::snprintf(text, sizeof text, pattern, value);
  return text;
}

std::string csvQuoted(std::string text) {
  for (std::size_t i = text.find('"'); i != std::string::npos; i = text.find('"', i + 2)) text.insert(i, 1, '"');
  return '"' + text + '"';
}

std::string perScale(const std::vector<std::size_t>& counts) {
  std::string text;
  for (const std::size_t count : counts) text += (text.empty() ? "" : " / ") + std::to_string(count);
  return text;
}

template <int D>
std::string perScale(const GaussianMap<D>& map) {
  std::vector<std::size_t> counts;
  counts.reserve(std::size_t(map.scales()));
  for (int s = 0; s < map.scales(); ++s) counts.push_back(map.gaussianCount(s));
  return perScale(counts);
}

template <int D>
std::string perScale(const GaussianMap<D>& map, const GaussianMap<D>& whole) {
  std::string text;
  for (int s = 0; s < map.scales(); ++s)
    text +=
        (s > 0 ? " / " : "") + std::to_string(map.gaussianCount(s)) + " of " + std::to_string(whole.gaussianCount(s));
  return text;
}
template std::string perScale(const GaussianMap<2>&);
template std::string perScale(const GaussianMap<3>&);
template std::string perScale(const GaussianMap<2>&, const GaussianMap<2>&);
template std::string perScale(const GaussianMap<3>&, const GaussianMap<3>&);

void writeText(const std::filesystem::path& path, const std::string& text) {
  detail::AtomicFile file(path);
  file.write(text.data(), text.size());
  file.commit();
}

std::string nameOfSystem(const std::string& text) {
  constexpr std::size_t kLongest = 100;
  const std::size_t begin = text.find("[\""), end = begin == std::string::npos ? begin : text.find('"', begin + 2);
  std::string name =
      end == std::string::npos ? text : text.substr(0, begin) + " " + text.substr(begin + 1, end - begin);
  for (char& c : name)
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  return name.size() > kLongest ? name.substr(0, kLongest) + "..." : name;
}

}  // namespace gaussmap::app
