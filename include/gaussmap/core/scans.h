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

/// A block of up to kCapacity points, with one array per axis. Readers fill blocks, and MomentGrid counts their points.
/// A block fits into the first-level cache, so no scan has to be copied as a whole.
template <int D>
struct PointBlock {
  static constexpr std::size_t kCapacity = 512;  ///< maximum number of points
  std::size_t size = 0;                          ///< number of points
  alignas(64) double coordinate[D][kCapacity];   ///< coordinate[axis][point] [m]
};

/// A view of points in records that the caller owns. Each record holds x, y and z as consecutive floats [m].
struct PointsView {
  const float* first = nullptr;  ///< x of the first point
  std::size_t count = 0;         ///< number of points
  std::size_t stride = 3;        ///< floats from one record to the next

  /// Returns the address of x, y and z of point `i`.
  const float* operator[](std::size_t i) const { return first + i * stride; }
};

/// Replaces every point p of a block by `R p + t`. NaN points stay NaN. The quaternion must have unit length.
GAUSSMAP_API void transform(const Pose& pose, PointBlock<3>& block);

/// The frame in which the points of scans are given.
enum class ScanFrame {
  Sensor,  ///< sensor frame: the pose transforms the points into the map frame
  Map      ///< map frame: the pose gives only the position of the sensor
};

/// What a pose that was read from a file means.
enum class PoseConvention {
  SensorToMap,  ///< usual: the pose moves points from the sensor frame into the map frame
  NoMotion,     ///< the pose is ignored: the points are in the map frame. Unlike ScanFrame::Map, no sensor positions
  Inverse,      ///< the pose moves points from the map frame into the sensor frame
  WFirst,       ///< the quaternion was read as x y z w, but is written as w x y z
  WLast,        ///< the quaternion was read as w x y z, but is written as x y z w
  Camera,       ///< the pose is that of a camera (x right, y down, z forward) on a lidar (x forward, y left, z up)
  Optical       ///< the pose is that of a body (x forward, y left, z up), but the points have the axes of a camera
};

/// Converts a pose `read` from a file into a pose from the sensor frame to the map frame.
///
/// Camera and Optical change the axes on both sides, as for the poses of KITTI odometry: the map has the axes of the
/// points. The distance between camera and lidar is unknown and counts as zero.
GAUSSMAP_API Pose poseAs(PoseConvention convention, const Pose& read);

/// Describes a scan before its points are read.
struct ScanInfo {
  std::string name;            ///< used in messages: the path of a file, or "scan 12"
  Pose pose;                   ///< sensor frame to map frame, unit quaternion
  std::optional<double> time;  ///< time of the scan [s]; std::nullopt if unknown
};

/// One scan in memory.
struct Scan {
  std::vector<Eigen::Vector3d> points;        ///< n [m], sensor frame, NaN for beams without a return
  Pose pose;                                  ///< sensor frame to map frame, unit quaternion
  int columns = 0;                            ///< points per row of an organised cloud; 0: not organised
  std::optional<double> time = std::nullopt;  ///< time of the scan [s]; std::nullopt if unknown
};

/// Returns true if a point [m, sensor frame] is a measurement: it is finite and does not lie at the sensor itself.
/// Some drivers write points at the sensor for "no return".
inline bool isReturn(const Eigen::Vector3d& point) {
  return point.allFinite() && !point.isZero(0.0);
}

/// Counts the accepted and the dropped points of scans. The other counts add up to `read`.
struct GAUSSMAP_API PointCounts {
  std::int64_t read = 0;          ///< all points
  std::int64_t accepted = 0;      ///< points that were used
  std::int64_t non_finite = 0;    ///< dropped: a coordinate is NaN or infinite
  std::int64_t at_sensor = 0;     ///< dropped: range 0, see isReturn()
  std::int64_t beyond_range = 0;  ///< dropped: farther from the sensor than max_range
  std::int64_t too_near = 0;      ///< dropped: nearer to the sensor than min_range
  std::int64_t outside = 0;       ///< dropped: outside the box to which the scans are cropped

  /// Adds the counts of other points.
  PointCounts& operator+=(const PointCounts& other);
};

/// Reads the points of one scan, block by block. All functions are thread-safe.
class GAUSSMAP_API ScanReader {
 public:
  virtual ~ScanReader() = default;

  /// Returns the number of points, including the invalid points of an organised cloud.
  virtual std::size_t size() const = 0;
  /// Returns the number of points per row of an organised cloud, or 0 if the cloud is not organised.
  virtual int columns() const { return 0; }
  /// Fills `block` with the points `first`, `first` + 1 and so on, until the block is full or the scan ends.
  ///
  /// The points [m] are in the frame of Scans::frame(). NaN and infinite values are kept. The block is empty if `first`
  /// is not less than size(). Throws FileError if the data are damaged.
  virtual void read(std::size_t first, PointBlock<3>& block) const = 0;
  /// Throws FileError if the file was truncated while it was read. Call this function after the last read().
  virtual void requireWhole() const {}

  /// Returns the names of the additional values of each point, for example "intensity". The list can be empty.
  virtual std::vector<std::string> valueNames() const { return {}; }
  /// Returns the value `name` of all points, size() numbers. Throws std::out_of_range if no value has this name.
  virtual std::vector<double> values(const std::string& name) const;
};

/// A list of scans with poses: the interface through which the library takes scans.
///
/// Building, online mapping, removal of moving points and evaluation all use this interface. FileScans holds files,
/// MemoryScans holds scans in memory, and a program can add its own implementation.
/// All functions are thread-safe, because the library reads scans in parallel.
class GAUSSMAP_API Scans {
 public:
  virtual ~Scans() = default;

  /// Returns the number of scans.
  virtual std::size_t size() const = 0;
  /// Returns the name, pose and time of a scan. Throws std::out_of_range if `index` is not less than size().
  virtual ScanInfo info(std::size_t index) const = 0;
  /// Returns the frame of the points of all scans.
  virtual ScanFrame frame() const { return ScanFrame::Sensor; }
  /// Returns a reader of the points of a scan. Throws std::out_of_range if `index` is not less than size(), and
  /// FileError if a file cannot be read.
  virtual std::unique_ptr<ScanReader> open(std::size_t index) const = 0;

  /// Returns a whole scan, always in the sensor frame, even if frame() is ScanFrame::Map.
  /// Throws like open() and ScanReader::read(), and FileError if the file was truncated.
  Scan read(std::size_t index) const;
};

/// Holds scans in memory, for a program that does not read them from files.
class GAUSSMAP_API MemoryScans : public Scans {
 public:
  /// Makes an empty list. `frame` is the frame of the points of all scans.
  explicit MemoryScans(ScanFrame frame = ScanFrame::Sensor) : frame_(frame) {}
  /// Makes a list of the given scans. Throws like add().
  explicit MemoryScans(std::vector<Scan> scans, ScanFrame frame = ScanFrame::Sensor);

  /// Adds a scan. Throws std::invalid_argument if the pose has a fault; the message gives the fault (see poseFault()).
  void add(Scan scan);
  /// Adds a scan from floats and copies them. Throws like the other add().
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
