// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/segment/output_classes.h"

#include <algorithm>
#include <map>
#include <optional>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/line_reader.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

constexpr std::string_view kUnlabeled = "unlabeled", kUnknown = "unknown";

/// The class of that number, which becomes one if it is none yet.
std::size_t index_of(OutputClasses& outputs, const OutputClasses::Class& wanted) {
  const auto found =
      std::ranges::find(outputs.classes, wanted.id, [](const auto& each) { return each.id; });
  const auto index = static_cast<std::size_t>(found - outputs.classes.begin());
  if (found == outputs.classes.end()) outputs.classes.push_back(wanted);
  return index;
}

/// The lines of a class map: CLASS = NUMBER [NUMBER...] [NAME].
class ClassMapReader {
 public:
  ClassMapReader(const std::filesystem::path& file, std::span<const std::string> network)
      : network_(network), input_(file), lines_(input_) {}

  std::map<std::string, OutputClasses::Class, std::less<>> entries() {
    while (const auto line = lines_.next_filled()) read(line->substr(0, line->find('#')));
    return std::move(entries_);
  }

 private:
  Error error(const std::string& why) const {
    return Error(ErrorKind::config, lines_.error_here(why).what());
  }

  void read(std::string_view line) {
    if (split_blanks(line).empty()) return;
    const std::size_t sign = line.find('=');
    const auto names = split_blanks(line.substr(0, sign));
    if (sign == std::string_view::npos || names.size() != 1)
      throw error("expected CLASS = NUMBER [NUMBER...] [NAME]");
    require_known(names[0]);
    if (!entries_.emplace(names[0], numbered(names[0], line.substr(sign + 1))).second)
      throw error(shown(names[0]) + " for the second time");
  }

  void require_known(std::string_view name) const {
    if (name == kUnlabeled || name == kUnknown) return;
    if (std::ranges::find(network_, name) != network_.end()) return;
    const auto nearest =
        nearest_word(std::string(name), std::vector(network_.begin(), network_.end()));
    throw error("the network has no class " + shown(name) +
                (nearest ? ", did you mean '" + *nearest + "'?" : std::string()));
  }

  OutputClasses::Class numbered(std::string_view name, std::string_view text) {
    OutputClasses::Class entry{0, std::string(name)};
    BlankTokens tokens(text);
    std::optional<std::uint16_t> first;
    for (std::string_view token = tokens.next(); !token.empty(); token = tokens.next()) {
      const auto number = parse_number<std::uint16_t>(token);
      if (!number && first) {
        entry.name = token;
        if (!tokens.rest().empty()) throw error(shown(tokens.rest()) + " behind the name");
        break;
      }
      if (!number) throw error(shown(token) + " is no number from 0 to 65535");
      if (!first) first = number;
    }
    if (!first) throw error("no number for " + shown(name));
    entry.id = *first;
    if (name != kUnlabeled) require_one_name(entry);
    return entry;
  }

  /// A number and its name belong to each other.
  void require_one_name(const OutputClasses::Class& entry) const {
    for (const auto& [name, other] : entries_) {
      const bool same_id = other.id == entry.id, same_name = other.name == entry.name;
      if (name == kUnlabeled || same_id == same_name) continue;
      throw error(same_id ? "number " + std::to_string(entry.id) + " is '" + other.name +
                                "' and '" + entry.name + "': give both the same name"
                          : "'" + entry.name + "' is number " + std::to_string(other.id) + " and " +
                                std::to_string(entry.id));
    }
  }

  std::span<const std::string> network_;
  InputFile input_;
  LineReader lines_;
  std::map<std::string, OutputClasses::Class, std::less<>> entries_;
};

}  // namespace

std::vector<float> OutputClasses::joined(std::span<const float> probabilities) const {
  const std::size_t points = probabilities.size() / of_network.size();
  std::vector<float> sums(points * classes.size());
  for (std::size_t i = 0; i < points; ++i)
    for (std::size_t c = 0; c < of_network.size(); ++c)
      sums[i * classes.size() + of_network[c]] += probabilities[i * of_network.size() + c];
  return sums;
}

OutputClasses semantickitti_outputs(std::span<const std::string> network,
                                    const std::filesystem::path& file) {
  OutputClasses outputs;
  for (const std::string& name : network) {
    const SemanticClass* const found = semantickitti_labels().find(name);
    if (found == nullptr)
      throw Error(ErrorKind::data, file.string() + ": SemanticKITTI has no class '" + name +
                                       "'; `class_map` gives it a number");
    outputs.of_network.push_back(index_of(outputs, {found->id, name}));
  }
  return outputs;
}

OutputClasses read_class_map(const std::filesystem::path& file,
                             std::span<const std::string> network) {
  const auto entries = ClassMapReader(file, network).entries();
  OutputClasses outputs;
  if (const auto found = entries.find(kUnlabeled); found != entries.end())
    outputs.unlabeled = found->second.id;
  for (const std::string& name : network) {
    auto found = entries.find(name);
    if (found == entries.end()) found = entries.find(kUnknown);
    if (found == entries.end())
      throw Error(ErrorKind::config, file.string() + ": has no line for the network's class '" +
                                         name + "' and none for 'unknown'");
    outputs.of_network.push_back(index_of(outputs, found->second));
  }
  return outputs;
}

}  // namespace adasplats
