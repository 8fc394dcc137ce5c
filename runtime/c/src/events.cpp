// SPDX-License-Identifier: Apache-2.0
// Events and callbacks of objects.
#include <utility>

#include "rr/callbacks.hpp"
#include "runtime/c/src/node.hpp"
#include "runtime/c/src/request.hpp"
#include "runtime/c/src/subscription.hpp"
#include "runtime/cpp/src/client/session.hpp"
#include "runtime/cpp/src/endpoint/arguments.hpp"

namespace rr::capi {
namespace {

Data read_arguments(const Arguments& arguments) {
  const Arguments::Source& source = arguments.rr_source();
  Decoder decoder(source.message.version, &source.message.strings, source.owner, &source.types);
  return read_entry(decoder, source.entry);
}

class RawEventHandler final : public EventHandler {
 public:
  RawEventHandler(const Member& member, std::shared_ptr<const Handler<rr_event_handler>> handler)
      : EventHandler(member), handler_(std::move(handler)) {}
  void call(const Arguments& arguments) override {
    const Data data = read_arguments(arguments);
    const rr_elements elements = data.elements();
    (*handler_)->on_event((*handler_)->context, &elements, data.get());
  }

 private:
  const std::shared_ptr<const Handler<rr_event_handler>> handler_;
};

class RawCallbackFunction final : public CallbackFunction {
 public:
  RawCallbackFunction(const Member& member,
                      std::shared_ptr<const Handler<rr_callback_handler>> handler)
      : CallbackFunction(member), handler_(std::move(handler)) {}

  std::shared_ptr<const void> call(const Arguments& arguments) override {
    auto wait = std::make_shared<Wait<std::optional<Raw>>>();
    auto request =
        std::make_unique<ValueRequest>(RR_REQUEST_CALLBACK, member().type != nullptr, wait);
    request->set_arguments(read_arguments(arguments));
    request->info.answer_version =
        static_cast<std::uint32_t>(arguments.rr_source().message.version);
    (*handler_)->on_call((*handler_)->context, request.release());
    std::optional<Raw> result = wait->take();
    if (!result) return nullptr;
    return std::make_shared<const Raw>(std::move(*result));
  }

 private:
  const std::shared_ptr<const Handler<rr_callback_handler>> handler_;
};

// The callback of an object in the open.
class RawCallback : public CallbackMember {
 public:
  RawCallback(Stub& stub, const Member& member) : CallbackMember(stub, member) {}
  void set(std::shared_ptr<const Handler<rr_callback_handler>> handler) {
    set_function(std::make_unique<RawCallbackFunction>(*member_, std::move(handler)));
  }
};

}  // namespace
}  // namespace rr::capi

using rr::capi::guarded;
using rr::capi::stub_of;

extern "C" {

rr_status rr_event_subscribe(rr_object* object, rr_str member, const rr_event_handler* handler,
                             rr_subscription** out_subscription, rr_error** error) {
  return guarded(error, [&] {
    rr::capi::output(out_subscription) = nullptr;
    auto kept = rr::capi::take_handler(handler, &rr_event_handler::on_event);
    rr::capi::RawStub& stub = stub_of(object);
    const rr::Member& event =
        stub.tables().member(rr::capi::text(member), rr::MemberKind::event, 0);
    auto subscription = std::make_unique<rr_subscription>();
    subscription->tables = stub.shared_tables();
    subscription->subscriptions.push_back(stub.rr_connect(
        event, std::make_unique<rr::capi::RawEventHandler>(event, std::move(kept))));
    *out_subscription = subscription.release();
  });
}

void rr_subscription_release(rr_subscription* subscription) { rr::capi::release(subscription); }

rr_status rr_callback_set(rr_object* object, rr_str member, uint32_t access, int32_t returns_value,
                          const rr_callback_handler* handler, rr_error** error) {
  return guarded(error, [&] {
    auto kept = rr::capi::take_handler(handler, &rr_callback_handler::on_call);
    rr::capi::RawStub& stub = stub_of(object);
    const rr::Member& callback =
        stub.tables().member(rr::capi::text(member), rr::MemberKind::callback,
                             rr::capi::access_of(access), returns_value != 0);
    rr::capi::RawCallback(stub, callback).set(std::move(kept));
  });
}

rr_status rr_callback_clear(rr_object* object, rr_str member, rr_error** error) {
  return guarded(error, [&] {
    rr::capi::RawStub& stub = stub_of(object);
    // Found by its name.
    const rr::Member& callback =
        stub.tables().member(rr::capi::text(member), rr::MemberKind::callback, 0);
    rr::capi::RawCallback(stub, callback).clear();
  });
}

}  // extern "C"
