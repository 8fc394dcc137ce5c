// SPDX-License-Identifier: Apache-2.0
// The steps of a plan that use pipes, wires, callbacks, memories and generators.
#include <atomic>

#include "conformance/runners/shared/call.hpp"
#include "conformance/runners/shared/outcomes.hpp"

namespace rr::conformance {
namespace {

// What an earlier step has made for this one.
template <class Handles>
auto& held(Handles& handles, const Json& step) {
  return *handles.at(step.at("handle").get<std::string>());
}

[[noreturn]] void unknown(const std::string& operation) {
  throw NotSupported("this runner cannot do " + operation);
}

}  // namespace

Json CallingNode::play_pipe(const std::string& operation, const Json& step) {
  if (operation == "pipe_connect") {
    const std::string name = step.at("as");
    auto pipe = object(step).caller->pipe(step.at("member").get<std::string>(),
                                          step.value("index", -1), [this, name](Json thing) {
                                            thing["pipe"] = name;
                                            arrivals_.add(std::move(thing));
                                          });
    const Json index = pipe->index();
    pipes_[name] = std::move(pipe);
    return index;
  }
  PlannedPipe& pipe = held(pipes_, step);
  if (operation == "pipe_send") return pipe.send(step.at("value"), step.value("ack", false));
  if (operation != "pipe_close") unknown(operation);
  pipe.close();
  return nullptr;
}

Json CallingNode::play_wire(const std::string& operation, const Json& step) {
  if (!step.contains("handle")) {
    auto wire = object(step).caller->wire(step.at("member").get<std::string>());
    if (operation == "wire_peek_in") return wire->peek_in();
    if (operation == "wire_peek_out") return wire->peek_out();
    if (operation == "wire_poke_out") {
      wire->poke_out(step.at("value"));
      return nullptr;
    }
    if (operation != "wire_connect") unknown(operation);
    const std::string name = step.at("as");
    wire->connect([this, name](Json thing) {
      thing["wire"] = name;
      arrivals_.add(std::move(thing));
    });
    wires_[name] = std::move(wire);
    return nullptr;
  }
  PlannedWire& wire = held(wires_, step);
  if (operation == "wire_in") return wire.in();
  if (operation == "wire_set") {
    wire.set_out(step.at("value"));
  } else if (operation == "wire_close") {
    wire.close();
  } else {
    unknown(operation);
  }
  return nullptr;
}

Json CallingNode::play_memory(const std::string& operation, const Json& step) {
  const auto memory = object(step).caller->memory(step.at("member").get<std::string>());
  if (operation == "mem_length") return memory->length();
  if (operation == "mem_dims") return memory->dims();
  if (operation == "mem_dimcount") return memory->dim_count();
  if (operation == "mem_read") return memory->read(step.at("pos"), step.at("count"));
  if (operation != "mem_write") unknown(operation);
  memory->write(step.at("pos"), step.at("count"), step.at("value"));
  return nullptr;
}

Json CallingNode::play_generator(const std::string& operation, const Json& step) {
  if (operation == "gen_call") {
    generators_[step.at("as").get<std::string>()] =
        object(step).caller->generate(step.at("member").get<std::string>(), step.at("args"));
    return nullptr;
  }
  PlannedGenerator& generator = held(generators_, step);
  if (operation == "gen_next") return generator.next(step.value("value", Json()));
  if (operation == "gen_close") {
    generator.close();
  } else if (operation == "gen_abort") {
    generator.abort();
  } else {
    unknown(operation);
  }
  return nullptr;
}

Json CallingNode::set_callback(const Json& step) {
  const std::string member = step.at("member");
  const auto calls = std::make_shared<std::atomic<std::size_t>>(0);
  object(step).caller->set_callback(
      member, [this, member, calls, outcomes = step.at("outcomes")](const Json& arguments) {
        arrivals_.add({{"callback", member}, {"args", arguments}});
        const Json outcome = outcome_of_call(outcomes, (*calls)++);
        if (outcome.contains("throw")) {
          const auto read = [this](const Json& json) { return binding_.read(json); };
          raise(read, outcome["throw"], arguments);
        }
        return part(outcome, "return");
      });
  return nullptr;
}

}  // namespace rr::conformance
