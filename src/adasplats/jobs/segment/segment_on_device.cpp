// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/segment/segment_on_device.h"

#include "adasplats/gpu/base/engines.h"

namespace adasplats {

Segmentation segment_on_device(const PointCloud& cloud, const Network& network,
                               const SegmentOptions& options, Session& session) {
  Segmentation result;
  const bool on_gpu = try_on_gpu(session.device, session.progress, [&] {
    const auto engine = make_cuda_segment_engine(session.device.gpu_numbers().front());
    result = segment_cloud(cloud, network, options, *engine, session.executor);
  });
  return on_gpu ? result : segment_cloud(cloud, network, options, session.executor);
}

}  // namespace adasplats
