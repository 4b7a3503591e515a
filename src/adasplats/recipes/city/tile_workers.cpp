// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/recipes/city/tile_workers.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "adasplats/io/base/sha256.h"

namespace adasplats {
namespace {

/// Tiles that a GPU works on at a time: it is idle while one is read, fused on the CPU or written.
constexpr std::size_t kTilesAGpu = 3;
/// Threads that one tile keeps busy on the CPU.
constexpr std::size_t kThreadsATile = 8;

/// What workers have to tell.
struct News {
  std::optional<CityTile> made;
  std::string warning;
};

/// The tiles that are left, and what became of the others.
class TileQueue {
 public:
  explicit TileQueue(std::span<const CityTile> tiles) : tiles_(tiles) {}

  std::optional<CityTile> next() {
    const std::lock_guard lock(mutex_);
    if (stops_ || next_ == tiles_.size()) return std::nullopt;
    return tiles_[next_++];
  }
  void tell(News news) {
    const std::lock_guard lock(mutex_);
    news_.push_back(std::move(news));
    changed_.notify_one();
  }
  /// The work ends; of several errors the first counts.
  void fail(std::exception_ptr error) {
    const std::lock_guard lock(mutex_);
    if (!error_) error_ = std::move(error);
    stops_ = true;
  }
  void stop() {
    const std::lock_guard lock(mutex_);
    stops_ = true;
  }
  void worker_ended() {
    const std::lock_guard lock(mutex_);
    ++ended_;
    changed_.notify_one();
  }

  /// What there is to tell, when there is something, or nothing for a while; false when all workers
  /// have ended and everything was told.
  bool wait(std::size_t workers, std::deque<News>& news) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::milliseconds(100),
                      [&] { return !news_.empty() || ended_ == workers; });
    news = std::exchange(news_, {});
    return !news.empty() || ended_ < workers;
  }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  std::span<const CityTile> tiles_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t next_ = 0, ended_ = 0;
  bool stops_ = false;
  std::deque<News> news_;
  std::exception_ptr error_;
};

/// Warnings of one worker.
class QueuedWarnings final : public ProgressSink {
 public:
  explicit QueuedWarnings(TileQueue& queue) : queue_(queue) {}
  void warn(std::string_view message) override { queue_.tell({{}, std::string(message)}); }

 private:
  TileQueue& queue_;
};

void work_on(TileQueue& queue, const CityWork& work, const TileModeller& modeller, int threads,
             DeviceChoice device) {
  try {
    const Executor executor(threads);
    QueuedWarnings warnings(queue);
    Session session = {executor, warnings, work.session.seed, device};
    while (const std::optional<CityTile> tile = queue.next())
      queue.tell({model_and_save(*tile, work, modeller, session), {}});
  } catch (...) {
    queue.fail(std::current_exception());
  }
  queue.worker_ended();
}

/// The GPU of worker k.
DeviceChoice device_of(const DeviceChoice& all, std::size_t k) {
  DeviceChoice one = all;
  if (all.gpus.size() > 1) one.gpus = {all.gpus[k % all.gpus.size()]};
  return one;
}

/// Threads that end before what they work on does.
class Workers {
 public:
  explicit Workers(TileQueue& queue) : queue_(queue) {}
  ~Workers() {
    queue_.stop();
    for (std::thread& thread : threads_) thread.join();
  }
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  template <class Work>
  void add(Work work) {
    threads_.emplace_back(std::move(work));
  }
  std::size_t size() const { return threads_.size(); }

 private:
  TileQueue& queue_;
  std::vector<std::thread> threads_;
};

}  // namespace

std::size_t tiles_at_once(const Session& session) {
  const auto threads = static_cast<std::size_t>(session.executor.threads());
  if (session.device.on_gpu())
    return std::clamp<std::size_t>(threads, 1, kTilesAGpu * session.device.gpus.size());
  return std::max<std::size_t>(1, threads / kThreadsATile);
}

CityTile model_and_save(const CityTile& tile, const CityWork& work, const TileModeller& modeller,
                        Session& session) {
  CityTile made = tile;
  const SplatModel model = modeller.model(tile.key, session);
  const std::filesystem::path file = work.path(model_file_of(tile.key));
  save_model(file, model);
  set_splats(model, made);
  made.sha256 = sha256_of_file(file);
  return made;
}

void model_tiles(const CityWork& work, const TileModeller& modeller,
                 std::span<const CityTile> tiles, ProgressSink& warnings,
                 const std::function<void(const CityTile&)>& take) {
  const std::size_t count = std::min(tiles.size(), tiles_at_once(work.session));
  const Executor& executor = work.session.executor;
  if (count <= 1) {
    Session session = {executor, warnings, work.session.seed, work.session.device};
    for (const CityTile& tile : tiles) take(model_and_save(tile, work, modeller, session));
    return;
  }
  TileQueue queue(tiles);
  {
    Workers workers(queue);
    const int threads = std::max(1, executor.threads() / static_cast<int>(count));
    for (std::size_t k = 0; k < count; ++k)
      workers.add([&, device = device_of(work.session.device, k)] {
        work_on(queue, work, modeller, threads, device);
      });
    std::deque<News> news;
    while (queue.wait(workers.size(), news)) {
      executor.check_interruption();
      for (const News& each : news) {
        if (each.made) take(*each.made);
        if (!each.warning.empty()) warnings.warn(each.warning);
      }
    }
  }
  queue.rethrow();
}

}  // namespace adasplats
