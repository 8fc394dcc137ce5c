// SPDX-License-Identifier: Apache-2.0
// Local sockets of Windows pass no handles: nodes share no memory there.
#include "runtime/cpp/src/platform/shared_memory.hpp"

namespace rr::platform {
namespace {

std::error_code there_is_none() { return std::make_error_code(std::errc::function_not_supported); }

}  // namespace

bool has_shared_memory() { return false; }

SharedMemory::~SharedMemory() = default;

SharedMemory make_shared_memory(std::size_t /*size*/, Descriptor& /*handle*/,
                                std::error_code& error) {
  error = there_is_none();
  return {};
}

SharedMemory map_shared_memory(const Descriptor& /*handle*/, std::size_t /*largest*/,
                               std::error_code& error) {
  error = there_is_none();
  return {};
}

SharedMemory make_published_memory(std::size_t /*size*/, Descriptor& /*handle*/,
                                   std::error_code& error) {
  error = there_is_none();
  return {};
}

SharedMemory map_published_memory(const Descriptor& /*handle*/, std::size_t /*largest*/,
                                  std::error_code& error) {
  error = there_is_none();
  return {};
}

std::ptrdiff_t send_with_handle(int /*socket*/, std::span<const std::byte> /*bytes*/,
                                const Descriptor& /*handle*/) {
  return broken;
}

bool has_unreceived(int /*socket*/) { return false; }

std::ptrdiff_t receive_with_handle(int socket, std::span<std::byte> room, Descriptor& /*handle*/) {
  return receive(socket, room, Wait::none);
}

bool sleep_on_shared(const SleepWord& word, std::uint32_t seen, std::chrono::nanoseconds time) {
  return sleep_on(word, seen,
                  Time::clock::now() + std::chrono::duration_cast<Time::duration>(time));
}

void wake_shared(const SleepWord* word) { wake(word); }

std::uint32_t current_processor() { return 0; }
void pause_briefly() {}

}  // namespace rr::platform
