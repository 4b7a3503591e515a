// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/drive_boxes.h"

#include <gtest/gtest.h>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/core/recorded_progress_test.h"
#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

/// Scans in memory; their files are their numbers.
class ScansInMemory final : public ScanReader {
 public:
  explicit ScansInMemory(std::vector<KittiScan> scans) : scans_(std::move(scans)) {}
  KittiScan read(const std::filesystem::path& file) const override {
    return scans_.at(static_cast<std::size_t>(std::stoi(file.string())));
  }

 private:
  std::vector<KittiScan> scans_;
};

constexpr std::size_t kScans = 10, kCars = 3;

/// Where a car is: 10 m/s along x or back.
Vec3d car_at(std::size_t car, double time_s) {
  const double way_m = 10 * time_s;
  return {car == 1 ? 20 - way_m : way_m, 6.0 * static_cast<double>(car), 1};
}

/// Three cars of 4 x 2 x 1.5 m, each measured at its own time within sweeps of 0.1 s.
KittiSequence drive_with_cars() {
  KittiSequence drive;
  std::vector<KittiScan> scans(kScans);
  Random random(1, 0, 0);
  for (std::size_t k = 0; k < kScans; ++k) {
    const double scan_s = 0.1 * static_cast<double>(k);
    drive.scans.emplace_back(std::to_string(k));
    drive.trajectory.push_back({scan_s, {}});
    for (std::size_t car = 0; car < kCars; ++car) {
      const double time_s = scan_s - 0.04 + 0.04 * static_cast<double>(car);
      for (int i = 0; i < 100; ++i) {
        const Vec3d in_car = {random.uniform(-2, 2), random.uniform(-1, 1),
                              random.uniform(-0.45, 0.7)};
        scans[k].positions.push_back(vec_cast<float>(car_at(car, time_s) + in_car));
        scans[k].times_s.push_back(time_s);
      }
    }
  }
  drive.reader = std::make_shared<ScansInMemory>(std::move(scans));
  return drive;
}

/// Boxes of the cars every 0.1 s: box(car, time).
template <class Box>
MovingBoxes boxes_of_cars(std::size_t cars, Box&& box) {
  BoxContent content;
  for (std::size_t car = 0; car < cars; ++car) {
    BoxTrack track{car, "car", {}};
    for (int k = -3; k < 14; ++k)
      track.boxes.push_back({0.1 * k, box(car, 0.1 * k), {2, 1, 0.75}, 0});
    content.moving.push_back(std::move(track));
  }
  content.begin_s = -0.3;
  content.end_s = 1.3;
  return MovingBoxes(std::move(content));
}

TEST(FitBoxClock, BoxesThatAreLate) {
  const MovingBoxes late = boxes_of_cars(
      kCars, [](std::size_t car, double time_s) { return car_at(car, time_s - 0.07); });
  const auto clock = fit_box_clock(late, drive_with_cars(), Executor(1));
  ASSERT_TRUE(clock);
  EXPECT_NEAR(clock->later_s, 0.07, 0.011);
  EXPECT_FALSE(clock->are_of_scans);
  EXPECT_GT(clock->points, clock->as_given);
}

TEST(FitBoxClock, BoxesOfScans) {
  // Each box encloses what the scan measured of the car, whenever that was.
  const MovingBoxes of_scans = boxes_of_cars(kCars, [](std::size_t car, double time_s) {
    return car_at(car, time_s - 0.04 + 0.04 * static_cast<double>(car));
  });
  const auto clock = fit_box_clock(of_scans, drive_with_cars(), Executor(1));
  ASSERT_TRUE(clock);
  EXPECT_TRUE(clock->are_of_scans);
  EXPECT_NEAR(clock->later_s, 0, 0.011);
}

TEST(FitBoxClock, NothingWhereTheTimesFitOrFewObjectsTell) {
  EXPECT_FALSE(fit_box_clock(boxes_of_cars(kCars, car_at), drive_with_cars(), Executor(1)));
  const MovingBoxes two =
      boxes_of_cars(2, [](std::size_t car, double time_s) { return car_at(car, time_s - 0.07); });
  EXPECT_FALSE(fit_box_clock(two, drive_with_cars(), Executor(1)));
}

TEST(AddBoxes, CorrectedTimesFindAllPointsAndAreStated) {
  const TemporaryFolder folder;
  std::string text = "time,id,stationary,x,y,z,size_x,size_y,size_z,yaw\n";
  for (std::size_t car = 0; car < kCars; ++car) {
    for (int k = -3; k < 14; ++k) {
      const Vec3d middle = car_at(car, 0.1 * k - 0.07);
      text += std::to_string(0.1 * k) + "," + std::to_string(car) + ",0," +
              std::to_string(middle.x) + "," + std::to_string(middle.y) + ",1,4,2,1.5,0\n";
    }
  }
  KittiSequence drive = drive_with_cars();
  DriveSettings settings;
  settings.boxes = folder.write("boxes.csv", text);
  RecordedProgress progress;
  add_boxes(settings, {}, drive, Executor(1), progress);
  ASSERT_EQ(progress.warnings.size(), 1U);
  EXPECT_NE(progress.warnings[0].find("0.07 s ahead"), std::string::npos) << progress.warnings[0];
  for (std::size_t k = 0; k < kScans; ++k) {
    const KittiScan scan = read_all_returns(drive, k);
    for (std::size_t i = 0; i < scan.in_boxes.size(); ++i) EXPECT_EQ(scan.in_boxes[i], i / 100 + 1);
    EXPECT_TRUE(read_kitti_points(drive, k).positions.empty());
  }
}

// The frame of the city, with a drive in its own.
TEST(AddBoxes, ThoseOfAnotherFrameAreAnError) {
  const TemporaryFolder folder;
  KittiSequence drive = drive_with_cars();
  DriveSettings settings;
  settings.boxes = folder.write("boxes.csv",
                                "time,id,stationary,x,y,z,size_x,size_y,size_z,yaw\n"
                                "0,1,0,650010,6860000,1,4,2,1.5,0\n"
                                "1,1,0,650015,6860000,1,4,2,1.5,0\n");
  RecordedProgress progress;
  try {
    add_boxes(settings, {}, drive, Executor(1), progress);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::data);
    EXPECT_NE(std::string(error.what()).find("within 500 m"), std::string::npos) << error.what();
  }
}

TEST(AddBoxes, ClocksFarApartAreAnError) {
  const TemporaryFolder folder;
  std::string text = "time,id,stationary,x,y,z,size_x,size_y,size_z,yaw\n";
  for (std::size_t car = 0; car < kCars; ++car)
    for (int k = -3; k < 17; ++k)
      text += std::to_string(0.1 * k) + "," + std::to_string(car) + ",0," +
              std::to_string(car_at(car, 0.1 * k - 0.35).x) + "," +
              std::to_string(car_at(car, 0).y) + ",1,4,2,1.5,0\n";
  KittiSequence drive = drive_with_cars();
  DriveSettings settings;
  settings.boxes = folder.write("boxes.csv", text);
  RecordedProgress progress;
  try {
    add_boxes(settings, {}, drive, Executor(1), progress);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::data);
    EXPECT_NE(std::string(error.what()).find("clock differs"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace adasplats
