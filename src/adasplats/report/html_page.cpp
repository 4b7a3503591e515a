// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <string_view>

#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/base64.h"
#include "adasplats/report/chart.h"
#include "adasplats/report/report_page.h"
#include "adasplats/report/results.h"
#include "adasplats/report/svg_marks.h"
#include "adasplats/report/text_format.h"

namespace adasplats {
namespace page {
namespace {

constexpr unsigned char kPage[] = {
#include "page.inc"
};

/// page.html with the values of its {{names}}. Braces in the values have no meaning.
std::string filled_page(const std::map<std::string, std::string, std::less<>>& values) {
  static const std::string file(std::begin(kPage), std::end(kPage));
  std::string_view rest = std::string_view(file).substr(file.find("<!DOCTYPE"));
  std::string page;
  for (std::size_t at = rest.find("{{"); at != std::string_view::npos; at = rest.find("{{")) {
    const std::size_t end = rest.find("}}", at);
    page.append(rest.substr(0, at)).append(values.find(rest.substr(at + 2, end - at - 2))->second);
    rest.remove_prefix(end + 2);
  }
  return page.append(rest);
}

std::string element(const std::string& name, const std::string& style, const std::string& content) {
  return "<" + name + (style.empty() ? "" : " class=\"" + style + "\"") + ">" + content + "</" +
         name + ">";
}

std::string facts_html(const std::vector<Fact>& facts, const std::string& style) {
  if (facts.empty()) return {};
  std::string html;
  for (const Fact& fact : facts) {
    const std::string pair =
        element("dt", "", html_escape(fact.term)) + element("dd", "", html_escape(fact.text));
    html += style == "facts" ? pair : element("div", "", pair);
  }
  return element("dl", style, html) + "\n";
}

std::string name_html(const std::string& title, const Key& key) {
  if (!key.slot) return html_escape(title);
  return "<svg class=\"key\" viewBox=\"0 0 12 12\" aria-hidden=\"true\">" + marker(key, 6, 6, "") +
         "</svg>" + html_escape(title);
}

std::string cell_html(const Column& column, const Cell& cell) {
  std::string text = html_escape(cell.text);
  if (cell.best) text = element("b", "", text);
  if (!cell.note.empty()) text += element("small", "", html_escape(cell.note));
  return element("td", column.is_text ? "text" : column.name == "paper" ? "paper" : "", text);
}

std::string heading_cell(const std::string& attributes, const std::string& text) {
  return "<th scope=\"col\"" + attributes + ">" + html_escape(text) + "</th>";
}

/// One row of headings, or two where columns are grouped.
std::string table_head(const std::vector<Column>& columns) {
  std::string upper;
  std::string lower;
  for (std::size_t c = 0; c < columns.size();) {
    const Column& column = columns[c];
    std::size_t end = c + 1;
    if (column.group.empty()) {
      upper += heading_cell(column.is_text ? " rowspan=\"2\" class=\"text\"" : " rowspan=\"2\"",
                            column.name);
    } else {
      while (end < columns.size() && columns[end].group == column.group) ++end;
      upper += "<th scope=\"colgroup\" class=\"group\" colspan=\"" + std::to_string(end - c) +
               "\">" + html_escape(column.group) + "</th>";
      for (std::size_t k = c; k < end; ++k) lower += heading_cell("", columns[k].name);
    }
    c = end;
  }
  const std::string corner = heading_cell(" rowspan=\"2\"", "model");
  return element("thead", "", "<tr>" + corner + upper + "</tr><tr>" + lower + "</tr>");
}

std::string table_html(const Table& table) {
  std::string body;
  for (const Row& row : table.rows) {
    std::string html = "<th scope=\"row\">" + name_html(row.title, row.key);
    if (!row.badge.empty()) {
      html +=
          element("span", row.badge == kPaperOnly ? "badge" : "badge bad", html_escape(row.badge));
    }
    html += "</th>";
    for (std::size_t c = 0; c < row.cells.size(); ++c) {
      html += cell_html(table.columns[c], row.cells[c]);
    }
    body += "<tr>" + html + "</tr>\n";
  }
  const std::string label = html_escape(table.title);
  return "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"" + label +
         "\"><table aria-label=\"" + label + "\">" + table_head(table.columns) + "\n" +
         element("tbody", "", body) + "</table></div>\n";
}

std::string chart_html(const Table& table, const ChartPlan& plan) {
  Chart chart{plan.title, plan.category_title, plan.value_title, {}, {}};
  for (const std::size_t c : plan.columns) {
    const Column& column = table.columns[c];
    const std::string name = column.group.empty() ? column.name : column.group;
    chart.categories.push_back(name.substr(0, name.find(" (")));  // the axis names the unit
  }
  for (const Row& row : table.rows) {
    Series series{row.title, row.key, {}};
    bool has_value = false;
    for (const std::size_t c : plan.columns) {
      series.points.push_back(row.cells[c]);
      has_value = has_value || row.cells[c].value.has_value();
    }
    if (has_value) chart.series.push_back(std::move(series));
  }
  if (chart.series.empty()) return {};
  switch (plan.kind) {
    case ChartKind::bars: return bar_chart(chart);
    case ChartKind::dots: return dot_chart(chart);
    case ChartKind::lines: break;
  }
  return line_chart(chart);
}

/// The charts of a section's tables side by side, with the tables that are folded behind them.
std::string figures_html(const std::vector<Table>& tables) {
  std::string html;
  for (const Table& table : tables) {
    for (const ChartPlan& plan : table.charts) {
      const std::string chart = chart_html(table, plan);
      if (chart.empty()) continue;
      std::string folded;
      if (table.folded) {
        folded = element("details", "", element("summary", "", "Figures") + table_html(table));
      }
      html += element("figure", "chart", element("div", "box", chart) + folded) + "\n";
    }
  }
  return html.empty() ? html : element("div", "figures", html) + "\n";
}

std::string plots_html(const std::vector<Plot>& plots) {
  std::string html;
  for (const Plot& plot : plots)
    html += element("figure", "chart", element("div", "box", plot_svg(plot))) + "\n";
  return html.empty() ? html : element("div", "figures", html) + "\n";
}

std::string scale_html(const ColorScale& scale) {
  std::string colors;
  for (const std::string& color : scale.colors) colors += "," + color;
  return element("div", "scale",
                 element("span", "", html_escape(scale.from)) +
                     "<i style=\"background:linear-gradient(90deg" + colors + ")\"></i>" +
                     element("span", "", html_escape(scale.to)) +
                     element("span", "", html_escape(scale.note))) +
         "\n";
}

std::string pictures_html(const Section& section, const std::filesystem::path& folder) {
  std::string html;
  for (const Picture& picture : section.pictures) {
    const std::string data = picture_data_uri(folder, picture.path);
    std::string content = element("figcaption", "", name_html(picture.title, picture.key));
    if (data.empty()) {
      content += element("p", "missing", "Picture missing: " + html_escape(picture.path));
    } else {
      const std::string alt = html_escape(section.title + ": " + picture.title);
      content += "<label class=\"zoom\"><input type=\"checkbox\" aria-label=\"Enlarge " + alt +
                 "\"><img alt=\"" + alt + "\" src=\"" + data + "\"></label>";
    }
    html += element("figure", "", content) + "\n";
  }
  return html.empty() ? html : element("div", "pictures", html) + "\n";
}

std::string commands_html(const std::vector<Fact>& commands) {
  std::string html;
  for (const Fact& command : commands) {
    if (!command.term.empty()) html += element("p", "command", html_escape(command.term));
    html += element("pre", "", html_escape(command.text)) + "\n";
  }
  return html;
}

std::string section_html(const Section& section, const std::filesystem::path& folder) {
  std::string html = element("h2", "", html_escape(section.title)) + "\n";
  for (const std::string& text : section.paragraphs) html += element("p", "", html_escape(text));
  html += facts_html(section.facts, section.facts_as_tiles ? "tiles" : "facts");
  for (const Table& table : section.tables) {
    if (table.folded) continue;
    const std::string body = table_html(table) + facts_html(table.definitions, "defs");
    html += table.on_demand
                ? element("details", "", element("summary", "", html_escape(table.title)) + body)
                : element("h3", "", html_escape(table.title)) + body;
  }
  html += figures_html(section.tables) + plots_html(section.plots);
  if (section.scale) html += scale_html(*section.scale);
  html += pictures_html(section, folder) + commands_html(section.commands);
  return "<section id=\"" + section.id + "\">\n" + html + "</section>\n";
}

}  // namespace

std::string picture_data_uri(const std::filesystem::path& folder, const std::string& relative) {
  const std::filesystem::path path(relative);
  const bool leaves = std::find(path.begin(), path.end(), "..") != path.end();
  if (relative.empty() || path.is_absolute() || leaves) return {};
  std::error_code error;
  if (!std::filesystem::is_regular_file(folder / path, error)) return {};
  const std::string bytes = read_file(folder / path);
  if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return "data:image/png;base64," + to_base64(bytes);
  if (bytes.starts_with("\xff\xd8\xff")) return "data:image/jpeg;base64," + to_base64(bytes);
  return {};
}

std::string html_page(const Document& document, const std::filesystem::path& folder) {
  std::string links;
  std::string sections;
  for (const Section& section : document.sections) {
    links += "<a href=\"#" + section.id + "\">" + html_escape(section.title) + "</a>\n";
    sections += section_html(section, folder);
  }
  return filled_page({{"title", html_escape(document.title)},
                      {"subtitle", html_escape(document.subtitle)},
                      {"links", links},
                      {"sections", sections},
                      {"footer", html_escape(document.footer)}});
}

}  // namespace page

std::string report_html(const nlohmann::ordered_json& results,
                        const std::filesystem::path& folder) {
  return page::html_page(page::document_of(results), folder);
}

}  // namespace adasplats
