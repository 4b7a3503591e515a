// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "adasplats/core/error.h"
#include "adasplats/io/packets/capture_sender.h"
#include "adasplats/jobs/session/inputs.h"
#include "cli/commands.h"
#include "cli/options/option_types.h"
#include "cli/terminal.h"
#include "cli/text_table.h"

namespace adasplats::app {
namespace {

constexpr const char* kSendExamples =
    "  adasplats send drive/drive.pcap --to 127.0.0.1\n"
    "  adasplats send drive.pcapng --to 192.168.1.77:2368 --port 2368 --speed 0.5\n";

class SendCommand final : public Command {
 public:
  explicit SendCommand(CLI::App& program)
      : Command(program, "send", "Send the packets of a capture over UDP, as a sensor would",
                kSendExamples) {
    OptionSet& app = options();
    require(add_path(app, "CAPTURE", capture_, "Capture of packets (.pcap, .pcapng)"));
    require(
        app.add_option("--to", to_,
                       "Destination: name or IPv4 address, and port (default: that of each packet)")
            ->type_name("HOST[:PORT]"));
    app.add_option("--port", sending_.only_port,
                   "Send only the packets of this destination port (default: all UDP packets)")
        ->type_name("PORT");
    app.add_option("--speed", sending_.speed,
                   "Playback speed; 1: real time, 0: as fast as possible")
        ->capture_default_str()
        ->type_name("X");
  }

  void run(Session& session) override {
    if (!(sending_.speed >= 0))
      throw Error(ErrorKind::usage, "--speed is below 0, expected 0 or more");
    require_input(capture_);
    set_destination(to_, sending_);
    session.progress.begin_step("send", 0);
    const SendResult result = send_capture(capture_, sending_, [&](std::uint64_t sent) {
      session.executor.check_interruption();
      session.progress.advance(sent);
    });
    session.progress.end_step();
    session.report["datagrams"] = result.datagrams;
    session.report["bytes"] = result.bytes;
    session.report["seconds"] = result.seconds;
    session.report["latest_s"] = result.latest_s;
    session.report["left_out"] = {{"others", result.counts.others},
                                  {"cut", result.counts.cut},
                                  {"timeless", result.counts.timeless},
                                  {"torn", result.counts.torn}};
    print(grouped(result.datagrams) + " datagrams, " + grouped(result.bytes) + " bytes, in " +
          fixed(result.seconds, 3) + " s to " + to_ + "\n");
  }

 private:
  std::filesystem::path capture_;
  std::string to_;
  SendOptions sending_;
};

}  // namespace

std::unique_ptr<Command> make_send_command(CLI::App& program) {
  return std::make_unique<SendCommand>(program);
}

}  // namespace adasplats::app
