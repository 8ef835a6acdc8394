// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gaussmap/core/pose.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// A handful of points, one array an axis: what readers fill and what MomentGrid counts. Small enough to
/// stay in the first-level cache, so that a scan is never copied as a whole.
template <int D>
struct PointBlock {
  static constexpr std::size_t kCapacity = 512;
  std::size_t size = 0;
  alignas(64) double coordinate[D][kCapacity];  ///< [m]
};

/// Points where they lie in somebody's records: x, y, z as floats one after the other [m], a record every `stride`
/// floats.
struct PointsView {
  const float* first = nullptr;
  std::size_t count = 0;
  std::size_t stride = 3;

  const float* operator[](std::size_t i) const { return first + i * stride; }
};

/// R p + t for every point of a block, in place, NaN points stay NaN. The quaternion must have unit length.
GAUSSMAP_API void transform(const Pose& pose, PointBlock<3>& block);

/// The frame that the points of scans are given in.
enum class ScanFrame {
  Sensor,  ///< the sensor's: the pose moves points into the map
  Map      ///< the map's: the pose says only where the sensor was
};

/// What is known of a scan before its points are read.
struct ScanInfo {
  std::string name;            ///< for messages: the path of a file, or "scan 12"
  Pose pose;                   ///< sensor frame to map frame, unit quaternion
  std::optional<double> time;  ///< [s]
};

/// One scan in memory.
struct Scan {
  std::vector<Eigen::Vector3d> points;        ///< n [m], sensor frame, NaN where the sensor saw nothing
  Pose pose;                                  ///< sensor frame to map frame, unit quaternion
  int columns = 0;                            ///< points per row of an organised cloud; 0: in no order
  std::optional<double> time = std::nullopt;  ///< [s]
};

/// True for a measured point [m, sensor frame]: it is finite, and not at the sensor itself, which is how some drivers
/// mark "no return".
inline bool isReturn(const Eigen::Vector3d& point) {
  return point.allFinite() && !point.isZero(0.0);
}

/// Where the points of scans went; the four kinds add up to `read`.
struct GAUSSMAP_API PointCounts {
  std::int64_t read = 0;
  std::int64_t accepted = 0;
  std::int64_t non_finite = 0;
  std::int64_t at_sensor = 0;     ///< at range 0, see isReturn()
  std::int64_t beyond_range = 0;  ///< farther from the sensor than the greatest range asked for

  PointCounts& operator+=(const PointCounts& other);
};

/// The points of one scan, block by block. All functions are thread-safe.
class GAUSSMAP_API ScanReader {
 public:
  virtual ~ScanReader() = default;

  /// Number of points, the invalid ones of an organised cloud included.
  virtual std::size_t size() const = 0;
  /// Points per row of an organised cloud; 0: in no order.
  virtual int columns() const { return 0; }
  /// Fills the block with points first, first + 1 ... as far as the block or the scan goes [m], in the frame of the
  /// scans, NaN and infinity as they are. Behind the last point the block is empty. Throws FileError for damaged data.
  virtual void read(std::size_t first, PointBlock<3>& block) const = 0;
  /// To be called after the last read(): throws FileError if a file was cut off while it was read.
  virtual void requireWhole() const {}

  /// Names of other numbers that every point has, such as "intensity"; they may be none.
  virtual std::vector<std::string> valueNames() const { return {}; }
  /// size() numbers. Throws std::out_of_range if there is no value of that name.
  virtual std::vector<double> values(const std::string& name) const;
};

/// Scans with poses, wherever they are: PcdScans are files, MemoryScans are in memory, and any program can bring its
/// own. What builds, maps on line, cleans or measures takes scans through this interface.
/// All functions are thread-safe: scans are read in parallel.
class GAUSSMAP_API Scans {
 public:
  virtual ~Scans() = default;

  virtual std::size_t size() const = 0;
  /// Throws std::out_of_range if there is no such scan, as all functions here.
  virtual ScanInfo info(std::size_t index) const = 0;
  virtual ScanFrame frame() const { return ScanFrame::Sensor; }
  /// Throws FileError if a file cannot be read.
  virtual std::unique_ptr<ScanReader> open(std::size_t index) const = 0;

  /// A whole scan at once, in the sensor's frame even if the points are given in the map frame. Throws as open() and
  /// ScanReader::read().
  Scan read(std::size_t index) const;
};

/// Scans in memory, for a program that has them from elsewhere.
class GAUSSMAP_API MemoryScans : public Scans {
 public:
  /// `frame`: that of the points of all scans.
  explicit MemoryScans(ScanFrame frame = ScanFrame::Sensor) : frame_(frame) {}
  explicit MemoryScans(std::vector<Scan> scans, ScanFrame frame = ScanFrame::Sensor);

  /// Adds a scan. Throws std::invalid_argument, saying why, if its pose has a fault (poseFault()).
  void add(Scan scan);
  /// The same from floats, which are copied.
  void add(const PointsView& points, const Pose& pose, std::optional<double> time = std::nullopt);

  std::size_t size() const override { return scans_.size(); }
  ScanInfo info(std::size_t index) const override;
  ScanFrame frame() const override { return frame_; }
  std::unique_ptr<ScanReader> open(std::size_t index) const override;

 private:
  std::vector<Scan> scans_;
  ScanFrame frame_;
};

}  // namespace gaussmap
