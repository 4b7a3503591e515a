// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/city/tile_stream.h"

#include <algorithm>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "adasplats/core/stopwatch.h"

namespace adasplats {
namespace {

/// Scans to wait for at once; fewer would make batches too small.
constexpr std::size_t kAtOnce = 32;

}  // namespace

bool SeenFrom::reaches(const CityTile& tile) const {
  if (tile.splats == 0) return false;
  const Vec3d away = max(max(tile.low - high, low - tile.high), Vec3d{});
  return dot(away, away) <= range_m * range_m;
}

struct TileStream::Impl {
  enum class State : std::uint8_t { away, loading, loaded };

  std::filesystem::path folder;
  CityManifest city;
  TileHolder& holder;
  std::size_t budget_bytes;
  Executor executor;  ///< of the loading thread

  mutable std::mutex mutex;
  std::condition_variable work, done;
  std::deque<std::size_t> queue;  ///< tiles to load, most urgent first
  std::vector<State> states;
  std::size_t bytes = 0;  ///< of loaded tiles and the one being loaded
  std::exception_ptr error;
  bool ends = false;
  TileStreamCounts counts;
  std::thread loader;

  Impl(std::filesystem::path folder_in, const CityManifest& city_in, TileHolder& holder_in,
       std::size_t budget_in, int threads)
      : folder(std::move(folder_in)),
        city(city_in),
        holder(holder_in),
        budget_bytes(budget_in),
        executor(threads),
        states(city.tiles.size(), State::away),
        loader([this] { load_tiles(); }) {}

  ~Impl() {
    {
      const std::lock_guard lock(mutex);
      ends = true;
    }
    work.notify_all();
    loader.join();
  }

  std::size_t bytes_of(std::size_t tile) const {
    return city.tiles[tile].splats * holder.bytes_per_splat();
  }

  // ---- the loading thread

  void load_tiles() {
    std::unique_lock lock(mutex);
    while (true) {
      work.wait(lock, [&] { return ends || !queue.empty(); });
      if (ends) return;
      const std::size_t tile = queue.front();
      queue.pop_front();
      states[tile] = State::loading;
      bytes += bytes_of(tile);
      counts.max_bytes = std::max(counts.max_bytes, bytes);
      lock.unlock();
      std::exception_ptr failed;
      try {
        holder.load(tile, load_city_tile(folder, city, tile), executor);
      } catch (...) {
        failed = std::current_exception();
      }
      lock.lock();
      states[tile] = State::loaded;
      ++counts.loaded;
      if (failed) {
        error = failed;
        queue.clear();
      }
      done.notify_all();
      if (failed) return;
    }
  }

  // ---- the casting thread

  /// The tiles that scans need, in order of need; the first `at_once` must be loaded before
  /// casting.
  struct Needs {
    std::vector<std::size_t> tiles;
    std::size_t at_once = 0;  ///< number of tiles to wait for
  };

  Needs needs_of(std::span<const SeenFrom> scans) const {
    Needs needs;
    std::vector<bool> known(states.size(), false);
    std::size_t sum = 0;
    for (std::size_t k = 0; k < std::min(scans.size(), kHorizon); ++k) {
      std::vector<std::size_t> more;
      std::size_t more_bytes = 0;
      for (std::size_t tile = 0; tile < states.size(); ++tile) {
        if (known[tile] || !scans[k].reaches(city.tiles[tile])) continue;
        more.push_back(tile);
        more_bytes += bytes_of(tile);
      }
      if (k > 0 && sum + more_bytes > budget_bytes) break;
      sum += more_bytes;
      for (const std::size_t tile : more) known[tile] = true;
      needs.tiles.insert(needs.tiles.end(), more.begin(), more.end());
      // Later scans wait for tiles only if half of the budget remains for loading others meanwhile.
      if (k == 0 || (k < kAtOnce && sum <= budget_bytes / 2)) needs.at_once = needs.tiles.size();
    }
    return needs;
  }

  /// Drops unneeded tiles until the needed ones fit.
  void make_room(const Needs& needs) {
    std::vector<bool> needed(states.size(), false);
    std::size_t sum = 0;
    for (const std::size_t tile : needs.tiles) {
      needed[tile] = true;
      sum += bytes_of(tile);
    }
    for (std::size_t tile = 0; tile < states.size(); ++tile)
      if (!needed[tile] && states[tile] != State::away) sum += bytes_of(tile);
    for (std::size_t tile = 0; tile < states.size() && sum > budget_bytes; ++tile) {
      if (needed[tile] || states[tile] != State::loaded) continue;
      holder.drop(tile);
      states[tile] = State::away;
      bytes -= bytes_of(tile);
      sum -= bytes_of(tile);
    }
  }

  std::size_t prefetch(std::span<const SeenFrom> scans) {
    const Needs needs = needs_of(scans);
    std::unique_lock lock(mutex);
    queue.clear();
    show({}, lock);  // shown tiles cannot be dropped
    make_room(needs);
    const Stopwatch watch;
    for (const std::size_t tile : needs.tiles)
      if (states[tile] == State::away) queue.push_back(tile);
    work.notify_all();
    const std::span first = std::span(needs.tiles).first(needs.at_once);
    done.wait(lock, [&] {
      return error || std::ranges::all_of(
                          first, [&](std::size_t tile) { return states[tile] == State::loaded; });
    });
    counts.waited_s += watch.seconds();
    if (error) std::rethrow_exception(error);
    std::vector<std::size_t> shown;
    for (std::size_t tile = 0; tile < states.size(); ++tile)
      if (states[tile] == State::loaded) shown.push_back(tile);
    show(shown, lock);
    return ready_of(scans, shown);
  }

  void show(std::span<const std::size_t> tiles, std::unique_lock<std::mutex>& lock) {
    lock.unlock();
    holder.show(tiles);
    lock.lock();
  }

  std::size_t ready_of(std::span<const SeenFrom> scans, std::span<const std::size_t> shown) const {
    std::vector<bool> is_shown(states.size(), false);
    for (const std::size_t tile : shown) is_shown[tile] = true;
    std::size_t ready = 0;
    for (; ready < std::min(scans.size(), kHorizon); ++ready)
      for (std::size_t tile = 0; tile < states.size(); ++tile)
        if (!is_shown[tile] && scans[ready].reaches(city.tiles[tile])) return ready;
    return ready;
  }
};

TileStream::TileStream(std::filesystem::path folder, const CityManifest& city, TileHolder& holder,
                       std::size_t budget_bytes, int threads)
    : impl_(std::make_unique<Impl>(std::move(folder), city, holder, budget_bytes, threads)) {}

TileStream::~TileStream() = default;

std::size_t TileStream::prefetch(std::span<const SeenFrom> scans) {
  if (scans.empty()) return 0;
  const std::size_t ready = impl_->prefetch(scans);
  if (ready == 0) throw std::logic_error("TileStream: no scan is ready after waiting");
  return ready;
}

TileStreamCounts TileStream::counts() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->counts;
}

}  // namespace adasplats
