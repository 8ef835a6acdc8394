// SPDX-License-Identifier: BSD-3-Clause
// Writes the files of this folder with libE57Format (https://github.com/asmaloney/libE57Format, commit 21c2943, Boost
// licence), which is independent of gaussmap, and prints E57 files as text with the same library. See make.sh.
//
//   make write FOLDER          the small files
//   make large FILE POINTS     a file with scaled integers, for measurements
//   make text FILE             every number of every scan
//   make time FILE             the time for reading x, y and z
#include <E57Format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace {

constexpr std::int64_t kMin64 = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t kMax64 = std::numeric_limits<std::int64_t>::max();

/// One field: integer(i) is stored, or real(i) if the function is set.
struct Column {
  std::string name;
  std::function<std::int64_t(std::int64_t)> integer;
  std::int64_t minimum = 0, maximum = 0;
  double scale = 0.0, offset = 0.0;  // scale 0: Integer, else ScaledInteger
  std::function<double(std::int64_t)> real = nullptr;
  e57::FloatPrecision precision = e57::PrecisionDouble;
};

Column real(const std::string& name, std::function<double(std::int64_t)> value, e57::FloatPrecision precision) {
  Column column;
  column.name = name;
  column.real = std::move(value);
  column.precision = precision;
  return column;
}

std::uint64_t hash(std::int64_t i) {
  std::uint64_t x = static_cast<std::uint64_t>(i) + 0x9E3779B97F4A7C15u;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
  return x ^ (x >> 31);
}

class Writer {
 public:
  explicit Writer(const std::string& path) : file_(path, "w"), root_(file_.root()), scans_(file_, true) {
    file_.extensionsAdd("", e57::VERSION_1_0_URI);
    file_.extensionsAdd("nor", "http://www.libe57.org/E57_EXT_surface_normals.txt");
    root_.set("formatName", e57::StringNode(file_, "ASTM E57 3D Imaging Data File"));
    root_.set("guid", e57::StringNode(file_, "{00000000-0000-0000-0000-000000000000}"));
    root_.set("versionMajor", e57::IntegerNode(file_, 1));
    root_.set("versionMinor", e57::IntegerNode(file_, 0));
    root_.set("coordinateMetadata", e57::StringNode(file_, "LOCAL_CS[\"site & <yard>\"]"));
    root_.set("data3D", scans_);
    root_.set("images2D", e57::VectorNode(file_, true));
  }
  ~Writer() { file_.close(); }

  e57::StructureNode addScan(const std::string& name) {
    e57::StructureNode scan(file_);
    scans_.append(scan);
    scan.set("guid", e57::StringNode(file_, "{guid of " + std::to_string(scans_.childCount()) + "}"));
    if (!name.empty()) scan.set("name", e57::StringNode(file_, name));
    return scan;
  }

  void setPose(e57::StructureNode scan, const std::vector<double>& t, const std::vector<double>& wxyz) {
    e57::StructureNode pose(file_), rotation(file_), translation(file_);
    scan.set("pose", pose);
    const char* const names[] = {"w", "x", "y", "z"};
    for (int i = 0; i < 4; ++i) rotation.set(names[i], e57::FloatNode(file_, wxyz[i]));
    for (int i = 0; i < 3; ++i) translation.set(names[i + 1], e57::FloatNode(file_, t[i]));
    pose.set("rotation", rotation);
    pose.set("translation", translation);
  }

  void setStart(e57::StructureNode scan, double gps) {
    e57::StructureNode start(file_);
    start.set("dateTimeValue", e57::FloatNode(file_, gps));
    start.set("isAtomicClockReferenced", e57::IntegerNode(file_, 1));
    scan.set("acquisitionStart", start);
  }

  void setColourLimits(e57::StructureNode scan, double maximum) {
    e57::StructureNode limits(file_);
    for (const char* const name : {"colorRed", "colorGreen", "colorBlue"}) {
      limits.set(std::string(name) + "Minimum", e57::FloatNode(file_, 0.0));
      limits.set(std::string(name) + "Maximum", e57::FloatNode(file_, maximum));
    }
    scan.set("colorLimits", limits);
  }

  /// Writes the points in pieces.
  void setPoints(e57::StructureNode scan, const std::vector<Column>& columns, std::size_t count,
                 bool with_text = false) {
    constexpr std::size_t kPiece = 4096;
    e57::StructureNode prototype(file_);
    std::vector<std::vector<std::int64_t>> integers(columns.size(), std::vector<std::int64_t>(kPiece));
    std::vector<std::vector<double>> reals(columns.size(), std::vector<double>(kPiece));
    std::vector<e57::ustring> text(kPiece, "text");
    for (const Column& column : columns) {
      if (column.real)
        prototype.set(column.name, e57::FloatNode(file_, 0.0, column.precision));
      else if (column.scale != 0.0)
        prototype.set(column.name, e57::ScaledIntegerNode(file_, column.minimum, column.minimum, column.maximum,
                                                          column.scale, column.offset));
      else
        prototype.set(column.name, e57::IntegerNode(file_, column.minimum, column.minimum, column.maximum));
    }
    if (with_text) prototype.set("nor:text", e57::StringNode(file_));
    e57::VectorNode codecs(file_, true);
    e57::CompressedVectorNode points(file_, prototype, codecs);
    scan.set("points", points);
    std::vector<e57::SourceDestBuffer> buffers;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (columns[i].real)
        buffers.emplace_back(file_, columns[i].name, reals[i].data(), kPiece, true);
      else
        buffers.emplace_back(file_, columns[i].name, integers[i].data(), kPiece, true, false);
    }
    if (with_text) buffers.emplace_back(file_, "nor:text", &text);
    e57::CompressedVectorWriter writer = points.writer(buffers);
    for (std::size_t first = 0; first < count; first += kPiece) {
      const std::size_t piece = std::min(kPiece, count - first);
      for (std::size_t i = 0; i < columns.size(); ++i)
        for (std::size_t k = 0; k < piece; ++k) {
          const auto point = static_cast<std::int64_t>(first + k);
          if (columns[i].real)
            reals[i][k] = columns[i].real(point);
          else
            integers[i][k] = columns[i].integer(point);
        }
      writer.write(piece);
    }
    writer.close();
  }

 private:
  e57::ImageFile file_;
  e57::StructureNode root_;
  e57::VectorNode scans_;
};

/// Integers of n bits: the largest value, the smallest, then random ones.
Column bits(const std::string& name, unsigned n, std::int64_t minimum) {
  const std::uint64_t range = ~std::uint64_t{0} >> (64 - n);
  const auto start = static_cast<std::uint64_t>(minimum);
  return {name,
          [=](std::int64_t i) {
            const std::uint64_t stored = i == 0 ? range : i == 1 ? 0 : hash(i + n) & range;
            return static_cast<std::int64_t>(start + stored);
          },
          minimum, static_cast<std::int64_t>(start + range)};
}

/// Three scans: scaled integers with colours and rows; spherical singles; doubles with an extension.
void writeScans(const std::string& path) {
  Writer writer(path);
  e57::StructureNode scan = writer.addScan("Halle Süd");
  writer.setPose(scan, {100.25, -20.5, 3.125}, {0.5, 0.5, -0.5, 0.5});
  writer.setStart(scan, 1234567890.25);
  writer.setColourLimits(scan, 255);
  writer.setPoints(
      scan,
      {{"cartesianX", [](std::int64_t i) { return 1000 * i - 50000; }, -100000, 1000000, 0.001, 0.0},
       {"cartesianY", [](std::int64_t i) { return 70000 - 3 * i * i; }, -524288, 524287, 0.001, 10.0},
       {"cartesianZ", [](std::int64_t i) { return i % 7 - 3; }, -3, 3, 0.25, -1.5},
       {"cartesianInvalidState", [](std::int64_t i) { return i % 11 == 5   ? 2
                                                             : i % 11 == 7 ? 1
                                                                           : 0; }, 0, 2},
       {"intensity", [](std::int64_t i) { return i * 37 % 4096; }, 0, 4095},
       {"colorRed", [](std::int64_t i) { return i; }, 0, 255},
       {"colorGreen", [](std::int64_t i) { return 255 - i; }, 0, 255},
       {"colorBlue", [](std::int64_t i) { return i * i % 256; }, 0, 255},
       {"rowIndex", [](std::int64_t i) { return i / 10; }, 0, 9},
       {"columnIndex", [](std::int64_t i) { return i % 10; }, 0, 9},
       real(
           "timeStamp", [](std::int64_t i) { return 1e-5 * static_cast<double>(i); }, e57::PrecisionDouble),
       {"isTimeStampInvalid", [](std::int64_t i) { return i % 5 == 4; }, 0, 1}},
      100);

  scan = writer.addScan("");
  writer.setPose(scan, {0, 0, 2}, {std::sqrt(0.5), 0, 0, std::sqrt(0.5)});
  const auto degrees = [](double a) { return a * 3.14159265358979323846 / 180; };
  writer.setPoints(
      scan,
      {real(
           "sphericalRange", [](std::int64_t i) { return 1.5 + 0.25 * static_cast<double>(i); }, e57::PrecisionSingle),
       real(
           "sphericalAzimuth", [=](std::int64_t i) { return degrees(7.0 * static_cast<double>(i) - 170); },
           e57::PrecisionSingle),
       real(
           "sphericalElevation", [=](std::int64_t i) { return degrees(3.0 * static_cast<double>(i) - 80); },
           e57::PrecisionDouble),
       {"sphericalInvalidState", [](std::int64_t i) { return i % 9 == 0 ? 2 : 0; }, 0, 2},
       real(
           "intensity", [](std::int64_t i) { return 1.0 / static_cast<double>(i + 1); }, e57::PrecisionSingle),
       {"isIntensityInvalid", [](std::int64_t i) { return i == 3; }, 0, 1},
       {"colorRed", [](std::int64_t i) { return 65535 - 257 * i; }, 0, 65535},
       {"colorGreen", [](std::int64_t i) { return 1000 * i; }, 0, 65535},
       {"colorBlue", [](std::int64_t) { return 0; }, 0, 65535},
       {"returnIndex", [](std::int64_t i) { return i % 3; }, 0, 2}},
      50);

  scan = writer.addScan("no pose");
  writer.setPoints(
      scan,
      {real(
           "cartesianX", [](std::int64_t i) { return 4e6 + 1e-9 * static_cast<double>(i); }, e57::PrecisionDouble),
       real(
           "cartesianY", [](std::int64_t i) { return -1.0 / 3 * static_cast<double>(i); }, e57::PrecisionDouble),
       real(
           "cartesianZ", [](std::int64_t i) { return std::sqrt(static_cast<double>(i)); }, e57::PrecisionSingle),
       real(
           "nor:normalX", [](std::int64_t i) { return std::cos(static_cast<double>(i)); }, e57::PrecisionSingle),
       real(
           "nor:normalY", [](std::int64_t i) { return std::sin(static_cast<double>(i)); }, e57::PrecisionSingle),
       {"nor:normalZ", [](std::int64_t) { return 0; }, 0, 0}},
      30);
}

/// Points with a text each, between two numbers.
void writeStrings(const std::string& path) {
  Writer writer(path);
  e57::StructureNode scan = writer.addScan("strings");
  writer.setPoints(scan, {bits("cartesianX", 3, 0), bits("cartesianY", 11, -7), bits("cartesianZ", 30, 5)}, 600, true);
}

/// Integers of all widths.
void writeWidths(const std::string& path) {
  Writer writer(path);
  e57::StructureNode scan = writer.addScan("widths");
  std::vector<Column> columns = {{"cartesianX", [](std::int64_t) { return 7; }, 7, 7, 0.5, 0.25},
                                 {"cartesianY", [](std::int64_t) { return -3; }, -3, -3},
                                 bits("cartesianZ", 20, -1000)};
  for (unsigned n = 1; n <= 64; ++n)
    columns.push_back(bits("nor:b" + std::to_string(n), n, n == 64 ? kMin64 : n > 60 ? kMin64 + 1000 : -5));
  writer.setPoints(scan, columns, 13);
}

void writeLarge(const std::string& path, std::size_t count) {
  Writer writer(path);
  e57::StructureNode scan = writer.addScan("large");
  const auto random = [](std::int64_t seed, std::uint64_t below) {
    return [=](std::int64_t i) { return static_cast<std::int64_t>(hash(3 * i + seed) % below); };
  };
  writer.setPoints(scan,
                   {{"cartesianX", random(0, 2000000), 0, 1999999, 0.0001, -100.0},
                    {"cartesianY", random(1, 3000000), 0, 2999999, 0.0001, -150.0},
                    {"cartesianZ", random(2, 500000), 0, 499999, 0.0001, -25.0},
                    {"intensity", random(5, 4096), 0, 4095},
                    {"colorRed", random(7, 256), 0, 255},
                    {"colorGreen", random(8, 256), 0, 255},
                    {"colorBlue", random(9, 256), 0, 255}},
                   count);
}

void printPose(const e57::StructureNode& scan) {
  if (!scan.isDefined("pose")) {
    std::printf("pose none\n");
    return;
  }
  std::printf("pose");
  for (const char* const name :
       {"translation/x", "translation/y", "translation/z", "rotation/w", "rotation/x", "rotation/y", "rotation/z"})
    std::printf(" %.17g", e57::FloatNode(scan.get(std::string("pose/") + name)).value());
  std::printf("\n");
}

/// Reads all numbers as doubles. Strings are left out.
void readScans(const std::string& path, bool is_timed) {
  e57::ImageFile file(path, "r");
  const e57::VectorNode scans(file.root().get("data3D"));
  for (std::int64_t s = 0; s < scans.childCount(); ++s) {
    const e57::StructureNode scan(scans.get(s));
    e57::CompressedVectorNode points(scan.get("points"));
    const e57::StructureNode prototype(points.prototype());
    const auto count = static_cast<std::size_t>(points.childCount());
    std::vector<std::string> names;
    for (std::int64_t f = 0; f < prototype.childCount(); ++f)
      if (prototype.get(f).type() != e57::TypeString &&
          (!is_timed || prototype.get(f).elementName().rfind("cartesian", 0) == 0))
        names.push_back(prototype.get(f).elementName());
    if (!is_timed) {
      std::printf("scan %d points %zu\n", static_cast<int>(s), count);
      printPose(scan);
      std::printf("fields");
      for (const std::string& name : names) std::printf(" %s", name.c_str());
      std::printf("\n");
    }
    if (count == 0) continue;
    const auto start = std::chrono::steady_clock::now();
    constexpr std::size_t kPiece = 65536;
    std::vector<std::vector<double>> values(names.size(), std::vector<double>(kPiece));
    std::vector<e57::SourceDestBuffer> buffers;
    for (std::size_t f = 0; f < names.size(); ++f)
      buffers.emplace_back(file, names[f], values[f].data(), kPiece, true, true);
    e57::CompressedVectorReader reader = points.reader(buffers);
    double sum = 0.0;
    while (const unsigned read = reader.read())
      for (unsigned i = 0; i < read; ++i)
        for (std::size_t f = 0; f < names.size(); ++f)
          if (is_timed)
            sum += values[f][i];
          else
            std::printf("%.17g%c", values[f][i], f + 1 == names.size() ? '\n' : ' ');
    reader.close();
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (is_timed)
      std::printf("%.17g %.3f s, %.1f M points/s\n", sum, seconds, static_cast<double>(count) / seconds / 1e6);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string mode = argc > 2 ? argv[1] : "", path = argc > 2 ? argv[2] : "";
  try {
    if (mode == "write") {
      writeScans(path + "/scans.e57");
      writeWidths(path + "/widths.e57");
      writeStrings(path + "/strings.e57");
    } else if (mode == "large" && argc > 3) {
      writeLarge(path, static_cast<std::size_t>(std::atoll(argv[3])));
    } else if (mode == "text" || mode == "time") {
      readScans(path, mode == "time");
    } else {
      return 2;
    }
  } catch (const e57::E57Exception& error) {
    std::fprintf(stderr, "%s: %s\n", error.what(), error.context().c_str());
    return 1;
  }
  return 0;
}
