// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/evaluate/evaluate_labels.h"

#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "adasplats/cloud/load/cloud_inputs.h"
#include "adasplats/cloud/load/cloud_part.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/error.h"
#include "adasplats/core/list_folder.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/jobs/session/inputs.h"

namespace adasplats {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// Two files with labels of the same points.
struct LabelFilePair {
  fs::path predicted;
  fs::path truth;
};

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

/// The .label files of a sequence or of a plain folder; empty if there are none.
LabelFolder label_folder(const fs::path& folder, LabelSide side) {
  std::vector<fs::path> candidates = {folder / "labels", folder};
  if (side == LabelSide::predicted) candidates.insert(candidates.begin(), folder / "predictions");
  LabelFolder labels;
  for (const fs::path& candidate : candidates) {
    for (const fs::path& file : files_by_name(candidate, ".label"))
      labels.files.emplace(file.stem().string(), file);
    labels.path = candidate;
    if (!labels.files.empty()) break;
  }
  return labels;
}

std::vector<fs::path> folders_in(const fs::path& folder) {
  std::vector<fs::path> folders;
  for (const fs::path& path : list_folder_if_any(folder)) {
    std::error_code broken;  // a broken link is not a folder
    const bool is_hidden = path.filename().string().front() == '.';
    if (!is_hidden && fs::is_directory(path, broken)) folders.push_back(path);
  }
  return folders;
}

/// The point files in a folder. Errors: those of cloud_inputs, data (a sequence: label_folder()
/// would have found its labels).
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
  for (const fs::path& parent : {path, path / "sequences"})
    for (const fs::path& folder : folders_in(parent))
      if (LabelFolder one = label_folder(folder, side); !one.files.empty())
        input.sequences.emplace(folder.filename().string(), std::move(one));
  if (input.sequences.empty()) input.sequences[""] = point_folder(path);
  return input;
}

/// Throws unless `lacking` has every name that `having` has.
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

/// The classes of all points of a file, in its order.
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

SegmentationResult no_points_of(const std::string& labels, const SegmentationOptions& options) {
  check(options);
  BenchmarkClasses classes(load_label_scheme(labels));
  SegmentationConfusion confusion(classes.classes().size());
  return {std::move(classes), std::move(confusion), options};
}

void add_files(const LabelFilePair& files, Session& session, SegmentationResult& result) {
  const std::vector<std::uint16_t> predicted = read_point_classes(files.predicted, session);
  const std::vector<std::uint16_t> truth = read_point_classes(files.truth, session);
  try {
    result.confusion.add(predicted, truth, result.classes, session.executor);
  } catch (const Error& error) {
    throw Error(error.kind(),
                files.predicted.string() + " and " + files.truth.string() + ": " + error.what());
  }
}

void require_judged(const SegmentationResult& result) {
  if (result.confusion.points() > 0) return;
  throw Error(ErrorKind::data, "none of the " + std::to_string(result.confusion.ignored()) +
                                   " true points has a class that counts");
}

Json to_json(const LabelAgreement& agreement) {
  Json json = {{"points", agreement.points}, {"agree", agreement.agree}};
  if (agreement.points > 0) {
    json["share"] = agreement.share();
    json["distance_m"] = agreement.distance_m;
  }
  return json;
}

Json confusion_json(const SegmentationConfusion& confusion, const Json& names) {
  Json counts = Json::array();
  for (std::size_t truth = 0; truth < confusion.classes(); ++truth) {
    Json row = Json::array();
    for (std::size_t predicted = 0; predicted <= confusion.classes(); ++predicted)
      row.push_back(confusion.count(truth, predicted));
    counts.push_back(row);
  }
  return {{"classes", names}, {"counts", counts}};
}

Json groups_json(const SegmentationConfusion& groups) {
  Json iou = Json::object();
  const std::vector<std::string> names = segmentation_groups();
  for (std::size_t g = 0; g < names.size(); ++g)
    if (groups.of_truth(g) > 0) iou[names[g]] = groups.iou(g);
  return {{"miou", groups.mean_iou()}, {"iou", iou}};
}

}  // namespace

LabelAgreementResult evaluate_labels(const LabelAgreementJob& job, Session& session) {
  const LabelScheme labels = load_label_scheme(job.labels);
  return compare_labels(open_kitti_sequence(resolve_cloud_input(job.simulated)),
                        open_kitti_sequence(resolve_cloud_input(job.original)), labels, job.options,
                        session.executor, session.progress);
}

SegmentationResult evaluate_segmentation(const SegmentationJob& job, Session& session) {
  SegmentationResult result = no_points_of(job.labels, job.options);
  const std::vector<LabelFilePair> pairs = pair_label_files(job.predicted, job.truth, job.scans);
  session.progress.begin_step("compare labels", pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    session.executor.check_interruption();
    add_files(pairs[i], session, result);
    session.progress.advance(i + 1);
  }
  session.progress.end_step();
  require_judged(result);
  return result;
}

SegmentationResult evaluate_segmentation(std::span<const std::uint16_t> predicted,
                                         std::span<const std::uint16_t> truth,
                                         const std::string& labels,
                                         const SegmentationOptions& options, Session& session) {
  SegmentationResult result = no_points_of(labels, options);
  result.confusion.add(predicted, truth, result.classes, session.executor);
  require_judged(result);
  return result;
}

Json to_json(const LabelAgreementResult& result) {
  Json json = {{"all", to_json(result.all)},
               {"labelled", to_json(result.labelled)},
               {"by_class", Json::object()}};
  for (const auto& [id, agreement] : result.by_class)
    json["by_class"][std::to_string(id)] = to_json(agreement);
  return json;
}

Json to_json(const SegmentationResult& result) {
  const SegmentationConfusion& confusion = result.confusion;
  const double min_share = result.options.min_share;
  Json names = Json::array(), iou = Json::object(), share = Json::object(), rare = Json::array();
  for (std::size_t c = 0; c < confusion.classes(); ++c) {
    const std::string& name = result.classes.classes()[c].name;
    names.push_back(name);
    if (confusion.of_truth(c) == 0) continue;
    iou[name] = confusion.iou(c);
    share[name] = confusion.share(c);
    if (confusion.is_rare(c, min_share)) rare.push_back(name);
  }
  return {{"miou_present", confusion.mean_iou(min_share)},
          {"accuracy", confusion.accuracy()},
          {"points", confusion.points()},
          {"ignored", confusion.ignored()},
          {"iou", iou},
          {"share", share},
          {"rare", rare},
          {"groups", groups_json(grouped(confusion, result.classes))},
          {"confusion", confusion_json(confusion, names)}};
}

}  // namespace adasplats
