// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/generators.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "rr/error.hpp"
#include "rr/type.hpp"
#include "runtime/cpp/src/channel/reactor.hpp"
#include "runtime/cpp/src/endpoint/service_path.hpp"
#include "runtime/cpp/src/endpoint/values.hpp"
#include "runtime/cpp/src/platform/random.hpp"
#include "runtime/cpp/src/service/handler_memory.hpp"
#include "runtime/cpp/src/service/request.hpp"
#include "runtime/cpp/src/service/server_endpoint.hpp"
#include "runtime/cpp/src/service/service_host.hpp"

namespace rr {
namespace service {
namespace {

// How long the number of a closed generator is known (07, section 8).
constexpr channel::Milliseconds closed_time{30'000};
// So many of them in one session: a client may open and close faster than that time passes.
constexpr std::size_t most_closed = 128;
// What a generator takes, about; a coroutine is not asked for its size.
constexpr std::size_t generator_cost = 1024;

// They are destroyed when the deferred calls are made.
void leave(std::vector<std::shared_ptr<ClientGenerator>> removed,
           channel::DeferredCallbacks& deferred) {
  if (removed.empty()) return;
  deferred.emplace_back(
      [kept = std::make_shared<decltype(removed)>(std::move(removed))] { kept->clear(); });
}

Error invalid_generator() { return {ErrorCode::invalid_operation, "Invalid generator"}; }

}  // namespace

std::int32_t Generators::add(const std::shared_ptr<ClientGenerator>& generator, std::size_t limit,
                             const std::function<void()>& check) {
  if (!generator->charge.add(generator_cost)) {
    throw Error(ErrorCode::out_of_system_resource,
                "the generators of this client take too much memory");
  }
  const platform::RandomNumbers random;
  generator->last_used = channel::coarse_now();
  const MutexLock lock(mutex_);
  if (has_ended_) throw Error(ErrorCode::connection_error, "the client has left");
  if (generators_.size() - closed_.size() >= limit) {
    throw Error(ErrorCode::out_of_system_resource,
                "more than " + std::to_string(limit) + " generators of one session");
  }
  check();
  while (true) {
    const auto index = static_cast<std::int32_t>(random() >> 1U);
    if (generators_.emplace(index, generator).second) return index;
  }
}

void Generators::remove(std::int32_t index) {
  std::shared_ptr<ClientGenerator> removed;
  const MutexLock lock(mutex_);
  removed = forget(index);
}

std::shared_ptr<ClientGenerator> Generators::forget(std::int32_t index) {
  std::erase(closed_, index);
  const auto node = generators_.extract(index);
  return node ? std::move(node.mapped()) : nullptr;
}

std::vector<std::shared_ptr<ClientGenerator>> Generators::forget_if(
    const std::function<bool(const ClientGenerator&)>& is_over) {
  std::vector<std::shared_ptr<ClientGenerator>> removed;
  std::erase_if(generators_, [&](auto& item) RR_REQUIRES(mutex_) {
    if (!is_over(*item.second)) return false;
    std::erase(closed_, item.first);
    item.second->state = ClientGenerator::State::ended;
    removed.push_back(std::move(item.second));
    return true;
  });
  return removed;
}

// A step that waits for a callback lets the next request in. When that is for the same generator it
// waits in turn, and like the other lets messages pass, of which one may bring the end of it.
Generators::Use::Use(Generators& generators, const ServedObject& object, std::int32_t index,
                     channel::Connection& connection)
    : generators_(generators), index_(index) {
  MutexLock lock(generators_.mutex_);
  const auto found = generators_.generators_.find(index);
  if (found == generators_.generators_.end() || found->second->object.get() != &object) {
    throw invalid_generator();
  }
  generator_ = found->second;
  const std::uint32_t step = generator_->next_step++;
  if (generator_->current_step == step) return;
  lock.unlock();
  const bool has_given_up = connection.step_out();
  if (has_given_up) channel::Reactor::about_to_wait();
  lock.lock();
  if (!has_given_up) {
    --generator_->next_step;  // with the turn, so nobody has come behind
    throw Error(ErrorCode::member_busy, "too many steps wait for their turn");
  }
  while (generator_->current_step != step) generators_.stepped_.wait(generators_.mutex_);
  lock.unlock();
  connection.step_in(channel::never);
}

Generators::Use::~Use() {
  {
    const MutexLock lock(generators_.mutex_);
    ++generator_->current_step;
    generator_->last_used = channel::coarse_now();
  }
  generators_.stepped_.notify_all();
}

ClientGenerator::State Generators::Use::state() const {
  const MutexLock lock(generators_.mutex_);
  return generator_->state;
}

void Generators::Use::close(ClientGenerator::State state) {
  std::shared_ptr<ClientGenerator> oldest;
  const MutexLock lock(generators_.mutex_);
  if (generator_->state != ClientGenerator::State::open) return;
  generator_->state = state;
  generators_.closed_.push_back(index_);
  if (generators_.closed_.size() > most_closed) {
    oldest = generators_.forget(generators_.closed_.front());
  }
}

void Generators::Use::end() {
  std::shared_ptr<ClientGenerator> removed;
  const MutexLock lock(generators_.mutex_);
  generator_->state = ClientGenerator::State::ended;
  removed = generators_.forget(index_);
}

std::size_t Generators::end_if(const Choice& is_over) {
  std::vector<std::shared_ptr<ClientGenerator>> removed;
  const MutexLock lock(mutex_);
  removed = forget_if([&](const ClientGenerator& generator) {
    return is_over(generator.object->path, generator.member->name);
  });
  return removed.size();
}

void Generators::release_path(std::string_view path) {
  end_if([&](std::string_view each, std::string_view) {
    return endpoint::is_at_or_below(each, path);
  });
}

void Generators::end(channel::DeferredCallbacks& deferred) {
  const MutexLock lock(mutex_);
  has_ended_ = true;
  leave(forget_if([](const ClientGenerator&) { return true; }), deferred);
}

void Generators::drop_unused(channel::Time now, channel::Milliseconds timeout,
                             channel::DeferredCallbacks& deferred) {
  const MutexLock lock(mutex_);
  leave(forget_if([&](const ClientGenerator& generator) {
          const bool is_open = generator.state == ClientGenerator::State::open;
          const channel::Milliseconds limit = is_open ? timeout : std::min(timeout, closed_time);
          return generator.next_step == generator.current_step && now - generator.last_used > limit;
        }),
        deferred);
}

// In a request an error is a wish (07, section 8); any answer with an error is the last.
void ServerEndpoint::answer_generator_step(Question& question) {
  const Entry& entry = question.entry;
  const auto object = find_object(entry.service_path);
  Decoder decoder = question.decoder(types().get());
  std::int32_t index = 0;
  endpoint::read_value(decoder, entry, "index", type_of<std::int32_t>, &index);
  Generators::Use generator(generators_, *object, index, *connection_);
  question.is_urgent = (generator->member->access & urgent) != 0;
  if (generator->member->name != entry.member) check_member(question, *generator->member);
  try {
    if (generator.state() == ClientGenerator::State::ended) throw invalid_generator();
    if (entry.error == 0) {
      step_generator(question, decoder, generator);
    } else {
      end_generator(static_cast<ErrorCode>(entry.error), generator);
      answer_void(question);
    }
  } catch (...) {
    generator.end();
    throw;
  }
}

void ServerEndpoint::step_generator(const Question& question, Decoder& decoder,
                                    Generators::Use& generator) {
  if (generator.state() == ClientGenerator::State::aborted) {
    throw Error(ErrorCode::operation_aborted, "generator was aborted");
  }
  if (generator.state() == ClientGenerator::State::closed) {
    throw Error(ErrorCode::stop_iteration, "");
  }
  std::shared_ptr<void> parameter;
  std::shared_ptr<void> result;
  if (generator->parameter != nullptr) {
    parameter = generator->parameter->make();
    endpoint::read_value(decoder, question.entry, "parameter",
                         *generator->member->generator_parameter, parameter.get());
  }
  if (generator->result != nullptr) result = generator->result->make();
  HandlerMemory made(*this, question, host_->answer_sizes().expected(*generator->member));
  made.expect();
  if (!generator->source->rr_step(parameter.get(), result.get())) {
    throw Error(ErrorCode::stop_iteration, "");
  }
  if (result) {
    answer_result(question, *generator->member, made, result.get());
  } else {
    answer_void(question);
  }
}

// The number stays known for a while, the rest goes.
void ServerEndpoint::end_generator(ErrorCode wish, Generators::Use& generator) {
  if (generator.state() != ClientGenerator::State::open) return;
  const bool is_close = wish == ErrorCode::stop_iteration;
  generator.close(is_close ? ClientGenerator::State::closed : ClientGenerator::State::aborted);
  const std::shared_ptr<GeneratorSource> source = std::move(generator->source);
  if (is_close) {
    source->rr_close();
  } else {
    source->rr_abort();
  }
}

void ServerEndpoint::answer_void(const Question& question) {
  const std::int32_t nothing = 0;  // what void looks like
  answer_value(question, "return", type_of<std::int32_t>, &nothing);
}

}  // namespace service

void Request::answer_generator(std::shared_ptr<GeneratorSource> generator, const Holding* result,
                               const Holding* parameter) {
  Source& source = *source_;
  if (source.state != Source::State::open) {
    throw Error(ErrorCode::invalid_operation, "the request has been answered already");
  }
  if (source.member.generator == GeneratorForm::none || !generator) {
    throw Error(ErrorCode::internal_error, "the handler has given no generator");
  }
  service::Generators& generators = source.endpoint.generators();
  const std::int32_t index =
      generators.add(std::make_shared<service::ClientGenerator>(service::ClientGenerator{
                         .object = source.object,
                         .member = &source.member,
                         .source = std::move(generator),
                         .result = result,
                         .parameter = parameter,
                         .charge = channel::Charge(source.endpoint.connection().account())}),
                     source.endpoint.generator_limit(), [&] {
                       if (!source.endpoint.is_still_allowed(source.question)) {
                         throw service::ServerEndpoint::no_longer_allowed();
                       }
                     });
  try {
    // What was released meanwhile has not been found among the generators.
    if (source.endpoint.find_object(source.question.entry.service_path) != source.object) {
      throw Error(ErrorCode::object_not_found, "the object was released");
    }
    source.endpoint.answer_value(source.question, "index", type_of<std::int32_t>, &index);
  } catch (...) {
    generators.remove(index);
    throw;
  }
  source.state = Source::State::answered;
}

}  // namespace rr
