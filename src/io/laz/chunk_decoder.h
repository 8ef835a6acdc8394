// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace gaussmap::detail {

/// A part of the point record of a LAZ file, with its own compression. The numbers are those of the file.
enum class LazItemType : std::uint16_t {
  Bytes = 0,
  Point10 = 6,
  GpsTime11 = 7,
  Rgb12 = 8,
  Point14 = 10,
  Rgb14 = 11,
  RgbNir14 = 12,
  Bytes14 = 14
};

struct LazItem {
  LazItemType type = LazItemType::Bytes;
  std::uint16_t size = 0;  ///< bytes in the record
  std::uint16_t version = 0;
};

/// Parts of a point that can be decoded separately, in the order of the layers of a file. The first layer, with x, y
/// and the number of the return, is always decoded.
enum LazLayers : unsigned {
  kLazZ = 1u << 1,
  kLazClassification = 1u << 2,
  kLazFlags = 1u << 3,
  kLazIntensity = 1u << 4,
  kLazScanAngle = 1u << 5,
  kLazUserData = 1u << 6,
  kLazPointSource = 1u << 7,
  kLazGpsTime = 1u << 8,
  kLazColour = 1u << 9,
  kLazInfrared = 1u << 10,
  kLazExtraBytes = 1u << 11,
  kAllLazLayers = ~0u
};

/// Decodes the chunks of a LAZ file, one after the other. No statistics are kept from one chunk to the next.
///
/// The functions return what is wrong with the data, as in "ends too early", or an empty string.
class LazChunkDecoder {
 public:
  virtual ~LazChunkDecoder() = default;

  /// Starts a chunk of `points` points, at least 1. `data` starts with the chunk and can be longer than it.
  virtual std::string start(std::string_view data, std::uint64_t points) = 0;
  /// Decodes the next points into consecutive records. Together at most the points of the chunk.
  virtual std::string decode(std::size_t points, char* records) = 0;
  /// Returns the number of bytes of the chunk, after all points have been decoded.
  virtual std::size_t bytes() const = 0;
};

/// Returns a decoder of the points of formats 0 to 5, whose items share one stream. `items` must have been checked.
std::unique_ptr<LazChunkDecoder> pointwiseDecoder(const std::vector<LazItem>& items);

/// Returns a decoder of the points of formats 6 to 10, whose attributes are stored in layers. Only the layers in
/// `wanted` (LazLayers) are decoded; other attributes of the records have the value of an earlier point. `items` must
/// have been checked.
std::unique_ptr<LazChunkDecoder> layeredDecoder(const std::vector<LazItem>& items, unsigned wanted);

}  // namespace gaussmap::detail
