// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#if defined(ADASPLATS_HAVE_CUDA)
#include "adasplats/gpu/simulate/gpu_reporter.h"

#include <algorithm>
#include <array>
#include <mutex>

#include "adasplats/core/error.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/gpu/simulate/device_report.h"
#include "adasplats/gpu/simulate/device_world.h"
#include "adasplats/gpu/simulate/scan_batches.h"

namespace adasplats {

namespace gpu {
namespace {

constexpr std::size_t kLanes = 3;  // launches in progress on each device
constexpr std::size_t kMaxScansAtOnce = 256;

/// Reference from sensor at all knots, in the order of BatchPoses.
void upload_frame_poses(std::span<const ScanMotion> motions, PinnedBuffer<ScanPose>& poses,
                        DeviceBuffer<ScanPose>& device_poses, cudaStream_t stream) {
  std::size_t knots = 0;
  for (const ScanMotion& motion : motions) knots += motion.knot_count();
  if (poses.size() < knots) {
    poses = PinnedBuffer<ScanPose>(knots);
    device_poses = DeviceBuffer<ScanPose>(knots, stream);
  }
  std::size_t filled = 0;
  for (const ScanMotion& motion : motions) {
    const std::vector<ScanPose> of_scan = frame_poses(motion);
    std::copy(of_scan.begin(), of_scan.end(), poses.data() + filled);
    filled += motion.knot_count();
  }
  device_poses.upload(poses.span().first(knots));
}

/// Queues the copies of the first `returns` of every attribute.
void copy_returns(const ReturnArrays& from, std::size_t returns, const ReturnArrays& to,
                  cudaStream_t stream) {
  const auto copy = [&]<class T>(const T* source, T* target) {
    if (source == nullptr || returns == 0) return;
    cuda_check(cudaMemcpyAsync(target, source, returns * sizeof(T), cudaMemcpyDeviceToHost, stream),
               "copy returns from the GPU");
  };
  copy(from.positions, to.positions);
  for_each_scan_attribute(
      [&](const auto& attribute) { copy(attribute.of(from), attribute.of(to)); });
}

}  // namespace

/// Reusable page-locked memory: allocating it takes longer than filling it.
class PinnedPool : public std::enable_shared_from_this<PinnedPool> {
 public:
  /// Returns at least this number of bytes, valid while the pointer is held.
  std::shared_ptr<std::uint8_t> get(std::size_t bytes) {
    auto buffer = take(bytes);
    if (!buffer) buffer = std::make_shared<PinnedBuffer<std::uint8_t>>(bytes);
    return {buffer->data(), [buffer, pool = weak_from_this()](std::uint8_t*) mutable {
              if (const auto here = pool.lock()) here->give_back(std::move(buffer));
            }};
  }

 private:
  using Buffer = std::shared_ptr<PinnedBuffer<std::uint8_t>>;

  Buffer take(std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    const auto found = std::find_if(free_.begin(), free_.end(),
                                    [&](const Buffer& buffer) { return buffer->size() >= bytes; });
    if (found == free_.end()) {
      free_.clear();  // too small; later requests will have the new size
      return nullptr;
    }
    Buffer buffer = std::move(*found);
    free_.erase(found);
    return buffer;
  }
  void give_back(Buffer buffer) {
    constexpr std::size_t kMaxFree = 2 * kLanes;
    const std::lock_guard lock(mutex_);
    if (free_.size() < kMaxFree) free_.push_back(std::move(buffer));
  }

  std::mutex mutex_;
  std::vector<Buffer> free_;
};

/// One launch, possibly in progress.
struct ReportLane {
  std::shared_ptr<Stream> stream = std::make_shared<Stream>();
  Event begin, traced, counted;
  BatchPoses poses;
  WorldObjects objects;
  PinnedBuffer<ScanPose> frame_poses;
  DeviceBuffer<ScanPose> device_frame_poses;
  DeviceBuffer<Hit> hits;
  DeviceBuffer<ReportedReturn> returns;
  DeviceBuffer<std::uint8_t> counts;
  DeviceBuffer<std::uint32_t> block_counts;
  DeviceBuffer<std::uint32_t> offsets;
  PinnedBuffer<std::uint32_t> host_offsets;
  std::shared_ptr<DeviceBuffer<std::uint8_t>> attributes;  ///< room for all returns
  std::size_t first = 0, count = 0;                        ///< scans

  ReportSpace space() const {
    return {returns.data(), counts.data(), block_counts.data(), offsets.data()};
  }
  /// After an exception: waits until no work in progress writes to the freed memory.
  ~ReportLane() { cudaStreamSynchronize(stream->get()); }
};

/// A sensor in a scene on one device.
struct DeviceReporter {
  explicit DeviceReporter(const DevicePart& scene_part) : part(&scene_part) {}
  ~DeviceReporter() {
    const DeviceGuard guard(part->device);
    for (auto& lane : lanes) lane.reset();
    world.reset();
    rules.reset();
    primitives = {};
    firings = {};
  }
  DeviceReporter(const DeviceReporter&) = delete;
  DeviceReporter& operator=(const DeviceReporter&) = delete;

  const DevicePart* part;
  Stream stream;
  RaySource source;
  OrderedFirings firings;
  DeviceBuffer<PrimitiveValues> primitives;
  std::unique_ptr<DeviceRules> rules;
  std::unique_ptr<DeviceWorld> world;
  std::array<std::unique_ptr<ReportLane>, kLanes> lanes;
};

}  // namespace gpu

using gpu::cuda_check;
using gpu::DeviceBuffer;
using gpu::DeviceGuard;
using gpu::DeviceReporter;
using gpu::ReportLane;

/// One call of report().
struct GpuReporter::Run {
  std::span<const ScanMotion> motions;
  std::uint64_t first_number;
  const World* world;
  const Executor& executor;
  BatchMemory memory;
  std::size_t devices;
  std::size_t scans = 0;  ///< of a batch
  ReportTimes times;

  std::size_t batches() const { return (motions.size() + scans - 1) / scans; }
  /// Batch k runs in lane k % lanes(), so batches are returned in order.
  std::size_t lanes() const { return devices * gpu::kLanes; }
  DeviceReporter& device_of(const GpuReporter& reporter, std::size_t k) const {
    return *reporter.devices_[k % lanes() % devices];
  }
  ReportLane& lane_of(const GpuReporter& reporter, std::size_t k) const {
    return *device_of(reporter, k).lanes[k % lanes() / devices];
  }
};

GpuReporter::GpuReporter(const gpu::SceneParts& scene, const ScanRules& rules)
    : scene_(scene),
      firings_(rules.firings().size()),
      hits_a_firing_(rules.beam().hits_per_firing()),
      returns_a_firing_(static_cast<std::size_t>(rules.beam().returns)),
      depth_(rules.beam().depth),
      scan_duration_s_(1.0 / rules.sensor().rotation_hz),
      fields_(rules.fields()),
      deskews_(rules.deskews()),
      pinned_(std::make_shared<gpu::PinnedPool>()) {
  if (firings_ == 0) throw Error(ErrorKind::usage, "the sensor has no firings");
  const std::vector<FiringRay> rays = firing_rays(rules.sensor(), rules.cast_firings());
  const gpu::CastingOrder order = gpu::coherent_order(rules.cast_firings());
  for (const gpu::DevicePart& part : scene.parts) {
    const DeviceGuard guard(part.device);
    auto device = std::make_unique<DeviceReporter>(part);
    const cudaStream_t stream = device->stream.get();
    device->firings = gpu::OrderedFirings(rays, order, stream);
    if (part.values == nullptr) device->primitives = gpu::upload_primitives(rules.table(), stream);
    device->rules = std::make_unique<gpu::DeviceRules>(
        rules, part.values != nullptr ? part.values : device->primitives.data(), stream);
    gpu::RaySource& source = device->source;
    source.kind = gpu::RaySource::Kind::scans;
    source.firing_count = static_cast<std::uint32_t>(rays.size());
    source.t_min = static_cast<float>(rules.sensor().min_range_m);
    source.t_max = static_cast<float>(rules.sensor().max_range_m);
    source.firings = device->firings.rays.data();
    source.order = device->firings.order.data();
    device->stream.wait("copy a sensor to the GPU");
    devices_.push_back(std::move(device));
  }
}

GpuReporter::~GpuReporter() = default;

std::size_t GpuReporter::scans_at_once(std::size_t scans, std::size_t lanes) const {
  const std::size_t work = firings_ * std::max(hits_a_firing_, returns_a_firing_);
  const std::size_t most =
      std::clamp<std::size_t>(gpu::kScanRaysAtOnce / work, 1, gpu::kMaxScansAtOnce);
  return std::clamp<std::size_t>((scans + lanes - 1) / lanes, 1, most);
}

/// Allocates memory for batches of this number of scans.
void GpuReporter::reserve(ReportLane& lane, std::size_t scans, BatchMemory memory) const {
  const cudaStream_t stream = lane.stream->get();
  const auto grow = [&]<class T>(DeviceBuffer<T>& buffer, std::size_t size) {
    if (buffer.size() >= size) return;
    buffer = {};  // before the larger one
    buffer = DeviceBuffer<T>(size, stream);
  };
  const std::size_t firings = scans * firings_;
  grow(lane.hits, firings * hits_a_firing_);
  grow(lane.returns, firings * returns_a_firing_);
  grow(lane.counts, firings);
  grow(lane.block_counts, gpu::report_blocks(scans, firings_));
  grow(lane.offsets, scans + 1);
  if (lane.host_offsets.size() < scans + 1)
    lane.host_offsets = gpu::PinnedBuffer<std::uint32_t>(scans + 1);
  if (memory == BatchMemory::device) return;
  const std::size_t bytes = ReturnLayout(fields_, firings * returns_a_firing_, nullptr).bytes;
  if (lane.attributes == nullptr) lane.attributes = std::make_shared<DeviceBuffer<std::uint8_t>>();
  grow(*lane.attributes, bytes);
}

/// Makes smaller batches if the memory is too small for batches that fill the GPU.
void GpuReporter::reserve_all(Run& run) {
  run.scans = scans_at_once(run.motions.size(), run.lanes());
  while (true) {
    try {
      for (std::size_t k = 0; k < std::min(run.lanes(), run.batches()); ++k) {
        DeviceReporter& device = run.device_of(*this, k);
        const DeviceGuard guard(device.part->device);
        auto& lane = device.lanes[k % run.lanes() / run.devices];
        if (lane == nullptr) lane = std::make_unique<ReportLane>();
        lane->stream->wait("prepare scans on the GPU");  // after an exception
        reserve(*lane, run.scans, run.memory);
      }
      return;
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::unavailable || run.scans == 1) throw;
      run.scans = (run.scans + 1) / 2;
      for (auto& device : devices_) {
        const DeviceGuard guard(device->part->device);
        for (auto& lane : device->lanes) lane.reset();
      }
    }
  }
}

/// Drops geometries of another world, or of this one before it grew.
void GpuReporter::prepare_world(Run& run) {
  if (run.world == nullptr) return;
  for (auto& device : devices_) {
    const DeviceGuard guard(device->part->device);
    if (device->world == nullptr || !device->world->is_of(*run.world))
      device->world = std::make_unique<gpu::DeviceWorld>(*run.world);
  }
}

/// Queues the work for batch k up to the counting of its returns.
void GpuReporter::begin(Run& run, std::size_t k) {
  DeviceReporter& device = run.device_of(*this, k);
  const DeviceGuard guard(device.part->device);
  ReportLane& lane = run.lane_of(*this, k);
  const cudaStream_t stream = lane.stream->get();
  lane.first = k * run.scans;
  lane.count = std::min(run.scans, run.motions.size() - lane.first);
  const auto motions = run.motions.subspan(lane.first, lane.count);
  lane.poses.upload(motions, scene_.origin, stream);
  gpu::LaunchPoses poses;
  if (deskews_ && lane.poses.moving) {
    gpu::upload_frame_poses(motions, lane.frame_poses, lane.device_frame_poses, stream);
    poses.frame_knots = lane.device_frame_poses.data();
  }
  poses.knots = lane.poses.device_poses.data();
  if (lane.poses.moving) poses.first_knots = lane.poses.device_first_poses.data();
  poses.first_scan = run.first_number + lane.first;
  poses.scans = static_cast<std::uint32_t>(lane.count);
  poses.firings = static_cast<std::uint32_t>(firings_);
  gpu::RaySource source = device.source;
  lane.poses.set(source);
  if (run.memory == BatchMemory::device) {
    const std::size_t room = lane.count * firings_ * returns_a_firing_;
    lane.attributes = std::make_shared<DeviceBuffer<std::uint8_t>>(
        ReturnLayout(fields_, room, nullptr).bytes, stream);
  }
  const std::size_t rays = lane.count * source.firing_count;
  if (run.world != nullptr)
    lane.objects.upload(*run.world, *device.world, motions, poses.first_scan, scan_duration_s_,
                        run.executor, stream);
  lane.begin.record(stream);
  device.part->scene->cast(source, rays, depth_, lane.hits.data(), stream);
  if (run.world != nullptr) lane.objects.add_hits(source, depth_, lane.hits.data(), stream);
  lane.traced.record(stream);
  const FiringRules& rules = device.rules->view();
  gpu::queue_reports(rules, poses, lane.hits.data(), lane.space(), stream);
  cuda_check(
      cudaMemcpyAsync(lane.host_offsets.data(), lane.offsets.data(),
                      (lane.count + 1) * sizeof(std::uint32_t), cudaMemcpyDeviceToHost, stream),
      "copy counts from the GPU");
  const ReturnLayout layout(fields_, lane.count * firings_ * returns_a_firing_,
                            lane.attributes->data());
  gpu::queue_returns(rules, poses, lane.space(), layout.arrays, stream);
  lane.counted.record(stream);
}

/// Waits for batch k, copies it and passes it to the sink.
void GpuReporter::end(Run& run, std::size_t k, BatchSink sink) {
  DeviceReporter& device = run.device_of(*this, k);
  const DeviceGuard guard(device.part->device);
  ReportLane& lane = run.lane_of(*this, k);
  const cudaStream_t stream = lane.stream->get();
  lane.counted.wait("simulate scans on the GPU");
  run.times.traced_s += lane.traced.seconds_since(lane.begin);
  ScanBatch batch;
  batch.first = lane.first;
  batch.offsets.assign(lane.host_offsets.data(), lane.host_offsets.data() + lane.count + 1);
  const std::size_t room = lane.count * firings_ * returns_a_firing_;
  const ReturnLayout there(fields_, room, lane.attributes->data());
  if (run.memory == BatchMemory::device) {
    batch.arrays = there.arrays;
    batch.device = device.part->device;
    void* const first = lane.attributes->data();
    batch.memory =
        std::shared_ptr<void>(first, [memory = std::move(lane.attributes), stream = lane.stream,
                                      number = batch.device](void*) mutable {
          const DeviceGuard here(number);
          memory.reset();
        });
    lane.attributes = nullptr;
  } else {
    const std::size_t bytes = ReturnLayout(fields_, batch.returns(), nullptr).bytes;
    // Two fixed sizes, so that the memory of one batch fits any other.
    const std::size_t most =
        ReturnLayout(fields_, run.scans * firings_ * returns_a_firing_, nullptr).bytes;
    auto memory = pinned_->get(bytes <= most / 2 ? most / 2 : most);
    batch.arrays = ReturnLayout(fields_, batch.returns(), memory.get()).arrays;
    gpu::copy_returns(there.arrays, batch.returns(), batch.arrays, stream);
    lane.stream->wait("copy returns from the GPU");
    batch.memory = std::move(memory);
  }
  sink(std::move(batch));
}

ReportTimes GpuReporter::report(std::span<const ScanMotion> scans, std::uint64_t first_number,
                                const World* world, const Executor& executor, BatchMemory memory,
                                BatchSink sink) {
  if (scans.empty()) return {};
  const std::size_t devices = memory == BatchMemory::device ? 1 : devices_.size();
  if (world != nullptr && world->empty()) world = nullptr;
  Run run{scans, first_number, world, executor, memory, devices, 0, {}};
  reserve_all(run);
  prepare_world(run);
  const Stopwatch all;
  double in_sink_s = 0;
  const auto timed_sink = [&](ScanBatch&& batch) {
    const Stopwatch watch;
    sink(std::move(batch));
    in_sink_s += watch.seconds();
  };
  for (std::size_t k = 0; k < std::min(run.lanes(), run.batches()); ++k) begin(run, k);
  for (std::size_t k = 0; k < run.batches(); ++k) {
    end(run, k, timed_sink);
    if (k + run.lanes() < run.batches()) begin(run, k + run.lanes());
  }
  run.times.reported_s = all.seconds() - in_sink_s;
  return run.times;
}

}  // namespace adasplats
#endif
