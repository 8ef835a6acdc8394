// SPDX-License-Identifier: BSD-3-Clause
#include "io/formats/kind_of_start.h"

#include <algorithm>

namespace gaussmap::detail {
namespace {

using namespace std::string_view_literals;

struct Signature {
  std::string_view bytes;
  const char* kind;
};

constexpr Signature kSignatures[] = {
    {"ply\n"sv, "a PLY file"},
    {"ply\r"sv, "a PLY file"},
    {"# .PCD"sv, "a PCD file"},
    {"VERSION "sv, "a PCD file"},
    {"FIELDS "sv, "a PCD file"},
    {"LASF"sv, "a LAS or LAZ file"},
    {"ASTM-E57"sv, "an E57 file"},
    {"\x89MCAP"sv, "an MCAP file"},
    {"#ROSBAG"sv, "a ROS bag"},
    {"SQLite format 3"sv, "an SQLite file"},
    {"\x1F\x8B"sv, "a gzip file, expand it with gunzip"},
    {"BZh"sv, "a bzip2 file, expand it with bunzip2"},
    {"\xFD"
     "7zXZ"sv,
     "an xz file, expand it with unxz"},
    {"7z\xBC\xAF"sv, "a 7z file, expand it with 7z x"},
    {"PK\x03\x04"sv, "a zip file, expand it with unzip"},
    {"\x28\xB5\x2F\xFD"sv, "a zstd file, expand it with unzstd"},
    {"\xD4\xC3\xB2\xA1"sv, "a recording of network packets (pcap), convert it with the driver of the lidar"},
    {"\x0A\x0D\x0D\x0A"sv, "a recording of network packets (pcapng), convert it with the driver of the lidar"},
    {"\x93NUMPY"sv, "a file of numpy; save the array with tofile()"},
    {"\x89HDF"sv, "an HDF5 file"},
    {"\x89PNG"sv, "a PNG picture"},
    {"\xFF\xD8\xFF"sv, "a JPEG picture"},
    {"glTF"sv, "a glTF model"},
    {"\x7F"
     "ELF"sv,
     "a program"},
    {"%PDF"sv, "a PDF document"}};

}  // namespace

std::string kindOfStart(std::string_view start) {
  for (const Signature& signature : kSignatures)
    if (start.substr(0, signature.bytes.size()) == signature.bytes) return signature.kind;
  return "";
}

bool looksLikeText(std::string_view start) {
  constexpr std::size_t kLooked = 4096;
  start = start.substr(0, kLooked);
  return std::all_of(start.begin(), start.end(),
                     [](char c) { return (c >= ' ' && c <= '~') || c == '\t' || c == '\r' || c == '\n'; });
}

}  // namespace gaussmap::detail
