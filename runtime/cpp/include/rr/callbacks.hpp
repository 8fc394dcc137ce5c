// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <tuple>
#include <type_traits>
#include <utility>

#include "rr/definition.hpp"
#include "rr/stub.hpp"
#include "rr/visibility.hpp"

/// Callbacks: functions of a client that the service calls (07, section 12).
namespace RR_VISIBLE rr {

/// Reads the parameters of a callback and calls the program's function. Made by Callback::set.
class CallbackFunction {
 public:
  virtual ~CallbackFunction() = default;
  /// The result to be sent, of the member's type; null for void. What it throws is sent as an
  /// error.
  virtual std::shared_ptr<const void> call(const Arguments& arguments) = 0;

 protected:
  /// For a callback that the definition describes so.
  explicit CallbackFunction(const Member& member) : member_(&member) {}
  /// The callback in its definition.
  [[nodiscard]] const Member& member() const { return *member_; }

 private:
  const Member* member_;
};

/// A callback of an object on another node, without its type.
class CallbackMember {
 public:
  /// From now on the service is told that there is no function (invalid_operation). Returns when
  /// calls that run have ended, unless one of them is the caller.
  void clear();

 protected:
  /// For a callback of an object, which must outlive this.
  CallbackMember(Stub& stub, const Member& member) : stub_(&stub), member_(&member) {}
  /// Sets the function in place of an earlier one. Throws rr::Error (invalid_operation) when the
  /// session has ended.
  void set_function(std::unique_ptr<CallbackFunction> function);

  /// the object's
  Stub* stub_;
  /// the callback in its definition
  const Member* member_;
};

/// A callback by the signature of its function; see Callback<R(Parameters...)>.
template <class Signature>
class Callback;

/// A callback of an object on another node: `stub->ask().set(function)`. The function is called on
/// a thread of the node, never under a lock and never inside a call that the program makes: it may
/// make calls itself, while a call of the same client waits, too. It may be called several times at
/// once, and while event handlers run. It is kept by the stub, until the session ends.
template <class R, class... Parameters>
class Callback<R(Parameters...)> : public CallbackMember {
 public:
  /// For generated code: a callback of an object.
  Callback(Stub& stub, const Member& member) : CallbackMember(stub, member) {}

  /// The service gets this function from now on, in place of an earlier one. What it throws is sent
  /// to the service as an error.
  template <class Function>
  void set(Function function) {
    class Bound final : public CallbackFunction {
     public:
      Bound(const Member& member, Function&& call)
          : CallbackFunction(member), call_(std::move(call)) {}
      std::shared_ptr<const void> call(const Arguments& arguments) override {
        std::tuple<Parameters...> values;
        return std::apply(
            [&](auto&... value) -> std::shared_ptr<const void> {
              void* const places[] = {&value..., nullptr};
              arguments.read(this->member(), places);
              if constexpr (std::is_void_v<R>) {
                call_(value...);
                return nullptr;
              } else {
                return std::make_shared<R>(call_(value...));
              }
            },
            values);
      }

     private:
      Function call_;
    };
    set_function(std::make_unique<Bound>(*member_, std::move(function)));
  }
};

}  // namespace rr
