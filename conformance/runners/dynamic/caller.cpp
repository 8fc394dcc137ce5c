// SPDX-License-Identifier: Apache-2.0
#include "conformance/runners/dynamic/caller.hpp"

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "conformance/runners/dynamic/notation.hpp"

namespace rr::conformance {
namespace {

using dynamic::Definitions;
using dynamic::MemberDescription;
using dynamic::Value;
using dynamic::ValueType;

// Values of one member, both ways.
class Typed {
 public:
  Typed(Definitions definitions, ValueType type)
      : definitions_(std::move(definitions)), type_(std::move(type)) {}
  [[nodiscard]] Value value(const Json& json) const {
    return value_of_json(definitions_, type_, json);
  }
  [[nodiscard]] Json json(const Value& value) const {
    return json_of_value(definitions_, type_, value);
  }

 private:
  Definitions definitions_;
  ValueType type_;
};

class DynamicPipe final : public PlannedPipe {
 public:
  DynamicPipe(Typed typed, dynamic::PipeEndpoint end, const Arrive& arrive)
      : typed_(std::move(typed)), end_(std::move(end)) {
    report_closing(end_, is_closing_, arrive);
    end_.on_acknowledged([arrive](std::uint32_t number) { arrive({{"ack", number}}); });
    packets_ = end_.on_packet([known = typed_, arrive](const Value& packet) {
      arrive({{"packet", known.json(packet)}});
    });
  }
  [[nodiscard]] Json index() const override { return end_.index(); }
  Json send(const Json& packet, bool acknowledged) override {
    end_.ask_for_acknowledgements(acknowledged);
    const std::uint32_t number = end_.send(typed_.value(packet));
    return end_.is_unreliable() ? Json() : Json(number);
  }
  void close() override {
    *is_closing_ = true;
    end_.close();
  }

 private:
  const Typed typed_;
  dynamic::PipeEndpoint end_;
  std::shared_ptr<std::atomic<bool>> is_closing_ = std::make_shared<std::atomic<bool>>(false);
  Subscription packets_;
};

class DynamicWire final : public PlannedWire {
 public:
  DynamicWire(Typed typed, dynamic::Wire wire) : typed_(std::move(typed)), wire_(std::move(wire)) {}
  Json peek_in() override { return typed_.json(wire_.peek_in().value); }
  Json peek_out() override { return typed_.json(wire_.peek_out().value); }
  void poke_out(const Json& value) override { wire_.poke_out(typed_.value(value)); }
  void connect(Arrive arrive) override {
    end_ = wire_.connect();
    report_closing(end_, is_closing_, arrive);
    values_ = end_.on_in([known = typed_, arrive](const Value& value, const TimeSpec&) {
      arrive({{"value", known.json(value)}});
    });
  }
  Json in() override { return typed_.json(end_.in()); }
  void set_out(const Json& value) override { end_.set_out(typed_.value(value)); }
  void close() override {
    *is_closing_ = true;
    end_.close();
  }

 private:
  const Typed typed_;
  dynamic::Wire wire_;
  dynamic::WireConnection end_;
  std::shared_ptr<std::atomic<bool>> is_closing_ = std::make_shared<std::atomic<bool>>(false);
  Subscription values_;
};

class DynamicMemory final : public PlannedMemory {
 public:
  DynamicMemory(Typed typed, bool has_dims, dynamic::Memory memory)
      : typed_(std::move(typed)), has_dims_(has_dims), memory_(std::move(memory)) {}
  Json length() override {
    if (has_dims_) throw Error(ErrorCode::invalid_operation, "It has dimensions");
    return text(memory_.length());
  }
  Json dims() override {
    Json list = Json::array();
    for (const std::uint64_t dim : memory_.dims()) list.push_back(text(dim));
    return list;
  }
  Json dim_count() override { return text(memory_.dim_count()); }
  Json read(const Json& position, const Json& count) override {
    return typed_.json(memory_.read(numbers(position), numbers(count)));
  }
  // Of more items than are to be written the first ones are meant.
  void write(const Json& position, const Json& count, const Json& value) override {
    if (has_dims_) {
      memory_.write(numbers(position), typed_.value(value));
      return;
    }
    Json items = value;
    items.erase(items.begin() + count.get<std::ptrdiff_t>(), items.end());
    memory_.write(numbers(position), typed_.value(items));
  }

 private:
  static Json text(std::uint64_t number) { return std::to_string(number); }
  static dynamic::Memory::Numbers numbers(const Json& json) {
    if (json.is_array()) return json.get<dynamic::Memory::Numbers>();
    return {json.get<std::uint64_t>()};
  }
  const Typed typed_;
  const bool has_dims_;
  const dynamic::Memory memory_;
};

class DynamicGenerator final : public PlannedGenerator {
 public:
  DynamicGenerator(Typed parameter, Typed result, dynamic::Generator generator)
      : parameter_(std::move(parameter)),
        result_(std::move(result)),
        generator_(std::move(generator)) {}
  Json next(const Json& parameter) override {
    const auto result = generator_.next(parameter_.value(parameter));
    if (!result) throw Error(ErrorCode::stop_iteration, "");
    return result_.json(*result);
  }
  void close() override { generator_.close(); }
  void abort() override { generator_.abort(); }

 private:
  const Typed parameter_;
  const Typed result_;
  dynamic::Generator generator_;
};

}  // namespace

dynamic::List DynamicCaller::arguments_of(const MemberDescription& member,
                                          const Json& arguments) const {
  return parameters_of_json(definitions_, member, arguments);
}

Json DynamicCaller::get(std::string_view property) {
  return json_of_value(definitions_, object_.member(property).type, object_.get(property));
}

void DynamicCaller::set(std::string_view property, const Json& value) {
  object_.set(property, value_of_json(definitions_, object_.member(property).type, value));
}

Json DynamicCaller::call(std::string_view function, const Json& arguments) {
  const MemberDescription member = object_.member(function);
  return json_of_value(definitions_, member.type,
                       object_.call(function, arguments_of(member, arguments)));
}

Held DynamicCaller::objref(std::string_view member, const Json& index) {
  const dynamic::Object found = index.is_null() ? object_.object(member)
                                : index.is_string()
                                    ? object_.object(member, index.get_ref<const std::string&>())
                                    : object_.object(member, index.get<std::int32_t>());
  // A varobject has no declared type: it is held as what it is. The names live in the session.
  const auto stub = found.shared_stub();
  const std::string declared = object_.member(member).object_type;
  if (declared.empty()) return {stub, stub->rr_object_type().name};
  const auto members = object_.stub().rr_object_type().members;
  const auto wire = std::ranges::find(members, member, &Member::name);
  if (wire == members.end()) throw std::logic_error("no member " + std::string(member));
  return {stub, wire->object_type};
}

Subscription DynamicCaller::listen(std::string_view event, std::function<void(Json)> handler) {
  return object_.on_event(event, [member = object_.member(event), known = definitions_,
                                  handler = std::move(handler)](const dynamic::List& values) {
    handler(json_of_parameters(known, member, values));
  });
}

std::unique_ptr<PlannedPipe> DynamicCaller::pipe(std::string_view member, std::int32_t index,
                                                 const Arrive& arrive) {
  const MemberDescription description = object_.member(member);
  const PipeOptions options{.index = index, .unreliable = (description.access & unreliable) != 0};
  return std::make_unique<DynamicPipe>(Typed(definitions_, description.type),
                                       object_.pipe(member).connect(options), arrive);
}

std::unique_ptr<PlannedWire> DynamicCaller::wire(std::string_view member) {
  return std::make_unique<DynamicWire>(Typed(definitions_, object_.member(member).type),
                                       object_.wire(member));
}

std::unique_ptr<PlannedMemory> DynamicCaller::memory(std::string_view member) {
  const ValueType type = object_.member(member).type;
  return std::make_unique<DynamicMemory>(Typed(definitions_, type), type.has_dims(),
                                         object_.memory(member));
}

std::unique_ptr<PlannedGenerator> DynamicCaller::generate(std::string_view function,
                                                          const Json& arguments) {
  const MemberDescription member = object_.member(function);
  return std::make_unique<DynamicGenerator>(
      Typed(definitions_, member.generator_parameter), Typed(definitions_, member.type),
      object_.generate(function, arguments_of(member, arguments)));
}

void DynamicCaller::set_callback(std::string_view name, std::function<Json(Json)> answer) {
  object_.callback(name).set([member = object_.member(name), known = definitions_,
                              answer = std::move(answer)](const dynamic::List& values) {
    return value_of_json(known, member.type, answer(json_of_parameters(known, member, values)));
  });
}

}  // namespace rr::conformance
