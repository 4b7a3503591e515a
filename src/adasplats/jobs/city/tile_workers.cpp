// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/city/tile_workers.h"

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
constexpr std::size_t kThreadsPerTile = 8;

/// Messages from workers.
struct News {
  std::optional<std::size_t> done;
  std::string warning;
};

/// The pieces of work that are left, and what became of the others.
class WorkQueue {
 public:
  explicit WorkQueue(std::size_t count) : count_(count) {}

  std::optional<std::size_t> next() {
    const std::lock_guard lock(mutex_);
    if (stops_ || next_ == count_) return std::nullopt;
    return next_++;
  }
  void push(News news) {
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

  /// Waits for a message, or returns none after a while; false when all workers have ended and no
  /// message is left.
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
  std::size_t count_;
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
  explicit QueuedWarnings(WorkQueue& queue) : queue_(queue) {}
  void warn(std::string_view message) override { queue_.push({{}, std::string(message)}); }

 private:
  WorkQueue& queue_;
};

void work_on(WorkQueue& queue, const Session& whole, int threads, DeviceChoice device,
             const std::function<void(std::size_t, Session&)>& work) {
  try {
    const Executor executor(threads);
    QueuedWarnings warnings(queue);
    Session session = {executor, warnings, whole.seed, device};
    while (const std::optional<std::size_t> k = queue.next()) {
      work(*k, session);
      queue.push({k, {}});
    }
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
  explicit Workers(WorkQueue& queue) : queue_(queue) {}
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
  WorkQueue& queue_;
  std::vector<std::thread> threads_;
};

}  // namespace

std::size_t tiles_at_once(const Session& session) {
  const auto threads = static_cast<std::size_t>(session.executor.threads());
  if (session.device.on_gpu())
    return std::clamp<std::size_t>(threads, 1, kTilesAGpu * session.device.gpus.size());
  return std::max<std::size_t>(1, threads / kThreadsPerTile);
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

void work_side_by_side(std::size_t count, std::size_t most, const Session& session,
                       ProgressSink& warnings,
                       const std::function<void(std::size_t, Session&)>& work,
                       const std::function<void(std::size_t)>& take) {
  const std::size_t wanted = tiles_at_once(session);
  const std::size_t at_once = std::min(count, most == 0 ? wanted : std::min(most, wanted));
  const Executor& executor = session.executor;
  if (at_once <= 1) {
    Session own = {executor, warnings, session.seed, session.device};
    for (std::size_t k = 0; k < count; ++k) {
      work(k, own);
      take(k);
    }
    return;
  }
  WorkQueue queue(count);
  {
    Workers workers(queue);
    const int threads = std::max(1, executor.threads() / static_cast<int>(at_once));
    for (std::size_t k = 0; k < at_once; ++k)
      workers.add([&, device = device_of(session.device, k)] {
        work_on(queue, session, threads, device, work);
      });
    std::deque<News> news;
    while (queue.wait(workers.size(), news)) {
      executor.check_interruption();
      for (const News& each : news) {
        if (each.done) take(*each.done);
        if (!each.warning.empty()) warnings.warn(each.warning);
      }
    }
  }
  queue.rethrow();
}

void model_tiles(const CityWork& work, const TileModeller& modeller,
                 std::span<const CityTile> tiles, ProgressSink& warnings,
                 const std::function<void(const CityTile&)>& take) {
  std::vector<CityTile> made(tiles.begin(), tiles.end());
  work_side_by_side(
      made.size(), work.job.memory.tiles_at_once, work.session, warnings,
      [&](std::size_t k, Session& session) {
        made[k] = model_and_save(tiles[k], work, modeller, session);
      },
      [&](std::size_t k) { take(made[k]); });
}

}  // namespace adasplats
