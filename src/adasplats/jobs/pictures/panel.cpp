// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/pictures/panel.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/core/error.h"
#include "adasplats/jobs/session/inputs.h"
#include "adasplats/report/text_format.h"
#include "adasplats/simulate/captions/captions.h"
#include "adasplats/simulate/captions/color_bar.h"
#include "adasplats/simulate/captions/plate.h"
#include "adasplats/simulate/image/class_colors.h"
#include "adasplats/simulate/image/point_colors.h"
#include "adasplats/simulate/image/shading_maths.h"

namespace adasplats {
namespace {

/// Errors beyond it have the colour at the end of the scale.
constexpr float kWrong_m = 0.5F;
constexpr Rgb kHole = {255, 170, 0};
constexpr Rgb kNotChecked = {150, 150, 150};

bool has_values(ImageColor color) {
  return color == ImageColor::intensity || color == ImageColor::height;
}

std::vector<Rgb> error_colors(std::span<const float> errors_m) {
  std::vector<Rgb> colors;
  colors.reserve(errors_m.size());
  for (const float error_m : errors_m)
    colors.push_back(std::isnan(error_m)
                         ? kHole
                         : signed_scale().at(0.5 + 0.5 * static_cast<double>(error_m / kWrong_m)));
  return colors;
}

/// Where a point is in the picture: column, row and distance; nothing where it is outside.
std::optional<Vec3d> in_picture(const Camera& camera, Vec3d world) {
  const Vec3d p = camera.world_from_camera.inverse() * world;
  if (!(p.x > 0.1)) return std::nullopt;
  const auto inside = [&](Vec3d at) {
    return at.x >= 0 && at.y >= 0 && at.x < camera.width && at.y < camera.height;
  };
  if (camera.lens) {
    const auto pixel = project(*camera.lens, {-p.y, -p.z, p.x});
    if (!pixel || !inside({pixel->x + 0.5, pixel->y + 0.5, p.x})) return std::nullopt;
    return Vec3d{pixel->x + 0.5, pixel->y + 0.5, p.x};
  }
  const double px_per_m =
      camera.orthographic_width_m > 0
          ? camera.width / camera.orthographic_width_m
          : 0.5 * camera.width / std::tan(0.5 * camera.horizontal_fov_rad) / p.x;
  const Vec3d at = {0.5 * camera.width - px_per_m * p.y, 0.5 * camera.height - px_per_m * p.z, p.x};
  if (!inside(at)) return std::nullopt;
  return at;
}

}  // namespace

bool is_model_file(const std::filesystem::path& input) {
  return input.extension() == ".toml" || is_splat_model(input) ||
         (std::filesystem::is_regular_file(input) && is_mesh_file(input));
}

Panel::Panel(const std::filesystem::path& input, const std::string& labels, Session& session) {
  if (is_model_file(input)) {
    auto scene = std::make_shared<ModelScene>(input, labels, session, WorldFiles::taken);
    if (scene->world() != nullptr) world_ = scene;
    model_ = std::move(scene);
    return;
  }
  const std::filesystem::path resolved = resolve_cloud_input(input);
  const std::span inputs(&resolved, 1);
  labels_ = label_scheme_for(labels, inputs);
  if (std::filesystem::is_regular_file(resolved) && has_error_points(resolved)) {
    ErrorPoints points = read_error_points(resolved);
    cloud_ = std::move(points.cloud);
    point_errors_m_ = std::move(points.errors_m);
  } else {
    LoadOptions load;
    load.other_columns = KeptColumns::colors;
    cloud_ = load_cloud(inputs, load, session.executor, session.progress).first;
  }
  if (cloud_.empty()) throw Error(ErrorKind::data, input.string() + ": no points");
}

void Panel::show_errors(const std::filesystem::path& errors) {
  show_errors(read_error_points(errors), errors);
}

void Panel::show_errors(const ErrorPoints& points, const std::filesystem::path& name) {
  if (!model_ || model_->splats() == nullptr || world_)
    throw Error(ErrorKind::usage, "errors are shown on splat models; draw " + name.string() +
                                      " by itself to see its points");
  SplatErrors errors(model_->splats()->size());
  errors.add(points, name);
  splat_errors_m_ = errors.means_m();
  holes_.clear();
  for (std::size_t i = 0; i < points.cloud.size(); ++i)
    if (std::isnan(points.errors_m[i])) holes_.push_back(points.cloud.world(i));
}

void Panel::show_at(std::optional<double> time_s, Session& session) {
  if (!world_) return;
  const double shown_s = time_s.value_or(world_->world()->motion_begin_s().value_or(0));
  if (shown_s_ == shown_s) return;
  world_->show_at(shown_s, session);
  shown_s_ = shown_s;
}

ShownPart Panel::shown_part() const {
  return model_ ? model_->shown_part() : adasplats::shown_part(cloud_.positions, cloud_.origin);
}

double Panel::origin_z() const { return model_ ? model_->origin().z : cloud_.origin.z; }

void Panel::prepare(const PanelLook& look, SharedRange& range) {
  if (!splat_errors_m_.empty()) {
    color_ = ImageColor::error;
    range_ = ValueRange{-kWrong_m, kWrong_m};
    return;
  }
  color_ = look.color.value_or(model_ ? model_->default_color()
                                      : default_color(cloud_, labels_ ? &*labels_ : nullptr));
  if (model_ && color_ == ImageColor::rgb && model_->image_scene().colors.empty())
    throw Error(ErrorKind::usage,
                "color rgb: the model has no colours (those of files with red, "
                "green and blue are kept by 'adasplats model')");
  if (!has_values(color_) || !point_errors_m_.empty()) return;
  const float lift = color_ == ImageColor::height ? static_cast<float>(origin_z()) : 0.0F;
  if (!range.contains(color_)) {
    const ValueRange own =
        model_ ? shown_range(model_->image_scene(), color_) : shown_range(cloud_, color_);
    range[color_] = {own.low + lift, own.high + lift};
  }
  range_ = ValueRange{range[color_].low - lift, range[color_].high - lift};
}

Image Panel::draw_model(const Camera& camera, const PanelLook& look) const {
  ImageOptions options;
  options.color = color_;
  options.samples_per_axis = look.samples_per_axis;
  options.relief = look.relief;
  options.range = range_;
  if (splat_errors_m_.empty()) return model_->render(camera, options);
  Image image = model_->render(camera, options, splat_errors_m_);
  mark_holes(image, camera);
  return image;
}

Image Panel::draw_cloud(const Camera& camera, const PanelLook& look,
                        const Executor& executor) const {
  PointImageOptions options;
  options.relief = look.relief;
  if (!point_errors_m_.empty()) {
    options.background = {22, 22, 26};  // what is right is white
    options.sky = options.relief = false;
    return draw_points(cloud_.positions, cloud_.origin, error_colors(point_errors_m_), camera,
                       options, executor);
  }
  std::vector<Rgb> colors = point_colors(cloud_, labels_ ? &*labels_ : nullptr, color_,
                                         camera.world_from_camera.translation, range_);
  if (color_ == ImageColor::semantic)
    std::transform(colors.begin(), colors.end(), colors.begin(), muted);
  return draw_points(cloud_.positions, cloud_.origin, colors, camera, options, executor);
}

Image Panel::draw(const Camera& camera, const PanelLook& look, const Executor& executor) const {
  return model_ ? draw_model(camera, look) : draw_cloud(camera, look, executor);
}

/// Dots where beams fell through the model and nothing of it is in front.
void Panel::mark_holes(Image& image, const Camera& camera) const {
  constexpr double kNearer_m = 0.3;
  std::vector<Ray> rays;
  std::vector<Vec3d> places;
  for (const Vec3d& hole : holes_) {
    const std::optional<Vec3d> at = in_picture(camera, hole);
    if (!at) continue;
    rays.push_back(camera.ray(at->x, at->y, model_->origin()));
    places.push_back(*at);
  }
  std::vector<Hit> hits(rays.size());
  model_->picture_tracer().nearest(rays, hits, model_->executor());
  const Vec3d forward = camera.world_from_camera.rotation * Vec3d{1, 0, 0};
  const double size_px = std::max(3.0, image.height / 300.0);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const double depth =
        static_cast<double>(hits[i].t) * dot(vec_cast<double>(rays[i].direction), forward);
    if (hits[i].valid() && depth < places[i].z - kNearer_m) continue;
    draw_line(image, places[i], places[i], size_px, kHole);
  }
}

void Panel::write_legend(Image& image) const {
  if (!splat_errors_m_.empty() || !point_errors_m_.empty()) {
    ColorBarText text{"predicted less measured range, m",
                      {{0, "-0.5 early"}, {0.5, "0"}, {1, "late +0.5"}},
                      {{kHole, "hole: the beam hit nothing"}}};
    if (!splat_errors_m_.empty()) text.keys.push_back({kNotChecked, "no held-out beam hit it"});
    draw_color_bar(image, signed_scale(), text);
    return;
  }
  if (color_ == ImageColor::semantic) {
    draw_classes(image, model_ ? legend_of(model_->image_scene())
                               : legend_of(cloud_.classes, labels_ ? &*labels_ : nullptr));
  } else if (has_values(color_) && range_) {
    const double lift = color_ == ImageColor::height ? origin_z() : 0;
    draw_color_bar(image, viridis_scale(),
                   {color_ == ImageColor::height ? "height, m" : "intensity",
                    {{0, page::measure_text(range_->low + lift)},
                     {1, page::measure_text(range_->high + lift)}},
                    {}});
  } else if (color_ == ImageColor::range) {
    draw_color_bar(image, viridis_scale(), {"range, m", {{0, "100"}, {0.5, "10"}, {1, "1"}}, {}});
  }
}

void Panel::write_captions(Image& image, const Camera& camera, const std::string& title,
                           std::optional<Vec3d> middle) const {
  write_legend(image);
  write_place(image, camera, title, middle);
}

void Panel::write_place(Image& image, const Camera& camera, const std::string& title,
                        std::optional<Vec3d> middle) const {
  draw_title(image, title);
  draw_north(image, camera, crs().empty() ? "y" : "N");
  if (!middle) return;
  const bool parallel = camera.orthographic_width_m > 0;
  const Vec3d forward = camera.world_from_camera.rotation * Vec3d{1, 0, 0};
  const double depth_m = dot(forward, *middle - camera.world_from_camera.translation);
  if (!parallel && !(depth_m > 0)) return;
  const double px_per_m =
      parallel ? camera.width / camera.orthographic_width_m
               : 0.5 * camera.width / std::tan(0.5 * camera.horizontal_fov_rad) / depth_m;
  draw_scale_bar(image, scale_bar(px_per_m, image.width / 6), parallel ? "" : "at the middle");
}

Image blank_image(int width, int height) {
  Image image{width, height, {}};
  image.pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
  return image;
}

void paste(Image& picture, const Image& part, int left, int top) {
  const std::size_t row_bytes = static_cast<std::size_t>(part.width) * 3;
  for (int row = 0; row < part.height; ++row) {
    const auto from = part.pixels.begin() +
                      static_cast<std::ptrdiff_t>(row_bytes * static_cast<std::size_t>(row));
    const std::size_t to =
        (static_cast<std::size_t>(top + row) * static_cast<std::size_t>(picture.width) +
         static_cast<std::size_t>(left)) *
        3;
    std::copy(from, from + static_cast<std::ptrdiff_t>(row_bytes),
              picture.pixels.begin() + static_cast<std::ptrdiff_t>(to));
  }
}

namespace {

constexpr std::size_t kMaxEntries = 14;
constexpr std::size_t kMinShare = 1000;  // one in so many

struct Entry {
  std::uint64_t count = 0;
  Rgb rgb{};
  std::string name;
};

ClassLegend commonest(std::vector<Entry> entries, std::size_t all) {
  std::erase_if(entries, [&](const Entry& entry) {
    return entry.count == 0 || entry.count * kMinShare < all;
  });
  std::stable_sort(entries.begin(), entries.end(),
                   [](const Entry& a, const Entry& b) { return a.count > b.count; });
  if (entries.size() > kMaxEntries) entries.resize(kMaxEntries);
  ClassLegend legend;
  for (Entry& entry : entries) legend.emplace_back(entry.rgb, std::move(entry.name));
  return legend;
}

}  // namespace

ClassLegend legend_of(std::span<const std::uint16_t> classes, const LabelScheme* labels) {
  if (labels == nullptr) return {};
  std::vector<std::uint64_t> counts(0x10000, 0);
  for (const std::uint16_t id : classes) ++counts[id];
  std::vector<Entry> entries;
  for (const SemanticClass& known : labels->classes())
    if (known.rgb != kNoClassColor)
      entries.push_back({counts[known.id], muted(known.rgb), known.name});
  return commonest(std::move(entries), classes.size());
}

ClassLegend legend_of(const ImageScene& scene) {
  if (!scene.attributes.classes.empty()) return legend_of(scene.attributes.classes, scene.labels);
  std::vector<Entry> entries(kSemanticGroups);
  for (int group = 0; group < kSemanticGroups; ++group) {
    Entry& entry = entries[static_cast<std::size_t>(group)];
    entry.rgb = rgb_of(shading::color_of(static_cast<SemanticGroup>(group)));
    entry.name = name_of(static_cast<SemanticGroup>(group));
  }
  for (const SemanticGroup group : scene.groups) ++entries[static_cast<std::size_t>(group)].count;
  return commonest(std::move(entries), scene.groups.size());
}

}  // namespace adasplats
