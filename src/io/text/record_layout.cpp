// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/record_layout.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <utility>

#include "gaussmap/core/error.h"
#include "io/files/text.h"
#include "io/formats/kind_of_start.h"

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "records are read as they are in memory");

namespace gaussmap::detail {
namespace {

constexpr std::string_view kTypeNames[] = {"i8", "u8", "i16", "u16", "i32", "u32", "f32", "f64"};

/// The fields of the records of a dataset, all of them f32.
struct KnownRecord {
  const char* fields;
};
constexpr KnownRecord kKitti = {"x y z intensity"};
constexpr KnownRecord kNuScenes = {"x y z intensity ring"};

/// Returns true if x or y spreads more than twice as far in some of `period` interleaved groups of records as in
/// others. That happens if the true records are longer or shorter than these.
bool isMixed(const RecordLayout& layout, std::string_view bytes, std::size_t period) {
  constexpr std::size_t kEnough = 100, kMost = 2000;  // records
  const std::size_t count = std::min(bytes.size() / layout.size, kMost);
  if (count < kEnough) return false;
  std::vector<double> values(count);
  for (const std::size_t field : {0, 1}) {
    readField(layout, field, bytes, 0, count, values.data());
    double least = std::numeric_limits<double>::infinity(), most = 0.0;
    for (std::size_t group = 0; group < period; ++group) {
      double sum = 0.0, squares = 0.0, size = 0.0;
      for (std::size_t i = group; i < count; i += period) {
        sum += values[i];
        squares += values[i] * values[i];
        ++size;
      }
      const double variance = std::max(0.0, squares / size - (sum / size) * (sum / size));
      least = std::min(least, variance);
      most = std::max(most, variance);
    }
    if (most > 4.0 * least) return true;
  }
  return false;
}

/// Returns why the bytes are not such records, or an empty text.
std::string misfit(const KnownRecord& known, std::string_view bytes) {
  const RecordLayout layout(parseFields(known.fields, true));
  if (bytes.size() % layout.size != 0) return "the size is not a multiple of " + std::to_string(layout.size) + " bytes";
  const std::vector<ColumnSample> samples = sampleRecords(layout, bytes);
  const auto complain = [&](std::size_t field, double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return layout.fields[field].name + " would be " + text;
  };
  // Nearly all floats whose bytes are not floats are very large, very small, or not finite.
  constexpr double kLargest = 1e4;
  constexpr double kSmallest = 1e-20;
  bool all_zero = true, are_shares = true, are_whole = true;
  std::size_t on_axis = 0;  // points with y = z = 0, but not x
  for (std::size_t i = 0; i < samples[0].values.size(); ++i) {
    for (std::size_t field = 0; field < samples.size(); ++field) {
      const double value = samples[field].values[i];
      const double size = std::abs(value);
      if (!(size < kLargest) || (size < kSmallest && size > 0.0)) return complain(field, value);
      all_zero = all_zero && value == 0.0;
    }
    on_axis += samples[0].values[i] != 0.0 && samples[1].values[i] == 0.0 && samples[2].values[i] == 0.0;
    const double intensity = samples[3].values[i];
    if (intensity < 0.0 || intensity > 255.0) return complain(3, intensity);
    are_shares = are_shares && intensity <= 1.0;
    are_whole = are_whole && intensity == std::floor(intensity);
    if (!are_shares && !are_whole) return complain(3, intensity);
    if (samples.size() < 5) continue;
    const double ring = samples[4].values[i];
    if (ring < 0.0 || ring > 127.0 || ring != std::floor(ring)) return complain(4, ring);
  }
  if (all_zero) return "all numbers would be 0";
  // Every other record of points that take 32 bytes, as in PCL.
  if (4 * on_axis > samples[0].values.size()) return "y and z of many points would be 0";
  for (const std::size_t period : {2, 3})
    if (isMixed(layout, bytes, period))
      return "every " + std::string(period == 2 ? "second" : "third") + " point would be of another kind";
  return "";
}

}  // namespace

RecordLayout::RecordLayout(std::vector<PointField> record_fields) : fields(std::move(record_fields)) {
  for (const PointField& field : fields) {
    offsets.push_back(size);
    size += sizeOf(field.type);
  }
}

std::string describe(const RecordLayout& layout) {
  std::string text;
  for (const PointField& field : layout.fields) {
    text += text.empty() ? "" : " ";
    text += field.name.empty() ? "-" : field.name;
    text += ":";
    text += kTypeNames[static_cast<std::size_t>(field.type)];
  }
  return text;
}

void readField(const RecordLayout& layout, std::size_t field, std::string_view bytes, std::size_t first,
               std::size_t count, double* values) {
  NumberType type = layout.fields[field].type;
  // A colour of PCL in a float: the bits are the number.
  if (layout.fields[field].name == "rgb" && type == NumberType::Float32) type = NumberType::UInt32;
  loadNumbers(type, false, bytes.data() + first * layout.size + layout.offsets[field], layout.size, count, values);
}

std::vector<ColumnSample> sampleRecords(const RecordLayout& layout, std::string_view bytes) {
  constexpr std::size_t kRuns = 64;
  constexpr std::size_t kRecordsPerRun = 64;
  const std::size_t records = bytes.size() / layout.size;
  std::vector<ColumnSample> samples(layout.fields.size());
  const bool all = records <= kRuns * kRecordsPerRun;
  const std::size_t per_run = all ? records : kRecordsPerRun;
  for (std::size_t field = 0; field < samples.size(); ++field) {
    samples[field].values.resize(all ? records : kRuns * kRecordsPerRun);
    for (std::size_t run = 0; run < (all ? 1 : kRuns); ++run)
      readField(layout, field, bytes, (records - per_run) / (kRuns - 1) * run, per_run,
                samples[field].values.data() + run * per_run);
  }
  return samples;
}

std::vector<PointField> guessRecord(const std::filesystem::path& path, std::string_view bytes) {
  const std::string kitti = misfit(kKitti, bytes);
  const std::string nuscenes = misfit(kNuScenes, bytes);
  if (!kitti.empty() && !nuscenes.empty())
    throw FileError(path, "its first bytes are not those of a known kind of file, and its " +
                              std::to_string(bytes.size()) +
                              " bytes are not raw floats: with 4 floats per point (KITTI), " + kitti +
                              "; with 5 (nuScenes), " + nuscenes +
                              "; if these are raw records, name the fields, for example with --fields \"x y z "
                              "intensity\" or --fields \"x y z intensity ring:u16 time:f64\"");
  const bool both = kitti.empty() && nuscenes.empty();
  if (both && !endsWith(path.filename().string(), ".pcd.bin"))
    throw FileError(path,
                    "can hold 4 floats per point (KITTI) or 5 (nuScenes): choose with --fields \"x y z intensity\" or "
                    "--fields \"x y z intensity ring\"");
  return parseFields(nuscenes.empty() ? kNuScenes.fields : kKitti.fields, true);
}

std::string likelyRecord(std::string_view bytes) {
  const bool kitti = misfit(kKitti, bytes).empty();
  const bool nuscenes = misfit(kNuScenes, bytes).empty();
  if (kitti == nuscenes) return "";
  return kitti ? kKitti.fields : kNuScenes.fields;
}

void refuseOtherKinds(const std::filesystem::path& path, std::string_view bytes) {
  constexpr std::size_t kEnough = 12;  // the bytes of fewer floats can be letters by chance
  if (const std::string kind = kindOfStart(bytes); !kind.empty())
    throw FileError(path, "is " + kind + ", not raw records of floats");
  if (bytes.size() >= kEnough && looksLikeText(bytes)) throw FileError(path, "is a text, not raw records of floats");
}

}  // namespace gaussmap::detail
