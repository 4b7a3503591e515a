// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "adasplats/jobs/session/session.h"
#include "adasplats/live/answer_thread.h"
#include "adasplats/live/live_loop.h"
#include "adasplats/sensors/camera_file.h"
#include "adasplats/serve/http_server.h"

namespace adasplats {

/// The requests of docs/live.md: what a test bench asks of a simulation in real time.
class LiveApi {
 public:
  /// All must outlive it.
  LiveApi(LiveRig& rig, LiveStreams& streams, LiveLoop& loop, std::vector<MountedCamera> cameras,
          Session& session);

  /// Answers a request, if need be later from another thread: with JSON, a scan, a picture or the
  /// page; errors as {"error": "..."} with 400 (bad request), 404 (unknown), 500, 503 (too
  /// many).
  void handle(const HttpRequest& request, const HttpAnswer& answer);
  /// What GET state answers. On the simulating thread, or after its end.
  std::string state() const;
  /// What most writes answer.
  std::string brief_state() const;

 private:
  void handle_read(const std::string& path, const HttpAnswer& answer);
  void handle_write(const HttpRequest& request, const HttpAnswer& answer);
  void post_step(const HttpRequest& request, const HttpAnswer& answer);
  void send_picture(const std::string& name, const HttpAnswer& answer);
  void send_scan(const std::string& file, const HttpAnswer& answer);
  HttpReply calibration(const std::string& name) const;
  std::size_t sensor_of(const std::string& name) const;
  /// Answers with brief_state(), after `change` on the simulating thread.
  void change(const HttpAnswer& answer, std::function<void()> change);
  template <class Call>
  void on_loop(const HttpAnswer& answer, Call call);

  LiveRig& rig_;
  LiveStreams& streams_;
  LiveLoop& loop_;
  const std::vector<MountedCamera> cameras_;
  Session& session_;
  AnswerThread encoder_;
};

}  // namespace adasplats
