// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "rr/definition.hpp"
#include "rr/error.hpp"
#include "rr/stub.hpp"
#include "rr/type.hpp"
#include "rr/varvalue.hpp"

/// What generated skeletons stand on: the service's side of an object.
namespace rr {

class ServiceContext;
class Skeleton;

/// The answer to one request that a handler gives later, from any thread: `reply(value)` or
/// `reply.fail(error)`, exactly once. Dropped without either, it answers with operation_aborted.
class ReplyHandle {
 public:
  ReplyHandle(ReplyHandle&&) noexcept;
  ReplyHandle& operator=(ReplyHandle&&) noexcept;
  ~ReplyHandle();
  void fail(std::exception_ptr error);

  struct State;  // internal
  explicit ReplyHandle(std::unique_ptr<State> state);

 protected:
  void succeed(const void* result);

 private:
  std::unique_ptr<State> state_;
};

template <class R>
class Reply : public ReplyHandle {
 public:
  using ReplyHandle::ReplyHandle;
  explicit Reply(ReplyHandle&& handle) : ReplyHandle(std::move(handle)) {}
  void operator()(const R& result) { succeed(&result); }
};
template <>
class Reply<void> : public ReplyHandle {
 public:
  using ReplyHandle::ReplyHandle;
  explicit Reply(ReplyHandle&& handle) : ReplyHandle(std::move(handle)) {}
  void operator()() { succeed(nullptr); }
};

/// One request to a member, as a generated skeleton sees it.
class Request {
 public:
  /// True for the set of a property.
  [[nodiscard]] bool is_set() const;
  /// Reads the value of a property set. Throws rr::Error.
  void read_value(void* value) const;
  /// Reads a function's parameters, one pointer each, in their order. Throws rr::Error.
  void read_arguments(void* const* values) const;
  template <class... Values>
  void read(Values&... values) const {
    void* const places[] = {&values..., nullptr};
    read_arguments(places);
  }
  /// Answers with a value of the member's type; null for a function without one.
  void answer(const void* value);
  /// Leaves the answer for later: the next request of this client is handled meanwhile.
  ReplyHandle defer();

  struct Source;  // internal
  explicit Request(Source& source) : source_(&source) {}

 private:
  Source* source_;
};

/// Which object of an objref is asked for.
struct ObjectIndex {
  std::int32_t number = 0;  ///< of an int32 index
  std::string_view text;    ///< of a string index, decoded
};

/// The base of every generated skeleton: an object that a service offers. Its members are called on
/// the thread that read the request, one at a time and in order for each client; calls of different
/// clients may overlap. The skeleton of an object has the members of those it implements.
class Skeleton {
 public:
  Skeleton();
  virtual ~Skeleton();
  Skeleton(const Skeleton&) = delete;
  Skeleton& operator=(const Skeleton&) = delete;

  [[nodiscard]] virtual const ObjectType& rr_object_type() const = 0;
  /// Called by the service when the object is first reached, before any member is: `path` is where.
  /// An object may be reached by several paths. The context lives until the service is closed.
  virtual void rr_attached(ServiceContext& context, const std::string& path);

  // Implemented by generated code. `member` counts in rr_object_type().members.
  virtual void rr_dispatch(std::size_t member, Request& request) = 0;
  virtual std::shared_ptr<Skeleton> rr_child(std::size_t member, const ObjectIndex& index) = 0;

  struct Places;  // internal: where the object is attached

 protected:
  /// Sends an event to every client of each service that offers this object. Throws rr::Error for
  /// values that cannot be written. Where it is too large to be sent, NodeOptions::log is told.
  void rr_fire(const Member& member, const void* const* arguments) const;
  template <class... Arguments>
  void rr_fire_event(const Member& member, const Arguments&... arguments) const {
    const void* const values[] = {&arguments..., nullptr};
    rr_fire(member, values);
  }

 private:
  const std::shared_ptr<Places> rr_places_;
};

}  // namespace rr
