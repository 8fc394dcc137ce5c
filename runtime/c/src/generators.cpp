// SPDX-License-Identifier: Apache-2.0
// Generators as a client sees them.
#include "rr/generators.hpp"

#include <utility>

#include "rr/type.hpp"
#include "runtime/c/src/node.hpp"
#include "runtime/cpp/src/client/generator.hpp"
#include "runtime/cpp/src/client/session.hpp"

namespace rr::capi {
namespace {

// A generator's steps in the open.
class RawGenerator : public GeneratorHandle {
 public:
  using GeneratorHandle::GeneratorHandle;
  using GeneratorHandle::start_end;
  using GeneratorHandle::start_step;
  using GeneratorHandle::step;
  [[nodiscard]] const std::shared_ptr<GeneratorState>& state() const { return state_; }
};

// The call of a generator function: its arguments, as a member of their own. What the generator
// keeps of a member is one of the session's.
class Opening {
 public:
  Opening(RawStub& stub, rr_str member, const rr_elements* arguments, const Terms& terms)
      : values_(arguments),
        member_(
            stub.tables().member(text(member), MemberKind::function, access_of(terms.access()))) {}
  [[nodiscard]] const Member& member() const { return member_; }
  [[nodiscard]] Outgoing request(const RawStub& stub) const {
    return {.type = EntryType::function_call_req,
            .path = stub.rr_path(),
            .member = member_.name,
            .parameters = values_.parameters(),
            .values = values_.places(),
            .is_urgent = (member_.access & urgent) != 0,
            .opens_generator = true};
  }

 private:
  const Values values_;
  const Member& member_;
};

}  // namespace
}  // namespace rr::capi

struct rr_generator {
  std::shared_ptr<const rr::capi::ClientTables> tables;
  rr::capi::RawGenerator generator;
};

namespace rr::capi {
namespace {

// What a step takes.
class StepParameter {
 public:
  explicit StepParameter(const rr_elements* elements) : values_(elements) {}
  [[nodiscard]] const void* place() const {
    return values_.count() == 0 ? nullptr : &values_.single();
  }

 private:
  const Values values_;
};

// One step that nobody waits for.
template <class Finish>
class StepCompletion final : public DoneCompletion<Raw, Finish, GeneratorStep> {
 public:
  using DoneCompletion<Raw, Finish, GeneratorStep>::DoneCompletion;
  void stop() override { this->done_.done(this->done_.context, nullptr, nullptr); }
};

}  // namespace
}  // namespace rr::capi

using rr::capi::guarded;
using rr::capi::need;
using rr::capi::output;
using rr::capi::stub_of;
using rr::capi::Terms;

extern "C" {

rr_status rr_generator_open(rr_object* object, rr_str member, const rr_elements* arguments,
                            const rr_call_options* options, rr_generator** out_generator,
                            rr_error** error) {
  return guarded(error, [&] {
    output(out_generator) = nullptr;
    rr::capi::RawStub& stub = stub_of(object);
    const Terms terms(options);
    const rr::capi::Opening opening(stub, member, arguments, terms);
    int32_t index = 0;
    stub.rr_session()->call(opening.request(stub), {"index", &rr::type_of<int32_t>, &index},
                            stub.rr_timeout());
    *out_generator = new rr_generator{
        stub.shared_tables(),
        rr::capi::RawGenerator(rr::client::make_generator(stub, opening.member(), index))};
  });
}

rr_status rr_generator_open_async(rr_object* object, rr_str member, const rr_elements* arguments,
                                  const rr_call_options* options, const rr_completion* completion,
                                  rr_error** error) {
  return guarded(error, [&] {
    rr::capi::RawStub& stub = stub_of(object);
    const Terms terms(options);
    const rr::capi::Opening opening(stub, member, arguments, terms);
    auto done = rr::capi::complete<int32_t>(
        completion, [of = object->stub, &member = opening.member()](int32_t index) -> void* {
          return new rr_generator{
              of->shared_tables(),
              rr::capi::RawGenerator(rr::client::make_generator(*of, member, index))};
        });
    int32_t& place = done->place();
    stub.rr_session()->start(opening.request(stub), {"index", &rr::type_of<int32_t>, &place},
                             stub.rr_timeout(), std::move(done));
  });
}

rr_status rr_generator_next(rr_generator* generator, const rr_elements* parameter,
                            const rr_call_options* options, rr_data** out_value, rr_error** error) {
  bool has_ended = false;
  const rr_status status = guarded(error, [&] {
    output(out_value) = nullptr;
    rr::capi::RawGenerator& of = need(generator, "there is no generator").generator;
    const Terms terms(options);
    const rr::capi::StepParameter given(parameter);
    rr::capi::Raw value;
    has_ended = !of.step(given.place(), &value);
    if (!has_ended) *out_value = std::move(value.data).hand_out();
  });
  return status == RR_OK && has_ended ? RR_STOP_ITERATION : status;
}

rr_status rr_generator_next_async(rr_generator* generator, const rr_elements* parameter,
                                  const rr_call_options* options, const rr_completion* completion,
                                  rr_error** error) {
  return guarded(error, [&] {
    rr::capi::RawGenerator& of = need(generator, "there is no generator").generator;
    const Terms terms(options);
    const rr::capi::StepParameter given(parameter);
    auto finish = [tables = generator->tables](rr::capi::Raw& value) -> void* {
      return std::move(value.data).hand_out();
    };
    rr::capi::RawGenerator::start_step(of.state(), given.place(),
                                       std::make_unique<rr::capi::StepCompletion<decltype(finish)>>(
                                           rr::capi::check(completion), std::move(finish)));
  });
}

rr_status rr_generator_end(rr_generator* generator, int32_t aborts, const rr_call_options* options,
                           rr_error** error) {
  return guarded(error, [&] {
    rr::capi::RawGenerator& of = need(generator, "there is no generator").generator;
    const Terms terms(options);
    if (aborts != 0) {
      of.abort();
    } else {
      of.close();
    }
  });
}

rr_status rr_generator_end_async(rr_generator* generator, int32_t aborts,
                                 const rr_call_options* options, const rr_completion* completion,
                                 rr_error** error) {
  return guarded(error, [&] {
    const rr::capi::RawGenerator& of = need(generator, "there is no generator").generator;
    const Terms terms(options);
    rr::capi::RawGenerator::start_end(of.state(), aborts != 0,
                                      rr::capi::complete_with_nothing(completion));
  });
}

void rr_generator_release(rr_generator* generator) { rr::capi::release(generator); }

}  // extern "C"
