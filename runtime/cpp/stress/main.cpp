// SPDX-License-Identifier: Apache-2.0
// All members of a service, used at random by many clients that come and go in every way, for a
// while: see docs/project/stress.md.
//   stress [--seconds S] [--clients N] [--seed N] [--no-kill]
#include <signal.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "runtime/cpp/stress/roles.hpp"

namespace {

// False for words that are not understood.
bool read_options(int count, char** words, rr::stress::Options& options) {
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    if (word == "--no-kill") {
      options.may_kill = false;
      continue;
    }
    if (++i == count) return false;
    const std::string value = words[i];
    if (word == "--role") {
      options.role = value;
      continue;
    }
    if (word == "--host") {
      options.host = value;
      continue;
    }
    char* end = nullptr;
    const unsigned long number = std::strtoul(value.c_str(), &end, 10);
    if (value.empty() || *end != '\0') return false;
    const auto size = static_cast<std::uint32_t>(number);
    if (word == "--seconds") {
      options.seconds = std::chrono::seconds(size);
    } else if (word == "--clients") {
      options.clients = size;
    } else if (word == "--seed") {
      options.seed = size;
    } else if (word == "--port") {
      options.port = static_cast<std::uint16_t>(number);
    } else if (word == "--first") {
      options.first = size;
    } else if (word == "--count") {
      options.count = size;
    } else {
      return false;
    }
  }
  return options.clients != 0 && options.seconds.count() != 0;
}

}  // namespace

int main(int count, char** words) {
  rr::stress::Options options;
  if (!read_options(count, words, options)) {
    std::fprintf(stderr, "usage: stress [--seconds S] [--clients N] [--seed N] [--no-kill]\n");
    return 2;
  }
  // A process that writes to one that has ended gets an error instead.
  ::signal(SIGPIPE, SIG_IGN);
  try {
    if (options.role == "service") return rr::stress::serve(options);
    if (options.role == "clients") return rr::stress::use(options);
    if (options.role == "holder") return rr::stress::hold(options);
    return rr::stress::direct(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "stress: %s\n", error.what());
    return 1;
  }
}
