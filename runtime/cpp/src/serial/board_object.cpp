// SPDX-License-Identifier: Apache-2.0
#include "rr/error.hpp"
#include "runtime/cpp/src/serial/packing.hpp"
#include "runtime/cpp/src/serial/served_board.hpp"

namespace rr::serial {

using dynamic::Value;

namespace {

std::exception_ptr as_pointer(const Error& error) { return std::make_exception_ptr(error); }

/// What is left of a reply behind its member, which has to be a value and no more.
Value only_value(const dynamic::TypeNode& type, std::span<const std::uint8_t> bytes) {
  Value value = unpack(type, bytes);
  if (!bytes.empty()) {
    throw Error(ErrorCode::data_serialization_error, type.text() + ": the board has sent too much");
  }
  return value;
}

}  // namespace

BoardObject::BoardObject(std::shared_ptr<BoardService> service, const dynamic::ObjectTable& table,
                         std::uint8_t number)
    : service_(std::move(service)), table_(table), number_(number) {}

BoardObject::Body BoardObject::body_of(std::size_t member) const {
  return {number_, static_cast<std::uint8_t>(member)};
}

void BoardObject::rr_attached(ServiceContext& /*context*/, const std::string& /*path*/) {
  if (std::exchange(is_served_, true)) return;
  for (std::size_t member = 0; member < table_.wire_members.size(); ++member) {
    if (wire_of(member).kind == MemberKind::wire) serve_wire(member);
    if (wire_of(member).kind == MemberKind::pipe) serve_pipe(member);
  }
}

void BoardObject::rr_dispatch(std::size_t member, Request& request) {
  const dynamic::MemberTable& table = table_.members[member];
  Body body = body_of(member);
  Kind kind = Kind::Get;
  if (wire_of(member).kind == MemberKind::function) {
    kind = Kind::Call;
    dynamic::List values(table.parameters.size());
    std::vector<void*> places;
    for (Value& value : values) places.push_back(&value);
    places.push_back(nullptr);
    request.read_arguments(places.data());
    for (std::size_t at = 0; at < values.size(); ++at) {
      pack(*table.parameters[at].second, values[at], body);
    }
  } else if (request.is_set()) {
    kind = Kind::Set;
    Value value;
    request.read_value(&value);
    pack(*table.type, value, body);
  }
  if (body.size() > bodyLimit) {
    throw Error(
        ErrorCode::buffer_limit_violation,
        std::string(wire_of(member).name) + ": the values are longer than a message to a board");
  }
  const dynamic::TypeNode* const type = kind == Kind::Set ? nullptr : table.type;
  // Function has to be copied; the reply cannot.
  const auto reply = std::make_shared<ReplyHandle>(request.defer());
  service_->ask(
      kind, std::move(body),
      [self = shared_from_this(), reply, type,
       name = wire_of(member).name](const Outcome& outcome) {
        if (outcome.kind != Outcome::Kind::reply) {
          reply->fail(as_pointer(self->service_->error_of(name, outcome)));
          return;
        }
        try {
          const auto bytes = std::span(outcome.body).subspan(1);
          if (type == nullptr) {
            if (!bytes.empty()) throw Error(ErrorCode::data_serialization_error, "too much");
            Reply<void>(std::move(*reply))();
          } else {
            const Value value = only_value(*type, bytes);
            Reply<Value>(std::move(*reply))(value);
          }
        } catch (const Error& error) {
          reply->fail(as_pointer(error));
        }
      },
      ServiceContext::current_client());
}

std::shared_ptr<Skeleton> BoardObject::rr_child(std::size_t member, const ObjectIndex& index) {
  Body body = body_of(member);
  if (wire_of(member).index == IndexForm::int32) {
    const auto number = static_cast<std::uint32_t>(index.number);
    for (unsigned at = 0; at < 4; ++at) {
      body.push_back(static_cast<std::uint8_t>((number >> (8 * at)) & 0xFF));
    }
  }
  const Outcome outcome = service_->ask(Kind::Child, std::move(body));
  if (outcome.kind != Outcome::Kind::reply) throw service_->error_of(wire_of(member).name, outcome);
  if (outcome.body.size() != 2) {
    throw Error(ErrorCode::data_serialization_error, "the board has sent no object");
  }
  return service_->object(outcome.body[1], table_.members[member].object_type);
}

Value BoardObject::peek(std::size_t member) {
  const Outcome outcome = service_->ask(Kind::Get, body_of(member));
  if (outcome.kind != Outcome::Kind::reply) throw service_->error_of(wire_of(member).name, outcome);
  return only_value(*table_.members[member].type, std::span(outcome.body).subspan(1));
}

void BoardObject::serve_wire(std::size_t member) {
  const WireServer<Value> wire(*this, wire_of(member));
  const std::weak_ptr<BoardObject> weak = weak_from_this();
  const auto number = static_cast<std::uint8_t>(member);
  if ((wire_of(member).access & writeonly) == 0) {
    wire.on_peek_in([weak, member]() -> Value {
      const auto self = weak.lock();
      if (!self) throw Error(ErrorCode::connection_error, "the board has gone");
      return self->peek(member);
    });
    wire.on_connect([weak, wire, number](ServedWire<Value> end) {
      const auto self = weak.lock();
      if (!self) return;
      self->service_->open(self->number_, number, true);
      end.on_closed([weak, wire, number] {
        const auto object = weak.lock();
        if (object && wire.connection_count() == 0) {
          object->service_->open(object->number_, number, false);
        }
      });
    });
  }
  if ((wire_of(member).access & readonly) == 0) {
    wire.on_out([weak, member](const Value& value, const TimeSpec&, std::uint32_t) {
      const auto self = weak.lock();
      if (!self) return;
      Body body = self->body_of(member);
      pack(*self->table_.members[member].type, value, body);
      self->service_->set_wire(std::move(body), [self, member](const Outcome& outcome) {
        self->service_->report_lost("a value of a wire", self->wire_of(member).name, outcome);
      });
    });
  }
}

void BoardObject::serve_pipe(std::size_t member) {
  const PipeServer<Value> pipe(*this, wire_of(member));
  const std::weak_ptr<BoardObject> weak = weak_from_this();
  const auto number = static_cast<std::uint8_t>(member);
  pipe.on_connect([weak, pipe, member, number](PipeEndpoint<Value> end) {
    const auto self = weak.lock();
    if (!self) return;
    self->service_->open(self->number_, number, true);
    end.on_closed([weak, pipe, number] {
      const auto object = weak.lock();
      if (object && pipe.endpoint_count() == 0) {
        object->service_->open(object->number_, number, false);
      }
    });
    if ((self->wire_of(member).access & readonly) != 0) return;
    end.on_packet([weak, member](const Value& value) {
         const auto object = weak.lock();
         if (!object) return;
         Body body = object->body_of(member);
         pack(*object->table_.members[member].type, value, body);
         object->service_->ask(Kind::Packet, std::move(body), [object, member](const Outcome& one) {
           object->service_->report_lost("a packet", object->wire_of(member).name, one);
         });
       })
        .detach();
  });
}

dynamic::List BoardObject::parameters_in(std::size_t member,
                                         std::span<const std::uint8_t>& bytes) const {
  dynamic::List values;
  for (const auto& [name, type] : table_.members[member].parameters) {
    values.push_back(unpack(*type, bytes));
  }
  if (!bytes.empty()) throw Error(ErrorCode::data_serialization_error, "too much");
  return values;
}

void BoardObject::handle(const Unasked& one) {
  const std::size_t member = one.body[1];
  if (member >= table_.members.size()) return;
  std::span<const std::uint8_t> bytes = std::span(one.body).subspan(2);
  const Member& wire = wire_of(member);
  try {
    if (one.kind == Kind::Event && wire.kind == MemberKind::event) {
      const dynamic::List values = parameters_in(member, bytes);
      std::vector<const void*> places;
      for (const Value& value : values) places.push_back(&value);
      places.push_back(nullptr);
      rr_fire(wire, places.data());
    } else if (one.kind == Kind::WireValue && wire.kind == MemberKind::wire) {
      WireServer<Value>(*this, wire).set_in(only_value(*table_.members[member].type, bytes));
    } else if (one.kind == Kind::OutPacket && wire.kind == MemberKind::pipe) {
      PipeServer<Value>(*this, wire).send(only_value(*table_.members[member].type, bytes));
    } else if (one.kind == Kind::Ask && wire.kind == MemberKind::callback && !bytes.empty()) {
      const std::uint32_t client = service_->client_of(bytes.front());
      bytes = bytes.subspan(1);
      const dynamic::List values = parameters_in(member, bytes);
      service_->node().run_aside([self = shared_from_this(), member, values, client] {
        self->answer_callback(member, values, client);
      });
    }
  } catch (const Error&) {
    // Its CRC was right, so the sketch is wrong about its own definition. Nobody has asked for it.
    return;
  }
}

template <class... Arguments>
Value BoardObject::call_back_with(std::size_t member, const dynamic::List& rest,
                                  std::uint32_t client, const Arguments&... before) {
  if constexpr (sizeof...(Arguments) <= most_callback_parameters) {
    if (sizeof...(Arguments) < rest.size()) {
      return call_back_with(member, rest, client, before..., rest[sizeof...(Arguments)]);
    }
    if (table_.members[member].type != nullptr) {
      return rr_call_back<Value>(wire_of(member), {}, client, before...);
    }
    rr_call_back<void>(wire_of(member), {}, client, before...);
    return {};
  } else {
    throw Error(ErrorCode::not_implemented_error, "a callback with too many parameters");
  }
}

Value BoardObject::call_back(std::size_t member, const dynamic::List& arguments,
                             std::uint32_t client) {
  return call_back_with(member, arguments, client);
}

void BoardObject::answer_callback(std::size_t member, const dynamic::List& arguments,
                                  std::uint32_t client) {
  const dynamic::MemberTable& table = table_.members[member];
  Body body = body_of(member);
  try {
    const Value result = call_back(member, arguments, client);
    body.push_back(0);
    if (table.type != nullptr) pack(*table.type, result, body);
  } catch (const Error& error) {
    body.resize(2);
    body.push_back(code_of(error, service_->exceptions()));
  }
  service_->ask(Kind::Answer, std::move(body),
                [self = shared_from_this(), member](const Outcome& outcome) {
                  self->service_->report_lost("the answer to a callback",
                                              self->wire_of(member).name, outcome);
                });
}

}  // namespace rr::serial
