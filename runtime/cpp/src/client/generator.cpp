// SPDX-License-Identifier: Apache-2.0
// Generators as a client sees them (07, section 8).
#include "runtime/cpp/src/client/generator.hpp"

#include <array>
#include <atomic>
#include <string>
#include <string_view>
#include <utility>

#include "rr/error.hpp"
#include "rr/generators.hpp"
#include "rr/type.hpp"
#include "runtime/cpp/src/client/session.hpp"
#include "runtime/cpp/src/endpoint/values.hpp"

namespace rr {
namespace {

// The request of a step and its elements.
class StepRequest {
 public:
  StepRequest(const std::string& path, const Member& member, const std::int32_t& index,
              const void* parameter)
      : parameters_{{{"index", &type_of<std::int32_t>}, {"parameter", member.generator_parameter}}},
        values_{&index, parameter},
        request_{.type = EntryType::generator_next_req,
                 .path = path,
                 .member = member.name,
                 .parameters = std::span(parameters_).first(parameter != nullptr ? 2 : 1),
                 .values = values_.data(),
                 .is_urgent = (member.access & urgent) != 0} {}
  StepRequest(const StepRequest&) = delete;
  StepRequest& operator=(const StepRequest&) = delete;

  operator const Outgoing&() const { return request_; }  // NOLINT

 private:
  const std::array<Parameter, 2> parameters_;
  const std::array<const void*, 2> values_;
  const Outgoing request_;
};

// The request that makes a generator.
Outgoing call_request(const std::string& path, const Member& member, const void* const* arguments) {
  return {.type = EntryType::function_call_req,
          .path = path,
          .member = member.name,
          .parameters = member.parameters,
          .values = arguments,
          .is_urgent = (member.access & urgent) != 0,
          .opens_generator = true};
}

// The request that ends a generator: an error that a request carries.
class EndRequest {
 public:
  EndRequest(const std::string& path, const Member& member, const std::int32_t& index, bool aborts)
      : EndRequest(path, member.name, index, aborts, (member.access & urgent) != 0) {}
  EndRequest(const std::string& path, std::string_view member, const std::int32_t& index,
             bool aborts, bool is_urgent)
      : code_(aborts ? ErrorCode::abort_operation : ErrorCode::stop_iteration),
        name_(error_name(code_)),
        text_(aborts ? "Generator abort requested" : ""),
        values_{&name_, &text_, &index},
        request_{.type = EntryType::generator_next_req,
                 .path = path,
                 .member = member,
                 .parameters = parameters,
                 .values = values_.data(),
                 .error = code_,
                 .is_urgent = is_urgent} {}
  EndRequest(const EndRequest&) = delete;
  EndRequest& operator=(const EndRequest&) = delete;

  operator const Outgoing&() const { return request_; }  // NOLINT

 private:
  static constexpr Parameter parameters[] = {parameter<std::string>("errorname"),
                                             parameter<std::string>("errorstring"),
                                             parameter<std::int32_t>("index")};
  const ErrorCode code_;
  const std::string name_;
  const std::string text_;
  const std::array<const void*, 3> values_;
  const Outgoing request_;
};

}  // namespace

/// A generator of a service, shared by its handles.
struct GeneratorState {
  GeneratorState(std::shared_ptr<Session> of, std::string at, const Member& function,
                 Session::Milliseconds limit, std::int32_t number)
      : session(std::move(of)),
        path(std::move(at)),
        member(&function),
        timeout(limit),
        index(number) {}
  ~GeneratorState() {
    if (has_ended) return;
    try {
      session->send(EndRequest(path, *member, index, false), true);
    } catch (const Error&) {
      // The session has ended, and all its generators with it.
    }
  }

  const std::shared_ptr<Session> session;
  const std::string path;
  const Member* const member;
  const Session::Milliseconds timeout;
  const std::int32_t index;
  std::atomic<bool> has_ended{false};  // and the service knows

  /// What an error says about the generator: true for its end in order.
  bool is_end(const Error& error) {
    const bool is_gone = error.code() == ErrorCode::invalid_operation;
    const bool is_end = error.code() == ErrorCode::stop_iteration;
    if (is_gone || is_end) has_ended = true;
    return is_end;
  }
};

namespace {

GeneratorState& need(const std::shared_ptr<GeneratorState>& state) {
  if (!state) throw Error(ErrorCode::invalid_operation, "there is no generator");
  return *state;
}

// The completion of a step, which keeps its generator.
class StepEnd final : public Completion {
 public:
  StepEnd(std::shared_ptr<GeneratorState> state, std::unique_ptr<GeneratorStep> step)
      : state_(std::move(state)), step_(std::move(step)) {}

  void* result() override { return step_->result(); }
  void succeed() override { step_->succeed(); }
  void fail(std::exception_ptr error) override {
    try {
      std::rethrow_exception(error);
    } catch (const Error& why) {
      if (state_->is_end(why)) {
        step_->stop();
        return;
      }
    } catch (...) {
      // Whatever it is, the program is told.
    }
    step_->fail(std::move(error));
  }

 private:
  const std::shared_ptr<GeneratorState> state_;
  const std::unique_ptr<GeneratorStep> step_;
};

// The completion of an EndRequest: a generator that is gone already has ended as wished.
class EndCompletion final : public Completion {
 public:
  EndCompletion(std::shared_ptr<GeneratorState> state, std::unique_ptr<Completion> completion)
      : state_(std::move(state)), completion_(std::move(completion)) {}

  void* result() override { return nullptr; }
  void succeed() override { completion_->succeed(); }
  void fail(std::exception_ptr error) override {
    try {
      std::rethrow_exception(error);
    } catch (const Error& why) {
      if (why.code() == ErrorCode::invalid_operation) {
        completion_->succeed();
        return;
      }
    } catch (...) {
      // As above.
    }
    completion_->fail(std::move(error));
  }

 private:
  const std::shared_ptr<GeneratorState> state_;
  const std::unique_ptr<Completion> completion_;
};

}  // namespace

bool GeneratorHandle::step(const void* parameter, void* result, const CallOptions& options) {
  const CallOptionsScope scope(options);
  GeneratorState& state = need(state_);
  try {
    state.session->call(StepRequest(state.path, *state.member, state.index, parameter),
                        {"return", state.member->type, result}, state.timeout);
  } catch (const Error& error) {
    if (!state.is_end(error)) throw;
    return false;
  }
  return true;
}

// What was kept is the program's once it has all of it.
void GeneratorHandle::collect(void* value, std::size_t size, const std::function<void()>& keep,
                              const CallOptions& options) {
  const CallOptionsScope scope(options);
  GeneratorState& state = need(state_);
  channel::Charge kept(state.session->connection().account());
  std::size_t received = 0;
  const auto read = [&](Decoder& decoder, const Message&, const Entry& entry) {
    endpoint::read_value(decoder, entry, "return", *state.member->type, value);
    received = entry.elements.size();
  };
  while (true) {
    try {
      state.session->call(StepRequest(state.path, *state.member, state.index, nullptr), read,
                          state.timeout);
    } catch (const Error& error) {
      if (!state.is_end(error)) throw;
      return;
    }
    if (!kept.add(size + received)) {
      throw Error(ErrorCode::out_of_system_resource,
                  "all values of `" + std::string(state.member->name) +
                      "` are more than this client holds for a service; next() takes one");
    }
    keep();
  }
}

void GeneratorHandle::start_step(const std::shared_ptr<GeneratorState>& state,
                                 const void* parameter, std::unique_ptr<GeneratorStep> step) {
  const GeneratorState& of = need(state);
  auto end = std::make_shared<StepEnd>(state, std::move(step));
  void* const result = end->result();
  of.session->start(StepRequest(of.path, *of.member, of.index, parameter),
                    {"return", of.member->type, result}, of.timeout, std::move(end));
}

void GeneratorHandle::end(bool aborts, const CallOptions& options) {
  const CallOptionsScope scope(options);
  GeneratorState& state = need(state_);
  if (state.has_ended.exchange(true)) return;
  try {
    state.session->call(EndRequest(state.path, *state.member, state.index, aborts), Incoming{},
                        state.timeout);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::invalid_operation) throw;  // else it is gone already
  }
}

void GeneratorHandle::start_end(const std::shared_ptr<GeneratorState>& state, bool aborts,
                                std::unique_ptr<Completion> completion) {
  GeneratorState& of = need(state);
  auto end = std::make_shared<EndCompletion>(state, std::move(completion));
  if (of.has_ended.exchange(true)) {
    of.session->post({[end] { end->succeed(); }});
    return;
  }
  of.session->start(EndRequest(of.path, *of.member, of.index, aborts), Incoming{}, of.timeout,
                    std::move(end));
}

std::shared_ptr<GeneratorState> Stub::rr_open_generator(const Member& member,
                                                        const void* const* arguments) {
  if (!rr_session_) {
    throw Error(ErrorCode::invalid_operation, "the stub is not attached to a session");
  }
  rr_session_->check_member(*this, member);
  std::int32_t index = 0;
  rr_session_->call(call_request(rr_path_, member, arguments),
                    {"index", &type_of<std::int32_t>, &index}, rr_timeout_);
  return client::make_generator(*this, member, index);
}

void client::abort_generator(Session& session, const std::string& path, const std::string& member,
                             std::int32_t index) noexcept {
  try {
    session.send(EndRequest(path, member, index, true, false), true);
  } catch (...) {
    // The session has ended, and all its generators with it.
  }
}

std::shared_ptr<GeneratorState> client::make_generator(const Stub& stub, const Member& member,
                                                       std::int32_t index) {
  return std::make_shared<GeneratorState>(stub.rr_session(), stub.rr_path(), member,
                                          stub.rr_timeout(), index);
}

void Stub::rr_start_generator(const Member& member, const void* const* arguments,
                              std::unique_ptr<Completion> completion) {
  if (!rr_session_) {
    throw Error(ErrorCode::invalid_operation, "the stub is not attached to a session");
  }
  if (rr_session_->refuse_start(*this, member, completion)) return;
  std::shared_ptr<Completion> shared = std::move(completion);
  auto* const place = static_cast<std::shared_ptr<GeneratorState>*>(shared->result());
  rr_session_->start(
      call_request(rr_path_, member, arguments),
      [place, session = rr_session_, path = rr_path_, function = &member, timeout = rr_timeout_](
          Decoder& decoder, const Message&, const Entry& entry) {
        std::int32_t index = 0;
        endpoint::read_value(decoder, entry, "index", type_of<std::int32_t>, &index);
        *place = std::make_shared<GeneratorState>(session, path, *function, timeout, index);
      },
      rr_timeout_, std::move(shared));
}

}  // namespace rr
