// SPDX-License-Identifier: Apache-2.0
// What the program holds of subscriptions.
#include <utility>

#include "rr/error.hpp"
#include "rr/subscription.hpp"
#include "runtime/cpp/src/subscription/links.hpp"
#include "runtime/cpp/src/subscription/object_links.hpp"
#include "runtime/cpp/src/subscription/pipe_links.hpp"
#include "runtime/cpp/src/subscription/services.hpp"
#include "runtime/cpp/src/subscription/wire_links.hpp"

namespace rr {
namespace {

using subscription::Links;
using subscription::ObjectLinks;
using subscription::PipeLinks;
using subscription::Services;
using subscription::WireLinks;

// An empty handle is none.
template <class T>
T& need_state(const std::shared_ptr<T>& state) {
  if (!state) throw Error(ErrorCode::invalid_operation, "there is no subscription");
  return *state;
}

// Each kind of handle is made with the state of its kind only.
template <class T>
T& as(const std::shared_ptr<Links>& links) {
  return static_cast<T&>(need_state(links));
}

}  // namespace

// All kinds

MemberSubscription::MemberSubscription(std::shared_ptr<Links> links) : links_(std::move(links)) {}
void MemberSubscription::close() {
  if (links_) links_->close();
}
bool MemberSubscription::is_open() const { return links_ && links_->is_open(); }
std::vector<SubscriptionClientId> MemberSubscription::clients() const {
  return need_state(links_).clients();
}
std::optional<Error> MemberSubscription::last_error() const {
  return need_state(links_).last_error();
}
Subscription MemberSubscription::on_failed(
    Function<void(const SubscriptionClientId&, const Error&)> function) {
  return need_state(links_).on_failed(std::move(function));
}

// Wires

void WireSubscriptionBase::set_lifespan(std::chrono::milliseconds lifespan) {
  as<WireLinks>(links_).set_lifespan(lifespan);
}
WireSubscriptionBase::Value WireSubscriptionBase::received() const {
  WireLinks::Value value = as<WireLinks>(links_).received();
  return {std::move(value.value), value.time, std::move(value.client)};
}
std::vector<WireSubscriptionBase::Value> WireSubscriptionBase::all_received() const {
  std::vector<Value> result;
  for (WireLinks::Value& value : as<WireLinks>(links_).all_received()) {
    result.push_back({std::move(value.value), value.time, std::move(value.client)});
  }
  return result;
}
bool WireSubscriptionBase::wait_received(std::chrono::milliseconds limit) const {
  return as<WireLinks>(links_).wait(limit);
}
Subscription WireSubscriptionBase::on_received(Function<void(const Value&)> function) {
  return as<WireLinks>(links_).on_received(
      [function = std::move(function)](const WireLinks::Value& value) {
        function({value.value, value.time, value.client});
      });
}
std::size_t WireSubscriptionBase::send_all(const void* value) {
  return as<WireLinks>(links_).send_all(value);
}
void WireSubscriptionBase::throw_no_value() {
  throw Error(ErrorCode::value_not_set, "Value not set");
}

// Pipes

std::size_t PipeSubscriptionBase::available() const { return as<PipeLinks>(links_).available(); }
std::size_t PipeSubscriptionBase::lost_count() const { return as<PipeLinks>(links_).lost_count(); }
void PipeSubscriptionBase::set_backlog_limit(std::size_t packets) {
  as<PipeLinks>(links_).set_backlog_limit(packets);
}
PipeSubscriptionBase::Packet PipeSubscriptionBase::take() {
  PipeLinks::Packet packet = as<PipeLinks>(links_).take();
  return {std::move(packet.value), std::move(packet.client)};
}
bool PipeSubscriptionBase::wait(std::chrono::milliseconds limit) const {
  return as<PipeLinks>(links_).wait(limit);
}
Subscription PipeSubscriptionBase::on_received(Function<void(Packet)> function) {
  return as<PipeLinks>(links_).on_received(
      [function = std::move(function)](const PipeLinks::Packet& packet) {
        function({packet.value, packet.client});
      });
}
std::size_t PipeSubscriptionBase::send_all(const void* value) {
  return as<PipeLinks>(links_).send_all(value);
}
void PipeSubscriptionBase::throw_no_packet() {
  throw Error(ErrorCode::invalid_operation, "no packet waits to be received");
}

// Objects

std::shared_ptr<Stub> SubObjectSubscription::find(const ObjectType* type) const {
  return as<ObjectLinks>(links_).find(type);
}
std::shared_ptr<Stub> SubObjectSubscription::need(const ObjectType* type) const {
  return as<ObjectLinks>(links_).need(type);
}
std::shared_ptr<Stub> SubObjectSubscription::wait(const ObjectType* type,
                                                  std::chrono::milliseconds limit) const {
  return as<ObjectLinks>(links_).wait(type, limit);
}
void SubObjectSubscription::start_wait(const ObjectType* type, std::chrono::milliseconds limit,
                                       std::unique_ptr<Completion> completion) const {
  as<ObjectLinks>(links_).start_wait(type, limit, std::move(completion));
}

// Services

ServiceSubscription::ServiceSubscription(std::shared_ptr<Services> services)
    : services_(std::move(services)) {}
void ServiceSubscription::close() {
  if (services_) services_->close();
}
bool ServiceSubscription::is_open() const { return services_ && services_->is_open(); }
void ServiceSubscription::update_urls(std::vector<std::string> urls) {
  update_services({std::move(urls)});
}
void ServiceSubscription::update_services(std::vector<std::vector<std::string>> services) {
  subscription::Services& state = need_state(services_);
  state.urls().replace(subscription::UrlSource::checked(state.core(), std::move(services)));
}
void ServiceSubscription::update_types(std::vector<std::string> types, ServiceFilter filter) {
  need_state(services_).look_for(std::move(types), std::move(filter));
}
void ServiceSubscription::set_retry_delay(std::chrono::milliseconds delay,
                                          std::chrono::milliseconds maximum) {
  need_state(services_).set_retry_delay(delay, maximum);
}
std::vector<SubscriptionClientId> ServiceSubscription::connected_clients() const {
  return need_state(services_).connected_clients();
}
std::vector<SubscribedService> ServiceSubscription::services() const {
  return need_state(services_).services();
}
std::optional<Error> ServiceSubscription::last_error() const {
  return need_state(services_).last_error();
}
void ServiceSubscription::release_client(ClientBase&& client) {
  need_state(services_).release(client);
}
Subscription ServiceSubscription::on_connected(
    Function<void(const SubscriptionClientId&)> function) {
  return need_state(services_).on_connected(std::move(function));
}
Subscription ServiceSubscription::on_disconnected(
    Function<void(const SubscriptionClientId&, const Error&)> function) {
  return need_state(services_).on_disconnected(std::move(function));
}
Subscription ServiceSubscription::on_failed(
    Function<void(const std::vector<std::string>&, const Error&)> function) {
  return need_state(services_).on_failed(std::move(function));
}

void ServiceSubscription::learn(const ObjectType* type) const { need_state(services_).learn(type); }
std::shared_ptr<Stub> ServiceSubscription::find(const ObjectType* type) const {
  return need_state(services_).find(type);
}
std::shared_ptr<Stub> ServiceSubscription::find(const SubscriptionClientId& id,
                                                const ObjectType* type) const {
  return need_state(services_).find(id, type);
}
std::shared_ptr<Stub> ServiceSubscription::need(const ObjectType* type) const {
  return need_state(services_).need(type);
}
std::shared_ptr<Stub> ServiceSubscription::wait(const ObjectType* type,
                                                std::chrono::milliseconds limit) const {
  return need_state(services_).wait(type, limit);
}
void ServiceSubscription::start_wait(const ObjectType* type, std::chrono::milliseconds limit,
                                     std::unique_ptr<Completion> completion) const {
  need_state(services_).start_wait(type, limit, std::move(completion));
}
std::shared_ptr<Session> ServiceSubscription::claim(const Stub* stub) {
  return need_state(services_).claim(stub);
}
ServiceSubscription::LinksPointer ServiceSubscription::add_wire(std::string_view member,
                                                                std::string_view path,
                                                                const Holding& holding) {
  return need_state(services_).add_wire(member, path, holding);
}
ServiceSubscription::LinksPointer ServiceSubscription::add_pipe(std::string_view member,
                                                                std::string_view path,
                                                                const Holding& holding,
                                                                std::size_t max_received) {
  return need_state(services_).add_pipe(member, path, holding, max_received);
}
ServiceSubscription::LinksPointer ServiceSubscription::add_sub_object(std::string_view path) {
  return need_state(services_).add_sub_object(path);
}

}  // namespace rr
