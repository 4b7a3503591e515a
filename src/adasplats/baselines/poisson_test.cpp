// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/baselines/poisson.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <csignal>
#include <fstream>
#include <optional>
#include <utility>

#include "adasplats/baselines/shapes_test.h"
#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

std::optional<PoissonPrograms> programs_of(PoissonProvider provider) {
  try {
    return find_poisson_programs(provider);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::unavailable) throw;
    return std::nullopt;
  }
}

class Poisson : public testing::TestWithParam<PoissonProvider> {};

// Oracle: the sphere.
TEST_P(Poisson, SphereIsRoundAndClosed) {
  const auto programs = programs_of(GetParam());
  if (!programs) GTEST_SKIP() << "the program is not here";
  EXPECT_EQ(programs->provider, GetParam());
  const TemporaryFolder folder;
  const OrientedPoints points = sphere({1, 2, 3}, 1, 20000);
  PoissonOptions options;
  options.depth = 6;
  options.trim = 0;
  ProgressSink progress;
  const PoissonSurface surface = poisson_surface(points.positions, points.normals, options,
                                                 *programs, folder.path(), 2, progress);
  EXPECT_TRUE(is_closed(surface.mesh));
  for (const Vec3f v : surface.mesh.vertices) EXPECT_NEAR(length(v - Vec3f{1, 2, 3}), 1, 0.01F);
  EXPECT_NEAR(volume_m3(surface.mesh), 4.18879, 0.04);
  EXPECT_GT(surface.peak_memory_bytes, 1U << 20);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

// Oracle: the square. Poisson closes open surfaces; trimming opens them again.
TEST_P(Poisson, TrimmingOpensASquare) {
  const auto programs = programs_of(GetParam());
  if (!programs) GTEST_SKIP() << "the program is not here";
  const TemporaryFolder folder;
  const OrientedPoints points = square(1, 200);
  ProgressSink progress;
  const auto area = [&](double trim) {
    PoissonOptions options;
    options.depth = 7;
    options.trim = trim;
    return area_m2(poisson_surface(points.positions, points.normals, options, *programs,
                                   folder.path(), 2, progress)
                       .mesh);
  };
  EXPECT_NEAR(area(6.5), 4, 0.25);
  EXPECT_NEAR(area(0), 4 * 1.1 * 1.1, 0.05);  // the octree's cube is larger by a tenth
  expect_error(ErrorKind::data, {"trimming", "16"}, [&] { area(16); });
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

INSTANTIATE_TEST_SUITE_P(Programs, Poisson,
                         testing::Values(PoissonProvider::poisson_recon, PoissonProvider::open3d),
                         [](const auto& tested) {
                           return tested.param == PoissonProvider::open3d ? "Open3D"
                                                                          : "PoissonRecon";
                         });

TEST(PoissonOptions, OutOfRange) {
  const OrientedPoints points = square(1, 2);
  ProgressSink progress;
  const auto bad = [&](const PoissonOptions& options) {
    expect_error(ErrorKind::usage, {}, [&] {
      poisson_surface(points.positions, points.normals, options, {}, ".", 1, progress);
    });
  };
  bad({.depth = 0});
  bad({.depth = 17});
  bad({.samples_per_node = 0});
  bad({.samples_per_node = NAN});
  expect_error(ErrorKind::data, {"no points"},
               [&] { poisson_surface({}, {}, {}, {}, ".", 1, progress); });
  EXPECT_EQ(PoissonOptions{}.trim_depth(), 10);
}

TEST(Program, ReportsFailures) {
  const TemporaryFolder folder;
  ProgressSink progress;
  const fs::path log = folder.path() / "log";
  const auto shell = [&](const std::string& script) {
    return run_program("/bin/sh", {"-c", script}, 1, log, progress);
  };
  EXPECT_GT(shell("test $OMP_NUM_THREADS = 1 && test -n $OMP_WAIT_POLICY"), 0U);
  expect_error(ErrorKind::unavailable, {"/bin/sh", "code 3", "no luck"},
               [&] { shell("echo first; echo no luck >&2; exit 3"); });
  expect_error(ErrorKind::unavailable, {"signal 9"}, [&] { shell("kill -9 $$"); });
  expect_error(ErrorKind::unavailable, {"/no/such", "cannot be started"},
               [&] { run_program("/no/such", {}, 1, log, progress); });
}

/// Cancels once a file exists, like the progress bar on Ctrl-C.
class Cancelling final : public ProgressSink {
 public:
  struct Cancelled {};
  explicit Cancelling(fs::path file) : file_(std::move(file)) {}
  void advance(std::uint64_t) override {
    if (fs::exists(file_)) throw Cancelled{};
  }

 private:
  fs::path file_;
};

TEST(Program, IsKilledOnCancel) {
  const TemporaryFolder folder;
  const fs::path started = folder.path() / "started";
  Cancelling progress(started);
  const std::string script = "echo $$ > '" + (folder.path() / "pid").string() + "'; mv '" +
                             (folder.path() / "pid").string() + "' '" + started.string() +
                             "'; exec sleep 600";
  EXPECT_THROW(run_program("/bin/sh", {"-c", script}, 1, folder.path() / "log", progress),
               Cancelling::Cancelled);
  pid_t process = 0;
  std::ifstream(started) >> process;
  ASSERT_GT(process, 1);
  EXPECT_EQ(kill(process, 0), -1);
  EXPECT_EQ(errno, ESRCH);
}

// Oracle: areas by hand; the square's value is its x.
TEST(Trimmed, CutsAlongTheBound) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  const std::vector<float> values = {0, 1, 1, 0};
  for (const float least : {-1.0F, 0.0F, 0.25F, 0.5F, 1.0F, 2.0F}) {
    const TriangleMesh part = trimmed(mesh, values, least);
    EXPECT_NEAR(area_m2(part), 1 - std::clamp(least, 0.0F, 1.0F), 1e-6) << least;
    for (const Vec3f v : part.vertices) EXPECT_GE(v.x, least - 1e-6F);
    for (std::size_t i = 0; i < part.triangles.size(); ++i)
      EXPECT_GE(cross_of(part.triangle(i)).z, 0);
  }
  // The cut's vertices are shared: 2 on the sides, 1 on the diagonal, and the 2 that stay.
  EXPECT_EQ(trimmed(mesh, values, 0.5F).vertices.size(), 5U);
  EXPECT_TRUE(trimmed({}, {}, 0).triangles.empty());
}

}  // namespace
}  // namespace adasplats
