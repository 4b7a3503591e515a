// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/baselines/program.h"

#include <cstdlib>

#include "adasplats/core/child_process.h"
#include "adasplats/core/error.h"

namespace adasplats {

std::uint64_t run_program(const std::filesystem::path& program,
                          const std::vector<std::string>& arguments, int threads,
                          const std::filesystem::path& log, ProgressSink& progress) {
  ChildProgram child{{program.string()}, {"OMP_NUM_THREADS=" + std::to_string(threads)}, log};
  child.arguments.insert(child.arguments.end(), arguments.begin(), arguments.end());
  // By default its threads spin while they wait, which took 4 times as long on shared cores.
  if (std::getenv("OMP_WAIT_POLICY") == nullptr)
    child.environment.emplace_back("OMP_WAIT_POLICY=passive");
  const ChildResult result = run_child(child, progress);
  if (result.end == ChildEnd::done) return result.peak_memory_bytes;
  throw Error(ErrorKind::unavailable, program.string() + ": failed (exit code " +
                                          std::to_string(result.exit_code) +
                                          "): " + result.message);
}

}  // namespace adasplats
