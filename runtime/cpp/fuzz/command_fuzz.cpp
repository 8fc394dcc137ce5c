// SPDX-License-Identifier: Apache-2.0
// The same for the commands of `robdef` that use a service, and what they print.
#include <cstdint>

#include "runtime/cpp/fuzz/client_exchange.hpp"
#include "runtime/cpp/fuzz/client_programs.hpp"
#include "runtime/cpp/fuzz/fuzzer_options.hpp"

extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
  // What is allocated at once for what a service claims is bounded: a memory has 64 MiB.
  rr::fuzz::add_fuzzer_options(
      count, arguments,
      {rr::fuzz::no_leaks, "-malloc_limit_mb=80", "-max_len=1024", "-len_control=20"});
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // One for all inputs: a node's threads take longer to start than an input to be handled.
  static rr::fuzz::ClientExchange exchange(rr::fuzz::command_programs());
  exchange.run(rr::fuzz::input_of(data, size));
  return 0;
}
