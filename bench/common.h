// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// For benchmarks: command lines, exit codes and results.

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"

namespace adasplats::bench {

/// The words of a command line. The usage text defines the options: "[--name VALUE]" or "[--name]".
class Arguments {
 public:
  /// Expects `min_inputs` to `max_inputs` words besides the options. Errors: usage.
  Arguments(int argc, char** argv, std::string usage, std::size_t min_inputs,
            std::size_t max_inputs)
      : usage_(std::move(usage)) {
    for (int i = 1; i < argc; ++i) {
      const std::string word = argv[i];
      if (!word.starts_with("--")) {
        inputs_.push_back(word);
      } else if (usage_.find("[" + word + "]") != std::string::npos) {
        options_[word] = "";
      } else if (usage_.find("[" + word + " ") != std::string::npos && i + 1 < argc) {
        options_[word] = argv[++i];
      } else {
        fail(word + " is unknown or needs a value");
      }
    }
    if (inputs_.size() < min_inputs || inputs_.size() > max_inputs)
      fail("wrong number of arguments");
  }

  const std::vector<std::string>& inputs() const { return inputs_; }
  std::string input(std::size_t k, const std::string& otherwise = "") const {
    return k < inputs_.size() ? inputs_[k] : otherwise;
  }
  bool has(const std::string& name) const { return options_.contains(name); }
  std::string text(const std::string& name, const std::string& otherwise = "") const {
    const auto found = options_.find(name);
    return found == options_.end() ? otherwise : found->second;
  }
  /// The number of an option, or `otherwise`. Errors: usage.
  template <class T>
  T number(const std::string& name, T otherwise) const {
    return has(name) ? parsed<T>(text(name)) : otherwise;
  }
  /// The number of an input, or `otherwise`. Errors: usage.
  template <class T>
  T input_number(std::size_t k, T otherwise) const {
    return k < inputs_.size() ? parsed<T>(inputs_[k]) : otherwise;
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw Error(ErrorKind::usage, problem + "\nusage: " + usage_);
  }
  template <class T>
  T parsed(const std::string& value) const {
    char* end = nullptr;
    const double number = std::strtod(value.c_str(), &end);
    if (value.empty() || *end != '\0') fail(value + " is not a number");
    return static_cast<T>(number);
  }

  std::string usage_;
  std::vector<std::string> inputs_;
  std::map<std::string, std::string> options_;
};

/// Prints the result, and writes it to a file if there is a name.
inline void print_and_write(const nlohmann::ordered_json& result, const std::string& file) {
  const std::string text = result.dump(2) + "\n";
  std::fputs(text.c_str(), stdout);
  if (!file.empty()) write_file(file, text);
}

/// Runs a benchmark; returns its exit code.
template <class Run>
int exit_code_of(const char* name, const Run& run) {
  try {
    run();
    return EXIT_SUCCESS;
  } catch (const Error& error) {
    std::fprintf(stderr, "%s: error: %s\n", name, error.what());
    return exit_code(error.kind());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: error: %s\n", name, error.what());
    return EXIT_FAILURE;
  }
}

}  // namespace adasplats::bench
