// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/core/executor.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <thread>
#include <utility>

#include "adasplats/core/progress_meter.h"

namespace adasplats {

namespace {

using oneapi::tbb::global_control;

/// TBB runs at most one thread a core unless this raises the limit.
std::unique_ptr<global_control> allow(int threads) {
  if (threads <= oneapi::tbb::info::default_concurrency()) return nullptr;
  return std::make_unique<global_control>(global_control::max_allowed_parallelism,
                                          static_cast<std::size_t>(threads));
}

/// Whether this thread is in a chunk of a loop.
thread_local bool inside_loop = false;

class InsideLoop {
 public:
  InsideLoop() : before_(std::exchange(inside_loop, true)) {}
  ~InsideLoop() { inside_loop = before_; }
  InsideLoop(const InsideLoop&) = delete;
  InsideLoop& operator=(const InsideLoop&) = delete;

 private:
  bool before_;
};

}  // namespace

struct Executor::Impl {
  std::unique_ptr<global_control> limit;
  mutable oneapi::tbb::task_arena arena;
  std::function<void()> interruption;
  ProgressMeter* meter;
  Impl(int threads, std::function<void()> interruption_in, ProgressMeter* meter_in)
      : limit(allow(threads)),
        arena(threads),
        interruption(std::move(interruption_in)),
        meter(meter_in) {}
};

Executor::Executor(int threads, std::function<void()> interruption, ProgressMeter* meter)
    : impl_(std::make_unique<Impl>(threads > 0 ? threads : oneapi::tbb::info::default_concurrency(),
                                   std::move(interruption), meter)) {}

Executor::~Executor() = default;

int Executor::threads() const { return impl_->arena.max_concurrency(); }

ProgressMeter* Executor::meter() const { return impl_->meter; }

void Executor::check_interruption() const {
  if (inside_loop) return;
  if (impl_->interruption) impl_->interruption();
  if (impl_->meter != nullptr && impl_->meter->is_step_thread()) impl_->meter->report();
}

void Executor::for_chunks(std::size_t count, std::size_t grain,
                          FunctionRef<void(std::size_t, std::size_t)> body) const {
  if (count == 0) return;
  const std::size_t chunks = (count + grain - 1) / grain;
  const bool is_outermost = !inside_loop;
  const std::thread::id caller = std::this_thread::get_id();
  ProgressMeter* const meter =
      is_outermost && impl_->meter != nullptr && impl_->meter->is_step_thread() ? impl_->meter
                                                                                : nullptr;
  // TBB hands a thread many chunks at once, and would run them all after another one has thrown.
  std::atomic<bool> stopped = false;
  const auto run_chunk = [&](std::size_t chunk) {
    if (stopped.load(std::memory_order_relaxed)) return;
    try {
      if (is_outermost && std::this_thread::get_id() == caller) check_interruption();
      const InsideLoop inside;
      const std::size_t begin = chunk * grain, end = std::min(count, begin + grain);
      body(begin, end);
      if (meter != nullptr) meter->add(end - begin);
    } catch (...) {
      stopped = true;
      throw;
    }
  };
  if (chunks == 1) {
    run_chunk(0);
    return;
  }
  const auto run_all = [&] { oneapi::tbb::parallel_for(std::size_t{0}, chunks, run_chunk); };
  impl_->arena.execute([&] {
    // While a nested loop waits for its last chunks, it may not begin chunks of the outer loop.
    if (is_outermost)
      run_all();
    else
      oneapi::tbb::this_task_arena::isolate(run_all);
  });
}

void Executor::run(FunctionRef<void()> body) const {
  check_interruption();
  impl_->arena.execute([&] {
    if (inside_loop)
      oneapi::tbb::this_task_arena::isolate([&] { body(); });
    else
      body();
  });
}

namespace {

/// Uninitialized memory: its pages are first touched by the threads that use them.
template <class T>
std::unique_ptr<T[]> untouched(std::size_t size) {
  return std::make_unique_for_overwrite<T[]>(size);
}

}  // namespace

void Executor::sort_keys(std::vector<std::uint64_t>& keys,
                         std::vector<std::uint32_t>& order) const {
  constexpr int kDigitBits = 11;
  constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
  const std::size_t n = keys.size();
  order.resize(n);
  if (n == 0) return;
  const std::size_t grain = std::max<std::size_t>(1 << 16, n / 64 + 1);
  const std::size_t blocks = (n + grain - 1) / grain;
  std::vector<std::uint64_t> differing(blocks);
  for_chunks(n, grain, [&](std::size_t begin, std::size_t end) {
    std::uint64_t bits = 0;
    for (std::size_t i = begin; i < end; ++i) {
      order[i] = static_cast<std::uint32_t>(i);
      bits |= keys[i] ^ keys[0];
    }
    differing[begin / grain] = bits;
  });
  std::uint64_t differs = 0;
  for (const std::uint64_t bits : differing) differs |= bits;
  const auto other_keys = untouched<std::uint64_t>(n);
  const auto other_order = untouched<std::uint32_t>(n);
  std::uint64_t *keys_in = keys.data(), *keys_out = other_keys.get();
  std::uint32_t *order_in = order.data(), *order_out = other_order.get();
  std::vector<std::array<std::uint32_t, kDigits>> counts(blocks);
  for (int shift = 0; shift < 64; shift += kDigitBits) {
    if ((differs >> shift & (kDigits - 1)) == 0) continue;  // this digit would move nothing
    const auto digit = [shift](std::uint64_t key) { return (key >> shift) & (kDigits - 1); };
    for_chunks(n, grain, [&](std::size_t begin, std::size_t end) {
      auto& count = counts[begin / grain];
      count.fill(0);
      for (std::size_t i = begin; i < end; ++i) ++count[digit(keys_in[i])];
    });
    // Start of each block's run of each digit.
    std::uint32_t start = 0;
    for (std::size_t d = 0; d < kDigits; ++d) {
      for (auto& count : counts) {
        const std::uint32_t c = count[d];
        count[d] = start;
        start += c;
      }
    }
    for_chunks(n, grain, [&](std::size_t begin, std::size_t end) {
      auto& next = counts[begin / grain];
      for (std::size_t i = begin; i < end; ++i) {
        const std::uint32_t to = next[digit(keys_in[i])]++;
        keys_out[to] = keys_in[i];
        order_out[to] = order_in[i];
      }
    });
    std::swap(keys_in, keys_out);
    std::swap(order_in, order_out);
  }
  if (keys_in == keys.data()) return;
  for_chunks(n, grain, [&](std::size_t begin, std::size_t end) {
    std::copy(keys_in + begin, keys_in + end, keys.data() + begin);
    std::copy(order_in + begin, order_in + end, order.data() + begin);
  });
}

}  // namespace adasplats
