// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The fuzz program: libFuzzer's main() with one target of the list.
//   adasplats_fuzz --target=NAME [libFuzzer's options] [FOLDERS OR FILES]
//   adasplats_fuzz --list            prints name, sources, largest input, largest allocation (MB)
//   adasplats_fuzz --check=CORPUS    every format has a target, every target seeds that it reads

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/io/bags/recording.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/point_format.h"
#include "fuzz_target.h"

namespace adasplats::fuzz {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    if (end > 0) words.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return words;
}

/// A folder in memory where there is one, else where TMPDIR says; goes with the program.
class WorkFolder {
 public:
  WorkFolder() {
    const char* const stated = std::getenv("TMPDIR");
    const fs::path memory = "/dev/shm";
    const bool has_memory = ::access(memory.c_str(), W_OK) == 0;
    const fs::path above = stated != nullptr || !has_memory ? fs::temp_directory_path() : memory;
    std::string pattern = (above / "adasplats-fuzz-XXXXXX").string();
    require(::mkdtemp(pattern.data()) != nullptr, "a temporary folder");
    path_ = pattern;
  }
  ~WorkFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// One target with the folder that its files are written to.
class Runner {
 public:
  explicit Runner(const FuzzTarget& target) : target_(target) {
    for (const std::string& name : words_of(target.files)) {
      files_.push_back(folder_.path() / name);
      fs::create_directories(files_.back().parent_path());
    }
  }

  /// What the reader said; empty: it read the input.
  std::string run(std::string_view bytes) {
    put_files(bytes);
    const Input input{bytes, folder_.path(), files_.empty() ? fs::path() : files_.front()};
    try {
      target_.read(input);
    } catch (const Error& error) {
      const std::string said = error.what();
      require(error.kind() != ErrorKind::software, "no bug of ours is reported");
      require(!said.empty(), "an error says something");
      // Which file of several is wrong is for the readers' tests.
      if (files_.size() == 1)
        require(said.find(files_.front().filename().string()) != std::string::npos,
                "an error names the file");
      return said;
    }
    return {};
  }

 private:
  /// Files that the input does not reach are not there.
  void put_files(std::string_view bytes) {
    constexpr std::string_view kBetween = "\n%%\n";
    bool is_over = false;
    for (const fs::path& file : files_) {
      std::error_code ignored;
      if (is_over) {
        fs::remove(file, ignored);
        continue;
      }
      const std::size_t end = files_.size() == 1 ? bytes.npos : bytes.find(kBetween);
      const std::string_view content = bytes.substr(0, end);
      std::ofstream(file, std::ios::binary | std::ios::trunc)
          .write(content.data(), static_cast<std::streamsize>(content.size()));
      is_over = end == bytes.npos;
      bytes.remove_prefix(is_over ? bytes.size() : end + kBetween.size());
    }
  }

  const FuzzTarget& target_;
  WorkFolder folder_;
  std::vector<fs::path> files_;
};

std::unique_ptr<Runner> the_runner;

const FuzzTarget* target_named(std::string_view name) {
  for (const FuzzTarget& target : fuzz_targets())
    if (target.name == name) return &target;
  return nullptr;
}

void list_targets() {
  for (const FuzzTarget& target : fuzz_targets())
    std::cout << target.name << '\t' << target.sources << '\t' << target.max_bytes << '\t'
              << target.allocation_mb << '\n';
}

/// Whether a target reads files of an extension.
bool is_fuzzed(std::string_view extension) {
  for (const FuzzTarget& target : fuzz_targets())
    for (const std::string& file : words_of(target.files))
      if (file.ends_with(extension)) return true;
  return false;
}

int check_formats() {
  int faults = 0;
  std::vector<std::string> extensions = recording_extensions();
  for (const PointFormat& format : point_formats())
    extensions.insert(extensions.end(), format.extensions.begin(), format.extensions.end());
  for (const std::string& extension : extensions) {
    if (is_fuzzed(extension)) continue;
    std::cerr << "no target in tests/fuzz/fuzz_targets.cpp reads " << extension << '\n';
    ++faults;
  }
  return faults;
}

int check_seeds(const FuzzTarget& target, const fs::path& folder) {
  Runner runner(target);
  std::size_t seeds = 0, read = 0;
  std::string said = "there are none";
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const std::string problem = runner.run(read_file(entry.path()));
    ++seeds;
    if (problem.empty())
      ++read;
    else
      said = problem;
  }
  if (read > 0) return 0;
  std::cerr << target.name << ": none of " << seeds << " seeds in " << folder.string()
            << " can be read: " << said << '\n';
  return 1;
}

/// Exit code of --check.
int check(const fs::path& corpus) {
  int faults = check_formats();
  for (const FuzzTarget& target : fuzz_targets())
    faults += check_seeds(target, corpus / target.name);
  for (const auto& entry : fs::directory_iterator(corpus)) {
    if (target_named(entry.path().filename().string()) != nullptr) continue;
    std::cerr << entry.path().string() << ": there is no such target\n";
    ++faults;
  }
  return faults == 0 ? 0 : 1;
}

}  // namespace

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "expected: %s\n", what);
  std::abort();
}

}  // namespace adasplats::fuzz

extern "C" int LLVMFuzzerInitialize(int* count, char*** words) {
  namespace fuzz = adasplats::fuzz;
  constexpr std::string_view kTarget = "--target=", kCheck = "--check=";
  for (int k = 1; k < *count; ++k) {
    const std::string_view word = (*words)[k];
    if (word == "--list") {
      fuzz::list_targets();
      std::exit(0);
    }
    if (word.starts_with(kCheck)) std::exit(fuzz::check(word.substr(kCheck.size())));
    if (!word.starts_with(kTarget)) continue;
    const auto* const target = fuzz::target_named(word.substr(kTarget.size()));
    if (target != nullptr) fuzz::the_runner = std::make_unique<fuzz::Runner>(*target);
  }
  if (fuzz::the_runner) return 0;
  std::cerr << "usage: adasplats_fuzz --target=NAME, --list or --check=CORPUS\n";
  std::exit(64);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  adasplats::fuzz::the_runner->run({reinterpret_cast<const char*>(bytes), size});
  return 0;
}
