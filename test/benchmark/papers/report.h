// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "drawing/plot.h"

namespace gaussmap::papers {

/// A statement of a paper, and what was measured.
struct Claim {
  std::string paper;    ///< "Yguel" or "Leal"
  std::string place;    ///< section, figure or equation
  std::string text;     ///< what the paper says
  std::string figure;   ///< what was measured
  std::string verdict;  ///< one sentence
};

/// A page of Markdown with pictures. The claims come first, in a table.
class Report {
 public:
  /// Makes an empty page. The pictures are written into the folder `NAME` beside the page NAME.md.
  explicit Report(std::filesystem::path page);

  void heading(int level, const std::string& text);
  void paragraph(const std::string& text);
  /// Adds a table: one row of titles, then the rows.
  void table(const std::vector<std::string>& titles, const std::vector<std::vector<std::string>>& rows);
  /// Writes NAME.svg and shows it with a caption.
  void picture(const app::LinePlot& plot, const std::string& name, const std::string& caption);
  /// Returns the file NAME.svg of a picture, and makes its folder. showPicture() then shows it.
  std::filesystem::path pictureFile(const std::string& name) const;
  void showPicture(const std::string& name, const std::string& caption);
  void claim(const Claim& claim);

  /// Writes the page: `preface`, the claims, and everything that was added. Throws FileError if it cannot be written.
  void save(const std::string& preface) const;

 private:
  std::filesystem::path page_;
  std::ostringstream body_;
  std::vector<Claim> claims_;
};

/// A number with three significant digits, from 1000 on a whole number.
std::string number(double value);
/// "3.42 x": a factor with three significant digits.
std::string times(double factor);
/// "97.5 %"
std::string percent(double share);

}  // namespace gaussmap::papers
