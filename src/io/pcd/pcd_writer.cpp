// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/pcd/pcd_writer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <locale>
#include <set>
#include <sstream>
#include <stdexcept>

#include "io/files/atomic_file.h"
#include "io/pcd/pcd_fields.h"

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "binary PCD is little-endian");

namespace gaussmap {
using namespace detail;

namespace {

constexpr std::size_t kBytesAtOnce = std::size_t{1} << 20;
constexpr std::size_t kMaxPoints = 0xFFFFFFFFu;  // readers such as PCL store WIDTH in 32 bits

std::string header(std::size_t width, std::size_t height, const std::vector<PcdOutput>& fields, const Pose& viewpoint) {
  std::ostringstream text;
  text.imbue(std::locale::classic());  // a decimal comma would make the file unreadable
  text.precision(std::numeric_limits<double>::max_digits10);
  text << "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS";
  for (const PcdOutput& field : fields) text << ' ' << field.name;
  text << "\nSIZE";
  for (const PcdOutput& field : fields) text << ' ' << field.size;
  text << "\nTYPE";
  for (const PcdOutput& field : fields) text << ' ' << field.type;
  text << "\nCOUNT";
  for (const PcdOutput& field : fields) text << ' ' << field.count;
  const Eigen::Vector3d& t = viewpoint.translation;
  const Pose::Rotation& q = viewpoint.rotation;
  text << "\nWIDTH " << width << "\nHEIGHT " << height << "\nVIEWPOINT " << t.x() << ' ' << t.y() << ' ' << t.z() << ' '
       << q.w() << ' ' << q.x() << ' ' << q.y() << ' ' << q.z() << "\nPOINTS " << width * height << "\nDATA binary\n";
  return text.str();
}

}  // namespace

void detail::checkEachField(const std::vector<PcdOutput>& fields) {
  if (fields.empty()) throw std::invalid_argument("a PCD file needs at least one field");
  for (const PcdOutput& field : fields) {
    const auto printable = [](char c) { return c > ' ' && c < '\x7F'; };
    if (field.name.empty() || !std::all_of(field.name.begin(), field.name.end(), printable))
      throw std::invalid_argument("PCD field '" + field.name + "': the name must be one word");
    const bool wide = field.size == 4 || field.size == 8, narrow = field.size == 1 || field.size == 2;
    const bool integer = field.type == 'I' || field.type == 'U';
    if (!(field.type == 'F' && wide) && !(integer && (wide || narrow)))
      throw std::invalid_argument("PCD field '" + field.name + "': " + std::string(1, field.type) +
                                  std::to_string(field.size) + " is not a type of PCD");
    if (field.count == 0) throw std::invalid_argument("PCD field '" + field.name + "': count is 0");
  }
}

void checkPcdFields(const std::vector<PcdOutput>& fields) {
  checkEachField(fields);
  std::set<std::string> names;
  for (const PcdOutput& field : fields)
    if (!names.insert(field.name).second) throw std::invalid_argument("PCD field '" + field.name + "' occurs twice");
}

void writePcd(const std::filesystem::path& path, std::size_t points, const std::vector<PcdOutput>& fields,
              const std::optional<Pose>& viewpoint, std::size_t width) {
  checkPcdFields(fields);
  writeFields(path, points, fields, viewpoint, width);
}

void detail::writeFields(const std::filesystem::path& path, std::size_t points, const std::vector<PcdOutput>& fields,
                         const std::optional<Pose>& viewpoint, std::size_t width) {
  checkEachField(fields);
  for (const PcdOutput& field : fields)
    if (!field.data && points > 0) throw std::invalid_argument("PCD field '" + field.name + "' has no data");
  if (points > kMaxPoints) throw std::invalid_argument("a PCD file holds at most 2^32 - 1 points");
  if (width > 0 && points % width != 0)
    throw std::invalid_argument(std::to_string(points) + " points do not fill rows of " + std::to_string(width));
  const Pose pose = viewpoint.value_or(Pose());
  if (const std::string fault = poseFault(pose); !fault.empty()) throw std::invalid_argument("PCD viewpoint: " + fault);

  AtomicFile file(path);
  const std::string text = width > 0 ? header(width, points / width, fields, pose) : header(points, 1, fields, pose);
  file.write(text.data(), text.size());

  std::size_t record = 0;
  for (const PcdOutput& field : fields) record += field.size * field.count;
  const std::size_t points_at_once = std::max<std::size_t>(1, kBytesAtOnce / record);
  std::vector<char> buffer(std::min(points, points_at_once) * record);
  for (std::size_t first = 0; first < points; first += points_at_once) {
    const std::size_t count = std::min(points_at_once, points - first);
    std::size_t offset = 0;
    for (const PcdOutput& field : fields) {
      const std::size_t bytes = field.size * field.count, stride = field.stride == 0 ? bytes : field.stride;
      const char* from = static_cast<const char*>(field.data) + first * stride;
      char* to = buffer.data() + offset;
      for (std::size_t i = 0; i < count; ++i, from += stride, to += record) std::memcpy(to, from, bytes);
      offset += bytes;
    }
    file.write(buffer.data(), count * record);
  }
  file.commit();
}

void writePcd(const std::filesystem::path& path, const std::vector<Vector<3>>& points, PcdPrecision precision,
              const std::optional<Pose>& viewpoint) {
  const auto write = [&](const auto* coordinates) {
    std::vector<PcdOutput> fields;
    const char* const names[] = {"x", "y", "z"};
    for (std::size_t axis = 0; axis < 3; ++axis)
      fields.push_back(pcdOutput(names[axis], coordinates ? coordinates + axis : nullptr, 1, 3 * sizeof(*coordinates)));
    writePcd(path, points.size(), fields, viewpoint);
  };
  if (precision == PcdPrecision::Double) return write(points.empty() ? nullptr : points.front().data());

  std::vector<float> floats;
  floats.reserve(3 * points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double value = points[i](axis);
      if (std::isfinite(value) && std::abs(value) > double{std::numeric_limits<float>::max()})
        throw std::invalid_argument("point " + std::to_string(i) + " does not fit into floats: write doubles");
      floats.push_back(static_cast<float>(value));
    }
  }
  write(floats.data());
}

}  // namespace gaussmap
