// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/view/live_scans.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/setting.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/dataset/range_image.h"
#include "adasplats/view/live_message.h"
#include "adasplats/view/picked.h"
#include "adasplats/view/scan_packet.h"

namespace adasplats {
namespace {

using Clock = std::chrono::steady_clock;

/// Maximum number of scans sent to a page before it is ready for more.
constexpr int kMaxPending = 2;
/// Maximum number of open picks of a page.
constexpr std::size_t kMaxPicks = 32;
/// Minimum time between scans of a page; it could not show more, and other pages wait.
constexpr Clock::duration kMinInterval = std::chrono::milliseconds(33);
/// Maximum number of cached simulators of all pages.
constexpr std::size_t kMaxSimulators = 8;

struct Client {
  std::shared_ptr<WebSocketPeer> peer;
  std::shared_ptr<const LiveSensor> sensor;
  bool sensor_is_new = true;  ///< the page has not received its description
  LivePose pose;
  bool running = false;
  int pending = 0;
  std::uint64_t next_number = 0;
  Clock::time_point next_scan;
  std::deque<PickMessage> picks;
  std::map<std::size_t, RigidTransform> placed;  ///< objects that the page has moved

  bool wants_scan(Clock::time_point now) const {
    return running && pending < kMaxPending && next_scan <= now;
  }
  bool has_work(Clock::time_point now) const {
    return sensor_is_new || !picks.empty() || wants_scan(now);
  }
};

/// The next work of the simulating thread, copied from a Client.
struct Work {
  std::shared_ptr<WebSocketPeer> peer;
  std::shared_ptr<const LiveSensor> sensor;
  bool sends_sensor = false;
  std::deque<PickMessage> picks;
  bool scan = false;
  LivePose pose;
  std::map<std::size_t, RigidTransform> placed;
  std::uint64_t number = 0;
};

struct Simulator {
  std::string key;
  std::unique_ptr<ScanSimulator> scans;
  ImageSize size;
};

/// Simulators of the most recently used sensors.
class Simulators {
 public:
  Simulators(const ScanScene& scene, const Executor& executor)
      : scene_(scene), executor_(executor) {}

  Simulator& of(const LiveSensor& sensor) {
    std::string key = sensor.key();
    const auto found =
        std::find_if(kept_.begin(), kept_.end(), [&](const auto& kept) { return kept.key == key; });
    if (found != kept_.end()) {
      std::rotate(kept_.begin(), found, found + 1);
      return kept_.front();
    }
    auto scans = std::make_unique<ScanSimulator>(scene_, sensor.settings, executor_);
    const ImageSize size = image_size_of(scans->firings());
    if (kept_.size() == kMaxSimulators) kept_.pop_back();
    return *kept_.insert(kept_.begin(), {std::move(key), std::move(scans), size});
  }

 private:
  const ScanScene& scene_;
  const Executor& executor_;
  std::vector<Simulator> kept_;  ///< most recently used first
};

/// Places the objects for the page whose scan is next; unmoved objects have their own motion.
class PlacedObjects {
 public:
  explicit PlacedObjects(const ViewScene& scene) : scene_(scene) {
    for (const ViewObject& object : scene.objects)
      own_.push_back(scene.model->world()->object(object.object).trajectory);
  }

  void place(const std::map<std::size_t, RigidTransform>& wanted) {
    for (const std::size_t id : placed_)
      if (!wanted.contains(id)) move(id, own_[id]);
    placed_.clear();
    for (const auto& [id, pose] : wanted) {
      move(id, {{0, pose}});
      placed_.push_back(id);
    }
  }

 private:
  void move(std::size_t id, Trajectory trajectory) {
    scene_.model->move_object(scene_.objects[id].object, std::move(trajectory));
  }

  const ViewScene& scene_;
  std::vector<Trajectory> own_;  ///< of the world file
  std::vector<std::size_t> placed_;
};

}  // namespace

class LiveScans::Implementation {
 public:
  Implementation(const ViewScene& scene, const Executor& executor)
      : scene_(scene), executor_(executor), simulators_(*scene.place, executor), objects_(scene) {
    first_sensor_ = std::make_shared<const LiveSensor>(live_sensor(scene.sensor));
    thread_ = std::thread([this] { simulate(); });
  }

  ~Implementation() {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }

  void opened(const std::shared_ptr<WebSocketPeer>& peer) {
    Client client;
    client.peer = peer;
    client.sensor = first_sensor_;
    client.pose.world_from_sensor = scene_.start_pose;
    {
      const std::lock_guard lock(mutex_);
      clients_.push_back(std::move(client));
    }
    changed_.notify_all();
  }

  void closed(const std::shared_ptr<WebSocketPeer>& peer) {
    const std::lock_guard lock(mutex_);
    std::erase_if(clients_, [&](const Client& client) { return client.peer == peer; });
  }

  void received(const std::shared_ptr<WebSocketPeer>& peer, std::string_view text) {
    LiveMessage message = parse_live_message(text, scene_.origin);
    {
      const std::lock_guard lock(mutex_);
      const auto client = std::find_if(clients_.begin(), clients_.end(),
                                       [&](const Client& c) { return c.peer == peer; });
      if (client == clients_.end()) return;
      if (const auto* const object = std::get_if<ObjectMessage>(&message)) check(*object);
      std::visit([&](auto&& part) { apply(*client, std::forward<decltype(part)>(part)); },
                 std::move(message));
    }
    changed_.notify_all();
  }

 private:
  static void apply(Client& client, LiveSensor&& sensor) {
    client.sensor = std::make_shared<const LiveSensor>(std::move(sensor));
    client.sensor_is_new = true;
  }
  static void apply(Client& client, const LivePose& pose) { client.pose = pose; }
  static void apply(Client& client, const RunMessage& run) { client.running = run.on; }
  static void apply(Client& client, ReadyMessage /*ready*/) {
    client.pending = std::max(client.pending - 1, 0);
  }
  void check(const ObjectMessage& object) const {
    if (object.id >= scene_.objects.size())
      throw Error(ErrorKind::usage, "unknown object " + std::to_string(object.id));
  }
  static void apply(Client& client, const ObjectMessage& object) {
    if (object.world_from_object)
      client.placed.insert_or_assign(object.id, *object.world_from_object);
    else
      client.placed.erase(object.id);
  }
  static void apply(Client& client, const PickMessage& pick) {
    if (client.picks.size() >= kMaxPicks)
      throw Error(ErrorKind::usage, "more than " + std::to_string(kMaxPicks) + " open picks");
    client.picks.push_back(pick);
  }

  /// Waits for the next work of a client. Nothing: the server stops.
  std::optional<Work> next_work() {
    std::unique_lock lock(mutex_);
    while (!stopping_) {
      const Clock::time_point now = Clock::now();
      for (std::size_t i = 0; i < clients_.size(); ++i) {
        if (!clients_[i].has_work(now)) continue;
        Work work = work_of(clients_[i], now);
        // Move it to the end, so that every client gets its turn.
        std::rotate(clients_.begin() + static_cast<std::ptrdiff_t>(i),
                    clients_.begin() + static_cast<std::ptrdiff_t>(i) + 1, clients_.end());
        return work;
      }
      changed_.wait_until(lock, wake_time(now));
    }
    return std::nullopt;
  }

  static Work work_of(Client& client, Clock::time_point now) {
    Work work;
    work.peer = client.peer;
    work.sensor = client.sensor;
    work.pose = client.pose;
    work.sends_sensor = std::exchange(client.sensor_is_new, false);
    work.picks = std::exchange(client.picks, {});
    work.scan = client.wants_scan(now);
    if (!work.scan) return work;
    work.placed = client.placed;
    work.number = client.next_number++;
    client.next_scan = now + kMinInterval;
    ++client.pending;
    return work;
  }

  /// The earliest time at which a waiting client may get its next scan.
  Clock::time_point wake_time(Clock::time_point now) const {
    Clock::time_point time = now + std::chrono::seconds(1);
    for (const Client& client : clients_)
      if (client.running && client.pending < kMaxPending) time = std::min(time, client.next_scan);
    return time;
  }

  void simulate() {
    while (const std::optional<Work> work = next_work()) {
      try {
        perform(*work);
      } catch (const std::exception& error) {
        work->peer->send_text(error_message(with_settings_as_options(error.what())));
      } catch (...) {  // an interruption, which also ends the server
      }
    }
  }

  void perform(const Work& work) {
    for (const PickMessage& pick : work.picks)
      work.peer->send_text(picked_message(scene_, pick, executor_));
    if (!work.sends_sensor && !work.scan) return;
    Simulator& simulator = simulators_.of(*work.sensor);
    const ImageSize size = simulator.size;
    if (work.sends_sensor)
      work.peer->send_text(sensor_message(*work.sensor, size.rings, size.columns,
                                          simulator.scans->firings().size()));
    if (work.scan) send_scan(work, *simulator.scans, size);
  }

  void send_scan(const Work& work, ScanSimulator& simulator, const ImageSize& size) {
    objects_.place(work.placed);
    const Stopwatch watch;
    const ScanMotion motion = motion_of(work.pose, *work.sensor);
    const Scan scan = simulator.scan(motion, work.number);
    ScanPacketHead head;
    head.number = static_cast<std::uint32_t>(work.number);
    head.rings = static_cast<std::uint32_t>(size.rings);
    head.columns = static_cast<std::uint32_t>(size.columns);
    head.moved = !motion.knots.empty();
    head.seconds = watch.seconds();
    head.max_range_m = simulator.settings().sensor.max_range_m;
    head.full_intensity = full_intensity();
    head.local_origin = scene_.origin;
    work.peer->send_binary(scan_packet(scan, head));
  }

  /// Computed once per model, so that all scans have the same scale.
  float full_intensity() {
    if (full_intensity_) return *full_intensity_;
    if (scene_.model != nullptr) {
      full_intensity_ = full_intensity_of(scene_.model->attributes().intensities);
    } else {
      // Estimate for a city on disk: the upper end of its range of intensities.
      const float high = intensity_range_of(scene_.layers.front()).high;
      full_intensity_ = full_intensity_of(std::span(&high, 1));
    }
    return *full_intensity_;
  }

  const ViewScene& scene_;
  const Executor& executor_;
  std::shared_ptr<const LiveSensor> first_sensor_;
  Simulators simulators_;  ///< this and the next two: only used by the simulating thread
  PlacedObjects objects_;
  std::optional<float> full_intensity_;
  std::mutex mutex_;  ///< for the members below
  std::condition_variable changed_;
  std::vector<Client> clients_;  ///< the next one to serve is first
  bool stopping_ = false;
  std::thread thread_;
};

LiveScans::LiveScans(const ViewScene& scene, const Executor& executor) {
  if (scene.place != nullptr) implementation_ = std::make_unique<Implementation>(scene, executor);
}

LiveScans::~LiveScans() = default;

void LiveScans::opened(const std::shared_ptr<WebSocketPeer>& peer) {
  if (implementation_) implementation_->opened(peer);
}

void LiveScans::received(const std::shared_ptr<WebSocketPeer>& peer, std::string_view text) {
  try {
    if (!implementation_) throw Error(ErrorKind::usage, "no model to simulate scans in");
    implementation_->received(peer, text);
  } catch (const Error& error) {
    constexpr std::uint16_t kInvalidPayload = 1007;  // RFC 6455, 7.4.1
    if (error.kind() == ErrorKind::data) {
      peer->close(kInvalidPayload, with_settings_as_options(error.what()));
    } else {
      peer->send_text(error_message(with_settings_as_options(error.what())));
    }
  }
}

void LiveScans::closed(const std::shared_ptr<WebSocketPeer>& peer) {
  if (implementation_) implementation_->closed(peer);
}

}  // namespace adasplats
