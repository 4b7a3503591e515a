// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/model/gaussian_usd.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/splats/model/gaussians.h"
#include "adasplats/splats/model/model_comments.h"

namespace adasplats {
namespace {

/// Text of a file of USD, with the shortest numbers that read back as the same floats.
class UsdText {
 public:
  explicit UsdText(AtomicFile& file) : file_(file) {}
  ~UsdText() = default;
  UsdText(const UsdText&) = delete;
  UsdText& operator=(const UsdText&) = delete;

  UsdText& operator<<(std::string_view text) {
    file_.write(text.data(), text.size());
    return *this;
  }
  UsdText& operator<<(float value) {
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    return *this << std::string_view(digits.data(), static_cast<std::size_t>(end - digits.data()));
  }
  /// "NAME = [...]": a number or a tuple for each splat, as of(i) writes it.
  template <class Of>
  void array(std::string_view name, std::span<const std::uint32_t> splats, const Of& of,
             std::string_view metadata = "") {
    *this << "        " << name << " = [";
    for (const std::uint32_t& i : splats) {
      if (&i != splats.data()) *this << ", ";
      of(i);
    }
    *this << "]" << metadata << "\n";
  }
  template <std::size_t N>
  void tuple(const std::array<float, N>& values) {
    for (std::size_t k = 0; k < N; ++k) *this << (k == 0 ? "(" : ", ") << values[k];
    *this << ")";
  }

 private:
  AtomicFile& file_;
};

/// A string of USD in quotes.
std::string usd_quoted(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c == '\n' || c == '\r' ? ' ' : c;
  }
  return quoted + "\"";
}

/// A name as USD allows it for prims, different from those in `used`.
std::string prim_name(std::string_view text, std::set<std::string>& used) {
  std::string name;
  for (const char c : text)
    name += std::isalnum(static_cast<unsigned char>(c)) != 0 && c > 0 ? c : '_';
  if (name.empty() || std::isdigit(static_cast<unsigned char>(name.front())) != 0)
    name.insert(0, "class_");
  while (!used.insert(name).second) name += '_';
  return name;
}

void write_head(UsdText& usd, const SplatModel& model) {
  usd << "#usda 1.0\n(\n    customLayerData = {\n        string[] adasplats = [";
  const std::vector<std::string> comments = comments_of(model);
  for (std::size_t i = 0; i < comments.size(); ++i)
    usd << (i == 0 ? "" : ", ") << usd_quoted(comments[i]);
  usd << "]\n";
  if (!model.crs.empty()) usd << "        string crs = " << usd_quoted(model.crs.name()) << "\n";
  usd << "    }\n    defaultPrim = \"Model\"\n    metersPerUnit = 1\n    upAxis = \"Z\"\n)\n\n"
      << "def Xform \"Model\" (\n    kind = \"component\"\n)\n{\n";
  const Vec3d o = model.origin;
  usd << "    double3 xformOp:translate = (" << exact_text(o.x) << ", " << exact_text(o.y) << ", "
      << exact_text(o.z) << ")\n    uniform token[] xformOpOrder = [\"xformOp:translate\"]\n";
}

/// The box of the splats, three standard deviations around their centers.
std::array<std::array<float, 3>, 2> extent_of(const SplatModel& model,
                                              std::span<const std::uint32_t> splats) {
  constexpr float kReach = 3;
  std::array<std::array<float, 3>, 2> box{};
  for (int axis = 0; axis < 3; ++axis)
    for (const std::uint32_t& i : splats) {
      const Disk& disk = model.disks[i];
      const auto sigma = static_cast<float>(gaussian_sigma(disk, !model.opacities.empty()));
      const auto k = static_cast<std::size_t>(axis);
      const float low = disk.center[axis] - kReach * sigma, high = low + 2 * kReach * sigma;
      const bool is_first = &i == splats.data();
      box[0][k] = is_first ? low : std::min(box[0][k], low);
      box[1][k] = is_first ? high : std::max(box[1][k], high);
    }
  return box;
}

void write_splats(UsdText& usd, const SplatModel& model, std::span<const ColorBytes> colors,
                  std::span<const std::uint32_t> splats) {
  const bool is_soft = !model.opacities.empty();
  const auto box = extent_of(model, splats);
  usd << "        float3[] extent = [";
  usd.tuple(box[0]);
  usd << ", ";
  usd.tuple(box[1]);
  usd << "]\n";
  usd.array("point3f[] positions", splats, [&](std::uint32_t i) {
    const Vec3f p = model.disks[i].center;
    usd.tuple(std::array{p.x, p.y, p.z});
  });
  usd.array("quatf[] orientations", splats, [&](std::uint32_t i) {
    const Quaternion q = rotation_from_z(vec_cast<double>(model.disks[i].normal));
    usd.tuple(std::array{static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y),
                         static_cast<float>(q.z)});
  });
  usd.array("float3[] scales", splats, [&](std::uint32_t i) {
    const double sigma = gaussian_sigma(model.disks[i], is_soft);
    const auto across = static_cast<float>(sigma);
    usd.tuple(std::array{across, across, static_cast<float>(kGaussianThickness * sigma)});
  });
  usd.array("float[] opacities", splats,
            [&](std::uint32_t i) { usd << (is_soft ? model.opacities[i] : 1.0F); });
  usd << "        int radiance:sphericalHarmonicsDegree = 0\n";
  usd.array("float3[] radiance:sphericalHarmonicsCoefficients", splats, [&](std::uint32_t i) {
    usd.tuple(std::array{harmonic_of(colors[i][0]), harmonic_of(colors[i][1]),
                         harmonic_of(colors[i][2])});
  });
  constexpr std::string_view kByVertex = " (\n            interpolation = \"vertex\"\n        )";
  const auto primvar = [&](const char* name, const std::vector<float>& values) {
    if (values.empty()) return;
    usd.array(
        std::string("float[] primvars:") + name, splats,
        [&](std::uint32_t i) { usd << (std::isfinite(values[i]) ? values[i] : 0.0F); }, kByVertex);
  };
  primvar("intensity", model.intensities);
  primvar("drop", model.drop_log_odds);
}

}  // namespace

void write_gaussian_usd(const std::filesystem::path& path, const SplatModel& model,
                        std::span<const ColorBytes> colors, const LabelScheme* labels) {
  if (colors.size() != model.size())
    throw std::logic_error("write_gaussian_usd: the number of colours is not the number of disks");
  std::map<std::uint16_t, std::vector<std::uint32_t>> by_class;
  for (std::size_t i = 0; i < model.size(); ++i)
    by_class[model.classes.empty() ? std::uint16_t{0} : model.classes[i]].push_back(
        static_cast<std::uint32_t>(i));
  AtomicFile file(path);
  UsdText usd(file);
  write_head(usd, model);
  std::set<std::string> used;
  for (const auto& [class_id, splats] : by_class) {
    const SemanticClass* const found = labels == nullptr ? nullptr : labels->find(class_id);
    const std::string name = found == nullptr ? std::to_string(class_id) : found->name;
    usd << "\n    def ParticleField3DGaussianSplat \""
        << prim_name(model.classes.empty() ? "splats" : name, used) << "\"";
    if (!model.classes.empty())
      usd << " (\n        prepend apiSchemas = [\"SemanticsLabelsAPI:class\"]\n    )";
    usd << "\n    {\n";
    if (!model.classes.empty())
      usd << "        token[] semantics:labels:class = [" << usd_quoted(name) << "]\n";
    write_splats(usd, model, colors, splats);
    usd << "    }\n";
  }
  usd << "}\n";
  file.commit();
}

}  // namespace adasplats
