// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/logs/carmen_log.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include "core/number_text.h"
#include "core/pi.h"
#include "io/files/gunzip.h"
#include "io/files/text.h"
#include "io/files/text_lines.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr double kDegree = kPi / 180.0;
constexpr double kFarthest = 1e9;  // largest coordinate of a pose [m]
constexpr std::size_t kMaxFaults = 1000;
constexpr double kSickNoReturn = 80.0, kSickLimit = 82.0;  // [m]; a SICK writes 81.83 or similar if there is no return

/// What is wrong with a line of the log.
struct BadLine : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Reads the words of a line one by one.
class Words {
 public:
  explicit Words(std::string_view line) : words_(splitWords(line)) {}

  std::size_t left() const { return words_.size() - next_; }

  std::string_view word(const char* what) {
    if (next_ == words_.size()) throw BadLine(std::string("the line ends before the ") + what);
    return words_[next_++];
  }
  double number(const char* what) {
    double value = 0.0;
    const std::string_view text = word(what);
    if (!parseNumber(text, value)) throw BadLine("expected the " + std::string(what) + ", found " + quote(text));
    return value;
  }
  double finite(const char* what) {
    const double value = number(what);
    if (!std::isfinite(value)) throw BadLine(std::string("the ") + what + " is not finite");
    return value;
  }
  /// Reads a number of words that must follow.
  std::size_t count(const char* what) {
    const std::string_view text = word(what);
    std::size_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
      throw BadLine("expected the " + std::string(what) + ", found " + quote(text));
    if (value > left())
      throw BadLine("the " + std::string(what) + " is " + std::string(text) + ", but only " + std::to_string(left()) +
                    " words follow");
    return value;
  }
  void skip(std::size_t words) { next_ += words; }
  /// Skips all words but the last `words`. Returns false if fewer are left.
  bool skipTo(std::size_t words) {
    if (left() < words) return false;
    next_ = words_.size() - words;
    return true;
  }

 private:
  std::vector<std::string_view> words_;
  std::size_t next_ = 0;
};

void readRanges(Words& words, std::size_t n, LaserScan& scan) {
  if (n == 0) throw BadLine("the scan has no beams");
  scan.ranges.reserve(n);
  for (std::size_t i = 0; i < n; ++i) scan.ranges.push_back(words.number("range"));
}

void readPose(Words& words, LaserScan& scan) {
  scan.pose.translation.x() = words.finite("x of the pose");
  scan.pose.translation.y() = words.finite("y of the pose");
  if (scan.pose.translation.cwiseAbs().maxCoeff() > kFarthest)
    throw BadLine("the pose is more than 10^9 m from the origin");
  scan.pose.heading = std::remainder(words.finite("heading of the pose"), 2.0 * kPi);
}

/// Reads the words that end a line: time of the message, host, time of the log.
void readTime(Words& words, LaserScan& scan) {
  if (!words.skipTo(3)) return;
  double time = 0.0;
  if (parseNumber(words.word("time"), time) && std::isfinite(time)) scan.time = time;
}

void setBearings(LaserScan& scan, double first, double step) {
  scan.bearings.reserve(scan.ranges.size());
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) scan.bearings.push_back(first + static_cast<double>(i) * step);
}

/// Reads the words after FLASER.
LaserScan readFlaser(Words& words) {
  LaserScan scan;
  const std::size_t n = words.count("number of ranges");
  readRanges(words, n, scan);
  if (words.left() > 9)  // at most two poses, time, host, time
    throw BadLine("there are " + std::to_string(words.left()) + " words after the " + std::to_string(n) +
                  " ranges: the number of ranges is wrong, or two lines were joined");
  readPose(words, scan);
  const double field = n == 400 || n == 401 ? 100.0 : 180.0;
  const bool is_last_beam_missing = n == 180 || n == 360 || n == 400;
  const double steps = is_last_beam_missing ? static_cast<double>(n) : std::max(static_cast<double>(n) - 1.0, 1.0);
  readTime(words, scan);
  setBearings(scan, -field / 2.0 * kDegree, field / steps * kDegree);
  scan.max_range = kSickNoReturn;
  return scan;
}

/// Reads the words after ROBOTLASER1.
LaserScan readRobotLaser(Words& words) {
  LaserScan scan;
  words.word("type of the laser");
  const double start = words.finite("start angle"), field = words.finite("field of view");
  double step = words.finite("angular step");
  const double max_range = words.number("maximum range");
  words.number("accuracy");
  words.word("remission mode");
  const std::size_t n = words.count("number of ranges");
  readRanges(words, n, scan);
  words.skip(words.count("number of remissions"));
  readPose(words, scan);
  if (n > 1 && step == 0.0) step = field / static_cast<double>(n - 1);
  if (n > 1 && !(step > 0.0 && step * static_cast<double>(n - 1) < 2.0 * kPi + step))
    throw BadLine(std::to_string(n) + " beams, each " + numberText(step) +
                  " rad from the next: the angular step must be above 0 and the field of view at most a full turn");
  if (std::abs(start) > 4.0 * kPi)
    throw BadLine("the start angle is " + numberText(start) + " rad, expected at most two turns");
  if (!(max_range > 0.0)) throw BadLine("the maximum range must be above 0");
  readTime(words, scan);
  setBearings(scan, start, step);
  scan.max_range = max_range > kSickNoReturn && max_range < kSickLimit ? kSickNoReturn : max_range;
  return scan;
}

void note(CarmenLog& log, std::size_t line, const std::string& what) {
  if (log.faults.size() < kMaxFaults) {
    log.faults.push_back({line, what});
  } else {
    ++log.more_faults;
  }
}

}  // namespace

CarmenLog readCarmenLog(const std::filesystem::path& path) {
  TextLines lines(path);
  CarmenLog log;
  std::string line;
  std::size_t kept = 0;  // bytes of the lines with scans; lines without scans take no memory
  const std::size_t most = maxGunzipped(static_cast<std::size_t>(std::filesystem::file_size(path)));
  while (lines.next(line)) {
    const std::size_t before = log.scans.size();
    try {
      Words words(line);
      const std::string_view kind = words.left() > 0 ? words.word("name") : "";
      if (kind == "FLASER") log.scans.push_back(readFlaser(words));
      if (kind == "ROBOTLASER1") log.scans.push_back(readRobotLaser(words));
    } catch (const BadLine& bad) {
      note(log, lines.number(), bad.what());
    }
    if (log.scans.size() > before) kept += line.size();
    if (kept > most)
      throw FileError(path, "expands to more than 100 times its size; if that is right, expand it with gunzip first");
  }
  if (!lines.damage().empty()) note(log, lines.number(), lines.damage());
  if (log.scans.empty()) {
    const std::string reason =
        log.faults.empty() ? "" : "; line " + std::to_string(log.faults.front().line) + ": " + log.faults.front().what;
    throw FileError(path, "has no usable scan of a planar laser (lines FLASER or ROBOTLASER1)" + reason);
  }
  return log;
}

bool isCarmenLogName(const std::filesystem::path& name) {
  const std::filesystem::path lower = lowerCase(name.filename().string());
  const std::filesystem::path inner = lower.extension() == ".gz" ? lower.stem() : lower;
  return inner.extension() == ".log" || inner.extension() == ".clf";
}

}  // namespace gaussmap
