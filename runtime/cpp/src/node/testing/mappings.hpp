// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/mman.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace rr::testing {

/// A shared memory that this process has mapped (docs/reference/shared_memory.md).
struct Mapping {
  std::byte* begin = nullptr;
  std::size_t size = 0;
  bool is_writable = false;
  std::uint32_t kind = 0;  ///< 1 two rings, 2 slots of a wire, 3 ring of a pipe
  std::uint64_t id = 0;    ///< of a wire or pipe: the number that readers know it by
};

/// All of them, but for those that go meanwhile.
inline std::vector<Mapping> mappings() {
  std::vector<Mapping> found;
  std::ifstream maps("/proc/self/maps");
  // Read by the system, which does not mind what is not there any more.
  std::ifstream memory("/proc/self/mem", std::ios::binary);
  for (std::string line; std::getline(maps, line);) {
    if (line.find("/memfd:robdef") == std::string::npos) continue;
    std::size_t dash = 0;
    const std::uintptr_t begin = std::stoull(line, &dash, 16);
    const std::size_t rights = line.find(' ') + 1;
    const std::uintptr_t end = std::stoull(line.substr(dash + 1), nullptr, 16);
    // NOLINTNEXTLINE(performance-no-int-to-ptr): the system writes addresses as numbers.
    Mapping mapping{reinterpret_cast<std::byte*>(begin), end - begin, line[rights + 1] == 'w'};
    std::array<char, 0x28> header{};
    memory.clear();
    memory.seekg(static_cast<std::streamoff>(begin));
    if (!memory.read(header.data(), header.size())) continue;
    std::memcpy(&mapping.kind, header.data() + 0x0C, sizeof mapping.kind);
    std::memcpy(&mapping.id, header.data() + 0x20, sizeof mapping.id);
    found.push_back(mapping);
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
    const std::size_t words = random() % 2 == 0 ? 0x300 : 0x1000;
    const std::size_t most = random() % 4 == 0 ? size_ : words;
    const std::uint64_t value = random() >> (random() % 64);
    const std::size_t at = random() % (most - sizeof value) & ~std::size_t{3};
    std::memcpy(static_cast<std::byte*>(bytes_) + at, &value, 1 + random() % sizeof value);
  }
  /// The same in a part of it.
  void scribble_at(std::size_t begin, std::size_t size, std::mt19937_64& random) const {
    const std::uint64_t value = random() >> (random() % 64);
    const std::size_t at = begin + random() % (size / sizeof value) * sizeof value;
    std::memcpy(static_cast<std::byte*>(bytes_) + at, &value, sizeof value);
  }

 private:
  void* bytes_;
  std::size_t size_;
};

}  // namespace rr::testing
