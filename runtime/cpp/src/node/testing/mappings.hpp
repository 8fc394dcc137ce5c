// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace rr::testing {

/// A shared memory that this process has mapped.
struct Mapping {
  std::byte* begin = nullptr;
  std::size_t size = 0;
  bool is_writable = false;

  /// Its kind (docs/reference/shared_memory.md): 1 two rings, 2 slots of a wire.
  [[nodiscard]] std::uint32_t kind() const { return number<std::uint32_t>(0x0C); }
  /// Of slots: the number that readers know it by.
  [[nodiscard]] std::uint64_t id() const { return number<std::uint64_t>(0x20); }

 private:
  template <class T>
  [[nodiscard]] T number(std::size_t at) const {
    T value{};
    std::memcpy(&value, begin + at, sizeof value);
    return value;
  }
};

/// All of them.
inline std::vector<Mapping> mappings() {
  std::vector<Mapping> found;
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    if (line.find("/memfd:robdef") == std::string::npos) continue;
    std::size_t dash = 0;
    const std::uintptr_t begin = std::stoull(line, &dash, 16);
    const std::size_t rights = line.find(' ') + 1;
    const std::uintptr_t end = std::stoull(line.substr(dash + 1), nullptr, 16);
    found.push_back({reinterpret_cast<std::byte*>(begin), end - begin, line[rights + 1] == 'w'});
  }
  return found;
}

/// The same memory at another place, where it stays for as long as this exists.
class SecondMapping {
 public:
  explicit SecondMapping(const Mapping& first)
      : bytes_(::mremap(first.begin, 0, first.size, MREMAP_MAYMOVE)), size_(first.size) {}
  SecondMapping(SecondMapping&& other) noexcept
      : bytes_(std::exchange(other.bytes_, MAP_FAILED)), size_(other.size_) {}
  SecondMapping& operator=(SecondMapping&&) = delete;
  ~SecondMapping() {
    if (is_there()) ::munmap(bytes_, size_);
  }

  /// False when the first one has gone before.
  [[nodiscard]] bool is_there() const { return bytes_ != MAP_FAILED; }
  /// Writes something at a place of it, of the words most of the time.
  void scribble(std::mt19937_64& random) const {
    const std::size_t most = random() % 4 == 0 ? size_ : std::size_t{0x300};
    const std::uint64_t value = random() >> (random() % 64);
    const std::size_t at = random() % (most - sizeof value) & ~std::size_t{3};
    std::memcpy(static_cast<std::byte*>(bytes_) + at, &value, 1 + random() % sizeof value);
  }

 private:
  void* bytes_;
  std::size_t size_;
};

}  // namespace rr::testing
