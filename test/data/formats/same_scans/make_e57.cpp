// SPDX-License-Identifier: BSD-3-Clause
// Writes raw scans (float32 x y z intensity) into one E57 file with libE57Format. See make.py.
//
//   make_e57 LIST FILE     LIST has one line per scan: file x y z qw qx qy qz
#include <E57Format.h>

#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace {

const std::vector<std::string> kFields = {"cartesianX", "cartesianY", "cartesianZ", "intensity"};

std::vector<std::vector<float>> readColumns(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<std::vector<float>> columns(kFields.size());
  float record[4];
  while (file.read(reinterpret_cast<char*>(record), sizeof record))
    for (std::size_t i = 0; i < columns.size(); ++i) columns[i].push_back(record[i]);
  return columns;
}

void addScan(e57::ImageFile& file, e57::VectorNode& scans, const std::string& line) {
  std::istringstream words(line);
  std::string path;
  double t[3], q[4];
  words >> path >> t[0] >> t[1] >> t[2] >> q[0] >> q[1] >> q[2] >> q[3];
  std::vector<std::vector<float>> columns = readColumns(path);
  const std::string number = std::to_string(scans.childCount());

  e57::StructureNode scan(file), pose(file), rotation(file), translation(file), prototype(file);
  scans.append(scan);
  scan.set("guid", e57::StringNode(file, "{scan " + number + "}"));
  scan.set("name", e57::StringNode(file, "scan " + number));
  const char* const names[] = {"w", "x", "y", "z"};
  for (int i = 0; i < 4; ++i) rotation.set(names[i], e57::FloatNode(file, q[i]));
  for (int i = 0; i < 3; ++i) translation.set(names[i + 1], e57::FloatNode(file, t[i]));
  pose.set("rotation", rotation);
  pose.set("translation", translation);
  scan.set("pose", pose);

  std::vector<e57::SourceDestBuffer> buffers;
  for (std::size_t i = 0; i < kFields.size(); ++i) {
    prototype.set(kFields[i], e57::FloatNode(file, 0.0, e57::PrecisionSingle));
    buffers.emplace_back(file, kFields[i], columns[i].data(), columns[i].size());
  }
  e57::VectorNode codecs(file, true);
  e57::CompressedVectorNode points(file, prototype, codecs);
  scan.set("points", points);
  e57::CompressedVectorWriter writer = points.writer(buffers);
  writer.write(columns[0].size());
  writer.close();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  try {
    e57::ImageFile file(argv[2], "w");
    e57::StructureNode root = file.root();
    file.extensionsAdd("", e57::VERSION_1_0_URI);
    root.set("formatName", e57::StringNode(file, "ASTM E57 3D Imaging Data File"));
    root.set("guid", e57::StringNode(file, "{00000000-0000-0000-0000-000000000000}"));
    root.set("versionMajor", e57::IntegerNode(file, 1));
    root.set("versionMinor", e57::IntegerNode(file, 0));
    e57::VectorNode scans(file, true);
    root.set("data3D", scans);
    root.set("images2D", e57::VectorNode(file, true));
    std::ifstream list(argv[1]);
    for (std::string line; std::getline(list, line);) addScan(file, scans, line);
    file.close();
  } catch (const e57::E57Exception& error) {
    std::fprintf(stderr, "%s: %s\n", error.what(), error.context().c_str());
    return 1;
  }
  return 0;
}
