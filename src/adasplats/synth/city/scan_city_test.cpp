// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/ply/ply.h"
#include "adasplats/synth/city/city_caster.h"
#include "adasplats/synth/city/city_drive.h"
#include "adasplats/synth/city/synth_city.h"

namespace adasplats {
namespace {

/// A short-range sensor, which needs few sections.
class SensorFile {
 public:
  SensorFile()
      : path_(std::filesystem::temp_directory_path() /
              ("adasplats city sensor " + std::to_string(::getpid()) + ".toml")) {
    write_file(path_,
               "name = \"short\"\nbeams = 16\nelevation_top_deg = 15.0\n"
               "elevation_bottom_deg = -25.0\ncolumns = 900\nmax_range_m = 25.0\n"
               "range_noise_m = 0.01\n");
  }
  ~SensorFile() { std::filesystem::remove(path_); }
  SensorFile(const SensorFile&) = delete;
  SensorFile& operator=(const SensorFile&) = delete;
  std::string name() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

SynthCityOptions thin_city(double length_m, double spacing_m) {
  static const SensorFile sensor;
  return {.seed = 6, .length_m = length_m, .spacing_m = spacing_m, .sensor = sensor.name()};
}

struct Recorded {
  std::map<std::size_t, Scan> scans;
  std::map<std::string, std::size_t> sections;  ///< triangles by name
  SynthCityReport report;
};

Recorded record(const SynthCityOptions& options, int threads) {
  Recorded recorded;
  std::mutex mutex;
  const SynthCitySink sink = {
      .scan =
          [&](std::size_t index, const Scan& scan) {
            const std::lock_guard lock(mutex);
            EXPECT_TRUE(recorded.scans.emplace(index, scan).second) << index;
          },
      .section =
          [&](const std::string& name, const BuiltMesh& section) {
            const std::lock_guard lock(mutex);
            EXPECT_TRUE(recorded.sections.emplace(name, section.mesh.triangles.size()).second)
                << name;
          },
      .scans_done = {}};
  const Executor executor(threads);
  ProgressSink progress;
  recorded.report = scan_synth_city(options, sink, executor, progress);
  return recorded;
}

// Oracle: the same drive with another number of threads.
TEST(ScanSynthCity, DoesNotDependOnThreads) {
  const Recorded one = record(thin_city(60, 15), 1);
  const Recorded three = record(thin_city(60, 15), 3);
  ASSERT_EQ(one.scans.size(), 5U);
  ASSERT_EQ(three.scans.size(), 5U);
  EXPECT_EQ(one.sections, three.sections);
  for (const auto& [index, scan] : one.scans) {
    const Scan& other = three.scans.at(index);
    EXPECT_EQ(scan.positions, other.positions);
    EXPECT_EQ(scan.intensities, other.intensities);
    EXPECT_EQ(scan.classes, other.classes);
    EXPECT_EQ(scan.instances, other.instances);
    EXPECT_GT(scan.size(), 5'000U);
  }
}

// Oracle: the density of streets does not depend on the length of the drive.
TEST(ScanSynthCity, SectionsInMemoryDoNotGrowWithTheDrive) {
  const SynthCityReport few = record(thin_city(300, 100), 2).report;
  const SynthCityReport many = record(thin_city(1500, 100), 2).report;
  EXPECT_GT(many.pieces, 2 * few.pieces);
  EXPECT_LE(many.max_pieces, 16U);
  EXPECT_EQ(many.scans, 16U);
}

TEST(ScanSynthCity, MeetsTheTargetNumberOfPoints) {
  SynthCityOptions options = thin_city(300, 1);
  options.spacing_m.reset();
  options.points = 200'000;
  const Recorded made = record(options, 2);
  EXPECT_NEAR(static_cast<double>(made.report.points), 200'000, 14'400);
  EXPECT_GT(made.report.scans, 5U);
}

TEST(ScanSynthCity, ScansHaveMovingAndStaticClasses) {
  const Recorded made = record(thin_city(800, 20), 2);
  std::set<std::uint16_t> classes;
  for (const auto& [index, scan] : made.scans)
    classes.insert(scan.classes.begin(), scan.classes.end());
  for (const int known : {10, 30, 40, 48, 50, 70, 71, 72, 80, 252, 254})
    EXPECT_TRUE(classes.count(static_cast<std::uint16_t>(known)) > 0) << known;
}

// Oracle: brute force over all triangles of the sections and the movers at their poses.
TEST(CastCity, EqualsBruteForce) {
  const Executor executor(2);
  const CityGrid grid(9);
  const MoverModels models(grid, executor);
  const CityDrive drive(grid, 300);
  LidarModel sensor = load_lidar_model("velodyne-vlp-16");
  sensor.range_noise_m = 0;
  sensor.max_range_m = 40;
  sensor.columns = 240;
  const std::vector<Firing> firings = firings_of(sensor);
  CitySections sections;
  std::size_t on_movers = 0;
  for (const double travelled : {20.0, 120.0, 250.0}) {
    TimedPose pose = drive.at(travelled);
    pose.world_from_sensor.translation.z += 1.7;
    CityScene scene = {.models = &models};
    scene.movers = vehicles_around(grid, models, drive.grid_position(travelled), 40, pose.time_s);
    std::vector<Ray> rays = street_rays(sensor, firings, pose.world_from_sensor, executor);
    std::vector<float> expected(rays.size(), std::numeric_limits<float>::infinity());
    const auto look = [&](const BuiltMesh& built, const RigidTransform& world_from_mesh) {
      TriangleMesh mesh = built.mesh;
      for (Vec3f& v : mesh.vertices) v = vec_cast<float>(world_from_mesh * vec_cast<double>(v));
      std::vector<Hit> hits(rays.size());
      make_cpu_tracer(SceneView{{}, &mesh}, executor)->nearest(rays, hits, executor);
      for (std::size_t i = 0; i < rays.size(); ++i) expected[i] = std::min(expected[i], hits[i].t);
    };
    for (const CitySectionId& id : sections_around(grid, drive.grid_position(travelled), 40)) {
      if (!sections.holds(id))
        sections.add(std::make_unique<CitySection>(grid, id, models), executor);
      scene.sections.push_back(&sections.section(id));
      look(sections.section(id).built, {});
    }
    const Vec3d here = pose.world_from_sensor.translation;
    for (const PlacedMover& mover : scene.movers) {
      const MoverModel& model = models.model(mover.model);
      if (!collides(model.low, model.high, mover.world_from_mover.inverse() * here))
        look(model.built, mover.world_from_mover);
    }
    const auto echoes =
        cast_city(scene, sensor, firings, FiringSectors(firings), pose, 1, 0, executor);
    std::vector<float> found(rays.size(), std::numeric_limits<float>::infinity());
    for (const StreetEcho& echo : echoes) {
      found[echo.ray] = echo.range_m;
      on_movers += echo.instance >= kFirstMover ? 1 : 0;
    }
    std::size_t off = 0;  // rays that graze an edge may pass it on either side
    for (std::size_t i = 0; i < rays.size(); ++i)
      off += std::isfinite(expected[i]) != std::isfinite(found[i]) ||
                     std::fabs(expected[i] - found[i]) > 2e-3F
                 ? 1
                 : 0;
    EXPECT_LE(off, rays.size() / 1000);
    EXPECT_GT(echoes.size(), rays.size() / 3);
  }
  EXPECT_GT(on_movers, 0U);
}

class WriteSynthCity : public testing::Test {
 protected:
  const TemporaryFolder temporary_;
  const std::filesystem::path folder_ = temporary_.path() / "city";
  ProgressSink progress_;
};

// Oracle: round trip through the readers.
TEST_F(WriteSynthCity, FilesRoundTrip) {
  const Executor executor(2);
  const SynthCityReport report = write_synth_city(folder_, thin_city(60, 20), executor, progress_);
  EXPECT_EQ(report.scans, 4U);
  const KittiSequence sequence = open_kitti_sequence(folder_ / "sequences" / "00");
  EXPECT_EQ(sequence.scans.size(), 4U);
  EXPECT_EQ(sequence.labels.size(), 4U);
  std::size_t faces = 0;
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "truth")) {
    faces += read_ply_mesh(entry.path()).faces.rows;
    ++files;
  }
  EXPECT_EQ(files, report.pieces);
  EXPECT_EQ(faces, report.mesh_triangles);
}

TEST_F(WriteSynthCity, OmitsTruthOnRequest) {
  const Executor executor(2);
  SynthCityOptions options = thin_city(50, 50);
  options.truth = false;
  write_synth_city(folder_, options, executor, progress_);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "truth"));
}

TEST_F(WriteSynthCity, RejectsAFolderWithACity) {
  const Executor executor(2);
  SynthCityOptions options = thin_city(50, 50);
  options.truth = false;
  write_synth_city(folder_, options, executor, progress_);
  expect_error(ErrorKind::cannot_create, {},
               [&] { write_synth_city(folder_, options, executor, progress_); });
}

}  // namespace
}  // namespace adasplats
