// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "rr/array.hpp"
#include "rr/definition.hpp"
#include "rr/stub.hpp"

/// Memories: arrays of which parts are read and written (07, section 13). Positions and counts are
/// in items; of several dimensions the first is the one whose items lie side by side.
namespace rr {

/// What a service offers as a memory, without its type: generated code hands it to the runtime.
/// Calls come on threads of the node and may overlap.
class MemorySource {
 public:
  virtual ~MemorySource() = default;

  /// A part of the memory, as a request names it. `data` is a value of the member's type, an
  /// Array<T> or MultiArray<T>. Throws rr::Error (out_of_range, ...).
  virtual void rr_read(std::span<const std::uint64_t> position,
                       std::span<const std::uint64_t> count, void* data) = 0;
  virtual void rr_write(std::span<const std::uint64_t> position,
                        std::span<const std::uint64_t> count, const void* data) = 0;
  /// One length, or one for each dimension.
  [[nodiscard]] virtual std::vector<std::uint64_t> rr_dims() const = 0;
};

/// A memory of one dimension that a service offers: derive from it, or use StoredArrayMemory.
template <class T>
class ArrayMemorySource : public MemorySource {
 public:
  [[nodiscard]] virtual std::uint64_t length() const = 0;
  /// Both are called with a part that lies inside.
  virtual void read(std::uint64_t position, std::span<T> items) = 0;
  virtual void write(std::uint64_t position, std::span<const T> items) = 0;

  void rr_read(std::span<const std::uint64_t> position, std::span<const std::uint64_t> count,
               void* data) final;
  void rr_write(std::span<const std::uint64_t> position, std::span<const std::uint64_t> count,
                const void* data) final;
  [[nodiscard]] std::vector<std::uint64_t> rr_dims() const final { return {length()}; }
};

/// A memory of several dimensions that a service offers: derive from it, or use StoredMultiMemory.
template <class T>
class MultiMemorySource : public MemorySource {
 public:
  [[nodiscard]] virtual std::vector<std::uint64_t> dims() const = 0;
  /// Both are called with a part that lies inside; `items` has the shape `count`, first dimension
  /// fastest.
  virtual void read(std::span<const std::uint64_t> position, std::span<const std::uint64_t> count,
                    std::span<T> items) = 0;
  virtual void write(std::span<const std::uint64_t> position, std::span<const std::uint64_t> count,
                     std::span<const T> items) = 0;

  void rr_read(std::span<const std::uint64_t> position, std::span<const std::uint64_t> count,
               void* data) final;
  void rr_write(std::span<const std::uint64_t> position, std::span<const std::uint64_t> count,
                const void* data) final;
  [[nodiscard]] std::vector<std::uint64_t> rr_dims() const final { return dims(); }
};

/// A memory that is kept in this process. May be used by any threads at once.
template <class T>
class StoredArrayMemory;
template <class T>
class StoredMultiMemory;

/// A memory of an object on another node, without its type. Transfers are cut into requests that
/// the service takes; each is whole, all together are not.
class MemoryMember {
 protected:
  MemoryMember(Stub& stub, const Member& member) : stub_(&stub), member_(&member) {}

  std::uint64_t ask_length();
  std::vector<std::uint64_t> ask_dims();

  Stub* stub_;
  const Member* member_;
};

/// A memory of one dimension of an object on another node: `stub->buffer()`.
template <class T>
class ArrayMemory;
/// A memory of several dimensions of an object on another node.
template <class T>
class MultiMemory;

}  // namespace rr
