// SPDX-License-Identifier: BSD-3-Clause
#include "papers/report.h"

#include <cmath>
#include <utility>

#include "common/report.h"

namespace gaussmap::papers {
namespace {

void addRow(std::ostream& out, const std::vector<std::string>& cells) {
  for (const std::string& cell : cells) out << "| " << cell << ' ';
  out << "|\n";
}

void addTable(std::ostream& out, const std::vector<std::string>& titles,
              const std::vector<std::vector<std::string>>& rows) {
  addRow(out, titles);
  addRow(out, std::vector<std::string>(titles.size(), "---"));
  for (const std::vector<std::string>& row : rows) addRow(out, row);
  out << '\n';
}

}  // namespace

Report::Report(std::filesystem::path page) : page_(std::move(page)) {}

void Report::heading(int level, const std::string& text) {
  body_ << std::string(static_cast<std::size_t>(level), '#') << ' ' << text << "\n\n";
}

void Report::paragraph(const std::string& text) {
  body_ << text << "\n\n";
}

void Report::table(const std::vector<std::string>& titles, const std::vector<std::vector<std::string>>& rows) {
  addTable(body_, titles, rows);
}

std::filesystem::path Report::pictureFile(const std::string& name) const {
  const std::filesystem::path folder = page_.parent_path() / page_.stem();
  std::filesystem::create_directories(folder);
  return folder / (name + ".svg");
}

void Report::showPicture(const std::string& name, const std::string& caption) {
  body_ << "![" << caption << "](" << (page_.stem() / (name + ".svg")).generic_string() << ")\n\n*" << caption
        << "*\n\n";
}

void Report::picture(const app::LinePlot& plot, const std::string& name, const std::string& caption) {
  app::drawPlot(plot, pictureFile(name));
  showPicture(name, caption);
}

void Report::claim(const Claim& claim) {
  claims_.push_back(claim);
}

void Report::save(const std::string& preface) const {
  std::ostringstream text;
  text << preface << "\n\n";
  for (const auto& [paper, title] :
       {std::pair{"Yguel", "Claims of Yguel et al. 2009"}, {"Leal", "Claims of Leal et al. 2000"}}) {
    std::vector<std::vector<std::string>> rows;
    for (const Claim& claim : claims_)
      if (claim.paper == paper) rows.push_back({claim.place, claim.text, claim.figure, claim.verdict});
    if (rows.empty()) continue;
    text << "## " << title << "\n\n";
    addTable(text, {"where", "the paper says", "measured", "verdict"}, rows);
  }
  std::string page = text.str() + body_.str();
  while (page.size() > 1 && page[page.size() - 2] == '\n') page.pop_back();  // one line feed at the end
  app::writeText(page_, page);
}

std::string number(double value) {
  return app::formatted(std::abs(value) < 1000.0 ? "%.3g" : "%.0f", value);
}

std::string times(double factor) {
  return number(factor) + " x";
}

std::string percent(double share) {
  return app::formatted("%.1f", 100.0 * share) + " %";
}

}  // namespace gaussmap::papers
