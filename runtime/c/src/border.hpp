// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstring>
#include <exception>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rr/call.hpp"
#include "rr/error.hpp"
#include "rr/node_id.hpp"
#include "rr/time_spec.hpp"
#include "runtime/c/include/rr.h"

/// The border between C and the runtime: nothing is thrown across it.
namespace rr::capi {

/// What a function of the C interface fails with, as a new rr_error and its code.
rr_status tell(rr_error** error, const std::exception_ptr& why) noexcept;
/// The same as an error of its own; null when there is no memory for one.
rr_error* make_error(const std::exception_ptr& why) noexcept;
/// The code alone.
rr_status status_of(const std::exception_ptr& why) noexcept;

/// The body of a C function that may fail.
template <class Body>
rr_status guarded(rr_error** error, const Body& body) noexcept {
  if (error != nullptr) *error = nullptr;
  try {
    body();
    return RR_OK;
  } catch (...) {
    return tell(error, std::current_exception());
  }
}
/// The body of one that cannot: `otherwise` when it has thrown all the same.
template <class Result, class Body>
Result guarded_or(Result otherwise, const Body& body) noexcept {
  try {
    return body();
  } catch (...) {
    return otherwise;
  }
}
/// The body of a release.
template <class Handle>
void release(Handle* handle) noexcept {
  try {
    delete handle;
  } catch (...) {
    // A destructor that throws has released what it could.
  }
}

[[noreturn]] void refuse_argument(const char* what);
/// A handle, function or output that may not be NULL.
template <class T>
T& need(T* pointer, const char* what) {
  if (pointer == nullptr) refuse_argument(what);
  return *pointer;
}
template <class T>
T& output(T* place) {
  return need(place, "there is no place for the result");
}

/// A struct as the caller knows it, perhaps an older, shorter one; `needed` when it may not be
/// NULL.
template <class T>
T known(const T* given, bool needed = false) {
  constexpr std::size_t most = 4096;
  T result{};
  result.size = sizeof result;
  if (given == nullptr) {
    if (needed) refuse_argument("a struct is NULL");
    return result;
  }
  const std::size_t size = given->size;
  if (size < sizeof size || size > most) refuse_argument("a struct has no size");
  std::memcpy(&result, given, std::min(size, sizeof result));
  result.size = sizeof result;
  return result;
}
/// Fills a struct as far as the caller knows it.
template <class T>
void fill(T* place, T value) {
  const std::size_t size = place->size;
  value.size = size;
  std::memcpy(place, &value, std::min(size, sizeof value));
}

std::string_view text(rr_str given);
/// An array of texts, of which `none` says what is missing when it is NULL.
std::vector<std::string> read_texts(const rr_str* texts, std::size_t count, const char* none);
rr_str view(std::string_view given);
/// Views of these, which stay where they are.
std::vector<rr_str> view_all(const std::vector<std::string>& texts);
rr_node_id id_of(const NodeId& id);
NodeId id_of(const rr_node_id& id);
rr_time time_of(const TimeSpec& time);
/// Of a time-out: RR_NO_LIMIT never comes, 0 says nothing.
std::chrono::milliseconds duration(std::int32_t milliseconds);
/// Of a wait: 0 does not wait.
std::chrono::milliseconds patience(std::int32_t milliseconds);

/// What a program gives to be called with; dropped with the last that refers to it.
class Context {
 public:
  using Drop = void (*)(void*);
  Context(void* data, Drop drop) : data_(data), drop_(drop) {}
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  ~Context() {
    if (drop_ != nullptr) drop_(data_);
  }
  [[nodiscard]] void* data() const { return data_; }

 private:
  void* const data_;
  const Drop drop_;
};

/// A struct of functions with the context that goes with them.
template <class Struct>
class Handler {
 public:
  /// Takes over the context: it is dropped even if this throws for something else afterwards.
  explicit Handler(const Struct* given)
      : functions_(known(given, true)), context_(functions_.context, functions_.drop) {}
  [[nodiscard]] const Struct& operator*() const { return functions_; }
  const Struct* operator->() const { return &functions_; }

 private:
  const Struct functions_;
  const Context context_;
};
/// The same, with a function in it that may not be NULL.
template <class Struct, class Function>
std::shared_ptr<const Handler<Struct>> take_handler(const Struct* given, Function Struct::*needed) {
  auto handler = std::make_shared<const Handler<Struct>>(given);
  if ((**handler).*needed == nullptr) refuse_argument("a function is NULL that is needed");
  return handler;
}
template <class Struct>
std::shared_ptr<const Handler<Struct>> take_handler(const Struct* given) {
  return std::make_shared<const Handler<Struct>>(given);
}

/// Time-out and cancellation of a call, while it is begun.
class Terms {
 public:
  explicit Terms(const rr_call_options* options);
  [[nodiscard]] std::uint32_t access() const { return options_.access; }

 private:
  const rr_call_options options_;
  CallOptions call_options_;
  CallOptionsScope scope_;
};

/// Of what the program says has failed.
Error read_info(const rr_error_info* info);
/// Views of an error for as long as this.
class ErrorInfo {
 public:
  explicit ErrorInfo(const Error& error);
  [[nodiscard]] const rr_error_info& info() const { return info_; }

 private:
  const Error error_;
  std::vector<std::byte> parameter_;
  rr_error_info info_{};
};

}  // namespace rr::capi

struct rr_error {
  rr::capi::ErrorInfo content;
};
struct rr_cancellation {
  std::stop_source cancellation;
};
