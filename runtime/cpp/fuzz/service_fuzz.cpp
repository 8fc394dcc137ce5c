// SPDX-License-Identifier: Apache-2.0
// What a client sends on one connection to a node that offers a service.
#include <cstdint>
#include <cstring>
#include <span>

#include "runtime/cpp/fuzz/conversation_mutation.hpp"
#include "runtime/cpp/fuzz/fuzzer_options.hpp"
#include "runtime/cpp/fuzz/service_exchange.hpp"

namespace {

std::span<const std::byte> bytes_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const std::byte*>(data), size};
}

// 0, which leaves the input as it is, when the result does not fit.
std::size_t put(const rr::fuzz::Bytes& bytes, std::uint8_t* data, std::size_t max_size) {
  if (bytes.size() > max_size) return 0;
  if (!bytes.empty()) std::memcpy(data, bytes.data(), bytes.size());
  return bytes.size();
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
  rr::fuzz::add_fuzzer_options(count, arguments, {rr::fuzz::no_leaks});
  return 0;
}

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned int seed) {
  rr::fuzz::ConversationMutation mutation(seed, LLVMFuzzerMutate);
  const std::size_t result = put(mutation.mutate(bytes_of(data, size)), data, max_size);
  return result != 0 ? result : LLVMFuzzerMutate(data, size, max_size);
}

extern "C" std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* data1, std::size_t size1,
                                                 const std::uint8_t* data2, std::size_t size2,
                                                 std::uint8_t* out, std::size_t max_size,
                                                 unsigned int seed) {
  rr::fuzz::ConversationMutation mutation(seed, LLVMFuzzerMutate);
  return put(mutation.cross(bytes_of(data1, size1), bytes_of(data2, size2)), out, max_size);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // One for all inputs: a node's threads take longer to start than an input to be handled.
  static rr::fuzz::ServiceExchange exchange;
  exchange.run(bytes_of(data, size));
  return 0;
}
