// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mex.h>

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include "rr/definition.hpp"
#include "rr/matlab/typed.hpp"
#include "rr/stub.hpp"

#ifdef _WIN32
#define RR_MATLAB_EXPORT __declspec(dllexport)
#else
#define RR_MATLAB_EXPORT __attribute__((visibility("default")))
#endif

/// Classes that were generated for MATLAB and are compiled into a MEX file: their properties and
/// functions call typed stubs.
namespace rr::matlab {

/// How a typed call is made.
class TypedCall {
 public:
  /// Runs `body`, the blocking call of a stub, so that it can be interrupted.
  virtual void block(void (*body)(void* context), void* context) = 0;

 protected:
  ~TypedCall() = default;
};

/// A member of an object, in the order of the definition.
struct TypedMember {
  std::string_view name;
  /// Calls the stub's method and makes the result; null for void. Throws Misfit for arguments that
  /// are too many, too few, or of another form than the usual one, before anything is sent;
  /// rr::Error for what the call throws. Null: used by its name.
  mxArray* (*run)(Stub& stub, std::span<const mxArray* const> arguments, TypedCall& call) = nullptr;
};

struct TypedObject {
  std::string_view name;  ///< qualified: `example.PanTilt`
  std::span<const TypedMember> members;
  /// What stubs of this class are; makes one.
  const ObjectType& (*type)();
};

/// What was generated for one definition.
struct Module {
  std::span<const TypedObject> objects;
};

template <class S>
constexpr TypedObject typed_object(std::string_view name,
                                   std::span<const TypedMember> members = {}) {
  return {name, members, []() -> const ObjectType& {
            static const S stub;
            return stub.rr_object_type();
          }};
}

constexpr TypedMember named_member(std::string_view name) { return {name, nullptr}; }

/// Calls `body`, which blocks, through `call`.
template <class Body>
void block(TypedCall& call, Body&& body) {
  call.block([](void* context) { (*static_cast<std::remove_reference_t<Body>*>(context))(); },
             &body);
}

/// Result and parameters of a stub's method, without the options of the call, which are its last
/// parameter.
template <class Method>
struct MethodOf;
template <class R, class S, class... Parameters>
struct MethodOf<R (S::*)(Parameters...)> {
 private:
  using All = std::tuple<std::remove_cvref_t<Parameters>...>;
  static constexpr std::size_t last = sizeof...(Parameters) - 1;
  static_assert(std::is_same_v<std::tuple_element_t<last, All>, CallOptions>);
  template <std::size_t... I>
  static std::tuple<std::tuple_element_t<I, All>...> without_last(std::index_sequence<I...>);

 public:
  using Result = R;
  using Arguments = decltype(without_last(std::make_index_sequence<last>()));
};

/// Calls one method of a stub.
template <class S, auto Method>
mxArray* run_method(Stub& stub, std::span<const mxArray* const> given, TypedCall& call) {
  using Of = MethodOf<decltype(Method)>;
  typename Of::Arguments arguments;
  need_form(given.size() == std::tuple_size_v<typename Of::Arguments>);
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (read_typed(given[I], std::get<I>(arguments)), ...);
  }
  (std::make_index_sequence<std::tuple_size_v<typename Of::Arguments>>());
  S& target = dynamic_cast<S&>(stub);
  const auto invoke = [&]() -> decltype(auto) {
    return std::apply(
        [&](auto&... argument) { return (target.*Method)(argument..., CallOptions()); }, arguments);
  };
  if constexpr (std::is_void_v<typename Of::Result>) {
    block(call, [&] { invoke(); });
    return nullptr;
  } else {
    typename Of::Result result{};
    block(call, [&] { result = invoke(); });
    return make_typed(result);
  }
}

template <class S, auto Method>
constexpr TypedMember typed_function(std::string_view name) {
  return {name, &run_method<S, Method>};
}

/// Without an argument it is read, with one it is set. Either may be null.
template <class S, auto Get, auto Set>
constexpr TypedMember typed_property(std::string_view name) {
  return {name, [](Stub& stub, std::span<const mxArray* const> given, TypedCall& call) -> mxArray* {
            if (given.empty()) {
              if constexpr (!std::is_null_pointer_v<decltype(Get)>) {
                return run_method<S, Get>(stub, given, call);
              }
            } else if constexpr (!std::is_null_pointer_v<decltype(Set)>) {
              return run_method<S, Set>(stub, given, call);
            }
            refuse_form();
          }};
}

/// The MEX function with these modules: what mexFunction does.
void run_mex(std::span<const Module* const> modules, int result_count, mxArray* results[],
             int argument_count, const mxArray* arguments[]);

}  // namespace rr::matlab
