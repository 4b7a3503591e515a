// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string_view>

#include "adasplats/report/report_page.h"
#include "adasplats/report/results.h"
#include "adasplats/report/text_format.h"

namespace adasplats {
namespace page {
namespace {

/// One line of text in which nothing is markup.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < 0x20) {
      result += ' ';
    } else if (c == '<') {
      result += "&lt;";
    } else if (c == '&') {
      result += "&amp;";
    } else {
      if (std::string_view("\\`*_[]|~#>").find(c) != std::string_view::npos) result += '\\';
      result += c;
    }
  }
  return result;
}

std::string cell_markdown(const Cell& cell) {
  std::string text = cell.best ? "**" + escaped(cell.text) + "**" : escaped(cell.text);
  if (!cell.note.empty()) text += " (" + escaped(cell.note) + ")";
  return text;
}

std::string table_markdown(const Table& table) {
  std::string head = "| model |";
  std::string rule = "|---|";
  for (const Column& column : table.columns) {
    const std::string group = column.group.empty() ? "" : column.group + ", ";
    head += " " + escaped(group + column.name) + " |";
    rule += column.is_text ? "---|" : "--:|";
  }
  std::string text = head + "\n" + rule + "\n";
  for (const Row& row : table.rows) {
    text += "| " + escaped(row.title);
    if (!row.badge.empty()) text += " (" + escaped(row.badge) + ")";
    text += " |";
    for (const Cell& cell : row.cells) text += " " + cell_markdown(cell) + " |";
    text += "\n";
  }
  return text + "\n";
}

std::string facts_markdown(const std::vector<Fact>& facts) {
  std::string text;
  for (const Fact& fact : facts) {
    text += "- **" + escaped(fact.term) + "**: " + escaped(fact.text) + "\n";
  }
  return text.empty() ? text : text + "\n";
}

/// A path as the target of a link: all but plain characters percent-encoded.
std::string link_target(const std::string& path) {
  constexpr std::string_view kHex = "0123456789ABCDEF";
  constexpr std::string_view kPlain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_./";
  std::string target;
  for (const char c : path) {
    const auto code = static_cast<unsigned char>(c);
    if (kPlain.find(c) != std::string_view::npos) {
      target += c;
    } else {
      target += {'%', kHex[code >> 4U], kHex[code & 15U]};
    }
  }
  return target;
}

/// A block of code whose fence is longer than any run of backticks in it.
std::string code_markdown(const std::string& code) {
  std::size_t longest = 2;
  std::size_t run = 0;
  for (const char c : code) {
    run = c == '`' ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  const std::string fence(longest + 1, '`');
  return fence + "sh\n" + code + "\n" + fence + "\n\n";
}

std::string section_markdown(const Section& section) {
  std::string text = "## " + escaped(section.title) + "\n\n";
  for (const std::string& paragraph : section.paragraphs) text += escaped(paragraph) + "\n\n";
  text += facts_markdown(section.facts);
  for (const Table& table : section.tables) {
    const std::string body = table_markdown(table) + facts_markdown(table.definitions);
    if (table.on_demand) {
      text += "<details><summary>" + html_escape(table.title) + "</summary>\n\n" + body +
              "</details>\n\n";
      continue;
    }
    text += "### " + escaped(table.title);
    if (table.folded) text += ": " + escaped(table.charts.front().value_title);
    text += "\n\n" + body;
  }
  for (const Picture& picture : section.pictures) {
    const std::string title = escaped(picture.title);
    text += "**" + title + "**\n\n![" + escaped(section.title) + ": " + title + "](" +
            link_target(picture.path) + ")\n\n";
  }
  for (const Fact& command : section.commands) {
    if (!command.term.empty()) text += escaped(command.term) + ":\n\n";
    text += code_markdown(command.text);
  }
  return text;
}

}  // namespace
}  // namespace page

std::string report_markdown(const nlohmann::ordered_json& results) {
  const page::Document document = page::document_of(results);
  std::string text =
      "# " + page::escaped(document.title) + "\n\n" + page::escaped(document.subtitle) + "\n\n";
  for (const page::Section& section : document.sections) text += page::section_markdown(section);
  return text + page::escaped(document.footer) + "\n";
}

}  // namespace adasplats
