// Pages of comparisons with measurements: one file, as a report is.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace topple::app {

/// A whole page. `body`: sections; `source`: where the data are from.
std::string validation_page(const std::string& title, const std::string& source, const std::string& body,
                            const std::string& call);

std::string html_section(const std::string& title, const std::string& content);
std::string html_paragraph(const std::string& text);
/// Figures that stand out: each with what it is.
std::string html_tiles(const std::vector<std::pair<std::string, std::string>>& tiles);
/// Columns beyond the first are numbers. Cells are text.
std::string html_table(const std::vector<std::string>& head,
                       const std::vector<std::vector<std::string>>& rows);

}  // namespace topple::app
