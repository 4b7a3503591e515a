// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

#include "arrays.h"
#include "scenes.h"

namespace adasplats::python {
namespace {

constexpr const char* kCastDoc = R"(Cast rays and find the nearest hits.

origins, directions: (N, 3), or (3,) for one that all rays share; world coordinates, m; unit
vectors. float32 and float64 arrays with any strides are read in blocks without a full copy.
Coordinates are made relative to Scene.origin in float64; with local, they already are. Hits count
for t_min < t <= t_max, m (None: no limit). depth: maximum number of hits per ray, nearest first.
In a scene with opacities the hit of depth 1 is where the ray most likely ends; with more depth the
hits are the disks themselves.
Neighbouring rays of similar directions are faster. A ray that is not finite hits nothing.
Returns Hits. Raises TypeError (no numbers), ValueError (shapes).)";

constexpr const char* kHitsDoc =
    R"(Hits of rays, made by Scene.cast(): arrays have shape (N,), or (N, depth) for a depth above 1.
ranges and primitives are read-only strided views without a copy.)";

/// Rays per block: 4 MB.
constexpr std::size_t kBlock = std::size_t{1} << 17;
constexpr std::size_t kGrain = std::size_t{1} << 13;

struct Hits {
  std::shared_ptr<SceneObject> scene;
  std::vector<Hit> hits;
  std::size_t rays = 0;
  std::size_t depth = 1;

  /// (N,) or (N, depth), followed by `last`.
  std::vector<py::ssize_t> shape(std::vector<py::ssize_t> last = {}) const {
    std::vector<py::ssize_t> all = {static_cast<py::ssize_t>(rays)};
    if (depth > 1) all.push_back(static_cast<py::ssize_t>(depth));
    all.insert(all.end(), last.begin(), last.end());
    return all;
  }
};

struct CastArguments {
  double t_min = 0;
  double t_max = std::numeric_limits<double>::infinity();
  int depth = 1;
  bool local = false;

  void take(Keywords& keywords) {
    keywords.take("t_min", t_min);
    keywords.take("t_max", t_max);
    keywords.take("depth", depth);
    keywords.take("local", local);
  }
};

/// The rays of a call, made block by block.
class RayBlocks {
 public:
  RayBlocks(py::handle origins, py::handle directions, const CastArguments& arguments,
            Vec3d scene_origin)
      : origins_(origins, 3, "origins"),
        directions_(directions, 3, "directions"),
        arguments_(arguments),
        shift_(arguments.local ? Vec3d{} : scene_origin) {
    const bool fits =
        origins_.is_single() || directions_.is_single() || origins_.size() == directions_.size();
    if (!fits)
      throw py::value_error("origins and directions: expected the same number of rows, got " +
                            std::to_string(origins_.size()) + " and " +
                            std::to_string(directions_.size()));
  }

  std::size_t size() const { return origins_.is_single() ? directions_.size() : origins_.size(); }

  void fill(std::span<Ray> rays, std::size_t begin, const Executor& executor) const {
    executor.for_chunks(rays.size(), kGrain, [&](std::size_t first, std::size_t end) {
      for (std::size_t i = first; i < end; ++i) rays[i] = ray(begin + i);
    });
  }

 private:
  Ray ray(std::size_t i) const {
    Ray ray;
    ray.origin = vec_cast<float>(origins_.vector(origins_.is_single() ? 0 : i) - shift_);
    ray.direction = vec_cast<float>(directions_.vector(directions_.is_single() ? 0 : i));
    ray.t_min = static_cast<float>(arguments_.t_min);
    ray.t_max = static_cast<float>(arguments_.t_max);
    return ray;
  }

  Rows origins_;
  Rows directions_;
  CastArguments arguments_;
  Vec3d shift_;
};

void cast_blocks(const RayBlocks& blocks, Hits& out, SceneObject& object,
                 PythonProgress& progress) {
  const auto lock = object.lock();
  const Tracer& tracer = object.scene->tracer();
  std::vector<Ray> rays(std::min(kBlock, blocks.size()));
  for (std::size_t begin = 0; begin < blocks.size(); begin += kBlock) {
    const std::span block = std::span(rays).first(std::min(kBlock, blocks.size() - begin));
    blocks.fill(block, begin, object.executor);
    const std::span hits = std::span(out.hits).subspan(begin * out.depth, block.size() * out.depth);
    if (out.depth == 1) {
      tracer.nearest(block, hits, object.executor);
    } else {
      tracer.nearest_hits(block, static_cast<int>(out.depth), hits, object.executor);
    }
    progress.advance(begin);
  }
}

std::shared_ptr<Hits> cast(const std::shared_ptr<SceneObject>& object, py::handle origins,
                           py::handle directions, const py::kwargs& kwargs) {
  const auto arguments = arguments_of<CastArguments>("cast", kwargs);
  if (arguments.depth < 1 || arguments.depth > kMaxDepth)
    throw py::value_error("depth must be 1 to " + std::to_string(kMaxDepth));
  const RayBlocks blocks(origins, directions, arguments, object->scene->origin());
  auto hits = std::make_shared<Hits>();
  hits->scene = object;
  hits->depth = static_cast<std::size_t>(arguments.depth);
  hits->rays = blocks.size();
  PythonProgress progress{py::none()};
  const py::gil_scoped_release released;
  hits->hits.resize(blocks.size() * hits->depth);
  cast_blocks(blocks, *hits, *object, progress);
  return hits;
}

const Hit kNoHit;

template <class T>
py::array view_of(const py::object& self, T Hit::*member) {
  const Hits& hits = self.cast<const Hits&>();
  const Hit* const first = hits.hits.empty() ? &kNoHit : hits.hits.data();
  constexpr auto kStride = static_cast<py::ssize_t>(sizeof(Hit));
  std::vector<py::ssize_t> strides = {kStride * static_cast<py::ssize_t>(hits.depth)};
  if (hits.depth > 1) strides.push_back(kStride);
  return array_view(py::dtype::of<T>(), &(first->*member), hits.shape(), std::move(strides), self);
}

py::array valid(const Hits& hits) {
  py::array_t<bool> mask(hits.shape());
  bool* out = mask.mutable_data();
  for (const Hit& hit : hits.hits) *out++ = hit.valid();
  return mask;
}

py::object classes(const Hits& hits) {
  const std::span<const std::uint16_t> known = hits.scene->scene->attributes().classes;
  if (known.empty()) return py::none();
  std::vector<std::uint16_t> values;
  values.reserve(hits.hits.size());
  for (const Hit& hit : hits.hits)
    values.push_back(hit.valid() ? known[hit.primitive] : std::uint16_t{0});
  return owned_array(std::move(values), hits.shape());
}

Vec3f normal_of(const SceneView& view, std::uint32_t primitive) {
  if (primitive < view.disk_count()) return view.disks[primitive].normal;
  const Triangle t = view.mesh->triangle(primitive - view.disk_count());
  return normalized(cross(t.b - t.a, t.c - t.a));
}

py::array normals(const Hits& hits) {
  const SceneView view = hits.scene->scene->view();
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  std::vector<float> values;
  values.reserve(3 * hits.hits.size());
  for (const Hit& hit : hits.hits) {
    const Vec3f n = hit.valid() ? normal_of(view, hit.primitive) : Vec3f{kNone, kNone, kNone};
    values.insert(values.end(), {n.x, n.y, n.z});
  }
  return owned_array(std::move(values), hits.shape({3}));
}

}  // namespace

void add_casting(SceneClass& type) {
  type.def("cast", &cast, py::arg("origins"), py::arg("directions"),
           documented<CastArguments>("cast", "self, origins, directions", kCastDoc).c_str());
}

void bind_hits(py::module_& module) {
  module.attr("NO_PRIMITIVE") = Hit::kNone;
  py::class_<Hits, std::shared_ptr<Hits>>(module, "Hits", kHitsDoc)
      .def("__len__", [](const Hits& h) { return h.rays; })
      .def_property_readonly(
          "ranges", [](const py::object& self) { return view_of(self, &Hit::t); },
          "float32, m; inf for rays that hit nothing.")
      .def_property_readonly(
          "primitives", [](const py::object& self) { return view_of(self, &Hit::primitive); },
          "uint32: index of the splat or triangle; NO_PRIMITIVE for rays that hit nothing.")
      .def_property_readonly("valid", &valid, "bool, whether the ray hits something: a new array.")
      .def_property_readonly(
          "classes", &classes,
          "uint16, 0 for rays that hit nothing: a new array; None without classes.")
      .def_property_readonly("normals", &normals,
                             "(..., 3) float32, NaN for rays that hit nothing: a new array.");
}

}  // namespace adasplats::python
