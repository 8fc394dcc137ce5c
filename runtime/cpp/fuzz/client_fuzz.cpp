// SPDX-License-Identifier: Apache-2.0
// What a service says to a client: generated stubs, with a service whose messages go through the
// fuzzer.
#include <cstdint>

#include "runtime/cpp/fuzz/client_exchange.hpp"
#include "runtime/cpp/fuzz/client_programs.hpp"
#include "runtime/cpp/fuzz/fuzzer_options.hpp"

extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
  // No single thing that a client allocates has to do with more than a few messages.
  rr::fuzz::add_fuzzer_options(
      count, arguments,
      {rr::fuzz::no_leaks, "-malloc_limit_mb=32", "-max_len=1024", "-len_control=20"});
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // One for all inputs: a node's threads take longer to start than an input to be handled.
  static rr::fuzz::ClientExchange exchange(rr::fuzz::client_programs());
  exchange.run(rr::fuzz::input_of(data, size));
  return 0;
}
