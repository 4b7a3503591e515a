// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/scene/city_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "adasplats/city/city_manifest.h"
#include "adasplats/core/error.h"
#include "adasplats/core/memory.h"
#include "adasplats/gpu/simulate/gpu_scene.h"
#include "adasplats/jobs/session/inputs.h"
#include "adasplats/simulate/world/world_file.h"
#include "adasplats/trace/tiled_tracer.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

/// The city that the path of a model refers to; empty: none.
fs::path city_folder(const fs::path& model) {
  if (is_city(model)) return model;
  if (model.extension() != ".toml" || !fs::exists(model)) return {};
  const WorldFile world = read_world_file(model);
  return is_city(world.model) ? world.model : fs::path();
}

std::vector<std::size_t> splats_of_tiles(const CityManifest& city) {
  std::vector<std::size_t> splats;
  for (const CityTile& tile : city.tiles) splats.push_back(tile.splats);
  return splats;
}

SeenFrom seen_from(const ScanMotion& scan, double reach_m) {
  const Vec3d at = scan.reference.world_from_sensor.translation;
  SeenFrom seen = {at, at, reach_m};
  for (const RigidTransform& knot : scan.knots) {
    seen.low = min(seen.low, knot.translation);
    seen.high = max(seen.high, knot.translation);
  }
  return seen;
}

/// The attributes of a city's splats, the same for all tiles.
class SplatValues {
 public:
  explicit SplatValues(const SplatModel& some_tile)
      : has_classes_(!some_tile.classes.empty()),
        has_intensities_(!some_tile.intensities.empty()) {}

  bool has_classes() const { return has_classes_; }
  bool has_intensities() const { return has_intensities_; }

  /// Those of a tile.
  void fill(const SplatModel& model, PrimitiveValues* values, const Executor& executor) const {
    if (model.classes.empty() == has_classes_ || model.intensities.empty() == has_intensities_)
      throw Error(ErrorKind::data,
                  "the tiles of the city have different attributes: only some have classes or "
                  "intensities");
    executor.for_chunks(model.size(), kCoarseGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        values[i] = {
            model.disks[i].normal,
            has_intensities_ ? model.intensities[i] : std::numeric_limits<float>::quiet_NaN(),
            has_classes_ ? model.classes[i] : std::uint16_t{0}, 0, 0};
    });
  }

 private:
  bool has_classes_, has_intensities_;
};

/// The attributes of objects, which follow those of the splats.
struct ObjectValues {
  std::vector<PrimitiveValues> values;
  bool has_classes = false, has_instances = false, has_intensities = false;

  ObjectValues() = default;
  ObjectValues(const PrimitiveAttributes& objects, std::size_t count)
      : values(count),
        has_classes(!objects.classes.empty()),
        has_instances(!objects.instances.empty()),
        has_intensities(!objects.intensities.empty()) {
    for (std::size_t i = 0; i < count; ++i) {
      values[i].reflectance =
          has_intensities ? objects.intensities[i] : std::numeric_limits<float>::quiet_NaN();
      if (has_classes) values[i].class_id = objects.classes[i];
      if (has_instances) values[i].instance = objects.instances[i];
    }
  }
};

/// Tiles that rays are cast into.
class CityTiles : public TileHolder {
 public:
  virtual const SceneCaster& caster() const = 0;
  /// Of all primitives of the city; the values in tiles that are not loaded are undefined.
  virtual std::span<const PrimitiveValues> values() const = 0;
};

class CpuTiles final : public CityTiles {
 public:
  CpuTiles(const CityManifest& city, const SplatValues& carried, const ObjectValues& objects,
           const Executor& executor)
      : carried_(carried), tracer_(make_tiled_tracer(splats_of_tiles(city))) {
    for (const CityTile& tile : city.tiles) first_.push_back(first_.back() + tile.splats);
    values_ = SparseArray<PrimitiveValues>(first_.back() + objects.values.size());
    std::ranges::copy(objects.values, values_.data() + first_.back());
    caster_ = make_cpu_scene_caster(*tracer_, city.origin, executor);
  }

  const SceneCaster& caster() const override { return *caster_; }
  std::span<const PrimitiveValues> values() const override {
    return {values_.data(), values_.size()};
  }

  std::size_t bytes_per_splat() const override {
    return kTiledTracerBytesPerSplat + sizeof(PrimitiveValues);
  }
  void load(std::size_t tile, SplatModel&& model, const Executor& executor) override {
    carried_.fill(model, values_.data() + first_[tile], executor);
    tracer_->build(tile, model.disks, executor);
  }
  void drop(std::size_t tile) override {
    tracer_->drop(tile);
    values_.release(first_[tile], first_[tile + 1]);
  }
  void show(std::span<const std::size_t> tiles) override { tracer_->show(tiles); }

 private:
  const SplatValues& carried_;
  std::vector<std::size_t> first_ = {0};  ///< splat of each tile
  SparseArray<PrimitiveValues> values_;
  std::unique_ptr<TiledTracer> tracer_;
  std::unique_ptr<SceneCaster> caster_;
};

class GpuTiles final : public CityTiles {
 public:
  GpuTiles(const CityManifest& city, const SplatValues& carried, const ObjectValues& objects,
           const std::vector<int>& devices)
      : carried_(carried),
        gpus_(make_gpu_city(splats_of_tiles(city), objects.values, city.origin, devices)),
        numbers_(city.splats() + objects.values.size()) {}

  const SceneCaster& caster() const override { return gpus_->scan_caster(); }
  std::span<const PrimitiveValues> values() const override {
    return {numbers_.data(), numbers_.size()};
  }

  std::size_t bytes_per_splat() const override { return GpuCity::kTileBytesASplat; }
  void load(std::size_t tile, SplatModel&& model, const Executor& executor) override {
    std::vector<PrimitiveValues> values(model.size());
    carried_.fill(model, values.data(), executor);
    gpus_->load_tile(tile, model.disks, values);
  }
  void drop(std::size_t tile) override { gpus_->drop_tile(tile); }
  void show(std::span<const std::size_t> tiles) override { gpus_->show_tiles(tiles); }

 private:
  const SplatValues& carried_;
  std::unique_ptr<GpuCity> gpus_;
  SparseArray<PrimitiveValues> numbers_;  ///< only its size is used
};

/// The smallest tile with splats.
SplatModel smallest_tile(const fs::path& folder, const CityManifest& city) {
  std::size_t smallest = city.tiles.size();
  for (std::size_t k = 0; k < city.tiles.size(); ++k)
    if (city.tiles[k].splats > 0 &&
        (smallest == city.tiles.size() || city.tiles[k].splats < city.tiles[smallest].splats))
      smallest = k;
  if (smallest == city.tiles.size()) throw Error(ErrorKind::data, folder.string() + ": no splats");
  return load_city_tile(folder, city, smallest);
}

}  // namespace

bool is_streamable(const fs::path& model) { return !city_folder(model).empty(); }

struct CityScene::Impl {
  fs::path folder;
  CityManifest city;
  SplatModel common;
  SplatValues carried;
  ObjectValues objects;
  std::optional<LabelScheme> labels;
  std::optional<World> world;
  std::unique_ptr<CityTiles> tiles;
  std::shared_ptr<PrimitiveTable> table = std::make_shared<PrimitiveTable>();
  std::unique_ptr<TileStream> stream;  ///< last, so that it ends before the members it fills

  Impl(const fs::path& model, const std::string& scheme, Session& session, std::size_t memory_bytes)
      : folder(city_folder(model)),
        city(load_city_manifest(folder)),
        common(load_model(folder / kCityCommonFile)),
        carried(smallest_tile(folder, city)) {
    labels = scheme.empty() ? load_labels_of_model(common.label_scheme, session.progress)
                            : load_label_scheme(scheme);
    if (model != folder) add_world(read_world_file(model));
    const bool on_gpu = try_on_gpu(session.device, session.progress, [&] {
      tiles = std::make_unique<GpuTiles>(city, carried, objects, session.device.gpu_numbers());
    });
    if (!on_gpu) tiles = std::make_unique<CpuTiles>(city, carried, objects, session.executor);
    table->values = tiles->values();
    table->has_classes = carried.has_classes() || objects.has_classes;
    table->has_instances = objects.has_instances;
    table->has_intensities = carried.has_intensities() || objects.has_intensities;
    table->response = common.response;
    stream = std::make_unique<TileStream>(folder, city, *tiles, memory_bytes,
                                          session.executor.threads());
  }

  void add_world(const WorldFile& file) {
    world.emplace(static_cast<std::uint32_t>(city.splats()), city.origin);
    add_objects(*world, file, labels ? *labels : LabelScheme("", {}));
    std::size_t primitives = 0;
    for (std::size_t i = 0; i < world->object_count(); ++i)
      primitives += world->geometry_view(world->object(i).geometry).primitive_count();
    objects = ObjectValues(world->object_attributes(), primitives);
  }
};

CityScene::CityScene(const fs::path& model, const std::string& labels, Session& session,
                     std::size_t memory_bytes)
    : impl_(std::make_unique<Impl>(model, labels, session, memory_bytes)) {}

CityScene::~CityScene() = default;

Vec3d CityScene::origin() const { return impl_->city.origin; }
const SceneCaster& CityScene::scan_caster() const { return impl_->tiles->caster(); }
const World* CityScene::world() const { return impl_->world ? &*impl_->world : nullptr; }
const LabelScheme* CityScene::labels() const { return impl_->labels ? &*impl_->labels : nullptr; }
std::shared_ptr<const PrimitiveTable> CityScene::primitive_table() const { return impl_->table; }
const CityManifest& CityScene::manifest() const { return impl_->city; }
TileStreamCounts CityScene::counts() const { return impl_->stream->counts(); }

float CityScene::highest_intensity() const {
  float highest = 0;
  const auto look_at = [&](std::span<const float> values) {
    for (const float value : values)
      if (std::isfinite(value)) highest = std::max(highest, value);
  };
  for (std::size_t k = 0; k < impl_->city.tiles.size(); ++k)
    if (impl_->city.tiles[k].splats > 0)
      look_at(load_city_tile(impl_->folder, impl_->city, k).intensities);
  if (impl_->world) look_at(impl_->world->object_attributes().intensities);
  return highest;
}

std::pair<Vec3d, Vec3d> CityScene::middle_box() const {
  std::optional<std::pair<Vec3d, Vec3d>> box;
  for (const CityTile& tile : impl_->city.tiles) {
    if (tile.splats == 0) continue;
    if (!box) box = {tile.low, tile.high};
    box->first = min(box->first, tile.low);
    box->second = max(box->second, tile.high);
  }
  return box.value_or(std::pair<Vec3d, Vec3d>());
}

std::size_t CityScene::prefetch(std::span<const ScanMotion> scans, double reach_m) const {
  // As far ahead as TileStream loads.
  std::vector<SeenFrom> seen;
  for (const ScanMotion& scan : scans.first(std::min(scans.size(), TileStream::kHorizon)))
    seen.push_back(seen_from(scan, reach_m));
  return impl_->stream->prefetch(seen);
}

}  // namespace adasplats
