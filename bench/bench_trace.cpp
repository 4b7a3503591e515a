// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Scans per second of the paper's HDL-64: our tree, our user geometry in Embree (in packets and
// single rays) and Embree's oriented discs, all in one run on the same disks and rays.
//
//   bench_trace [MODEL.ply] [--disks N] [--threads N] [--json FILE]

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/maths/median.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/jobs/provenance/provenance.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/splats/model/splat_model.h"
#include "adasplats/trace/embree.h"
#include "adasplats/trace/tracer.h"
#include "common.h"

namespace adasplats {
namespace {

constexpr int kScans = 10;   // sensor positions along the street
constexpr int kRepeats = 5;  // for medians
constexpr double kSensorHeight_m = 1.73;
constexpr float kMaxRange_m = 120.0F;

// ---- the scene -----------------------------------------------------------------------------

/// Disks in Morton order; real models are in a similar order.
std::vector<Disk> in_morton_order(const std::vector<Disk>& disks, const Executor& executor) {
  const auto spread = [](std::uint64_t v) {
    std::uint64_t bits = 0;
    for (int i = 0; i < 16; ++i) bits |= ((v >> i) & 1U) << (3 * i);
    return bits;
  };
  const auto cell = [](float v) { return static_cast<std::uint64_t>((v + 1000.0F) * 32.0F); };
  std::vector<std::uint64_t> keys;
  for (const Disk& disk : disks)
    keys.push_back(spread(cell(disk.center.x)) | (spread(cell(disk.center.y)) << 1) |
                   (spread(cell(disk.center.z)) << 2));
  std::vector<std::uint32_t> order;
  executor.sort_keys(keys, order);
  std::vector<Disk> sorted;
  for (const std::uint32_t i : order) sorted.push_back(disks[i]);
  return sorted;
}

Vec3f random_direction(Random& random) {
  const double z = random.uniform(-1, 1);
  const double angle = random.uniform(0, 6.283185307179586);
  const double flat = std::sqrt(1 - z * z);
  return vec_cast<float>(Vec3d{flat * std::cos(angle), flat * std::sin(angle), z});
}

/// `normal` tilted by a few degrees, as in real clouds.
Vec3f shaken(Vec3f normal, Random& random) {
  return normalized(normal +
                    static_cast<float>(random.uniform(0, 0.06)) * random_direction(random));
}

/// A street of 240 m: ground, two rows of facades, trees; surfaces are covered several times.
std::vector<Disk> random_street(std::size_t count, const Executor& executor) {
  constexpr double kHalfLength_m = 120, kHalfWidth_m = 12, kFacade_m = 12;
  constexpr double kArea_m2 = 2 * kHalfLength_m * (2 * kHalfWidth_m + 2 * kFacade_m);
  constexpr double kCover = 4;  // disks per point of the ground or a facade
  const double mean_radius_m =
      std::sqrt(kCover * kArea_m2 / (0.8 * static_cast<double>(count) * 3.14159265358979));
  std::vector<Disk> disks;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(1, 0, i);
    const double part = random.uniform();
    const double x = random.uniform(-kHalfLength_m, kHalfLength_m);
    const float radius = static_cast<float>(mean_radius_m * random.uniform(0.5, 1.4));
    const double shift = 0.01 * random.normal();
    if (part < 0.4) {
      const double y = random.uniform(-kHalfWidth_m, kHalfWidth_m);
      disks.push_back({vec_cast<float>(Vec3d{x, y, shift}), radius, shaken({0, 0, 1}, random)});
    } else if (part < 0.8) {
      const double side = random.uniform() < 0.5 ? -1 : 1;
      const Vec3d center = {x, side * (kHalfWidth_m + shift), random.uniform(0, kFacade_m)};
      disks.push_back({vec_cast<float>(center), radius, shaken({0, 1, 0}, random)});
    } else {
      const double tree_x = std::round(x / 12) * 12 + 6;
      const double side = random.uniform() < 0.5 ? -1 : 1;
      const Vec3f out = random_direction(random);
      const float reach = static_cast<float>(2.0 * std::cbrt(random.uniform()));
      const Vec3f crown = vec_cast<float>(Vec3d{tree_x, side * 8, 5});
      disks.push_back({crown + reach * out, radius, random_direction(random)});
    }
  }
  return in_morton_order(disks, executor);
}

/// Rays of `kScans` scans along the middle of the scene's box, above the ground (the median height
/// of the lower half of the disks).
std::vector<std::vector<Ray>> make_scans(const std::vector<Disk>& disks) {
  std::vector<float> xs, ys, zs;
  for (std::size_t i = 0; i < disks.size(); i += 1 + disks.size() / 100'000) {
    xs.push_back(disks[i].center.x);
    ys.push_back(disks[i].center.y);
    zs.push_back(disks[i].center.z);
  }
  for (auto* values : {&xs, &ys, &zs}) std::ranges::sort(*values);
  const auto quantile = [](const std::vector<float>& values, double q) {
    return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
  };
  const LidarModel sensor = hdl_64_paper();
  const std::vector<Firing> firings = firings_of(sensor);
  std::vector<std::vector<Ray>> scans;
  for (int scan = 0; scan < kScans; ++scan) {
    const double share = 0.1 + 0.8 * scan / (kScans - 1);
    const Vec3f eye = {quantile(xs, share), quantile(ys, 0.5),
                       quantile(zs, 0.25) + static_cast<float>(kSensorHeight_m)};
    std::vector<Ray> rays;
    for (const Firing& firing : firings) rays.push_back({eye, 0.0F, firing.direction, kMaxRange_m});
    scans.push_back(std::move(rays));
  }
  return scans;
}

// ---- Embree's oriented discs ---------------------------------------------------------------

class EmbreeDiscs {
 public:
  EmbreeDiscs(const std::vector<Disk>& disks, int threads) {
    for (const Disk& disk : disks) {
      points_.insert(points_.end(), {disk.center.x, disk.center.y, disk.center.z, disk.radius});
      normals_.push_back(disk.normal);
    }
    normals_.push_back({});  // Embree reads 16 bytes of the last normal
    device_ = rtcNewDevice(("threads=" + std::to_string(threads)).c_str());
    scene_ = rtcNewScene(device_);
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                               points_.data(), 0, 4 * sizeof(float), disks.size());
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_NORMAL, 0, RTC_FORMAT_FLOAT3,
                               normals_.data(), 0, sizeof(Vec3f), disks.size());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~EmbreeDiscs() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreeDiscs(const EmbreeDiscs&) = delete;
  EmbreeDiscs& operator=(const EmbreeDiscs&) = delete;

  void nearest_singly(std::span<const Ray> rays, std::span<Hit> hits,
                      const Executor& executor) const {
    executor.for_chunks(rays.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) hits[i] = cast(rays[i]);
    });
  }

  /// In coherent packets of 16, like our tracer.
  void nearest_in_packets(std::span<const Ray> rays, std::span<Hit> hits,
                          const Executor& executor) const {
    executor.for_chunks(rays.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; i += 16)
        cast_packet(rays.subspan(i, std::min<std::size_t>(16, end - i)), hits.subspan(i));
    });
  }

 private:
  Hit cast(const Ray& ray) const {
    RTCRayHit single{};
    single.ray = {ray.origin.x,
                  ray.origin.y,
                  ray.origin.z,
                  ray.t_min,
                  ray.direction.x,
                  ray.direction.y,
                  ray.direction.z,
                  0.0F,
                  ray.t_max,
                  ~0U,
                  0,
                  0};
    single.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    single.hit.primID = Hit::kNone;
    embree::QueryContext context;
    embree::init(context);
    embree::intersect(scene_, context, single);
    return {single.hit.primID == Hit::kNone ? HUGE_VALF : single.ray.tfar, single.hit.primID};
  }

  void cast_packet(std::span<const Ray> rays, std::span<Hit> hits) const {
    RTCRayHit16 packet{};
    alignas(64) int valid[16];
    for (std::size_t i = 0; i < 16; ++i) {
      const Ray& ray = rays[std::min(i, rays.size() - 1)];
      valid[i] = i < rays.size() ? -1 : 0;
      packet.ray.org_x[i] = ray.origin.x;
      packet.ray.org_y[i] = ray.origin.y;
      packet.ray.org_z[i] = ray.origin.z;
      packet.ray.tnear[i] = ray.t_min;
      packet.ray.dir_x[i] = ray.direction.x;
      packet.ray.dir_y[i] = ray.direction.y;
      packet.ray.dir_z[i] = ray.direction.z;
      packet.ray.tfar[i] = ray.t_max;
      packet.ray.mask[i] = ~0U;
      packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.primID[i] = Hit::kNone;
    }
    embree::QueryContext context;
    embree::init(context);
    embree::intersect(scene_, context, valid, packet);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const bool hit = packet.hit.primID[i] != Hit::kNone;
      hits[i] = {hit ? packet.ray.tfar[i] : HUGE_VALF, packet.hit.primID[i]};
    }
  }

  std::vector<float> points_;
  std::vector<Vec3f> normals_;
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
};

// ---- measuring -----------------------------------------------------------------------------

struct Figure {
  std::string name;
  std::function<void(std::span<const Ray>, std::span<Hit>)> cast;
  std::vector<double> rates = {};  ///< scans/s, one per repeat
  std::size_t hits = 0;

  double median_rate() const { return upper_median_of(std::vector(rates)); }
};

/// Alternates between the contestants, so that other load on the machine affects all of them.
void measure(std::vector<Figure>& figures, const std::vector<std::vector<Ray>>& scans) {
  std::vector<Hit> hits(scans.front().size());
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    for (Figure& figure : figures) {
      figure.hits = 0;
      double seconds = 0;
      for (const std::vector<Ray>& rays : scans) {
        const Stopwatch watch;
        figure.cast(rays, hits);
        seconds += watch.seconds();
        figure.hits += static_cast<std::size_t>(std::ranges::count_if(hits, &Hit::valid));
      }
      figure.rates.push_back(static_cast<double>(scans.size()) / seconds);
    }
  }
}

struct BuildTime {
  std::string name;
  double seconds;  ///< median
};

void report(const std::vector<Figure>& figures, const std::vector<BuildTime>& builds,
            const bench::Arguments& arguments, const Executor& executor, std::size_t disks,
            std::size_t rays) {
  std::printf("%zu disks, %d threads, %zu rays per scan\n", disks, executor.threads(), rays);
  nlohmann::json build_seconds;
  for (const BuildTime& build : builds) {
    std::printf("%-34s built in %.3f s\n", build.name.c_str(), build.seconds);
    build_seconds[build.name] = build.seconds;
  }
  nlohmann::json rows = nlohmann::json::array();
  for (const Figure& figure : figures) {
    const double ratio = figures.front().median_rate() / figure.median_rate();
    std::printf("%-34s %8.1f scans/s   ours is %.2fx   %zu hits\n", figure.name.c_str(),
                figure.median_rate(), ratio, figure.hits);
    rows.push_back({{"name", figure.name},
                    {"scans_per_second", figure.median_rate()},
                    {"ratio_of_ours", ratio},
                    {"hits", figure.hits}});
  }
  if (!arguments.has("--json")) return;
  double fastest_discs = 0;  // of Embree, in packets or single rays
  for (const Figure& figure : figures) {
    if (figure.name.starts_with("Embree's"))
      fastest_discs = std::max(fastest_discs, figure.median_rate());
  }
  const nlohmann::ordered_json result = {{"provenance", to_json(provenance_of(executor.threads()))},
                                         {"disks", disks},
                                         {"threads", executor.threads()},
                                         {"rays_per_scan", rays},
                                         {"build_seconds", build_seconds},
                                         {"model", arguments.input(0)},
                                         {"ours_per_s", figures.front().median_rate()},
                                         {"embree_discs_per_s", fastest_discs},
                                         {"figures", rows}};
  write_file(arguments.text("--json"), result.dump(2) + "\n");
}

void run(const bench::Arguments& arguments) {
  const Executor executor(arguments.number("--threads", 0));
  const std::vector<Disk> disks =
      arguments.inputs().empty()
          ? random_street(arguments.number<std::size_t>("--disks", 1'700'000), executor)
          : load_model(arguments.input(0)).disks;
  if (disks.empty()) throw std::runtime_error("the model has no disks");
  const auto scans = make_scans(disks);

  std::vector<BuildTime> builds;
  const auto built = [&](const char* name, const auto& make) {
    std::vector<double> seconds;
    std::unique_ptr<Tracer> tracer;
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
      tracer.reset();
      const Stopwatch watch;
      tracer = make();
      seconds.push_back(watch.seconds());
    }
    builds.push_back({name, upper_median_of(seconds)});
    return tracer;
  };
  const SceneView scene = {disks, nullptr};
  const auto wide = built("wide", [&] { return make_wide_tracer(scene, executor); });
  const auto user = built("user geometry", [&] { return make_embree_tracer(scene, executor); });
  const EmbreeDiscs discs(disks, executor.threads());

  constexpr int kDepth = 5;
  std::vector<Hit> lists(kDepth * scans.front().size());
  const auto cast_lists = [&](const Tracer& tracer, auto rays, auto hits) {
    tracer.nearest_hits(rays, kDepth, lists, executor);
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = lists[kDepth * i];
  };
  std::vector<Figure> figures = {
      {"ours: wide tree", [&](auto rays, auto hits) { wide->nearest(rays, hits, executor); }},
      {"ours: user geometry, packets",
       [&](auto rays, auto hits) { user->nearest(rays, hits, executor); }},
      {"ours: user geometry, single rays",
       [&](auto rays, auto hits) { user->nearest_hits(rays, 1, hits, executor); }},
      {"Embree's oriented discs, packets",
       [&](auto rays, auto hits) { discs.nearest_in_packets(rays, hits, executor); }},
      {"Embree's oriented discs, single",
       [&](auto rays, auto hits) { discs.nearest_singly(rays, hits, executor); }},
      {"nearest 5: wide tree", [&](auto rays, auto hits) { cast_lists(*wide, rays, hits); }},
      {"nearest 5: user geometry", [&](auto rays, auto hits) { cast_lists(*user, rays, hits); }}};
  measure(figures, scans);
  report(figures, builds, arguments, executor, disks.size(), scans.front().size());
}

}  // namespace
}  // namespace adasplats

int main(int argc, char** argv) {
  return adasplats::bench::exit_code_of("bench_trace", [&] {
    adasplats::run(
        {argc, argv, "bench_trace [MODEL.ply] [--disks N] [--threads N] [--json FILE]", 0, 1});
  });
}
