// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/evaluate/label_files.h"

#include <iterator>
#include <map>
#include <string>
#include <utility>

#include "adasplats/cloud/load/cloud_inputs.h"
#include "adasplats/cloud/load/cloud_part.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/jobs/session/inputs.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

enum class LabelSide : bool { predicted, truth };

/// The labels of one sequence, by the names of its scans.
struct LabelFolder {
  fs::path path;
  std::map<std::string, fs::path> files;
};

struct LabelInput {
  fs::path path;
  bool is_file = false;
  std::map<std::string, LabelFolder> sequences;  ///< by name
};

/// The .label files of a sequence, or of a folder that holds nothing else; none where it is
/// neither.
LabelFolder label_folder(const fs::path& folder, LabelSide side) {
  std::vector<fs::path> places = {folder / "labels", folder};
  if (side == LabelSide::predicted) places.insert(places.begin(), folder / "predictions");
  LabelFolder labels;
  for (const fs::path& place : places) {
    for (const fs::path& file : files_by_name(place, ".label"))
      labels.files.emplace(file.stem().string(), file);
    labels.path = place;
    if (!labels.files.empty()) break;
  }
  return labels;
}

std::vector<fs::path> folders_in(const fs::path& folder) {
  std::vector<fs::path> folders;
  std::error_code ignored;  // what cannot be listed holds none
  for (fs::directory_iterator entry(folder, ignored), end; !ignored && entry != end;
       entry.increment(ignored)) {
    std::error_code broken;  // a link is no folder
    const bool is_hidden = entry->path().filename().string().front() == '.';
    if (!is_hidden && entry->is_directory(broken)) folders.push_back(entry->path());
  }
  return folders;
}

/// The files of points in a folder. Errors: those of cloud_inputs, data (sequences: they have no
/// labels, else they would have been found).
LabelFolder point_folder(const fs::path& path) {
  LabelFolder folder{path, {}};
  for (const CloudInput& input : cloud_inputs(path)) {
    if (input.is_sequence) throw Error(ErrorKind::data, input.path.string() + ": has no labels");
    folder.files.emplace(input.path.stem().string(), input.path);
  }
  return folder;
}

LabelInput find_labels(const fs::path& path, LabelSide side) {
  require_input(path);
  LabelInput input{path, !fs::is_directory(path), {}};
  if (input.is_file) {
    input.sequences[""] = {path, {{path.stem().string(), path}}};
    return input;
  }
  if (LabelFolder one = label_folder(path, side); !one.files.empty()) {
    input.sequences[""] = std::move(one);
    return input;
  }
  for (const fs::path& place : {path, path / "sequences"})
    for (const fs::path& folder : folders_in(place))
      if (LabelFolder one = label_folder(folder, side); !one.files.empty())
        input.sequences.emplace(folder.filename().string(), std::move(one));
  if (input.sequences.empty()) input.sequences[""] = point_folder(path);
  return input;
}

/// Throws where `lacking` has not every name that `having` has.
template <class Named>
void require_names(const fs::path& lacking_path, const Named& lacking, const fs::path& having_path,
                   const Named& having, const std::string& what) {
  for (const auto& [name, value] : having)
    if (!lacking.contains(name))
      throw Error(ErrorKind::data, lacking_path.string() + ": has no labels of " + what + " " +
                                       name + ", which " + having_path.string() + " has");
}

void append_pairs(const LabelFolder& predicted, const LabelFolder& truth, const ScanRange& scans,
                  std::vector<LabelFilePair>& pairs) {
  std::map<std::string, fs::path> chosen;
  if (scans == ScanRange()) {
    require_names(truth.path, truth.files, predicted.path, predicted.files, "scan");
    chosen = truth.files;
  } else {
    for (const std::size_t i : chosen_scans(scans, truth.files.size(), truth.path))
      chosen.insert(*std::next(truth.files.begin(), static_cast<std::ptrdiff_t>(i)));
  }
  require_names(predicted.path, predicted.files, truth.path, chosen, "scan");
  for (const auto& [name, file] : chosen) pairs.push_back({predicted.files.at(name), file});
}

}  // namespace

std::vector<LabelFilePair> pair_label_files(const fs::path& predicted, const fs::path& truth,
                                            const ScanRange& scans) {
  const LabelInput has = find_labels(predicted, LabelSide::predicted);
  const LabelInput expected = find_labels(truth, LabelSide::truth);
  if (has.is_file && expected.is_file) {
    if (scans == ScanRange()) return {{predicted, truth}};
    throw Error(ErrorKind::usage, "`scans` has no effect on two files");
  }
  std::vector<LabelFilePair> pairs;
  if (has.sequences.size() == 1 && expected.sequences.size() == 1) {
    append_pairs(has.sequences.begin()->second, expected.sequences.begin()->second, scans, pairs);
    return pairs;
  }
  require_names(has.path, has.sequences, expected.path, expected.sequences, "sequence");
  require_names(expected.path, expected.sequences, has.path, has.sequences, "sequence");
  for (const auto& [name, folder] : expected.sequences)
    append_pairs(has.sequences.at(name), folder, scans, pairs);
  return pairs;
}

std::vector<std::uint16_t> read_point_classes(const fs::path& file, Session& session) {
  if (lower_case(file.extension().string()) == ".label") {
    const std::vector<std::uint32_t> labels = read_kitti_labels(file);
    std::vector<std::uint16_t> classes;
    classes.reserve(labels.size());
    for (const std::uint32_t label : labels)
      classes.push_back(static_cast<std::uint16_t>(label & 0xffff));
    return classes;
  }
  CloudPart part = read_file_part(file, {}, session.progress, &session.executor);
  if (part.cloud.classes.empty() && part.size() > 0)
    throw Error(ErrorKind::data, file.string() + ": has no labels (a column label or class)");
  return std::move(part.cloud.classes);
}

}  // namespace adasplats
