// SPDX-License-Identifier: BSD-3-Clause
// The columns of a table without a header line, from its numbers.
#include <algorithm>
#include <cmath>

#include "io/files/text.h"
#include "io/scans/pose_text.h"

namespace gaussmap::detail {
namespace {

using Columns = std::vector<PoseColumn>;

constexpr std::size_t kSampleLines = 1000;

const Columns kPosition = {PoseColumn::X, PoseColumn::Y, PoseColumn::Z};
const Columns kXyzw = {PoseColumn::QX, PoseColumn::QY, PoseColumn::QZ, PoseColumn::QW};
const Columns kWxyz = {PoseColumn::QW, PoseColumn::QX, PoseColumn::QY, PoseColumn::QZ};
const Columns kAngles = {PoseColumn::Roll, PoseColumn::Pitch, PoseColumn::Yaw};

Columns operator+(Columns a, const Columns& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

Columns matrixRows(bool four) {
  Columns columns;
  for (int i = 0; i < 12; ++i) columns.push_back(matrixColumn(i));
  if (four) columns.resize(16, PoseColumn::Skip);
  return columns;
}

/// The fields of one line, and their values.
struct Sample {
  std::vector<std::string_view> fields;
  std::vector<double> numbers;  // of the fields behind the name
};

/// The numbers of the first lines.
struct Samples {
  std::vector<Sample> lines;
  bool named = false;  // the first field is not a number
  std::size_t numbers = 0;
  std::size_t first_line = 0;  // number of the first line
};

Samples takeSamples(const PoseText& text, std::size_t first) {
  Samples samples;
  samples.first_line = text.lines[first].number;
  for (std::size_t i = first; i < std::min(text.lines.size(), first + kSampleLines); ++i) {
    Sample sample;
    sample.fields = fieldsOf(text, text.lines[i].text);
    double ignored = 0.0;
    const bool named = !parseNumber(sample.fields.front(), ignored);
    if (i == first) samples.named = named;
    sample.numbers = numbersOf(sample.fields, samples.named ? 1 : 0);
    if (i == first) samples.numbers = sample.numbers.size();
    if (samples.numbers == 0 && i == first) {
      const auto bad = std::find_if(sample.fields.rbegin(), sample.fields.rend(),
                                    [&](std::string_view field) { return !parseNumber(field, ignored); });
      text.fail(text.lines[i].number, std::to_string(sample.fields.size()) +
                                          (sample.fields.size() == 1 ? " word" : " words") +
                                          (bad != sample.fields.rend() ? ", " + quote(*bad) + " is not a number" : "") +
                                          ": expected the numbers of a pose, or a line with the names of the columns, "
                                          "for example 'time x y z qx qy qz qw' (TUM); 12 numbers are KITTI");
    }
    if (sample.numbers.size() != samples.numbers || named != samples.named)
      text.fail(text.lines[i].number, "the line has another layout than the lines before it");
    samples.lines.push_back(std::move(sample));
  }
  return samples;
}

bool isUnitQuaternion(const double* q) {
  const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  return std::abs(norm - 1.0) <= kQuaternionTolerance;
}

/// Returns true if `test` holds for every line whose numbers from `begin` to `end` are not NaN.
template <typename Test>
bool fitsAll(const Samples& samples, std::size_t begin, std::size_t end, const Test& test) {
  bool any = false;
  for (const Sample& sample : samples.lines) {
    const auto first = sample.numbers.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto last = sample.numbers.begin() + static_cast<std::ptrdiff_t>(end);
    if (std::all_of(first, last, [](double value) { return std::isnan(value); })) continue;
    any = true;
    if (!test(&*first)) return false;
  }
  return any;
}

/// Returns true if the number `i` of every line has only digits and lies in [low, high).
bool isWhole(const Samples& samples, std::size_t i, double low, double high) {
  return std::all_of(samples.lines.begin(), samples.lines.end(), [&](const Sample& sample) {
    const std::optional<Decimal> number = parseDecimal(sample.fields[i + (samples.named ? 1 : 0)]);
    return number && number->whole && number->value() >= low && number->value() < high;
  });
}

struct Body {
  Columns columns;
  RotationKind rotation;
  PoseFormat format;
};

bool bodyFits(const Samples& samples, const Body& body, std::size_t begin) {
  const std::size_t end = begin + body.columns.size();
  if (body.rotation == RotationKind::Quaternion)
    return fitsAll(samples, begin, end, [](const double* v) { return isUnitQuaternion(v + 3); });
  return fitsAll(samples, begin, end,
                 [&](const double* v) { return isRigid(v) && (body.columns.size() < 16 || lastRowFault(v).empty()); });
}

bool leadFits(const Samples& samples, const Columns& lead) {
  if (lead.size() < 2) return true;
  if (lead[0] == PoseColumn::Seconds) return isWhole(samples, 0, 1e8, 4.2e9) && isWhole(samples, 1, 0.0, 1e9);
  return isWhole(samples, 0, 0.0, 1e8) && !isWhole(samples, 1, 0.0, 1e8);  // index and time
}

const std::vector<Body>& bodies() {
  static const std::vector<Body> all = {
      {kPosition + kXyzw, RotationKind::Quaternion, PoseFormat::Tum},
      {matrixRows(false), RotationKind::Matrix, PoseFormat::Kitti},
      {matrixRows(true), RotationKind::Matrix, PoseFormat::Matrix4},
  };
  return all;
}

PoseLayout layoutOf(const Samples& samples, const Columns& lead, const Body& body) {
  PoseLayout layout;
  if (samples.named) layout.columns = {PoseColumn::Name};
  layout.columns = layout.columns + lead + body.columns;
  layout.rotation = body.rotation;
  if (body.columns.size() == 16) layout.last_row = layout.columns.size() - 4;
  return layout;
}

/// All layouts with this number of columns that the numbers fit.
std::vector<InferredLayout> fittingLayouts(const Samples& samples) {
  std::vector<Columns> leads = {
      {}, {PoseColumn::Key}, {PoseColumn::Index, PoseColumn::Time}, {PoseColumn::Seconds, PoseColumn::Nanoseconds}};
  if (samples.named) leads = {{}, {PoseColumn::Time}, {PoseColumn::Seconds, PoseColumn::Nanoseconds}};
  std::vector<InferredLayout> fitting;
  for (const Body& body : bodies()) {
    for (const Columns& lead : leads) {
      const std::size_t used = lead.size() + body.columns.size();
      const bool behind = used + 1 == samples.numbers;
      if (used != samples.numbers && !(behind && isWhole(samples, used, 0.0, 1e18))) continue;
      if (!leadFits(samples, lead) || !bodyFits(samples, body, lead.size())) continue;
      InferredLayout one{layoutOf(samples, lead, body), body.format, behind};
      if (behind) one.layout.columns.push_back(PoseColumn::Index);
      fitting.push_back(std::move(one));
    }
  }
  return fitting;
}

/// The usual layout with this number of columns, whose faults are then reported line by line.
std::optional<InferredLayout> usualLayout(const Samples& samples) {
  for (const Body& body : bodies()) {
    const std::size_t more = samples.numbers - body.columns.size();
    if (samples.numbers < body.columns.size() || more > (samples.named ? 0u : 1u)) continue;
    if (more == 0 && body.rotation == RotationKind::Quaternion && !samples.named) continue;
    return InferredLayout{layoutOf(samples, more == 1 ? Columns{PoseColumn::Key} : Columns{}, body), body.format,
                          false};
  }
  return std::nullopt;
}

constexpr std::size_t kEuRocNumbers = 17;  // time, pose with w first, velocity, biases

/// Returns true if the numbers can be those of EuRoC: a unit quaternion with w first, and not the columns of a matrix.
bool isEuRoc(const Samples& samples) {
  return !samples.named && samples.numbers == kEuRocNumbers &&
         fitsAll(samples, 4, 8, [](const double* v) { return isUnitQuaternion(v); }) &&
         !fitsAll(samples, 1, 17, [](const double* v) { return v[3] == 0.0 && v[7] == 0.0 && v[11] == 0.0; });
}

InferredLayout layoutOfEuRoc() {
  InferredLayout euroc;
  euroc.layout.columns = Columns{PoseColumn::Time} + kPosition + kWxyz;
  euroc.layout.unit = TimeUnit::Nanoseconds;
  euroc.format = PoseFormat::EuRoc;
  return euroc;
}

std::string countText(const Samples& samples) {
  return (samples.named ? "a name and " : "") + std::to_string(samples.numbers) + " numbers per line";
}

}  // namespace

InferredLayout inferLayout(const PoseText& text, std::size_t first) {
  if (first >= text.lines.size()) throw FileError(text.path, "no pose in this file, only a header line");
  const Samples samples = takeSamples(text, first);
  std::vector<InferredLayout> fitting = fittingLayouts(samples);
  if (fitting.empty() && isEuRoc(samples)) {
    if (isWhole(samples, 0, 1e17, 1e19)) return layoutOfEuRoc();
    text.fail(samples.first_line,
              "17 numbers: EuRoC? Its time is in whole nanoseconds. Add its header line, or use --pose-format euroc");
  }
  // An eighth number in front (TUM) is far more common than one behind the pose.
  if (fitting.size() > 1 && samples.numbers == 8 && !samples.named)
    fitting.erase(std::remove_if(fitting.begin(), fitting.end(), [](const auto& one) { return one.index_behind; }),
                  fitting.end());
  if (fitting.size() == 1) return fitting.front();
  if (fitting.size() > 1)
    text.fail(samples.first_line, countText(samples) + " can be '" + fitting[0].layout.text() + "' or '" +
                                      fitting[1].layout.text() +
                                      "': name the columns with --pose-format \"time x y z ...\"");
  if (samples.numbers == 6 || (samples.numbers == 7 && !samples.named))
    text.fail(samples.first_line, countText(samples) +
                                      " look like x y z roll pitch yaw, but the unit of the angles is "
                                      "not stated: use --pose-format xyzrpy-deg or xyzrpy-rad");
  std::optional<InferredLayout> usual = usualLayout(samples);
  if (!usual)
    text.fail(samples.first_line,
              countText(samples) +
                  " fit no known layout: expected 'time x y z qx qy qz qw' (TUM), the 12 numbers of a "
                  "matrix (KITTI), or a line with the names of the columns; name them with --pose-format "
                  "\"time x y z qx qy qz qw\"");
  return *usual;
}

PoseLayout layoutOfFormat(const PoseText& text, PoseFormat format, std::size_t first) {
  const Samples samples = takeSamples(text, first);
  const bool is_matrix = format == PoseFormat::Kitti || format == PoseFormat::Matrix4;
  const bool is_angles = format == PoseFormat::XyzRpyDegrees || format == PoseFormat::XyzRpyRadians;
  Columns body = is_matrix                     ? matrixRows(format == PoseFormat::Matrix4)
                 : is_angles                   ? kPosition + kAngles
                 : format == PoseFormat::EuRoc ? kPosition + kWxyz
                                               : kPosition + kXyzw;
  PoseLayout layout;
  layout.rotation = is_matrix   ? RotationKind::Matrix
                    : is_angles ? RotationKind::RollPitchYaw
                                : RotationKind::Quaternion;
  layout.degrees = format == PoseFormat::XyzRpyDegrees;
  if (samples.named)
    layout.columns = {PoseColumn::Name};
  else if (format == PoseFormat::EuRoc)
    layout.columns = {PoseColumn::Time}, layout.unit = TimeUnit::Nanoseconds;
  else if (samples.numbers > body.size())
    layout.columns = {PoseColumn::Key};
  layout.columns = layout.columns + body;
  if (format == PoseFormat::Matrix4) layout.last_row = layout.columns.size() - 4;
  const std::size_t expected = layout.columns.size(), found = samples.numbers + (samples.named ? 1 : 0);
  if (found < expected || (found > expected && (is_matrix || is_angles)))
    text.fail(samples.first_line, countText(samples) + " do not fit --pose-format: expected '" + layout.text() + "'");
  return layout;
}

}  // namespace gaussmap::detail
