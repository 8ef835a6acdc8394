// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/export/map_tiles.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <locale>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "core/check.h"
#include "gaussmap/io/pcd/map_pcd.h"
#include "gaussmap/io/pcd/pcd_reader.h"
#include "gaussmap/mapping/build.h"
#include "io/files/atomic_file.h"
#include "io/files/text.h"
#include "io/files/text_lines.h"
#include "io/pcd/wide_records.h"

namespace gaussmap {
using namespace detail;

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kOptionsComment = "# gaussmap:";
using Corner = std::array<std::int64_t, 2>;  // [m]

std::string exactText(double value) {
  char text[64];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

/// Groups the records by the square that contains them, given by its lower corner. The means become map coordinates.
std::map<Corner, GaussianRecords> bySquare(const GaussianRecords& all, int size, bool floats) {
  std::map<Corner, GaussianRecords> squares;
  for (GaussianRecord record : all.records) {
    Corner corner{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double& mean = record.mean[axis];
      mean += all.origin(static_cast<Eigen::Index>(axis));
      if (floats) mean = static_cast<double>(static_cast<float>(mean));  // the square is that of the written mean
      if (axis == 2) continue;
      const double low = std::floor(mean / size) * size;
      if (!(std::abs(low) < static_cast<double>(std::numeric_limits<std::int32_t>::max() - size)))
        throw std::out_of_range("a Gaussian at " + numberText(mean) +
                                " m is too far away: the index of the tiles stores 32-bit metres");
      corner[axis] = static_cast<std::int64_t>(low);
    }
    squares[corner].records.push_back(record);
  }
  return squares;
}

/// Returns half of the step between floats at the farthest coordinate of the records [m].
double roundingOfFloats(const GaussianRecords& all) {
  double farthest = 0.0;
  for (const GaussianRecord& record : all.records)
    for (std::size_t axis = 0; axis < 3; ++axis)
      farthest = std::max(farthest, std::abs(record.mean[axis] + all.origin(static_cast<Eigen::Index>(axis))));
  const auto at = static_cast<float>(farthest);
  return 0.5 * (double{std::nextafter(at, std::numeric_limits<float>::infinity())} - double{at});
}

/// A directory that is written under a temporary name. commit() gives it its final name; otherwise it is removed.
class PartFolder {
 public:
  explicit PartFolder(const fs::path& target) : target_(target), part_(target) {
    part_ += ".part";
    std::error_code error;
    if (fs::exists(target_, error) && !(fs::is_directory(target_, error) && fs::is_empty(target_, error)))
      throw FileError(target_, "exists already and is not overwritten");
    if (!fs::create_directory(part_, error))
      throw FileError(part_, error ? "cannot be created: " + error.message()
                                   : "exists already: another process is writing these tiles; if none is, remove it");
  }
  ~PartFolder() {
    std::error_code ignored;
    if (!done_) fs::remove_all(part_, ignored);
  }
  PartFolder(const PartFolder&) = delete;
  PartFolder& operator=(const PartFolder&) = delete;
  const fs::path& path() const { return part_; }
  void commit() {
    std::error_code error;
    fs::rename(part_, target_, error);
    if (error) throw FileError(target_, "cannot be renamed to its final name: " + error.message());
    done_ = true;
  }

 private:
  fs::path target_, part_;
  bool done_ = false;
};

/// The content of the index file.
struct Index {
  double x_size = 0.0, y_size = 0.0;
  std::vector<std::string> files;
  std::optional<MapOptions> options;
};

/// Splits a line "key: rest". Returns false for blank lines and comments.
bool splitLine(const std::string& line, std::string& key, std::string& rest) {
  const std::size_t first = line.find_first_not_of(" \t\r");
  if (first == std::string::npos || line[first] == '#') return false;
  const std::size_t colon = line.find(':', first);
  if (colon == std::string::npos) return false;
  const auto trimmed = [](const std::string& text) {
    const std::size_t begin = text.find_first_not_of(" \t\r\"'"), end = text.find_last_not_of(" \t\r\"'");
    return begin == std::string::npos ? std::string() : text.substr(begin, end - begin + 1);
  };
  key = trimmed(line.substr(first, colon - first));
  rest = trimmed(line.substr(colon + 1));
  return true;
}

double numberOf(const fs::path& path, std::size_t line, const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value > 0.0) || !std::isfinite(value))
    throw FileError(path, "line " + std::to_string(line) + ": '" + text + "' is not a positive number");
  return value;
}

Index readIndex(const fs::path& path) {
  Index index;
  TextLines lines(path);
  for (std::string line, key, rest; lines.next(line);) {
    if (line.compare(0, kOptionsComment.size(), kOptionsComment) == 0) {
      MapOptions options;
      std::istringstream words(line.substr(kOptionsComment.size()));
      words.imbue(std::locale::classic());
      std::string name;
      if (words >> name >> options.resolution >> name >> options.ratio >> name >> options.scales >> name >>
          options.noise)
        index.options = options;
      continue;
    }
    if (!splitLine(line, key, rest)) continue;
    if (key == "x_resolution")
      index.x_size = numberOf(path, lines.number(), rest);
    else if (key == "y_resolution")
      index.y_size = numberOf(path, lines.number(), rest);
    else if (fs::path(key).filename() != key || key == "." || key == "..")
      throw FileError(path,
                      "line " + std::to_string(lines.number()) + ": '" + key + "' is not a file in the same folder");
    else
      index.files.push_back(key);
  }
  if (index.x_size == 0.0 || index.y_size == 0.0) throw FileError(path, "has no x_resolution or no y_resolution");
  if (index.files.empty()) throw FileError(path, "names no tile");
  return index;
}

/// Returns true if the tiles hold only scale 0, with one Gaussian per cell and without occupancy.
bool isPlainFinest(const GaussianMap<3>& map, const GaussianRecords& all) {
  return map.scales() == 1 && map.gaussianCount(0) == map.cellCount(0) && all.records.front().scale == 0.0f &&
         !map.hasOccupancy();
}

}  // namespace

WrittenTiles saveTiles(const fs::path& folder, const GaussianMap<3>& map, const TilesOptions& options) {
  require(options.size >= 1, "size", options.size, "must be at least 1 m");
  const GaussianRecords all = toRecords(map, options.scale);
  WrittenTiles written;
  written.doubles = !options.floats && !all.origin.isZero();
  written.rounding = roundingOfFloats(all);
  const std::map<Corner, GaussianRecords> squares = bySquare(all, options.size, !written.doubles);
  PartFolder part(folder);
  const MapOptions& grid = map.options();
  std::ostringstream index;
  index.imbue(std::locale::classic());
  index << kOptionsComment << " resolution " << exactText(grid.resolution) << " ratio " << grid.ratio << " scales "
        << grid.scales << " noise " << exactText(grid.noise) << '\n'
        << "x_resolution: " << options.size << ".0\ny_resolution: " << options.size << ".0\n";
  for (const auto& [corner, records] : squares) {
    const std::string name = "tile_" + std::to_string(corner[0]) + "_" + std::to_string(corner[1]) + ".pcd";
    if (written.doubles)
      saveWideRecordsPcd(part.path() / name, records);
    else
      saveRecordsPcd(part.path() / name, records);
    index << name << ": [" << corner[0] << ", " << corner[1] << "]\n";
    ++written.tiles;
    written.gaussians += records.records.size();
  }
  AtomicFile file(part.path() / kTilesIndex);
  const std::string text = index.str();
  file.write(text.data(), text.size());
  file.commit();
  part.commit();
  return written;
}

GaussianMap<3> loadTiles(const fs::path& folder) {
  const fs::path path = folder / kTilesIndex;
  std::error_code ignored;
  if (!fs::exists(path, ignored))
    throw FileError(path, "does not exist, so " + folder.string() +
                              " is not a folder of tiles; build a map of PCD files with gaussmap pcd2map");
  const Index index = readIndex(path);
  GaussianRecords all;
  for (const std::string& file : index.files) {
    if (PcdReader(folder / file).header().find("covariance") == nullptr)
      throw FileError(folder / file, "holds points, not Gaussians; build a map from such tiles with gaussmap pcd2map " +
                                         folder.string() + " --frame map -o MAP");
    GaussianRecords tile = loadRecordsPcd(folder / file);
    for (GaussianRecord& record : tile.records)
      for (std::size_t axis = 0; axis < 3; ++axis) record.mean[axis] += tile.origin(static_cast<Eigen::Index>(axis));
    all.records.insert(all.records.end(), tile.records.begin(), tile.records.end());
  }
  try {
    GaussianMap<3> map = fromRecords(all);
    if (!index.options || !isPlainFinest(map, all) || index.options->scales == 1) return map;
    return build<3>(map.scale(0), *index.options);
  } catch (const std::logic_error& error) {
    throw FileError(path, std::string("its tiles do not form a map: ") + error.what());
  }
}

}  // namespace gaussmap
