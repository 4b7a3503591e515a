// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <sstream>

#include "cli/manual/manual.h"

namespace adasplats::app {
namespace {

/// Text that roff shows unchanged: '-' must not become a hyphen, which cannot be pasted into a
/// shell, and a line must not begin with a control character.
std::string roff(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '\\') {
      escaped += "\\e";
    } else if (c == '-') {
      escaped += "\\-";
    } else if ((c == '.' || c == '\'') && (escaped.empty() || escaped.back() == '\n')) {
      escaped += std::string("\\&") + c;
    } else {
      escaped += c;
    }
  }
  return escaped;
}

std::string bold(const std::string& text) { return "\\fB" + roff(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + roff(text) + "\\fR"; }

std::string tagged(const std::string& tag, const std::string& text) {
  return ".TP\n" + tag + "\n" + text + "\n";
}

/// The line above an option's description.
std::string tag_of(const OptionEntry& option) {
  std::string tag;
  for (const std::string& name : option.names) {
    tag += tag.empty() ? "" : ", ";
    tag += option.is_positional ? italic(name) : bold(name);
  }
  if (option.takes_value) tag += " " + italic(option.type);
  if (option.takes_value && option.takes_more) tag += " ...";
  return tag;
}

/// Text that ends with a full stop.
std::string sentence(const std::string& text) {
  return text.empty() || text.back() == '.' ? roff(text) : roff(text) + ".";
}

std::string option_text(const OptionEntry& option) {
  std::string text = tagged(tag_of(option), sentence(option.description));
  if (option.is_required) text += "Required.\n";
  if (!option.initial.empty()) text += "Default: " + bold(option.initial) + ".\n";
  return text;
}

std::string synopsis(const CommandEntry& command) {
  std::string line = bold("adasplats");
  for (const std::string& word : command.path) line += " " + bold(word);
  line += " [" + italic("OPTION") + " ...]";
  for (const OptionEntry& option : command.options) {
    if (!option.is_positional) continue;
    const std::string name = italic(option.names.front()) + (option.takes_more ? " ..." : "");
    line += option.is_required ? " " + name : " [" + name + "]";
  }
  if (!command.parts.empty()) line += " [" + italic("COMMAND") + "]";
  return ".SH SYNOPSIS\n" + line + "\n";
}

/// Arguments and options, each heading in the order in which it first occurs.
std::string options_text(const CommandEntry& command) {
  std::string arguments;
  std::vector<std::pair<std::string, std::string>> headings;
  for (const OptionEntry& option : command.options) {
    if (option.is_positional) {
      arguments += option_text(option);
      continue;
    }
    std::size_t at = 0;
    while (at < headings.size() && headings[at].first != option.heading) ++at;
    if (at == headings.size()) headings.emplace_back(option.heading, "");
    headings[at].second += option_text(option);
  }
  std::string text;
  if (!arguments.empty()) text += ".SH ARGUMENTS\n" + arguments;
  text += ".SH OPTIONS\n";
  for (const auto& [heading, options] : headings) {
    if (heading != kOptionsHeading) text += ".SS " + roff(heading) + "\n";
    text += options;
  }
  return text;
}

std::string parts_text(const CommandEntry& command) {
  if (command.parts.empty()) return "";
  std::string text = ".SH COMMANDS\n";
  for (const CommandEntry& part : command.parts)
    text += tagged(bold(part.path.back()), roff(part.description));
  return text;
}

/// The footer of the help: "Examples:" and lines.
std::string examples_text(const CommandEntry& command) {
  std::string text;
  std::istringstream lines(command.examples);
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) text += roff(line) + "\n";
  return text.empty() ? "" : ".SH EXAMPLES\n.nf\n" + text + ".fi\n";
}

std::string see_also(const CommandEntry& command) {
  std::string text;
  if (!command.path.empty()) {
    CommandEntry above;
    above.path = command.above();
    text += ".BR " + roff(man_page_name(above)) + " (1),\n";
  }
  for (const CommandEntry& part : command.parts)
    text += ".BR " + roff(man_page_name(part)) + " (1),\n";
  return ".SH \"SEE ALSO\"\n" + text + ".BR sysexits (3)\n";
}

constexpr const char* kExitStatus =
    ".SH \"EXIT STATUS\"\n"
    "0 on success, else one of\n.BR sysexits (3),\n"
    "or 128 and the number of the signal that ended the program.\n";

}  // namespace

std::string man_page_name(const CommandEntry& command) {
  return command.path.empty() ? "adasplats" : "adasplats-" + joined(command.path, "-");
}

std::string man_page(const CommandEntry& command) {
  const std::string name = man_page_name(command);
  return ".TH " + roff(name) +
         " 1 \"\" \"adasplats " ADASPLATS_VERSION "\" \"adasplats manual\"\n" + ".SH NAME\n" +
         roff(name) + " \\- " + roff(command.description) + "\n" + synopsis(command) +
         parts_text(command) + options_text(command) + kExitStatus + examples_text(command) +
         see_also(command);
}

}  // namespace adasplats::app
