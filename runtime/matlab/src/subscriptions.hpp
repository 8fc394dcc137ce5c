// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "rr/subscription.hpp"
#include "runtime/matlab/src/objects.hpp"

namespace rr::matlab {

/// A subscription that the interpreter's user has made. Ends when it is closed, or nothing of it is
/// held any more.
class SubscriptionHandle final : public Handled {
 public:
  SubscriptionHandle(Runtime& runtime, ServiceSubscription given);
  ~SubscriptionHandle() override;

  ServiceSubscription subscription;
  /// Of all functions of the user's, and of the types that are known.
  const std::shared_ptr<Connection> home;

  /// The number of a stub's object. Those of one session share a Connection.
  mxArray* give(Runtime& runtime, const std::shared_ptr<Stub>& stub);
  void close();

 private:
  std::map<const Session*, std::weak_ptr<Connection>> connections_;
};

/// A client that its user keeps when the subscription is closed.
struct ClaimedClient final : Handled {
  explicit ClaimedClient(Client<Stub> given) : client(std::move(given)) {}
  Client<Stub> client;
};

/// A wire, pipe or object of a subscription, with its type as soon as a client has told it.
template <class Subscribed>
class MemberSubscriptionHandle final : public Handled {
 public:
  MemberSubscriptionHandle(std::shared_ptr<SubscriptionHandle> given, Subscribed made,
                           std::string name, std::string at)
      : owner(std::move(given)),
        subscribed(std::move(made)),
        member(std::move(name)),
        path(std::move(at)) {}
  ~MemberSubscriptionHandle() override { subscribed.close(); }

  const std::shared_ptr<SubscriptionHandle> owner;
  Subscribed subscribed;
  const std::string member;
  const std::string path;
  std::chrono::milliseconds lifespan{0};
};

/// struct with NodeID and ServiceName.
mxArray* client_to_mex(const SubscriptionClientId& client);
/// A struct of fields as ServiceSubscriptionFilter has them. Throws rr::Error.
ServiceFilter read_filter(const mxArray* given);
/// A struct array of services, or nodes.
mxArray* services_to_mex(const std::vector<FoundService>& services);

/// Puts a function of the user's into the subscription's; `subscribe(number)` makes what calls it.
template <class Subscribe>
void add_function(Runtime& runtime, const std::shared_ptr<Connection>& home, Call& call,
                  const mxArray* function, const Subscribe& subscribe) {
  if (!mxIsClass(function, "function_handle") && !mxIsChar(function)) {
    throw Error(ErrorCode::data_type_mismatch,
                "expected a function handle, got " + described(function));
  }
  const std::uint64_t number = home->add({.function = Kept(function),
                                          .parameter = {},
                                          .member = {},
                                          .connection = home,
                                          .subscription = nullptr});
  runtime.functions().find(number)->subscription =
      std::make_shared<Subscription>(subscribe(number));
  call.give(make_number(number));
}

/// Calls such a function, with what `make` gives; on the interpreter's thread.
template <class Make>
void call_function_of(Runtime& runtime, std::uint64_t number, const Make& make) {
  const UserFunction* const function = runtime.functions().find(number);
  const auto home = function != nullptr ? function->connection.lock() : nullptr;
  if (home) UserFunctions::run_alone(function->function, make(*home));
}

}  // namespace rr::matlab
