// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "rr/array.hpp"
#include "rr/definition.hpp"
#include "rr/error.hpp"
#include "rr/mutex.hpp"
#include "rr/stub.hpp"
#include "rr/visibility.hpp"

/// Memories: arrays of which parts are read and written (07, section 13). Positions and counts are
/// in items; of several dimensions the first is the one whose items lie side by side.
namespace RR_VISIBLE rr {

/// What a service offers as a memory, without its type: generated code hands it to the runtime.
/// Calls come on threads of the node and may overlap.
class MemorySource {
 public:
  virtual ~MemorySource() = default;

  /// Reads or writes a part, which lies inside: one position and one count for each dimension.
  /// `items` are as many items of the memory's type as the product of the counts. Throws rr::Error.
  virtual void rr_read(std::span<const std::uint64_t> position,
                       std::span<const std::uint64_t> count, void* items) = 0;
  /// Writes a part, which lies inside; otherwise as rr_read().
  virtual void rr_write(std::span<const std::uint64_t> position,
                        std::span<const std::uint64_t> count, const void* items) = 0;
  /// One length, or one for each dimension.
  [[nodiscard]] virtual std::vector<std::uint64_t> rr_dims() const = 0;
};

/// A memory of one dimension that a service offers: derive from it, or use StoredArrayMemory.
template <class T>
class ArrayMemorySource : public MemorySource {
 public:
  /// Number of items. Asked before each transfer.
  [[nodiscard]] virtual std::uint64_t length() const = 0;
  /// Gives items from `position` on, as many as `items` has room for. The part lies inside, by the
  /// length asked just before. Throws rr::Error, which the client gets.
  virtual void read(std::uint64_t position, std::span<T> items) = 0;
  /// Takes items from `position` on. The part lies inside, by the length asked just before. Throws
  /// rr::Error, which the client gets.
  virtual void write(std::uint64_t position, std::span<const T> items) = 0;

  /// Calls read().
  void rr_read(std::span<const std::uint64_t> position, std::span<const std::uint64_t> count,
               void* items) final {
    read(position[0], {static_cast<T*>(items), static_cast<std::size_t>(count[0])});
  }
  /// Calls write().
  void rr_write(std::span<const std::uint64_t> position, std::span<const std::uint64_t> count,
                const void* items) final {
    write(position[0], {static_cast<const T*>(items), static_cast<std::size_t>(count[0])});
  }
  /// Calls length().
  [[nodiscard]] std::vector<std::uint64_t> rr_dims() const final { return {length()}; }
};

/// A memory of several dimensions that a service offers: derive from it, or use StoredMultiMemory.
template <class T>
class MultiMemorySource : public MemorySource {
 public:
  /// Length of each dimension. Asked before each transfer.
  [[nodiscard]] virtual std::vector<std::uint64_t> dims() const = 0;
  /// Gives the part at `position`, of the shape `count`, first dimension fastest. It lies inside,
  /// by the dims asked just before. Throws rr::Error, which the client gets.
  virtual void read(std::span<const std::uint64_t> position, std::span<const std::uint64_t> count,
                    std::span<T> items) = 0;
  /// Takes the part at `position`, of the shape `count`, first dimension fastest. It lies inside,
  /// by the dims asked just before. Throws rr::Error, which the client gets.
  virtual void write(std::span<const std::uint64_t> position, std::span<const std::uint64_t> count,
                     std::span<const T> items) = 0;

  /// Calls read().
  void rr_read(std::span<const std::uint64_t> position, std::span<const std::uint64_t> count,
               void* items) final {
    read(position, count, {static_cast<T*>(items), size_of(count)});
  }
  /// Calls write().
  void rr_write(std::span<const std::uint64_t> position, std::span<const std::uint64_t> count,
                const void* items) final {
    write(position, count, {static_cast<const T*>(items), size_of(count)});
  }
  /// Calls dims().
  [[nodiscard]] std::vector<std::uint64_t> rr_dims() const final { return dims(); }

 private:
  static std::size_t size_of(std::span<const std::uint64_t> count) {
    std::size_t size = 1;
    for (const std::uint64_t one : count) size *= static_cast<std::size_t>(one);
    return size;
  }
};

/// Copies a part of an array of several dimensions out of it, or into it. The part lies inside.
void copy_memory_part(std::span<const std::uint64_t> dims, std::span<const std::uint64_t> position,
                      std::span<const std::uint64_t> count, std::size_t item_size, const void* all,
                      void* part);
/// The other way: copies a part into an array of several dimensions.
void copy_into_memory(std::span<const std::uint64_t> dims, std::span<const std::uint64_t> position,
                      std::span<const std::uint64_t> count, std::size_t item_size, const void* part,
                      void* all);

/// A memory that is kept in this process; its length does not change. May be used by any threads at
/// once.
template <class T>
class StoredArrayMemory : public ArrayMemorySource<T> {
 public:
  /// Keeps these items, shared with their other holders until one is written.
  explicit StoredArrayMemory(Array<T> items) : items_(std::move(items)) {}
  /// Keeps so many items, all zero at first.
  explicit StoredArrayMemory(std::size_t length = 0) : items_(length) {}

  /// Number of items.
  [[nodiscard]] std::uint64_t length() const final {
    const MutexLock lock(mutex_);
    return items_.size();
  }
  /// Copies items out. Throws rr::Error (out_of_range).
  void read(std::uint64_t position, std::span<T> items) override {
    const MutexLock lock(mutex_);
    check(position, items.size());
    if (!items.empty()) std::memcpy(items.data(), items_.data() + position, items.size_bytes());
  }
  /// Copies items in. Throws rr::Error (out_of_range).
  void write(std::uint64_t position, std::span<const T> items) override {
    const MutexLock lock(mutex_);
    check(position, items.size());
    if (items.empty()) return;
    std::memcpy(items_.mutate().data() + position, items.data(), items.size_bytes());
  }
  /// What it holds now; later writes do not show in it.
  [[nodiscard]] Array<T> items() const {
    const MutexLock lock(mutex_);
    return items_;
  }

 private:
  void check(std::uint64_t position, std::size_t count) const RR_REQUIRES(mutex_) {
    if (position > items_.size() || count > items_.size() - position) {
      throw Error(ErrorCode::out_of_range, "Index out of range");
    }
  }

  mutable Mutex mutex_;
  Array<T> items_ RR_GUARDED_BY(mutex_);
};

/// The same, of several dimensions.
template <class T>
class StoredMultiMemory : public MultiMemorySource<T> {
 public:
  /// Throws rr::Error (invalid_argument) when there are not as many items as dims say.
  explicit StoredMultiMemory(MultiArray<T> array = {})
      : dims_(array.dims.begin(), array.dims.end()), items_(std::move(array.items)) {
    std::uint64_t size = dims_.empty() ? 0 : 1;
    for (const std::uint64_t dim : dims_) size *= dim;
    if (size != items_.size()) throw Error(ErrorCode::invalid_argument, "dims do not fit");
  }

  /// Length of each dimension.
  [[nodiscard]] std::vector<std::uint64_t> dims() const final { return dims_; }
  /// Copies a part out.
  void read(std::span<const std::uint64_t> position, std::span<const std::uint64_t> count,
            std::span<T> items) override {
    const MutexLock lock(mutex_);
    copy_memory_part(dims_, position, count, sizeof(T), items_.data(), items.data());
  }
  /// Copies a part in.
  void write(std::span<const std::uint64_t> position, std::span<const std::uint64_t> count,
             std::span<const T> items) override {
    const MutexLock lock(mutex_);
    copy_into_memory(dims_, position, count, sizeof(T), items.data(), items_.mutate().data());
  }
  /// What it holds now; later writes do not show in it.
  [[nodiscard]] MultiArray<T> array() const {
    const MutexLock lock(mutex_);
    return {{dims_.begin(), dims_.end()}, items_};
  }

 private:
  const std::vector<std::uint64_t> dims_;
  mutable Mutex mutex_;
  Array<T> items_ RR_GUARDED_BY(mutex_);
};

/// A memory of an object on another node, without its type: a handle, which is copied freely and
/// used while the stub lives. Transfers are cut into requests that both sides take
/// (NodeOptions::memory_transfer_limit); each request is whole, all together are not. A time-out is
/// for each request. After a failure what was transferred before stays so.
class MemoryMember {
 protected:
  /// A memory of an object.
  MemoryMember(Stub& stub, const Member& member) : stub_(&stub), member_(&member) {}

  /// A number for each dimension.
  using Numbers = std::span<const std::uint64_t>;
  /// Asks the service for the length.
  std::uint64_t ask_length() const;
  /// Asks the service for the length of each dimension.
  std::vector<std::uint64_t> ask_dims() const;
  /// Asks the service for the number of dimensions.
  std::uint64_t ask_dim_count() const;
  /// Reads a part into `items`, which are `size` items.
  void read_part(Numbers position, Numbers count, void* items, std::size_t size) const;
  /// Writes a part from `items`, which are `size` items.
  void write_part(Numbers position, Numbers count, const void* items, std::size_t size) const;
  /// As read_part(), without waiting. `items` stay where they are until the completion has been
  /// called.
  void start_read(Numbers position, Numbers count, void* items, std::size_t size,
                  std::unique_ptr<Completion> completion) const;
  /// As write_part(), without waiting. `owner` keeps the items.
  void start_write(Numbers position, Numbers count, const void* items, std::size_t size,
                   MemoryRef owner, std::unique_ptr<Completion> completion) const;
  /// The product of counts. Throws rr::Error (invalid_argument) when it fits no memory.
  static std::size_t size_of(Numbers count);

  /// the object
  Stub* stub_;
  /// the memory in its definition
  const Member* member_;
};

/// A memory of one dimension of an object on another node: `stub->buffer()`. All throw rr::Error:
/// out_of_range for a part that is not inside, read_only_member and write_only_member before
/// anything is sent.
template <class T>
class ArrayMemory : public MemoryMember {
 public:
  /// For generated code: a memory of an object.
  ArrayMemory(Stub& stub, const Member& member) : MemoryMember(stub, member) {}

  /// Asks the service.
  [[nodiscard]] std::uint64_t length(const CallOptions& options = {}) const {
    const CallOptionsScope scope(options);
    return ask_length();
  }

  /// Reads as many items as `items` has room for, from `position` on.
  void read(std::uint64_t position, std::span<T> items, const CallOptions& options = {}) const {
    const CallOptionsScope scope(options);
    const std::uint64_t count = items.size();
    read_part({&position, 1}, {&count, 1}, items.data(), items.size());
  }
  /// Reads `count` items from `position` on into a new array.
  [[nodiscard]] Array<T> read(std::uint64_t position, std::uint64_t count,
                              const CallOptions& options = {}) const {
    Array<T> items(size_of({&count, 1}));
    read(position, items.mutate(), options);
    return items;
  }
  /// Writes all of `items`, from `position` on.
  void write(std::uint64_t position, std::span<const T> items,
             const CallOptions& options = {}) const {
    const CallOptionsScope scope(options);
    const std::uint64_t count = items.size();
    write_part({&position, 1}, {&count, 1}, items.data(), items.size());
  }
  /// The same for an array. A template, so that nothing is converted to an Array first.
  template <std::same_as<Array<T>> A>
  void write(std::uint64_t position, const A& items, const CallOptions& options = {}) const {
    write(position, std::span<const T>(items.data(), items.size()), options);
  }

  /// Reads as read(). Signature: void(std::exception_ptr, Array<T>). Defined in rr/async.hpp.
  template <class Token>
  auto async_read(std::uint64_t position, std::uint64_t count, const CallOptions& options,
                  Token&& token) const;
  /// As above, with the client's time-out.
  template <class Token>
  auto async_read(std::uint64_t position, std::uint64_t count, Token&& token) const {
    return async_read(position, count, CallOptions(), std::forward<Token>(token));
  }
  /// Writes as write(). Signature: void(std::exception_ptr). The items are copied, or shared when
  /// the array owns them. Defined in rr/async.hpp.
  template <class Token>
  auto async_write(std::uint64_t position, const Array<T>& items, const CallOptions& options,
                   Token&& token) const;
  /// As above, with the client's time-out.
  template <class Token>
  auto async_write(std::uint64_t position, const Array<T>& items, Token&& token) const {
    return async_write(position, items, CallOptions(), std::forward<Token>(token));
  }
};

/// A memory of several dimensions of an object on another node. As ArrayMemory, but for a part that
/// is not inside: invalid_argument.
template <class T>
class MultiMemory : public MemoryMember {
 public:
  /// For generated code: a memory of an object.
  MultiMemory(Stub& stub, const Member& member) : MemoryMember(stub, member) {}

  /// Length of each dimension. Asks the service.
  [[nodiscard]] std::vector<std::uint64_t> dims(const CallOptions& options = {}) const {
    const CallOptionsScope scope(options);
    return ask_dims();
  }
  /// Number of dimensions. Asks the service.
  [[nodiscard]] std::uint64_t dim_count(const CallOptions& options = {}) const {
    const CallOptionsScope scope(options);
    return ask_dim_count();
  }

  /// `items` has the shape `count`, first dimension fastest.
  void read(Numbers position, Numbers count, std::span<T> items,
            const CallOptions& options = {}) const {
    const CallOptionsScope scope(options);
    read_part(position, count, items.data(), items.size());
  }
  /// Reads the part at `position` of the shape `count` into a new array.
  [[nodiscard]] MultiArray<T> read(Numbers position, Numbers count,
                                   const CallOptions& options = {}) const {
    MultiArray<T> array{{count.begin(), count.end()}, Array<T>(size_of(count))};
    read(position, count, array.items.mutate(), options);
    return array;
  }
  /// Writes the part at `position` of the shape `count`; `items` are first dimension fastest.
  void write(Numbers position, Numbers count, std::span<const T> items,
             const CallOptions& options = {}) const {
    const CallOptionsScope scope(options);
    write_part(position, count, items.data(), items.size());
  }
  /// Writes an array at `position`; its dims are the counts.
  void write(Numbers position, const MultiArray<T>& array, const CallOptions& options = {}) const {
    write(position, std::vector<std::uint64_t>(array.dims.begin(), array.dims.end()), array.items,
          options);
  }

  /// Reads as read(). Signature: void(std::exception_ptr, MultiArray<T>). Defined in rr/async.hpp.
  template <class Token>
  auto async_read(std::vector<std::uint64_t> position, std::vector<std::uint64_t> count,
                  const CallOptions& options, Token&& token) const;
  /// As above, with the client's time-out.
  template <class Token>
  auto async_read(std::vector<std::uint64_t> position, std::vector<std::uint64_t> count,
                  Token&& token) const {
    return async_read(std::move(position), std::move(count), CallOptions(),
                      std::forward<Token>(token));
  }
  /// Writes as write(). Signature: void(std::exception_ptr). Defined in rr/async.hpp.
  template <class Token>
  auto async_write(std::vector<std::uint64_t> position, const MultiArray<T>& array,
                   const CallOptions& options, Token&& token) const;
  /// As above, with the client's time-out.
  template <class Token>
  auto async_write(std::vector<std::uint64_t> position, const MultiArray<T>& array,
                   Token&& token) const {
    return async_write(std::move(position), array, CallOptions(), std::forward<Token>(token));
  }
};

}  // namespace rr
