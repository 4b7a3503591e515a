// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/help_text.h"

#include <sstream>

#include "cli/option_traits.h"

namespace adasplats::app {
namespace {

constexpr std::size_t kColumns = 96;
constexpr std::size_t kIndent = 30;

/// " TYPE [DEFAULT] REQUIRED" as far as there is something to say.
std::string traits_of(const CLI::Option& option) {
  std::string traits;
  if (option.get_items_expected_max() > 0) traits += " " + option.get_type_name();
  if (option.get_items_expected_max() > 1) traits += " ...";
  if (!option.get_default_str().empty()) traits += " [" + option.get_default_str() + "]";
  if (option.get_required()) traits += " REQUIRED";
  return traits;
}

/// Words in lines that begin at column kIndent; the first line continues `text`.
void append_wrapped(std::string& text, std::size_t column, const std::string& description) {
  const std::string new_line = "\n" + std::string(kIndent, ' ');
  if (column + 2 > kIndent) {
    text += new_line;
  } else {
    text.append(kIndent - column, ' ');
  }
  column = kIndent;
  std::istringstream words(description);
  for (std::string word; words >> word;) {
    if (column > kIndent && column + 1 + word.size() > kColumns) {
      text += new_line;
      column = kIndent;
    }
    if (column > kIndent) {
      text += ' ';
      ++column;
    }
    text += word;
    column += word.size();
  }
}

}  // namespace

std::string HelpFormatter::make_option(const CLI::Option* option, bool /*is_positional*/) const {
  std::string text = "  " + joined(names_of(*option), ", ") + traits_of(*option);
  append_wrapped(text, text.size(), option->get_description());
  return text + "\n";
}

std::string help_text(const CLI::App& app) {
  std::string name = app.get_name();
  for (const CLI::App* above = app.get_parent(); above != nullptr; above = above->get_parent())
    name = above->get_name() + " " + name;
  // Not app.help(): that gives the help of a subcommand which the command line has.
  std::string text = app.get_formatter()->make_help(&app, name, CLI::AppFormatMode::Normal);
  // CLI11 leaves two blank lines between groups.
  for (std::size_t at = 0; (at = text.find("\n\n\n", at)) != std::string::npos;) text.erase(at, 1);
  text.erase(text.find_last_not_of('\n') + 1);
  return text + "\n";
}

}  // namespace adasplats::app
