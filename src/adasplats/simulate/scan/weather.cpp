// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/scan/weather.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"

namespace adasplats {

namespace {

/// A surface that a sensor just reports at its greatest range (Velodyne HDL-64E manual: 120 m for
/// 0.80, 50 m for 0.10, where the square of the range gives 0.14).
constexpr double kNeededReflectance = 0.8;
/// What no sensor reports, however near: half a step of the reflectivity of Velodynes.
constexpr double kNeededNear = 0.005;
constexpr double kLeastReflectance = 0.01;  // a step of the reflectivity of Velodynes
constexpr double kUsualReflectance = 0.3;   // where the intensity is not known

/// Width of a beam as it leaves, and full angles where the sensor's are not known: Velodyne VLP-16,
/// geometric means of 9.5 x 12.7 mm and 1.5 x 3.0 mrad.
constexpr double kExit_m = 0.011;
constexpr double kUsualDivergence_rad = 2.1e-3;
/// Emitter and receiver see nothing in common nearer than this (Rasshofer et al. 2011).
constexpr double kNearest_m = 1.0;
/// Half the length of a pulse of 5 ns: what of the fog answers at a time.
constexpr double kHalfPulse_m = 0.75;
/// Fog sends back 0.046 / (V at 5 % contrast) per sr (Rasshofer et al. 2011), and alpha is ln 20 /
/// V.
const double kFogBackscatter = 0.046 / std::log(20.0);
constexpr double kTableStep_m = 0.05;

/// Particles with exponential sizes: density * slope * exp(-slope D) per m^3 and mm.
struct Particles {
  double density_per_m3 = 0;
  double slope_per_mm = 1;
  double reflectance = 0;  ///< of the disk that one is to the beam

  /// Large against the wavelength, a particle takes twice its cross-section: integral of 2 pi / 4
  /// D^2.
  double extinction_per_m() const {
    return 1e-6 * std::numbers::pi * density_per_m3 / (slope_per_mm * slope_per_mm);
  }
};

/// What a disk of the cross-section of a particle reflects that takes twice that and has the lidar
/// ratio S: pi * 2 / S.
double reflectance_of(double lidar_ratio_sr) { return 2.0 * std::numbers::pi / lidar_ratio_sr; }

/// Marshall and Palmer 1948: 8000 exp(-4.1 R^-0.21 D) per m^3 and mm. Lidar ratio of drops: 18.8 sr
/// (O'Connor et al. 2004).
Particles rain_drops(double rate_mm_h) {
  if (!(rate_mm_h > 0)) return {};
  const double slope = 4.1 * std::pow(rate_mm_h, -0.21);
  return {8000.0 / slope, slope, reflectance_of(18.8)};
}

/// Gunn and Marshall 1958: 3800 R^-0.87 exp(-2.55 R^-0.48 D) with D of the melted drop. As a flake
/// of a tenth of the density of water it is 10^(1/3) times as wide. Lidar ratio of ice: 25 sr.
Particles snow_flakes(double rate_mm_h) {
  if (!(rate_mm_h > 0)) return {};
  const double melted_slope = 2.55 * std::pow(rate_mm_h, -0.48);
  const double density = 3800.0 * std::pow(rate_mm_h, -0.87) / melted_slope;
  return {density, melted_slope / std::cbrt(10.0), reflectance_of(25.0)};
}

/// Koschmieder: contrast falls to 2 % within the visibility, exp(-alpha V) = 0.02.
double fog_extinction_per_m(const Weather& weather) {
  const double visibility_m = weather.fog_visibility_m;
  return visibility_m > 0 && std::isfinite(visibility_m) ? 3.912 / visibility_m : 0.0;
}

/// What a sensor needs to report a surface in clear air.
double needed_reflectance(double range_m, const LidarModel& sensor) {
  const double share = range_m / sensor.max_range_m;
  return std::max(kNeededNear, kNeededReflectance * share * share);
}

/// What comes back in clear air, in units of what the sensor needs.
double power_of(double reflectance, double range_m, const LidarModel& sensor) {
  return reflectance / needed_reflectance(range_m, sensor);
}

double usable(double reflectance) {
  return std::isnan(reflectance) ? kUsualReflectance : std::max(reflectance, kLeastReflectance);
}

double reported_share(double extinction_per_m, double range_m, double power) {
  return std::exp(-std::expm1(2.0 * extinction_per_m * range_m) / power);
}

/// Something in the air that the sensor could report.
struct Speck {
  double range_m;
  double power;  ///< that comes back, in units of what the sensor needs: 1 or more
};

/// Where along a ray the air answers: the rates, per metre, at which drops, flakes and fog do that
/// are strong enough, and their integral from the sensor on.
class Clutter {
 public:
  Clutter(const Weather& weather, const LidarModel& sensor)
      : kinds_{rain_drops(weather.rain_mm_h), snow_flakes(weather.snow_mm_h)},
        fog_backscatter_(kFogBackscatter * fog_extinction_per_m(weather)),
        extinction_(extinction_per_m(weather)),
        sensor_(sensor),
        begin_m_(std::max(sensor.min_range_m, kNearest_m)) {
    for (const int axis : {0, 1})
      if (sensor.divergence_rad[axis] > 0) divergence_[axis] = sensor.divergence_rad[axis];
    const double length_m = std::max(0.0, sensor.max_range_m - begin_m_);
    const auto steps = static_cast<std::size_t>(std::ceil(length_m / kTableStep_m));
    expected_.reserve(steps + 1);
    expected_.push_back(0);
    for (std::size_t i = 0; i < steps; ++i) {
      const Rates rates = rates_at(begin_m_ + (static_cast<double>(i) + 0.5) * kTableStep_m);
      expected_.push_back(expected_.back() + kTableStep_m * (rates[0] + rates[1] + rates[2]));
    }
  }

  /// How many answers to expect nearer than a range.
  double expected_within(double range_m) const {
    const double place = std::max(0.0, (range_m - begin_m_) / kTableStep_m);
    const auto step =
        static_cast<std::size_t>(std::min(place, static_cast<double>(expected_.size() - 1)));
    if (step + 1 == expected_.size()) return expected_.back();
    const double late = place - static_cast<double>(step);
    return expected_[step] + late * (expected_[step + 1] - expected_[step]);
  }

  /// The nearest answer of one ray, where there is one nearer than `end_m`.
  std::optional<Speck> nearest(double end_m, Random& random) const {
    const double target = -std::log1p(-random.uniform());
    if (!(target < expected_within(end_m))) return std::nullopt;
    // The first entry above the target is not the first of all, which is 0.
    const auto above = std::ranges::upper_bound(expected_, target);
    const double before = *(above - 1);
    const double late = (target - before) / (*above - before);
    const double place = static_cast<double>(above - expected_.begin() - 1) + late;
    const double range_m = begin_m_ + place * kTableStep_m;
    return Speck{range_m, power_at(range_m, random)};
  }

 private:
  using Rates = std::array<double, 3>;

  double beam_width_m(double range_m) const {
    return std::sqrt((kExit_m + divergence_[0] * range_m) * (kExit_m + divergence_[1] * range_m));
  }
  double attenuated(double reflectance, double range_m) const {
    return power_of(reflectance, range_m, sensor_) * std::exp(-2.0 * extinction_ * range_m);
  }
  double fog_power(double range_m) const {
    return attenuated(std::numbers::pi * fog_backscatter_ * kHalfPulse_m, range_m);
  }
  /// What a particle must measure to be reported: one that fills the share s of the beam's width
  /// sends back s^2 of a wall's power. Infinite where filling the beam is not enough.
  double least_diameter_mm(const Particles& kind, double range_m) const {
    const double share = 1.0 / std::sqrt(attenuated(kind.reflectance, range_m));
    return share <= 1.0 ? 1e3 * beam_width_m(range_m) * share
                        : std::numeric_limits<double>::infinity();
  }
  Rates rates_at(double range_m) const {
    const double width_m = beam_width_m(range_m);
    const double area_m2 = 0.25 * std::numbers::pi * width_m * width_m;
    Rates rates{};
    for (std::size_t i = 0; i < kinds_.size(); ++i)
      if (kinds_[i].density_per_m3 > 0)
        rates[i] = area_m2 * kinds_[i].density_per_m3 *
                   std::exp(-kinds_[i].slope_per_mm * least_diameter_mm(kinds_[i], range_m));
    if (fog_backscatter_ > 0) rates[2] = std::exp(-1.0 / fog_power(range_m)) / kHalfPulse_m;
    return rates;
  }
  /// Power of what answers at a range. Sizes of particles and powers of fog are exponential, so
  /// what they have beyond the least that is reported is exponential too.
  double power_at(double range_m, Random& random) const {
    const Rates rates = rates_at(range_m);
    const double place = random.uniform() * (rates[0] + rates[1] + rates[2]);
    const double beyond = -std::log1p(-random.uniform());
    if (place >= rates[0] + rates[1]) return 1.0 + beyond * fog_power(range_m);
    const Particles& kind = kinds_[place < rates[0] ? 0 : 1];
    const double diameter_mm = least_diameter_mm(kind, range_m) + beyond / kind.slope_per_mm;
    const double share = std::min(1.0, 1e-3 * diameter_mm / beam_width_m(range_m));
    return attenuated(kind.reflectance, range_m) * share * share;
  }

  std::array<Particles, 2> kinds_;
  double fog_backscatter_;  ///< 1 / (m sr)
  double extinction_;
  const LidarModel& sensor_;
  double begin_m_;
  double divergence_[2] = {kUsualDivergence_rad, kUsualDivergence_rad};
  std::vector<double> expected_;  ///< answers up to begin_m_ + i * kTableStep_m
};

constexpr std::size_t kSpeck = std::numeric_limits<std::size_t>::max();

/// One return in weather.
struct Reported {
  std::size_t firing;
  std::size_t source;  ///< return of the clear scan, or kSpeck
  float range_m;
  float intensity;
  std::uint8_t index;
};

/// Finds the firing of each return of a scan; both are in the same order.
class FiringSearch {
 public:
  FiringSearch(const Scan& scan, std::span<const Firing> firings)
      : scan_(scan), firings_(firings) {}

  /// The returns of the next firing: [begin, end) of the scan.
  std::size_t end_of_next() {
    const Firing& firing = firings_[firing_++];
    if (!is_of(firing)) return return_;
    ++return_;
    // A further return of the same firing, not the first of another that looks the same.
    while (is_of(firing) && !scan_.return_indices.empty() &&
           scan_.return_indices[return_] > scan_.return_indices[return_ - 1])
      ++return_;
    return return_;
  }
  void check_all_found() const {
    if (return_ != scan_.size()) throw std::logic_error("a return of a scan has no firing");
  }

 private:
  bool is_of(const Firing& firing) const {
    return return_ < scan_.size() && scan_.rings[return_] == firing.ring &&
           scan_.columns[return_] == firing.column && scan_.times_s[return_] == firing.time_s;
  }

  const Scan& scan_;
  std::span<const Firing> firings_;
  std::size_t firing_ = 0;
  std::size_t return_ = 0;
};

/// What weather makes of the returns of one firing after the other.
class WeatherFilter {
 public:
  WeatherFilter(const Scan& clear, const LidarModel& sensor, const BeamOptions& beam,
                const Weather& weather)
      : clear_(clear),
        sensor_(sensor),
        beam_(beam),
        white_(weather.white_intensity),
        extinction_(extinction_per_m(weather)),
        clutter_(weather, sensor) {}

  /// The returns [begin, end) of the clear scan are those of firing number `firing`.
  void filter(std::size_t firing, std::size_t begin, std::size_t end, Random random) {
    const std::size_t first = reported_.size();
    double end_m = begin == end ? sensor_.max_range_m : 0.0;
    for (std::size_t i = begin; i < end; ++i)
      end_m = std::max(end_m, static_cast<double>(clear_.ranges_m[i]));
    const std::optional<Speck> speck = clutter_.nearest(end_m, random);
    pulses_.clear();
    for (std::size_t i = begin; i < end; ++i) add_return(firing, i, random);
    if (speck) add_speck(firing, *speck);
    if (speck && reported_.size() > first) reselect(first);
    for (std::size_t i = first; i < reported_.size(); ++i)
      reported_[i].index = static_cast<std::uint8_t>(i - first);
  }

  std::span<const Reported> reported() const { return reported_; }

 private:
  /// As the sensor reports it: a multiple of its resolution, and in its range, or nothing.
  std::optional<float> measured(double range_m) const {
    const double step_m = sensor_.range_resolution_m;
    if (step_m > 0) range_m = step_m * std::round(range_m / step_m);
    const auto reported_m = static_cast<float>(range_m);
    const bool in_range = reported_m > static_cast<float>(sensor_.min_range_m) &&
                          reported_m <= static_cast<float>(sensor_.max_range_m);
    return in_range ? std::optional(reported_m) : std::nullopt;
  }

  void add_return(std::size_t firing, std::size_t source, Random& random) {
    const bool has_intensity = !clear_.intensities.empty();
    const double range_m = static_cast<double>(clear_.ranges_m[source]);
    const double intensity = has_intensity ? static_cast<double>(clear_.intensities[source])
                                           : std::numeric_limits<double>::quiet_NaN();
    const double power = power_of(usable(intensity / white_), range_m, sensor_);
    const bool lost = random.uniform() >= reported_share(extinction_, range_m, power);
    const double normal = random.normal();
    if (lost) return;
    const double left = std::exp(-2.0 * extinction_ * range_m);
    // Noise is as the inverse root of the power: sigma exp(alpha r), of which sigma is in already.
    const double sigma_m =
        sensor_.range_noise_m * std::sqrt(std::expm1(2.0 * extinction_ * range_m));
    const auto reported_m =
        sigma_m > 0 ? measured(range_m + sigma_m * normal) : std::optional(clear_.ranges_m[source]);
    if (!reported_m) return;
    pulses_.push_back({*reported_m, static_cast<std::uint32_t>(reported_.size()),
                       static_cast<float>(power * left)});
    reported_.push_back({firing, source, *reported_m, static_cast<float>(intensity * left), 0});
  }

  void add_speck(std::size_t firing, const Speck& speck) {
    const auto reported_m = measured(speck.range_m);
    if (!reported_m) return;
    const double reflectance = speck.power * needed_reflectance(speck.range_m, sensor_);
    pulses_.push_back({*reported_m, static_cast<std::uint32_t>(reported_.size()),
                       static_cast<float>(speck.power)});
    reported_.push_back({firing, kSpeck, *reported_m, static_cast<float>(white_ * reflectance), 0});
  }

  /// What of reported_[first..] the sensor reports.
  void reselect(std::size_t first) {
    std::ranges::stable_sort(pulses_, {}, &Return::range_m);
    const std::size_t count = reported_returns(pulses_, beam_);
    chosen_.clear();
    for (std::size_t i = 0; i < count; ++i) chosen_.push_back(reported_[pulses_[i].primitive]);
    reported_.resize(first);
    reported_.insert(reported_.end(), chosen_.begin(), chosen_.end());
  }

  const Scan& clear_;
  const LidarModel& sensor_;
  const BeamOptions& beam_;
  double white_;
  double extinction_;
  Clutter clutter_;
  std::vector<Reported> reported_;
  std::vector<Return> pulses_;  ///< of one firing; `primitive` is the place in reported_
  std::vector<Reported> chosen_;
};

/// The values of the returns' sources; of specks 0. Empty where the clear scan has none.
template <class T>
std::vector<T> gathered(const std::vector<T>& values, std::span<const Reported> reported) {
  std::vector<T> result;
  if (values.empty()) return result;
  result.reserve(reported.size());
  for (const Reported& one : reported)
    result.push_back(one.source == kSpeck ? T{} : values[one.source]);
  return result;
}

Vec3f position_of(const Reported& reported, const Scan& clear, const Firing& firing) {
  if (reported.source == kSpeck) return firing.origin + reported.range_m * firing.direction;
  const float farther_m = reported.range_m - clear.ranges_m[reported.source];
  return clear.positions[reported.source] + farther_m * firing.direction;
}

Scan scan_of(std::span<const Reported> reported, const Scan& clear, std::span<const Firing> firings,
             const BeamOptions& beam) {
  Scan scan;
  scan.world_from_sensor = clear.world_from_sensor;
  scan.time_s = clear.time_s;
  scan.rays = clear.rays;
  const bool has_indices = beam.returns > 1 || !clear.return_indices.empty();
  for (const Reported& one : reported) {
    const Firing& firing = firings[one.firing];
    scan.positions.push_back(position_of(one, clear, firing));
    scan.ranges_m.push_back(one.range_m);
    scan.rings.push_back(firing.ring);
    scan.columns.push_back(firing.column);
    scan.times_s.push_back(firing.time_s);
    if (!clear.intensities.empty()) scan.intensities.push_back(one.intensity);
    if (has_indices) scan.return_indices.push_back(one.index);
  }
  scan.classes = gathered(clear.classes, reported);
  scan.instances = gathered(clear.instances, reported);
  return scan;
}

}  // namespace

void check_weather(const Weather& weather, const LidarModel& sensor) {
  check_settings(weather);
  if (!(sensor.max_range_m > 0 && std::isfinite(sensor.max_range_m)))
    throw Error(ErrorKind::usage, "the sensor '" + sensor.name + "' has no greatest range");
}

bool Weather::is_clear() const { return extinction_per_m(*this) == 0; }

double extinction_per_m(const Weather& weather) {
  return rain_drops(weather.rain_mm_h).extinction_per_m() + fog_extinction_per_m(weather) +
         snow_flakes(weather.snow_mm_h).extinction_per_m();
}

double reported_share(const Weather& weather, const LidarModel& sensor, double range_m,
                      double reflectance) {
  check_weather(weather, sensor);
  return reported_share(extinction_per_m(weather), range_m,
                        power_of(usable(reflectance), range_m, sensor));
}

double clutter_share(const Weather& weather, const LidarModel& sensor, double range_m) {
  check_weather(weather, sensor);
  return -std::expm1(-Clutter(weather, sensor).expected_within(range_m));
}

Scan in_weather(const Scan& clear, std::span<const Firing> firings, const LidarModel& sensor,
                const BeamOptions& beam, const Weather& weather, std::uint64_t seed,
                std::uint64_t scan_index) {
  check_weather(weather, sensor);
  if (weather.is_clear()) return clear;
  // Not the numbers that the scan's own noise was drawn from.
  constexpr std::uint64_t kWeatherStream = 0x7765617468657221ULL;
  const std::uint64_t weather_seed = Random::mix(seed ^ kWeatherStream);
  WeatherFilter filter(clear, sensor, beam, weather);
  FiringSearch search(clear, firings);
  std::size_t begin = 0;
  for (std::size_t firing = 0; firing < firings.size(); ++firing) {
    const std::size_t end = search.end_of_next();
    filter.filter(firing, begin, end, Random(weather_seed, scan_index, firing));
    begin = end;
  }
  search.check_all_found();
  return scan_of(filter.reported(), clear, firings, beam);
}

}  // namespace adasplats
