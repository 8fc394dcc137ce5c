// SPDX-License-Identifier: Apache-2.0
#include "runtime/c/src/served_object.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "runtime/cpp/src/endpoint/values.hpp"
#include "runtime/cpp/src/service/request.hpp"
#include "runtime/cpp/src/service/service_host.hpp"

namespace rr::capi {
namespace {

std::uint32_t kind_of(const Member& member, bool is_set) {
  if (is_set) return RR_REQUEST_SET;
  if (member.kind == MemberKind::property) return RR_REQUEST_GET;
  return member.generator != GeneratorForm::none ? RR_REQUEST_GENERATOR : RR_REQUEST_CALL;
}

Data read_question(const rr::Request::Source& source) {
  const service::Question& question = source.question;
  Decoder decoder(question.message.version, &question.message.strings, question.owner,
                  &source.types);
  return read_entry(decoder, question.entry);
}

}  // namespace

RawSkeleton::RawSkeleton(std::shared_ptr<const OwnedObjectType> type, Functions handler)
    : type_(std::move(type)),
      handler_(std::move(handler)),
      memories_(type_->type().members.size()) {
  if (((*handler_)->on_monitor_enter == nullptr) != ((*handler_)->on_monitor_exit == nullptr)) {
    refuse_argument("a monitor has two functions");
  }
}

void RawSkeleton::join(const std::shared_ptr<Keeper>& keeper) {
  keeper->keep(type_);
  const MutexLock lock(mutex_);
  keepers_.insert(keeper);
}

void RawSkeleton::set_memory(std::uint32_t place, std::shared_ptr<MemorySource> memory) {
  const MutexLock lock(mutex_);
  memories_[place].swap(memory);  // what was there before goes when the lock has
}

// The function may be told of a service before it has got its handle.
void RawSkeleton::rr_attached(ServiceContext& context, const std::string& path) {
  if ((*handler_)->on_attached == nullptr) return;
  auto& host = dynamic_cast<service::ServiceHost&>(context);
  auto handle = std::make_unique<::rr_service>(::rr_service{host.weak_from_this(), host.name()});
  (*handler_)->on_attached((*handler_)->context, handle.release(), view(path));
}

void RawSkeleton::rr_released(const std::string& path) {
  if ((*handler_)->on_released != nullptr) {
    (*handler_)->on_released((*handler_)->context, view(path));
  }
}

// The program owns the request from here on.
void RawSkeleton::ask(std::unique_ptr<rr_request> request) const {
  describe_client(request->info);
  const rr_request_info info = [&] {
    rr_request_info copy = request->info;
    copy.size = sizeof copy;
    return copy;
  }();
  (*handler_)->on_request((*handler_)->context, request.release(), &info);
}

void RawSkeleton::rr_dispatch(std::size_t place, Request& request) {
  const Member& member = type_->type().members[place];
  const auto state =
      std::make_shared<MemberRequest::State>(member, type_, request.is_set(), request);
  auto asked = std::make_unique<MemberRequest>(kind_of(member, request.is_set()), state);
  asked->info.member = static_cast<std::uint32_t>(place);
  asked->set_arguments(read_question(request.rr_source()));
  request.rr_source().made.expect();
  ask(std::move(asked));
  state->leave();
}

std::shared_ptr<Skeleton> RawSkeleton::rr_child(std::size_t place, const ObjectIndex& index) {
  const auto wait = std::make_shared<Wait<std::shared_ptr<Skeleton>>>();
  auto asked = std::make_unique<ObjectRequest>(wait);
  asked->info.member = static_cast<std::uint32_t>(place);
  asked->info.index_number = index.number;
  asked->set_name(index.text);
  ask(std::move(asked));
  std::shared_ptr<Skeleton> found = wait->take();
  if (const auto raw = std::dynamic_pointer_cast<RawSkeleton>(found)) {
    std::set<std::shared_ptr<Keeper>> keepers;
    {
      const MutexLock lock(mutex_);
      keepers = keepers_;
    }
    for (const auto& keeper : keepers) raw->join(keeper);
  }
  return found;
}

std::shared_ptr<void> RawSkeleton::peek(std::uint32_t kind, std::uint32_t place) const {
  const auto wait = std::make_shared<Wait<std::optional<Raw>>>();
  auto asked = std::make_unique<ValueRequest>(kind, true, wait);
  asked->info.member = place;
  ask(std::move(asked));
  return std::make_shared<Raw>(std::move(wait->take().value()));
}

std::shared_ptr<MemorySource> RawSkeleton::rr_memory(std::size_t place) {
  const MutexLock lock(mutex_);
  return memories_[place];
}

bool RawSkeleton::rr_has_monitor() const { return (*handler_)->on_monitor_enter != nullptr; }

bool RawSkeleton::rr_monitor_enter(std::chrono::milliseconds timeout) {
  constexpr auto longest = std::chrono::milliseconds(std::numeric_limits<std::int32_t>::max());
  return (*handler_)->on_monitor_enter(
             (*handler_)->context, static_cast<std::int32_t>(std::min(timeout, longest).count())) !=
         0;
}

void RawSkeleton::rr_monitor_exit() { (*handler_)->on_monitor_exit((*handler_)->context); }

bool RawGeneratorSource::rr_step(const void* parameter, void* result) {
  const auto wait = std::make_shared<Wait<Step>>();
  auto asked = std::make_unique<StepRequest>(result != nullptr, wait);
  if (parameter != nullptr) asked->set_arguments(static_cast<const Raw*>(parameter)->data);
  describe_client(asked->info);
  rr_request_info info = asked->info;
  info.size = sizeof info;
  (*handler_)->on_step((*handler_)->context, asked.release(), &info);
  Step step = wait->take();
  if (step.is_end) return false;
  if (result != nullptr) *static_cast<Raw*>(result) = std::move(step.value.value());
  return true;
}

void RawGeneratorSource::end(std::int32_t aborts) const {
  if ((*handler_)->on_end != nullptr) (*handler_)->on_end((*handler_)->context, aborts);
}

}  // namespace rr::capi

using rr::capi::guarded;
using rr::capi::need;

extern "C" {

rr_status rr_served_object_new(rr_object_type* type, const rr_object_handler* handler,
                               rr_served_object** out_object, rr_error** error) {
  return guarded(error, [&] {
    rr::capi::output(out_object) = nullptr;
    auto functions = rr::capi::take_handler(handler, &rr_object_handler::on_request);
    *out_object = new rr_served_object{std::make_shared<rr::capi::RawSkeleton>(
        need(type, "there is no type").type, std::move(functions))};
  });
}

void rr_served_object_release(rr_served_object* object) { rr::capi::release(object); }

rr_status rr_request_answer_object(rr_request* request, rr_served_object* object,
                                   int32_t per_client, rr_error** error) {
  return guarded(error, [&] {
    rr_request& asked = need(request, "there is no request");
    std::shared_ptr<rr::Skeleton> found = object != nullptr ? object->skeleton : nullptr;
    if (found && per_client != 0) found = rr::per_client(std::move(found));
    asked.answer_object(std::move(found));
  });
}

rr_status rr_request_answer_generator(rr_request* request, const rr_generator_handler* handler,
                                      rr_error** error) {
  return guarded(error, [&] {
    auto functions = rr::capi::take_handler(handler, &rr_generator_handler::on_step);
    need(request, "there is no request")
        .answer_generator(std::make_shared<rr::capi::RawGeneratorSource>(std::move(functions)));
  });
}

}  // extern "C"
