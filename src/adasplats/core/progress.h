// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace adasplats {

/// Receives the progress of long work. Calls come from one thread at a time. The library never
/// prints: a program that wants a bar or a log passes its own sink.
class ProgressSink {
 public:
  virtual ~ProgressSink() = default;
  /// A step begins, of known or unknown (0) size; the previous one has ended.
  virtual void begin_step(std::string_view /*name*/, std::uint64_t /*total*/) {}
  /// `done` of the step's total. May throw to cancel the work (the exception reaches the caller).
  virtual void advance(std::uint64_t /*done*/) {}
  virtual void end_step() {}
  /// Something that the user should know although the result is valid, e.g. unoriented normals.
  virtual void warn(std::string_view /*message*/) {}
};

}  // namespace adasplats
