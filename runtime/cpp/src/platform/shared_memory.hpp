// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <system_error>
#include <utility>

#include "runtime/cpp/src/platform/clock.hpp"
#include "runtime/cpp/src/platform/sleep_word.hpp"
#include "runtime/cpp/src/platform/sockets.hpp"

/// Memory that two processes of one machine share, how one gets it from the other, and how they
/// wake each other.
namespace rr::platform {

/// Whether this system has what is here. Without it the functions below fail with
/// function_not_supported.
bool has_shared_memory();

/// Memory that other processes may map, too, mapped into this one. Anybody who has it may change
/// it at any time.
class SharedMemory {
 public:
  SharedMemory() = default;
  SharedMemory(std::byte* bytes, std::size_t size) : bytes_(bytes), size_(size) {}
  SharedMemory(SharedMemory&& other) noexcept
      : bytes_(std::exchange(other.bytes_, nullptr)), size_(std::exchange(other.size_, 0)) {}
  SharedMemory& operator=(SharedMemory&& other) noexcept {
    std::swap(bytes_, other.bytes_);
    std::swap(size_, other.size_);
    return *this;
  }
  ~SharedMemory();

  [[nodiscard]] std::byte* bytes() const { return bytes_; }
  [[nodiscard]] std::size_t size() const { return size_; }
  explicit operator bool() const { return bytes_ != nullptr; }

 private:
  std::byte* bytes_ = nullptr;
  std::size_t size_ = 0;
};

/// Fresh memory of `size` bytes, filled with zeros, whose size nobody can change. `handle` is to be
/// passed on.
SharedMemory make_shared_memory(std::size_t size, Descriptor& handle, std::error_code& error);
/// Maps what another process has passed. Refused, with invalid_argument: what is no memory, or
/// could change its size, or is larger than `largest` bytes.
SharedMemory map_shared_memory(const Descriptor& handle, std::size_t largest,
                               std::error_code& error);

/// As make_shared_memory(), but nobody who gets the handle can write to it, whoever he is: neither
/// by a mapping nor otherwise. This process can. An error where the system has nothing of the kind.
SharedMemory make_published_memory(std::size_t size, Descriptor& handle, std::error_code& error);
/// Maps such memory, to be read alone: writing to it ends the process. Refused as by
/// map_shared_memory(), and what another reader could write to.
SharedMemory map_published_memory(const Descriptor& handle, std::size_t largest,
                                  std::error_code& error);

/// As send(), on a local socket, with a handle that travels with the first byte.
std::ptrdiff_t send_with_handle(int socket, std::span<const std::byte> bytes,
                                const Descriptor& handle);
/// Whether the other side of a local socket has yet to receive something that was sent. False where
/// the system does not say.
bool has_unreceived(int socket);
/// As receive() without waiting. A handle that comes with the bytes is left in `handle`; of several
/// the first.
std::ptrdiff_t receive_with_handle(int socket, std::span<std::byte> room, Descriptor& handle);

/// As sleep_on(), on a word in shared memory, for `time` at most. False when that is over. The word
/// need not be in memory that this process may write to; the same holds for wake_shared().
bool sleep_on_shared(const SleepWord& word, std::uint32_t seen, std::chrono::nanoseconds time);
/// Wakes the threads of all processes that sleep on the word.
void wake_shared(const SleepWord* word);

/// The number of the processor that the calling thread runs on now.
std::uint32_t current_processor();
/// To be called between two looks at a word that another processor is about to change.
void pause_briefly();

}  // namespace rr::platform
