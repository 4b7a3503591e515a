// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/shading.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace adasplats {

namespace {

constexpr Vec3f kNeutral = {0.72F, 0.72F, 0.72F};
/// Label schemes give black to what has no class; a black surface would show no shape.
constexpr std::array<std::uint8_t, 3> kUnlabelled = {0, 0, 0};

/// Muted colours that stay apart in greyscale.
Vec3f color_of(SemanticGroup group) {
  switch (group) {
    case SemanticGroup::ground: return {0.62F, 0.60F, 0.64F};
    case SemanticGroup::surface: return {0.90F, 0.76F, 0.55F};
    case SemanticGroup::linear: return {0.85F, 0.35F, 0.30F};
    case SemanticGroup::non_surface: return {0.42F, 0.66F, 0.36F};
  }
  return kNeutral;
}

/// Share of the light that a surface sends back. A lamp at the camera shows the shape; the sky from
/// above and a low sun tell ground, facades and the two sides of a street apart. Normals of clouds
/// have no reliable sign, so every term takes both sides.
float light(Vec3f normal, Vec3f view) {
  constexpr Vec3f kSun = {0.36F, 0.80F, 0.48F};
  constexpr float kAmbient = 0.22F, kHeadlight = 0.38F, kSkylight = 0.26F, kSunlight = 0.14F;
  const float sum = kAmbient + kHeadlight * std::fabs(dot(normal, view)) +
                    kSkylight * std::fabs(normal.z) + kSunlight * std::fabs(dot(normal, kSun));
  // To the power of 3/4, as screens show it: shadows stay readable. Square roots are exact
  // anywhere.
  return std::sqrt(sum * std::sqrt(sum));
}

void check_size(std::size_t values, std::size_t primitives, const char* name) {
  if (values != 0 && values != primitives)
    throw std::logic_error(std::string("an image's ") + name + " are not one a primitive");
}

}  // namespace

Shading::Shading(const ImageScene& scene, const ImageOptions& options)
    : scene_(scene), options_(options) {
  const std::size_t primitives = scene.view.primitive_count();
  check_size(scene.attributes.classes.size(), primitives, "classes");
  check_size(scene.attributes.intensities.size(), primitives, "intensities");
  check_size(scene.groups.size(), primitives, "groups");
  if (options.color == ImageColor::intensity)
    intensities_ = quantile_range(scene.attributes.intensities, 0.02, 0.98);
  if (scene.labels == nullptr) return;
  for (const SemanticClass& known : scene.labels->classes()) {
    if (known.rgb == kUnlabelled) continue;
    if (known.id >= class_colors_.size()) class_colors_.resize(known.id + std::size_t{1});
    class_colors_[known.id] = adasplats::color_of(known.rgb);
  }
}

Vec3f Shading::color(const Ray& ray, const Hit& hit) const {
  if (!hit.valid()) return background(ray.direction);
  const Vec3f normal = normal_towards(ray, hit.primitive);
  switch (options_.color) {
    case ImageColor::shading: return light(normal, ray.direction) * Vec3f{0.92F, 0.92F, 0.92F};
    case ImageColor::semantic: return light(normal, ray.direction) * semantic_color(hit.primitive);
    case ImageColor::normal: return 0.5F * (normal + Vec3f{1, 1, 1});
    case ImageColor::intensity:
      // The colour itself is the message: only a hint of the shape.
      return (0.5F + 0.5F * light(normal, ray.direction)) * intensity_color(hit.primitive);
    case ImageColor::range: return viridis(1.0F - 0.5F * std::log10(hit.t));
  }
  return kNeutral;
}

Vec3f Shading::background(Vec3f direction) const {
  const Vec3f ground = adasplats::color_of(options_.background);
  if (!options_.sky || !(direction.z > 0.0F)) return ground;
  constexpr Vec3f kZenith = {0.52F, 0.71F, 0.91F};
  const float share = std::sqrt(direction.z);  // most of the change is near the horizon
  return (1.0F - share) * ground + share * kZenith;
}

Vec3f Shading::normal_towards(const Ray& ray, std::uint32_t primitive) const {
  const std::size_t disks = scene_.view.disk_count();
  Vec3f normal;
  if (primitive < disks) {
    normal = scene_.view.disks[primitive].normal;
  } else {
    const Triangle triangle = scene_.view.mesh->triangle(primitive - disks);
    normal = cross(triangle.b - triangle.a, triangle.c - triangle.a);
    const float doubled_area = length(normal);
    // A sliver may have no area left in float and be hit all the same.
    normal = doubled_area > 0.0F ? normal / doubled_area : -ray.direction;
  }
  return dot(normal, ray.direction) > 0.0F ? -normal : normal;
}

Vec3f Shading::semantic_color(std::uint32_t primitive) const {
  if (!scene_.attributes.classes.empty()) {
    const std::uint16_t id = scene_.attributes.classes[primitive];
    if (id < class_colors_.size() && class_colors_[id]) return *class_colors_[id];
  }
  return scene_.groups.empty() ? kNeutral : color_of(scene_.groups[primitive]);
}

Vec3f Shading::intensity_color(std::uint32_t primitive) const {
  if (scene_.attributes.intensities.empty()) return kNeutral;
  const float intensity = scene_.attributes.intensities[primitive];
  if (!std::isfinite(intensity)) return kNeutral;
  return viridis((intensity - intensities_.low) / (intensities_.high - intensities_.low));
}

}  // namespace adasplats
