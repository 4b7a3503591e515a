// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "commands/view_job.h"

#include <atomic>
#include <chrono>
#include <exception>
#include <thread>

#include "adasplats/core/error.h"
#include "adasplats/view/live_message.h"
#include "adasplats/view/live_scans.h"
#include "adasplats/view/page_files.h"
#include "adasplats/view/view_pages.h"
#include "cli/interrupt.h"
#include "cli/open_browser.h"
#include "cli/terminal.h"
#include "commands/view_inputs.h"

namespace adasplats::app {
namespace {

/// How often it is looked whether the user wants to stop.
constexpr std::chrono::milliseconds kGlance{50};

void check_page() {
  if (!page_files().empty()) return;
  throw Error(ErrorKind::unavailable,
              "this program was built without the viewer; install Node.js 18 or newer with npm and "
              "build it again (the build says what it found)");
}

/// Stops the server when the user asks for it. The exception of an interrupt is kept for the
/// caller's thread.
class StopOnSignal {
 public:
  explicit StopOnSignal(HttpServer& server) : thread_([this, &server] { watch(server); }) {}
  ~StopOnSignal() {
    done_ = true;
    thread_.join();
  }
  StopOnSignal(const StopOnSignal&) = delete;
  StopOnSignal& operator=(const StopOnSignal&) = delete;

 private:
  void watch(HttpServer& server) {
    while (!done_) {
      try {
        throw_if_interrupted();
      } catch (const Interrupted&) {
        server.stop();
        return;
      }
      std::this_thread::sleep_for(kGlance);
    }
  }

  std::atomic<bool> done_ = false;
  std::thread thread_;
};

}  // namespace

void run_view(const ViewJob& job, Session& session) {
  check_page();
  live_sensor(job.sensor);  // an unknown name is refused before anything is loaded
  const LoadedView view = load_view(job, session);
  const ViewPages pages(view.scene);
  LiveScans live(view.scene, session.executor);
  HttpServerOptions options;
  options.address = job.address;
  options.port = job.port;
  options.token = job.token.empty() ? random_token() : job.token;
  HttpServer server(
      options, [&pages](std::string_view path) { return pages.get(path); }, live);
  print(server.url() + "\n");
  if (job.browser) open_browser(server.url());
  {
    const StopOnSignal stop(server);
    server.run();
  }
  throw_if_interrupted();
}

}  // namespace adasplats::app
