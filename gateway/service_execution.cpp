// SPDX-License-Identifier: Apache-2.0
// How requests that are allowed are executed. On threads of the node, with nothing that changes.
#include <algorithm>
#include <utility>

#include "gateway/elements.hpp"
#include "gateway/properties.hpp"
#include "gateway/service_exporter.hpp"
#include "rr/error.hpp"

namespace rr::gateway {
namespace {

using Clock = std::chrono::steady_clock;
using Executed = Function<void(std::exception_ptr, Message)>;

/// Answers with a value.
dynamic::Done<dynamic::Value> give(const Executed& done, const dynamic::ValueType& type) {
  return [done, type](const std::exception_ptr& error, const dynamic::Value& value) {
    if (error) {
      done(error, {});
      return;
    }
    try {
      done(nullptr, {"", encode_element(type, value), {{"type", type.text()}}});
    } catch (...) {
      done(std::current_exception(), {});
    }
  };
}

/// Answers without one.
dynamic::Done<> finish(const Executed& done) {
  return [done](const std::exception_ptr& error) { done(error, {}); };
}

dynamic::Memory::Numbers numbers(const Message& message, const char* name) {
  auto found = numbers_property(message, name);
  if (found) return *std::move(found);
  throw Error(ErrorCode::invalid_argument,
              std::string("`") + name + "` of the request is no list of numbers");
}

// The client makes room for as many items as are asked for, before the service has seen the
// request.
void check_items(const dynamic::Memory::Numbers& count) {
  std::uint64_t items = 1;
  for (const std::uint64_t one : count) {
    // Both factors are small enough for their product.
    items = std::min(one, most_items + 1) * items;
    if (items > most_items) {
      throw Error(ErrorCode::invalid_argument,
                  "a request reads at most " + std::to_string(most_items) + " items of a memory");
    }
  }
}

void get_memory(const dynamic::Memory& memory, const dynamic::ValueType& type,
                const Message& message, const Executed& done) {
  if (message.find("position")) {
    const auto count = numbers(message, "count");
    check_items(count);
    memory.async_read(numbers(message, "position"), count, give(done, type));
  } else {
    done(nullptr, {"", {}, {{"dims", list_text(memory.dims())}}});
  }
}

void peek(const dynamic::Wire& wire, const dynamic::ValueType& type, const Message& message,
          const Executed& done) {
  const auto give_value = [value = give(done, type)](const std::exception_ptr& error,
                                                     const Timed<dynamic::Value>& timed) {
    value(error, timed.value);
  };
  if (message.find("peek") == "out") {
    wire.async_peek_out(give_value);
  } else {
    wire.async_peek_in(give_value);
  }
}

void get(const dynamic::Object& object, const dynamic::MemberDescription& member,
         const Message& message, const Executed& done) {
  if (member.kind == MemberKind::memory) {
    get_memory(object.memory(member.name), member.type, message, done);
  } else if (member.kind == MemberKind::wire) {
    peek(object.wire(member.name), member.type, message, done);
  } else {
    object.async_get(member.name, give(done, member.type));
  }
}

/// The error if it is of a lock; any other says nothing of locks.
std::exception_ptr lock_error(const std::exception_ptr& error) {
  try {
    if (error) std::rethrow_exception(error);
  } catch (const Error& reason) {
    if (reason.code() == ErrorCode::object_locked_error) return error;
  } catch (...) {
  }
  return nullptr;
}

// What a lock keeps out is refused a peek as well.
void check_connect(const dynamic::Object& object, const dynamic::MemberDescription& member,
                   const Executed& done) {
  if (member.kind == MemberKind::pipe) {
    object.pipe(member.name).async_check_lock([done](const std::exception_ptr& error) {
      done(lock_error(error), {});
    });
    return;
  }
  const dynamic::Wire wire = object.wire(member.name);
  const auto seen = [done](const std::exception_ptr& error, const Timed<dynamic::Value>&) {
    done(lock_error(error), {});
  };
  if ((member.access & writeonly) != 0) {
    wire.async_peek_out(seen);
  } else {
    wire.async_peek_in(seen);
  }
}

void set(const dynamic::Object& object, const dynamic::MemberDescription& member,
         const Message& message, const Executed& done) {
  const dynamic::Value value = decode_element(object.types(), member.type, message.payload);
  if (member.kind == MemberKind::memory) {
    object.memory(member.name).async_write(numbers(message, "position"), value, finish(done));
  } else {
    object.async_set(member.name, value, finish(done));
  }
}

}  // namespace

void ServiceExporter::execute(const RequestTopic& request, const Message& message) {
  const std::string name(message.find("session").value_or(""));
  const auto session = name.empty() ? nullptr : sessions_.find(request.user, name);
  if (session) sessions_.request_begun(request.user, name);
  const Executed done = [weak = Weak(shared_from_this()), request, message, name, session](
                            const std::exception_ptr& error, const Message& result) {
    const Self self = weak.lock();
    if (!self) return;
    self->shared_.worker.post([weak, request, message, name, session, error, result] {
      const Self exporter = weak.lock();
      if (!exporter) return;
      if (error) {
        exporter->answer_error(request, message, error, "robot");
      } else {
        exporter->answer(request, message, result);
      }
      if (session) exporter->sessions_.request_answered(request.user, name, session);
    });
  };
  if (request.verb == Verb::next) {
    try {
      step(request, message, done);
    } catch (...) {
      done(std::current_exception(), {});
    }
    return;
  }
  find_object_for(request, message,
                  [weak = Weak(shared_from_this()), request, message, session, done](
                      const std::exception_ptr& error, const dynamic::Object& object) {
                    const Self self = weak.lock();
                    if (!self) return;
                    try {
                      if (error) std::rethrow_exception(error);
                      if (session) self->serve_callbacks(request, message, *session, object);
                      if (request.verb == Verb::lock) {
                        self->keep_lock(request, message, session, object, done);
                      } else {
                        self->perform(request, message, object, done);
                      }
                    } catch (...) {
                      done(std::current_exception(), {});
                    }
                  });
}

void ServiceExporter::find_object_for(const RequestTopic& request, const Message& message,
                                      const RobotSession::Found& found) {
  const auto name = message.find("session");
  if (!name) {
    session_of(request.user)->find(request.path, found);
  } else if (const auto session = sessions_.find(request.user, *name)) {
    session->find(request.path, found);
  } else {
    found(error_pointer(ErrorCode::connection_error, "the session at the robot has ended"), {});
  }
}

void ServiceExporter::perform(const RequestTopic& request, const Message& message,
                              const dynamic::Object& object, const Executed& done) {
  if (request.verb == Verb::object) {
    done(nullptr, {"", {}, {{"type", object.type_name()}}});
    return;
  }
  const dynamic::MemberDescription member = object.member(request.member);
  const dynamic::Definitions definitions = object.types();
  if (request.verb == Verb::get) {
    get(object, member, message, done);
  } else if (request.verb == Verb::set) {
    set(object, member, message, done);
  } else if (request.verb == Verb::poke) {
    object.wire(member.name)
        .async_poke_out(decode_element(definitions, member.type, message.payload), finish(done));
  } else if (request.verb == Verb::connect) {
    check_connect(object, member, done);
  } else if (request.verb == Verb::send) {
    send_packets(request, message, object, done);
  } else {
    const dynamic::List arguments =
        decode_arguments(definitions, member.parameters, message.payload);
    if (member.generator == GeneratorForm::none) {
      object.async_call(member.name, arguments, give(done, member.type));
    } else {
      open_generator(request, object, arguments, done);
    }
  }
}

// Each endpoint of a far client has one here. Packets of one endpoint come one request at a time.
void ServiceExporter::send_packets(const RequestTopic& request, const Message& message,
                                   const dynamic::Object& object, const Executed& done) {
  const std::string name = request.user + " " + request.path + "." + request.member + " " +
                           std::string(message.find("endpoint").value_or(""));
  if (message.find("end")) {
    endpoints_.close(name);
    done(nullptr, {});
    return;
  }
  const std::uint64_t count = number_property(message, "count").value_or(1);
  // Before anything is made for each of them.
  if (count > most_packets) {
    throw Error(ErrorCode::invalid_argument,
                "a request has at most " + std::to_string(most_packets) +
                    " packets, this one says " + std::to_string(count));
  }
  const std::vector<dynamic::ParameterDescription> parameters(
      count, {"value", object.member(request.member).type});
  const dynamic::List packets = decode_arguments(object.types(), parameters, message.payload);
  if (endpoints_.send(name, packets, Clock::now())) {
    done(nullptr, {});
    return;
  }
  object.pipe(request.member)
      .async_connect([weak = Weak(shared_from_this()), name, packets, done](
                         const std::exception_ptr& error, const dynamic::PipeEndpoint& end) {
        const Self self = weak.lock();
        if (!self) return;
        try {
          if (error) std::rethrow_exception(error);
          self->endpoints_.add(name, end, Clock::now());
          self->endpoints_.send(name, packets, Clock::now());
          done(nullptr, {});
        } catch (...) {
          done(std::current_exception(), {});
        }
      });
}

void ServiceExporter::open_generator(const RequestTopic& request, const dynamic::Object& object,
                                     const dynamic::List& arguments, const Executed& done) {
  object.async_generate(request.member, arguments,
                        [weak = Weak(shared_from_this()), user = request.user, object,
                         member = object.member(request.member), done](
                            const std::exception_ptr& error, const dynamic::Generator& generator) {
                          const Self self = weak.lock();
                          if (!self) return;
                          if (error) {
                            done(error, {});
                            return;
                          }
                          const std::string name = self->generators_.add(
                              user, {generator, object.types(), member}, Clock::now());
                          done(nullptr, {"", {}, {{"generator", name}}});
                        });
}

void ServiceExporter::step(const RequestTopic& request, const Message& message,
                           const Executed& done) {
  const std::string name(message.find("generator").value_or(""));
  auto open = generators_.find(request.user, name, Clock::now());
  if (!open || open->member.name != request.member) {
    throw Error(ErrorCode::invalid_operation,
                "the robot's gateway has no such generator: it has ended, or was left for 10 "
                "minutes, or the gateway was started again");
  }
  if (const auto end = message.find("end")) {
    generators_.remove(name);
    if (*end == "abort") {
      open->generator.async_abort(finish(done));
    } else {
      open->generator.async_close(finish(done));
    }
    return;
  }
  const auto parameter =
      decode_element(open->definitions, open->member.generator_parameter, message.payload);
  open->generator.async_next(
      parameter, [weak = Weak(shared_from_this()), name, type = open->member.type, done](
                     const std::exception_ptr& error, const std::optional<dynamic::Value>& value) {
        const Self self = weak.lock();
        if (!self) return;
        // After an error a generator has ended, too.
        if (!value) self->generators_.remove(name);
        if (error || value) {
          give(done, type)(error, value.value_or(dynamic::Value()));
        } else {
          done(nullptr, {"", {}, {{"end", "1"}}});
        }
      });
}

}  // namespace rr::gateway
