// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/image/posed_scene.h"

#include <gtest/gtest.h>

#include <cmath>

#include "adasplats/core/maths/random.h"
#include "adasplats/trace/tracer.h"

namespace adasplats {
namespace {

constexpr Vec3d kPosedOrigin = {650'000, 6'860'000, 30};

/// Disks of 0.6 m, 0.5 m apart, in a square of 2 * half m; normal along an axis.
SplatModel plate(float half_m, int axis, std::uint16_t class_id) {
  SplatModel model;
  for (float a = -half_m; a <= half_m; a += 0.5F)
    for (float b = -half_m; b <= half_m; b += 0.5F) {
      Disk disk;
      disk.radius = 0.6F;
      disk.normal[axis] = 1;
      disk.center[(axis + 1) % 3] = a;
      disk.center[(axis + 2) % 3] = b;
      model.disks.push_back(disk);
      model.classes.push_back(class_id);
    }
  return model;
}

MeshModel wall() {
  MeshModel model;
  model.mesh.vertices = {{0, -2, -1}, {0, 2, -1}, {0, 2, 1}, {0, -2, 1}};
  model.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return model;
}

RigidTransform at(double x, double y, double yaw_rad) {
  return {rotation_from_yaw_pitch_roll(yaw_rad, 0, 0), kPosedOrigin + Vec3d{x, y, 0}};
}

class PosedSceneTest : public testing::Test {
 protected:
  PosedSceneTest() {
    place_.origin = kPosedOrigin;
    for (Disk& disk : place_.disks) disk.center.z -= 1.5F;
    scene_.view = place_.view();
    scene_.attributes.classes = place_.classes;
    scene_.origin = kPosedOrigin;
    SplatModel car = plate(1, 1, 252);
    car.origin = {0, 0.5, 0};
    add(std::move(car), {{0, at(8, -2, 0.2)}, {1, at(8, 3, 0.9)}}).scale = 1.25;
    world_.add_object(last_);
    add(wall(), {{0, at(-6, 1, 0.3)}}).class_id = 50;
    world_.add_object(last_);
    add(wall(), {{0, at(3, 0, 0)}, {0.1, at(3, 0, 0)}}).only_during = true;
    world_.add_object(last_);
  }

  WorldObject& add(AnyModel geometry, Trajectory trajectory) {
    last_ = {};
    last_.geometry = world_.add_geometry(std::move(geometry));
    last_.trajectory = std::move(trajectory);
    return last_;
  }

  Executor executor_{2};
  SplatModel place_ = plate(20, 2, 40);
  ImageScene scene_;
  World world_{static_cast<std::uint32_t>(place_.size()), kPosedOrigin};
  WorldObject last_;
};

// Oracle: the hits of scans, which cast the objects one by one in their own frames.
TEST_F(PosedSceneTest, RaysMeetWhatScansMeet) {
  constexpr double kTime_s = 0.6;
  const PosedScene posed(scene_, world_, kTime_s);
  const ImageScene shown = posed.scene();
  ASSERT_EQ(shown.attributes.classes.size(), shown.view.primitive_count());
  std::vector<Ray> rays;
  for (std::uint64_t i = 0; i < 20'000; ++i) {
    Random random(1, 0, i);
    const double yaw = random.uniform(-3.14, 3.14), pitch = random.uniform(-0.3, 0.2);
    Ray ray;
    ray.direction = vec_cast<float>(
        Vec3d{std::cos(yaw) * std::cos(pitch), std::sin(yaw) * std::cos(pitch), std::sin(pitch)});
    rays.push_back(ray);
  }
  std::vector<Hit> expected(rays.size()), hits(rays.size());
  make_cpu_tracer(scene_.view, executor_)->nearest(rays, expected, executor_);
  world_.add_hits(rays, std::vector<double>(rays.size(), kTime_s), expected, executor_);
  make_cpu_tracer(shown.view, executor_)->nearest(rays, hits, executor_);
  const PrimitiveAttributes attributes = world_.attributes(scene_.attributes);
  std::size_t different = 0, on_objects = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (expected[i].valid() && expected[i].primitive >= place_.size()) ++on_objects;
    const bool same = expected[i].valid() == hits[i].valid() &&
                      (!hits[i].valid() || (std::fabs(expected[i].t - hits[i].t) < 1e-3F &&
                                            attributes.classes[expected[i].primitive] ==
                                                shown.attributes.classes[hits[i].primitive]));
    if (!same) ++different;
  }
  EXPECT_GT(on_objects, 1500U);
  EXPECT_LT(different, 20U) << "rims round differently";
}

TEST_F(PosedSceneTest, ShowsWhatIsPresent) {
  EXPECT_EQ(PosedScene(scene_, world_, 0.05).scene().view.triangle_count(), 4U);
  EXPECT_EQ(PosedScene(scene_, world_, 0.5).scene().view.triangle_count(), 2U);
}

// The softness of the scene is kept; objects are opaque.
TEST_F(PosedSceneTest, KeepsOpacities) {
  const std::vector<float> opacities(place_.size(), 0.5F);
  scene_.view.opacities = opacities;
  const PosedScene posed(scene_, world_, 0);
  const SceneView view = posed.scene().view;
  ASSERT_EQ(view.opacities.size(), view.disk_count());
  EXPECT_EQ(view.opacities.front(), 0.5F);
  EXPECT_EQ(view.opacities.back(), 1.0F);
}

}  // namespace
}  // namespace adasplats
