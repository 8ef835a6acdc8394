// SPDX-License-Identifier: BSD-3-Clause
#include "io/pcd/pcd_records.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "gaussmap/io/pcd/pcd_writer.h"
#include "io/pcd/pcd_fields.h"

namespace gaussmap::detail {
namespace {

const PcdField* findField(const PcdRecords& records, const std::string& name) {
  const auto found = std::find_if(records.fields.begin(), records.fields.end(),
                                  [&](const PcdField& field) { return field.name == name; });
  return found == records.fields.end() ? nullptr : &*found;
}

/// Three fields that form a vector of floats or doubles.
class VectorField {
 public:
  VectorField(PcdRecords& records, const std::array<std::string, 3>& names) : records_(records) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      fields_[axis] = findField(records, names[axis]);
      if (!fields_[axis] || fields_[axis]->type != 'F' || (fields_[axis]->size != 4 && fields_[axis]->size != 8))
        there_ = false;
    }
  }
  bool there() const { return there_; }

  Eigen::Vector3d get(std::size_t point) const {
    Eigen::Vector3d value;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const char* const place = records_.bytes.data() + point * records_.record_size + fields_[axis]->offset;
      float single = 0.0f;
      if (fields_[axis]->size == sizeof(double)) {
        std::memcpy(&value[Eigen::Index(axis)], place, sizeof(double));
      } else {
        std::memcpy(&single, place, sizeof(float));
        value[Eigen::Index(axis)] = double(single);
      }
    }
    return value;
  }

  void set(std::size_t point, const Eigen::Vector3d& value) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      char* const place = records_.bytes.data() + point * records_.record_size + fields_[axis]->offset;
      const double number = value[Eigen::Index(axis)];
      const auto single = static_cast<float>(number);
      if (fields_[axis]->size == sizeof(double))
        std::memcpy(place, &number, sizeof(double));
      else
        std::memcpy(place, &single, sizeof(float));
    }
  }

 private:
  PcdRecords& records_;
  std::array<const PcdField*, 3> fields_;
  bool there_ = true;
};

bool sameFields(const std::vector<PcdField>& a, const std::vector<PcdField>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const PcdField& one, const PcdField& other) {
    return one.name == other.name && one.size == other.size && one.type == other.type && one.count == other.count;
  });
}

/// Returns the fields without padding.
std::vector<PcdOutput> outputsOf(const std::vector<PcdField>& fields, const char* bytes, std::size_t record_size) {
  std::vector<PcdOutput> outputs;
  for (const PcdField& field : fields)
    if (field.name != "_")
      outputs.push_back(
          {field.name, field.type, field.size, field.count, bytes ? bytes + field.offset : nullptr, record_size});
  return outputs;
}

}  // namespace

void checkWritable(const PcdReader& reader) {
  const PcdHeader& header = reader.header();
  try {
    checkEachField(outputsOf(header.fields, nullptr, header.record_size));
  } catch (const std::invalid_argument& error) {
    throw FileError(reader.path(), std::string(error.what()) + ": it cannot be written again");
  }
}

PcdRecords readRecords(const PcdReader& reader) {
  const PcdHeader& header = reader.header();
  return {header.fields, header.record_size, reader.records(), header.height > 1 ? header.width : 0, header.viewpoint};
}

void keepOnly(PcdRecords& records, const std::vector<bool>& keep) {
  if (keep.size() != records.size())
    throw std::invalid_argument(std::to_string(keep.size()) + " flags for " + std::to_string(records.size()) +
                                " points");
  if (records.width > 0) {
    VectorField xyz(records, {"x", "y", "z"});
    for (std::size_t i = 0; i < keep.size(); ++i)
      if (!keep[i]) xyz.set(i, Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
    return;
  }
  char* to = records.bytes.data();
  for (std::size_t i = 0; i < keep.size(); ++i) {
    if (!keep[i]) continue;
    const char* const from = records.bytes.data() + i * records.record_size;
    if (to != from) std::memmove(to, from, records.record_size);
    to += records.record_size;
  }
  records.bytes.resize(static_cast<std::size_t>(to - records.bytes.data()));
}

bool hasFloatCoordinates(const PcdRecords& records) {
  return std::all_of(records.fields.begin(), records.fields.end(), [](const PcdField& field) {
    return (field.name != "x" && field.name != "y" && field.name != "z") || field.size == sizeof(float);
  });
}

void widenCoordinates(PcdRecords& records) {
  PcdRecords wide;
  wide.width = records.width;
  wide.viewpoint = records.viewpoint;
  for (PcdField field : records.fields) {
    const bool is_coordinate = field.name == "x" || field.name == "y" || field.name == "z";
    if (is_coordinate) field.size = sizeof(double);
    field.offset = wide.record_size;
    wide.record_size += field.size * field.count;
    wide.fields.push_back(std::move(field));
  }
  if (wide.record_size == records.record_size) return;  // they are doubles already
  wide.bytes.resize(records.size() * wide.record_size);
  for (std::size_t f = 0; f < wide.fields.size(); ++f) {
    const PcdField &from = records.fields[f], &to = wide.fields[f];
    for (std::size_t i = 0; i < records.size(); ++i) {
      const char* const source = records.bytes.data() + i * records.record_size + from.offset;
      char* const target = wide.bytes.data() + i * wide.record_size + to.offset;
      if (from.size == to.size) {
        std::memcpy(target, source, from.size * from.count);
      } else {
        float single = 0.0f;
        std::memcpy(&single, source, sizeof(single));
        const double number{single};
        std::memcpy(target, &number, sizeof(number));
      }
    }
  }
  records = std::move(wide);
}

void moveToMap(PcdRecords& records, const Pose& pose, double precision) {
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  double farthest = 0.0;
  {
    const VectorField given(records, {"x", "y", "z"});
    for (std::size_t i = 0; i < records.size(); ++i) {
      const double distance = (rotation * given.get(i) + pose.translation).cwiseAbs().maxCoeff();
      if (std::isfinite(distance)) farthest = std::max(farthest, distance);
    }
  }
  if (farthest * double{std::numeric_limits<float>::epsilon()} > precision) widenCoordinates(records);
  VectorField xyz(records, {"x", "y", "z"}), normal(records, {"normal_x", "normal_y", "normal_z"});
  for (std::size_t i = 0; i < records.size(); ++i) {
    xyz.set(i, rotation * xyz.get(i) + pose.translation);
    if (normal.there()) normal.set(i, rotation * normal.get(i));
  }
  records.viewpoint = Pose();
}

void append(PcdRecords& records, PcdRecords more) {
  if (!sameFields(records.fields, more.fields)) {
    PcdRecords wide{records.fields, records.record_size, {}, 0, {}},
        wide_more{more.fields, more.record_size, {}, 0, {}};
    widenCoordinates(wide);
    widenCoordinates(wide_more);
    if (!sameFields(wide.fields, wide_more.fields)) throw std::invalid_argument("the clouds have different fields");
    widenCoordinates(records);
    widenCoordinates(more);
  }
  records.bytes.insert(records.bytes.end(), more.bytes.begin(), more.bytes.end());
  records.width = 0;
}

void writePcd(const std::filesystem::path& path, const PcdRecords& records) {
  writeFields(path, records.size(), outputsOf(records.fields, records.bytes.data(), records.record_size),
              records.viewpoint, records.width);
}

}  // namespace gaussmap::detail
