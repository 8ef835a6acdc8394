// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gaussmap/core/error.h"
#include "gaussmap/core/scans.h"
#include "gaussmap/io/pcd/pcd_reader.h"
#include "gaussmap/io/scans/pose_file.h"
#include "gaussmap/version.h"

namespace gaussmap {

struct FindScansOptions;
struct FoundScans;

namespace detail {
class CoordinateSamples;
class KeptReaders;
class ScanFiles;
}  // namespace detail

/// A scan in a file, and the pose of its sensor.
struct FileScan {
  std::filesystem::path path;                 ///< the file
  Pose pose;                                  ///< sensor frame to map frame, unit quaternion
  std::optional<double> time = std::nullopt;  ///< time of the scan [s]; std::nullopt if unknown
  std::size_t index = 0;                      ///< of the scan in a file with several scans
  std::string name = "";                      ///< of the scan in a file with several scans, for messages
  /// False: the points are in the map frame, and the file does not say where the sensor was, as in LAS files.
  bool has_sensor_position = true;
};

/// Options for recordings of ROS: MCAP files, databases of rosbag2, and bags of ROS 1.
struct RecordingOptions {
  std::string topic;       ///< with the scans; empty: the only topic of type PointCloud2, else of LaserScan
  std::string poses;       ///< where poses come from: "tf", or a topic such as "/odom"; empty: see findScans()
  std::string pose_frame;  ///< frame whose poses are given; empty: child_frame_id of the topic, else that of the scans
  /// Frame that becomes the map frame. Empty: for poses from tf, map, else odom; for poses from a topic, its frame_id.
  std::string fixed_frame;
  bool log_times = false;  ///< true: uses the times of recording, not those in the headers of the messages
};

/// Settings for files whose content does not say everything: names of columns, topics and frames.
struct FileOptions {
  /// Names of the columns of a text file, or of the fields of raw records such as .bin files: "x y z intensity". "-"
  /// skips a column; "x:mm" and "time:ns" give units, "ring:u16" gives the type in a record. Empty: found from the
  /// content.
  std::string fields;
  RecordingOptions recording;  ///< for recordings
};

/// Scans in files of any kind that gaussmap reads. The kind of a file follows from its content.
///
/// Each file is opened once. The points of a file that must be parsed or decompressed stay in memory only as long as
/// their reader exists. The pages of other files are released when about a million more points were read. So memory
/// depends on the largest scan, not on the number of scans. The values of the points are the other fields of the file,
/// for example "intensity". Elements of fields with several numbers have an index: "normal[2]".
class GAUSSMAP_API FileScans : public Scans {
 public:
  /// Opens the files and checks their headers. Poses in the files are not used. Throws FileError if a file is not
  /// usable or has no scan with this index, and std::invalid_argument if options.fields is not valid.
  explicit FileScans(std::vector<FileScan> scans, ScanFrame frame = ScanFrame::Sensor, const FileOptions& options = {});
  ~FileScans() override;
  FileScans(FileScans&&) noexcept;
  FileScans& operator=(FileScans&&) noexcept;

  std::size_t size() const override { return scans_.size(); }
  ScanInfo info(std::size_t index) const override;
  ScanFrame frame() const override { return frame_; }
  std::unique_ptr<ScanReader> open(std::size_t index) const override;

  /// Returns the list of scans.
  const std::vector<FileScan>& files() const { return scans_; }
  /// Returns the kind of the file of a scan, for messages: "PCD binary", "LAS 1.2, point format 3". Throws like open().
  std::string kind(std::size_t index) const;
  /// Returns the coordinate reference system of the file of a scan, as text (often WKT); empty if the file has none.
  /// Throws like open().
  std::string coordinateSystem(std::size_t index) const;
  /// Returns a reader of the file of a scan if it is a PCD file, for access to its header, records and columns;
  /// std::nullopt for other files. Throws like open().
  std::optional<PcdReader> pcd(std::size_t index) const;

  /// From now on, keeps the readers of opened scans that hold their points in memory, until the scans are opened again.
  /// All kept points together take at most `bytes`; 0 = stop. A program that looks at some scans before it reads all of
  /// them then parses or decompresses these scans only once.
  void keepForNextOpen(std::size_t bytes);

  /// Returns warnings about the coordinates of the points that were read so far: floats that are too coarse for cells
  /// of this side [m], and coordinates that look like millimetres. Call it after the scans have been read.
  std::vector<std::string> coordinateWarnings(double resolution) const;
  /// Returns up to about a thousand of the points of a scan that were read so far [m, map frame].
  std::vector<Eigen::Vector3d> sample(std::size_t index) const;

 private:
  friend FoundScans findScans(const std::vector<std::filesystem::path>&, const FindScansOptions&);
  FileScans(std::vector<FileScan> scans, ScanFrame frame, std::shared_ptr<detail::ScanFiles> files);

  std::vector<FileScan> scans_;
  std::vector<std::size_t> file_of_;  // per scan: the number of its file in files_
  std::shared_ptr<detail::ScanFiles> files_;
  ScanFrame frame_;
  std::shared_ptr<detail::CoordinateSamples> samples_;  // of the points that were read
  std::shared_ptr<detail::KeptReaders> kept_;
};

/// Returns the files of a list of inputs, in the order of the inputs.
///
/// A file is listed unchanged, and so is the folder of a recording (with metadata.yaml, or with nothing but .mcap, .db3
/// or .bag files). Another directory is replaced by its *.pcd and *.pcd.gz files, in natural order; if it has no such
/// file, by the files of another kind (.bin .ply .las .laz .e57 .pts .ptx .xyz .mcap .db3 .bag). The search is not
/// recursive, ignores case, and skips hidden files. Throws FileError if an input does not exist, or if a directory has
/// no such file or has files of several kinds, but no PCD file.
GAUSSMAP_API std::vector<std::filesystem::path> listScans(const std::vector<std::filesystem::path>& inputs);

/// The pose of the sensor in the frame that the poses describe, for example of a lidar on a vehicle.
struct Extrinsic {
  Pose pose;                   ///< sensor frame to the frame that the poses describe
  bool turns_map = false;      ///< true: the map frame is turned as well, pose^-1 * T * pose, as usual for KITTI
  std::filesystem::path file;  ///< where it comes from; can be empty
};

/// Reads an extrinsic: a pose (x y z qx qy qz qw), a 3 x 4 or 4 x 4 matrix, the matrix T_BS of a sensor.yaml (EuRoC),
/// the line Tr of a calib.txt (KITTI), or the lines R and T of calib_velo_to_cam.txt or calib_imu_to_velo.txt (KITTI
/// raw; the name decides between them, because the lidar is the sensor of both). Throws FileError if the file has none
/// of them.
GAUSSMAP_API Extrinsic readExtrinsic(const std::filesystem::path& file);

/// Options of findScans().
struct FindScansOptions {
  std::filesystem::path poses;                              ///< pose file; empty: the poses in the files
  PoseFormat pose_format = PoseFormat::Automatic;           ///< kind of the pose file
  std::string pose_columns;                                 ///< names of its columns, for PoseFormat::Table
  PoseMatching matching;                                    ///< how poses and scans are matched
  PoseConvention convention = PoseConvention::SensorToMap;  ///< what the poses mean
  bool skip_without_pose = false;  ///< leaves out the scans without a pose; false: they are an error
  std::optional<Extrinsic> extrinsic =
      std::nullopt;                     ///< std::nullopt: calib.txt beside a KITTI pose file, if it exists
  ScanFrame frame = ScanFrame::Sensor;  ///< frame of the points in the files
  FileOptions files;                    ///< names of columns, topics and frames
};

/// Scans with poses, and what was found out about them.
struct FoundScans {
  FileScans scans;                        ///< the scans
  std::vector<std::string> warnings;      ///< one or two sentences each, with file names and what to do
  std::string poses;                      ///< where the poses come from and how they were matched, one sentence
  std::vector<std::string> without_pose;  ///< the scans that were left out, with the reason
  std::vector<Pose> poses_as_read;        ///< per scan: the pose as read, before convention and extrinsic
  Pose extrinsic;                         ///< the extrinsic that was applied; the identity without one
};

/// Lists the scans (see listScans()), assigns the poses, and checks them.
///
/// If the options name a pose file, the poses come from it (see readPoseFile() and matchPoses()). Otherwise they are
/// those in the files:
/// - PCD: VIEWPOINT. E57 and PTX: the pose of each scan.
/// - Recordings: the pose of the sensor frame in the fixed frame at the time of the scan. It comes from tf if a moving
///   transform connects the frames, else from the only topic of odometry. Transforms are interpolated between
///   neighbours at most 1 s apart, and poses of a topic between neighbours at most twice the interval of the scans
///   apart. If PoseMatching::max_time_gap is set, neighbours may also be up to twice this gap apart, and else the
///   nearest transform or pose counts if it is at most this gap away.
/// - LAS and LAZ: none, because the points are in the map frame. Other files: the sensor is at the origin.
///
/// There is a warning if a scan is listed twice. Throws FileError if a file cannot be read or is a map, if a scan has
/// no pose, or if a pose is not usable. Throws std::invalid_argument if options.files.fields is not valid.
GAUSSMAP_API FoundScans findScans(const std::vector<std::filesystem::path>& inputs,
                                  const FindScansOptions& options = {});
/// The same with a pose file and the defaults of the other options.
GAUSSMAP_API FoundScans findScans(const std::vector<std::filesystem::path>& inputs, const std::filesystem::path& poses);

}  // namespace gaussmap
