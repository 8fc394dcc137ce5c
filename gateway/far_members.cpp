// SPDX-License-Identifier: Apache-2.0
// Members of a robot's objects as they are offered here. Functions of members hold the requests and
// not the service, which has the objects.
#include <future>
#include <utility>

#include "gateway/elements.hpp"
#include "gateway/far_service.hpp"
#include "gateway/properties.hpp"
#include "rr/error.hpp"

namespace rr::gateway {
namespace {

constexpr std::size_t most_unsent = std::size_t{1} << 20U;  // bytes to one client

using dynamic::Reply;
using dynamic::Value;

/// Answers a client with the value in an answer of the robot.
FarCalls::Done reply_with(dynamic::Definitions definitions, dynamic::ValueType type, Reply reply) {
  return [definitions = std::move(definitions), type = std::move(type), reply = std::move(reply)](
             const std::exception_ptr& error, const Message& answer) {
    try {
      if (error) std::rethrow_exception(error);
      reply(decode_element(definitions, type, answer.payload));
    } catch (...) {
      reply.fail(std::current_exception());
    }
  };
}

/// The request that ends a generator whose steps are asked for by `next`.
FarRequest end_of(FarRequest next, bool aborts) {
  next.properties.emplace_back("end", aborts ? "abort" : "close");
  return next;
}

std::optional<std::string> index_text(const Value& index) {
  if (index.is_null()) return std::nullopt;
  if (index.kind() == dynamic::Kind::text) return index.text();
  return std::to_string(index.as<std::int32_t>());
}

}  // namespace

dynamic::ServedObject FarService::make_object(const std::string& path, const std::string& type) {
  dynamic::ServedObject object(*definitions_, type);
  objects_[path] = object;
  for (const dynamic::MemberDescription& member : object.members()) {
    switch (member.kind) {
      case MemberKind::property:
        serve_property(object, path, member);
        break;
      case MemberKind::function:
        serve_function(object, path, member);
        break;
      case MemberKind::objref:
        serve_objref(object, path, member);
        break;
      case MemberKind::wire:
        serve_wire(object, path, member);
        break;
      case MemberKind::pipe:
        serve_pipe(object, path, member);
        break;
      case MemberKind::event:
        serve_event(object, path, member);
        break;
      case MemberKind::memory:
        serve_memory(object, path, member);
        break;
      // Called by the robot: far_callbacks.cpp.
      case MemberKind::callback:
        break;
    }
  }
  return object;
}

void FarService::serve_property(const dynamic::ServedObject& object, const std::string& path,
                                const dynamic::MemberDescription& member) {
  const auto sessions = sessions_;
  if ((member.access & writeonly) == 0) {
    object.on_get_later(
        member.name, [sessions, address = address_, path, name = member.name, type = member.type,
                      definitions = *definitions_](const Reply& reply) {
          sessions->request(ServiceContext::current_client(), {address, Verb::get, path, name},
                            reply_with(definitions, type, reply));
        });
  }
  if ((member.access & readonly) != 0) return;
  object.on_set_later(
      member.name, [sessions, address = address_, path, name = member.name, type = member.type,
                    definitions = *definitions_](const Value& value, const Reply& reply) {
        sessions->request(ServiceContext::current_client(),
                          {address, Verb::set, path, name, encode_element(type, value)},
                          reply_with(definitions, {}, reply));
      });
}

void FarService::serve_function(const dynamic::ServedObject& object, const std::string& path,
                                const dynamic::MemberDescription& member) {
  if (member.generator != GeneratorForm::none) {
    serve_generator(object, path, member);
    return;
  }
  object.on_call_later(member.name, [sessions = sessions_, address = address_, path, member,
                                     definitions = *definitions_](const dynamic::List& arguments,
                                                                  const Reply& reply) {
    sessions->request(
        ServiceContext::current_client(),
        {address, Verb::call, path, member.name, encode_arguments(member.parameters, arguments)},
        reply_with(definitions, member.type, reply));
  });
}

// Opening it and each step wait for the robot on a thread of the node.
void FarService::serve_generator(const dynamic::ServedObject& object, const std::string& path,
                                 const dynamic::MemberDescription& member) {
  object.on_generate(member.name, [sessions = sessions_, address = address_, path, member,
                                   definitions = *definitions_](const dynamic::List& arguments) {
    const std::uint32_t client = ServiceContext::current_client();
    const Message opened = sessions->wait(client, {address, Verb::call, path, member.name,
                                                   encode_arguments(member.parameters, arguments)});
    FarRequest next{address, Verb::next, path, member.name};
    next.properties = {{"generator", std::string(opened.find("generator").value_or(""))}};
    return dynamic::Steps(
        [sessions, client, next, member,
         definitions](const Value& parameter) -> std::optional<Value> {
          FarRequest step = next;
          step.payload = encode_element(member.generator_parameter, parameter);
          try {
            const Message answer = sessions->wait(client, std::move(step));
            if (answer.find("end")) return std::nullopt;
            return decode_element(definitions, member.type, answer.payload);
          } catch (...) {
            // It has ended here, perhaps without the robot's notice.
            sessions->request(client, end_of(next, true),
                              [](const std::exception_ptr&, const Message&) {});
            throw;
          }
        },
        [sessions, client, next](bool aborts) { sessions->wait(client, end_of(next, aborts)); });
  });
}

// Each request asks the robot for the dimensions as well, which it may change.
void FarService::serve_memory(const dynamic::ServedObject& object, const std::string& path,
                              const dynamic::MemberDescription& member) {
  using Numbers = dynamic::MemoryFunctions::Numbers;
  const FarRequest get{address_, Verb::get, path, member.name};
  const auto part = [](const Numbers& position, const Numbers& count) {
    return Properties{{"position", list_text(position)}, {"count", list_text(count)}};
  };
  dynamic::MemoryFunctions functions;
  functions.dims = [sessions = sessions_, get] {
    const auto dims = numbers_property(sessions->wait(get), "dims");
    if (dims) return *dims;
    throw Error(ErrorCode::internal_error, "the robot's gateway does not say the dimensions");
  };
  if ((member.access & writeonly) == 0) {
    functions.read = [sessions = sessions_, get, part, type = member.type,
                      definitions = *definitions_](const Numbers& position, const Numbers& count) {
      FarRequest request = get;
      request.properties = part(position, count);
      return decode_element(definitions, type, sessions->wait(std::move(request)).payload);
    };
  }
  if ((member.access & readonly) == 0) {
    functions.write = [sessions = sessions_, get, type = member.type](const Numbers& position,
                                                                      const Value& items) {
      FarRequest request = get;
      request.verb = Verb::set;
      request.properties = {{"position", list_text(position)}};
      request.payload = encode_element(type, items);
      sessions->wait(std::move(request));
    };
  }
  object.serve_memory(member.name, std::move(functions));
}

// The client's request waits for the robot, which knows whether there is such an object, and of
// which type.
void FarService::serve_objref(const dynamic::ServedObject& object, const std::string& path,
                              const dynamic::MemberDescription& member) {
  object.on_object(
      member.name,
      [weak = Weak(shared_from_this()), sessions = sessions_, address = address_, path,
       name = member.name](const Value& index) -> std::shared_ptr<Skeleton> {
        const std::string below = path_below(path, {name, index_text(index)});
        const Message answer = sessions->wait({address, Verb::object, below, ""});
        const Self self = weak.lock();
        if (!self) return nullptr;
        // Streams and wires of the object belong to the worker's thread.
        const auto promise = std::make_shared<std::promise<std::shared_ptr<Skeleton>>>();
        auto made = promise->get_future();
        self->shared_.worker.post(
            [self, below, promise, type = std::string(answer.find("type").value_or(""))] {
              try {
                promise->set_value(self->make_object(below, type).skeleton());
              } catch (...) {
                promise->set_exception(std::current_exception());
              }
              self->shared_.pump();
            });
        return made.get();
      });
}

// Peeks ask the robot, which may have another value than the newest that was sent.
void FarService::serve_peeks(const dynamic::ServedObject& object, const std::string& path,
                             const dynamic::MemberDescription& member) {
  const auto peek = [sessions = sessions_,
                     request = FarRequest{address_, Verb::get, path, member.name},
                     type = member.type, definitions = *definitions_](const char* side) {
    FarRequest wanted = request;
    wanted.properties = {{"peek", side}};
    return decode_element(definitions, type, sessions->wait(std::move(wanted)).payload);
  };
  if ((member.access & writeonly) == 0) {
    object.wire(member.name).on_peek_in([peek] { return peek("in"); });
  }
  if ((member.access & readonly) == 0) {
    object.wire(member.name).on_peek_out([peek] { return peek("out"); });
  }
}

void FarService::serve_wire(const dynamic::ServedObject& object, const std::string& path,
                            const dynamic::MemberDescription& member) {
  serve_peeks(object, path, member);
  if ((member.access & readonly) == 0) {
    object.wire(member.name)
        .on_out([sessions = sessions_, address = address_, path, name = member.name,
                 type = member.type](const Value& value, const TimeSpec&, std::uint32_t client) {
          sessions->request(client, {address, Verb::poke, path, name, encode_element(type, value)},
                            [](const std::exception_ptr&, const Message&) {});
        });
  }
  if ((member.access & writeonly) != 0) return;
  const std::string topic = member_topic(address_, path, member.name);
  wires_[topic] = {object, member};
  shared_.values.subscribe(topic);
}

void FarService::take_value(const Message& message) {
  const auto found = wires_.find(message.topic);
  if (found == wires_.end()) return;
  FarWire& wire = found->second;
  const auto epoch = number_property(message, "stream", 16);
  const auto number = number_property(message, "number");
  if (!epoch || !number) return;
  if (!wire.order.take(*epoch, *number, ValueOrder::Clock::now())) return;
  try {
    wire.object.wire(wire.member.name)
        .set_in(decode_element(*definitions_, wire.member.type, message.payload));
  } catch (const Error& error) {
    shared_.log(LogLevel::warning, message.topic + ": " + error.what());
  }
}

void FarService::serve_pipe(const dynamic::ServedObject& object, const std::string& path,
                            const dynamic::MemberDescription& member) {
  const auto pipe = object.pipe(member.name);
  take_packets(pipe, path, member);
  if ((member.access & writeonly) != 0) return;
  StreamReader::Sink sink;
  sink.record = [this, pipe, member](const Message& message) {
    try {
      pipe.send(decode_element(*definitions_, member.type, message.payload));
    } catch (const Error& error) {
      shared_.log(LogLevel::warning, message.topic + ": " + error.what());
    }
  };
  // A client can not be told of a gap but by the end of its endpoint.
  sink.gap = [this, pipe, name = member.name](const StreamGap& gap) {
    report_gap(name, gap);
    for (dynamic::PipeEndpoint& end : pipe.endpoints()) end.close();
  };
  add_stream(path, member.name, std::move(sink), [pipe] {
    for (const dynamic::PipeEndpoint& end : pipe.endpoints()) {
      if (end.is_open() && !end.wait_sent(std::chrono::milliseconds(0), most_unsent)) return false;
    }
    return true;
  });
}

/// Packets of clients, each of whose endpoints has one at the robot.
void FarService::take_packets(const dynamic::PipeServer& pipe, const std::string& path,
                              const dynamic::MemberDescription& member) {
  if ((member.access & readonly) != 0) return;
  const FarRequest request{address_, Verb::send, path, member.name};
  pipe.on_connect([sessions = sessions_, log = shared_.log, topic = topic_, request,
                   type = member.type](dynamic::PipeEndpoint end) {
    const auto packets = std::make_shared<FarPackets>(
        sessions, ServiceContext::current_client(), request, type, FarPackets::Limits(),
        [log, topic, end, name = request.member](const std::string& reason) mutable {
          log(LogLevel::warning, topic + ": packets for `" + name + "` are lost: " + reason);
          end.close();
        });
    const auto kept = std::make_shared<Subscription>();
    *kept = end.on_packet([packets](const Value& packet) { packets->add(packet); });
    end.on_closed([kept, packets] {
      packets->end();
      *kept = Subscription();
    });
  });
}

void FarService::serve_event(const dynamic::ServedObject& object, const std::string& path,
                             const dynamic::MemberDescription& member) {
  StreamReader::Sink sink;
  sink.record = [this, object = dynamic::WeakServedObject(object), member](const Message& message) {
    const dynamic::ServedObject served = object.lock();
    if (!served) return;
    try {
      served.fire(member.name, decode_arguments(*definitions_, member.parameters, message.payload));
    } catch (const Error& error) {
      shared_.log(LogLevel::warning, message.topic + ": " + error.what());
    }
  };
  sink.gap = [this, name = member.name](const StreamGap& gap) { report_gap(name, gap); };
  add_stream(path, member.name, std::move(sink), [] { return true; });
}

void FarService::add_stream(const std::string& path, const std::string& member,
                            StreamReader::Sink sink, Function<bool()> has_room) {
  // The object was released and is found anew: what its clients have got is not given again.
  const auto known = streams_.find(member_topic(address_, path, member));
  if (known != streams_.end()) {
    known->second->redirect(std::move(sink), std::move(has_room));
    return;
  }
  auto stream = std::make_unique<FarStream>(address_, path, member, shared_.reader, std::move(sink),
                                            std::move(has_room));
  shared_.carrier.subscribe(stream->topic());
  stream->reconnected(shared_.outbox);
  streams_[stream->topic()] = std::move(stream);
}

void FarService::report_gap(const std::string& member, const StreamGap& gap) {
  const std::string what = gap.first == 0 ? "an unknown number of records is missing"
                                          : "records " + std::to_string(gap.first) + " to " +
                                                std::to_string(gap.last) + " are lost";
  shared_.log(LogLevel::warning, topic_ + ": " + member + ": " + what);
}

}  // namespace rr::gateway
