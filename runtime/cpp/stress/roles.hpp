// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

/// The stress program is several processes of one program: a director, a service, and processes
/// with clients. The director writes commands to the others, a line each, and reads what they say.
namespace rr::stress {

struct Options {
  std::chrono::seconds seconds{600};
  std::uint32_t clients = 64;
  std::uint32_t seed = 1;
  bool may_kill = true;  ///< whether processes are killed and stopped
  // Of one process
  std::string role = "director";
  std::string host = "127.0.0.1";  ///< where the service is
  std::uint16_t port = 0;
  std::uint32_t first = 0;  ///< of the clients of a process
  std::uint32_t count = 0;
};

/// Each runs until it is told to end; the result is that of the process.
int direct(const Options& options);
int serve(const Options& options);
int use(const Options& options);
int hold(const Options& options);

/// How long a call may take before it is taken to hang, and for what comes by itself.
std::chrono::seconds hang_limit();
std::chrono::seconds patience();

}  // namespace rr::stress
