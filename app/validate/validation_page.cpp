#include "app/validate/validation_page.h"

#include <fmt/format.h>

#include "app/report/page_style.h"
#include "app/report/svg_chart.h"

namespace topple::app {

std::string validation_page(const std::string& title, const std::string& source, const std::string& body,
                            const std::string& call) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n<meta name=\"generator\" content=\"topple "
      "{}\">\n<link "
      "rel=\"icon\" href=\"data:,\">\n<title>{}</title>\n<style>{}figure > svg {{ width: 100%; height: auto; "
      "}}</style>\n</head>\n<body>\n<header>\n<p>Held against measurements</p>\n<h1>{}</h1>\n<p>topple "
      "{}</p>\n</header>\n<main>\n{}</main>\n<footer>Data: {}<br>{}</footer>\n</body>\n</html>\n",
      TOPPLE_VERSION, escaped(title), k_page_style, escaped(title), TOPPLE_VERSION, body, escaped(source),
      escaped(call));
}

std::string html_section(const std::string& title, const std::string& content) {
  return "<section>\n<h2>" + escaped(title) + "</h2>\n" + content + "</section>\n";
}

std::string html_paragraph(const std::string& text) {
  return "<p>" + escaped(text) + "</p>\n";
}

std::string html_tiles(const std::vector<std::pair<std::string, std::string>>& tiles) {
  std::string out = "<div class=\"figures\">\n";
  for (const auto& [figure, what] : tiles)
    out += "<div><b>" + escaped(figure) + "</b><span>" + escaped(what) + "</span></div>\n";
  return out + "</div>\n";
}

std::string html_table(const std::vector<std::string>& head,
                       const std::vector<std::vector<std::string>>& rows) {
  std::string out = "<div class=\"wide\"><table class=\"numbers\">\n<thead><tr>";
  for (const std::string& cell : head) out += "<th scope=\"col\">" + escaped(cell) + "</th>";
  out += "</tr></thead>\n<tbody>\n";
  for (const auto& row : rows) {
    out += "<tr>";
    for (std::size_t c = 0; c < row.size(); ++c)
      out += c == 0 ? "<th scope=\"row\">" + escaped(row[c]) + "</th>" : "<td>" + escaped(row[c]) + "</td>";
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

}  // namespace topple::app
