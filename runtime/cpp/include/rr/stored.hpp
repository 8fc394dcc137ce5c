// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "rr/error.hpp"
#include "rr/mutex.hpp"
#include "rr/visibility.hpp"

/// What generated Default classes stand on.
namespace RR_VISIBLE rr {

/// A property's value. May be read and set from any threads at once.
template <class T>
class Stored {
 public:
  /// T{} at first.
  Stored() = default;
  /// This value at first.
  explicit Stored(T value) : value_(std::move(value)) {}

  /// A copy of the value.
  [[nodiscard]] T get() const {
    const MutexLock lock(mutex_);
    return value_;
  }
  /// Sets the value.
  void set(T value) {
    const MutexLock lock(mutex_);
    std::swap(value_, value);
  }

 private:
  mutable Mutex mutex_;
  T value_ RR_GUARDED_BY(mutex_){};
};

/// What is kept for clients. Forgets what it keeps for one when that leaves.
class ClientValues {
 public:
  virtual ~ClientValues() = default;
  /// A session that was current has ended. On a thread of the node.
  virtual void forget(const void* session) = 0;

  /// The session whose request this thread handles; null outside of handlers.
  static const void* current_session();
  /// Has forget() called for the current session when that ends. False when it has ended.
  static bool keep_for_current(const std::shared_ptr<ClientValues>& values);
};

/// The values of a `perclient` property. In a handler this is the value of the client whose request
/// it is; what a client has set is forgotten when it leaves. Outside of handlers it is the initial
/// value, which all clients get that have set none. May be read and set from any threads at once.
template <class T>
class StoredPerClient {
 public:
  /// T{} is the initial value.
  StoredPerClient() : StoredPerClient(T{}) {}
  /// `initial` is the initial value.
  explicit StoredPerClient(T initial) : values_(std::make_shared<Values>(std::move(initial))) {}

  /// A copy of the value of the client whose request this thread handles; outside of handlers of
  /// the initial one.
  [[nodiscard]] T get() const {
    const void* const session = ClientValues::current_session();
    const MutexLock lock(values_->mutex);
    const auto found = values_->own.find(session);
    return found != values_->own.end() ? found->second : values_->initial;
  }
  /// Sets the value of the client whose request this thread handles; outside of handlers the
  /// initial one.
  void set(T value) {
    const void* const session = ClientValues::current_session();
    const MutexLock lock(values_->mutex);
    if (session == nullptr) {
      std::swap(values_->initial, value);
    } else if (const auto found = values_->own.find(session); found != values_->own.end()) {
      std::swap(found->second, value);
    } else if (ClientValues::keep_for_current(values_)) {
      values_->own.emplace(session, std::move(value));
    }
  }

 private:
  struct Values final : ClientValues {
    explicit Values(T first) : initial(std::move(first)) {}
    void forget(const void* session) override {
      typename std::map<const void*, T>::node_type forgotten;  // goes when the lock has
      const MutexLock lock(mutex);
      forgotten = own.extract(session);
    }

    Mutex mutex;
    T initial RR_GUARDED_BY(mutex);
    std::map<const void*, T> own RR_GUARDED_BY(mutex);
  };

  const std::shared_ptr<Values> values_;
};

/// Throws the error of a function that a Default class does not have (not_implemented_error).
[[noreturn]] inline void throw_not_implemented(std::string_view member) {
  throw Error(ErrorCode::not_implemented_error,
              std::string(member) + " is not implemented by this object");
}
/// Throws the error of an objref at which there is nothing (object_not_found).
[[noreturn]] inline void throw_no_object(std::string_view member) {
  throw Error(ErrorCode::object_not_found, "there is no object at " + std::string(member));
}

}  // namespace rr
